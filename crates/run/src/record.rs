//! What a run writes while it rolls, and when.

mod images;
mod row;

use self::images::{Images, mirrored};
use self::row::{PatchMeasures, Resultants, Whereabouts, row};
use crate::error::RunError;
use crate::means::Means;
use crate::mesh_mode::WatchedFaces;
use crate::probes::Probes;
use case::hertz::patch_shape;
use case::schema::{Case, Window};
use contact::NodalContact;
use contact::patch::{self, PatchShape};
use dynamics::{Hub, Simulation, StepReport, Travel};
use mesh::Padded;
use output::layout::{
    BODIES, BODY_NAMES, BodyFields, CONTACT, ContactFields, HISTORY, MORTAR, NODE_TO_FACE, Pairing,
    attribute, file,
};
use output::{
    BackgroundWriter, Cells, Checkpoint, FieldSpec, GridSpec, History, Kept, OutputError,
    Provenance, Results, RunFiles, Snapshot, StaticField, TransientGrid, Values,
};
use scenario::{BAR, DISK, Model};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::path::Path;
use std::time::{Duration, Instant};

/// Rows of the history gathered before they are handed to the writer.
const HISTORY_BATCH: usize = 64;

/// Nodes of both contact zones and the motion copied from them before a step.
struct Zones {
    tables: [NodalContact; 2],
    /// Whether records at t^n hold the velocities of the step before (t^{n-1/2}) or after (t^{n+1/2}).
    pairing: Pairing,
    displacement: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
}

impl Zones {
    fn copy_velocity(&mut self, simulation: &Simulation) {
        let nodes = self.tables.iter().flat_map(|t| &t.nodes);
        for (v, &node) in self.velocity.iter_mut().zip(nodes) {
            *v = simulation.velocity()[node as usize].xyz();
        }
    }
}

/// Writes fields, contact surfaces, history and probes, and gathers the means over the evaluation window.
pub(crate) struct Recorder {
    writer: BackgroundWriter,
    zones: Zones,
    enforced_on: Option<usize>,
    fields: Schedule,
    contact_every: u64,
    /// First and last step of each output window, and its interval (steps).
    windows: Vec<(u64, u64, u64)>,
    history_every: u64,
    /// Rows of the history that are not yet handed to the writer.
    rows: Vec<f64>,
    probes: Option<Probes>,
    stress: bool,
    /// Nodes of the disk, which moves with the hub but for its deformation.
    disk: Range<usize>,
    images: Images,
    /// Undeformed positions of the zones' nodes (m), and of those of the bar with their images.
    points: [Vec<[f64; 3]>; 2],
    whole_bar: Vec<[f64; 3]>,
    /// Buffer: pressures (Pa) there.
    whole_pressure: Vec<f64>,
    /// Rows of the bar's table on the centre line, by x.
    centreline: Vec<usize>,
    shape: PatchShape,
    /// Buffer: x (m) of the nodes of the centre line in contact, and whether they stick.
    line: Vec<(f64, bool)>,
    effective_radius: f64,
    speed: f64,
    /// How many parts alike make up the bodies, of which one is modelled.
    parts: f64,
    hertz_pressure: f64,
    /// The evaluation window (s).
    evaluate: [f64; 2],
    mesh_mode: WatchedFaces,
    pub(crate) means: Means,
    /// Wall time of output on the time loop's side.
    pub(crate) wall: Duration,
}

/// Times at which snapshots of the fields are due: an interval apart, or at every step where steps are longer (s).
struct Schedule {
    interval: f64,
    next: f64,
}

impl Schedule {
    /// Moves on to the first instant of the schedule after `time`, at which a snapshot was due.
    fn advance(&mut self, time: f64) {
        self.next += self.interval;
        // where steps are longer than the interval: all of those between at once
        if self.next <= time {
            let between = ((time - self.next) / self.interval).floor();
            let next = self.next + (between + 1.0) * self.interval;
            self.next = next.min(time + self.interval);
        }
    }
}

/// What the files of a run are made from besides the case.
pub(crate) struct RecordBasis<'a> {
    pub(crate) folder: &'a Path,
    pub(crate) provenance: Provenance,
    pub(crate) effective_radius: f64,
    pub(crate) hertz_pressure: f64,
    /// How much of the existing files a resumed run keeps; none for a run that begins.
    pub(crate) keeps: Option<Results>,
}

impl RecordBasis<'_> {
    fn grid(
        &self,
        name: &str,
        grid: &GridSpec<'_>,
        fields: &[FieldSpec],
        provenance: &Provenance,
        of: fn(&Results) -> &Kept,
    ) -> Result<TransientGrid, RunError> {
        let path = self.folder.join(name);
        Ok(match &self.keeps {
            Some(kept) => TransientGrid::reopen(path, grid, fields, of(kept))?,
            None => TransientGrid::create(path, grid, fields, provenance)?,
        })
    }

    pub(crate) fn history(
        &self,
        name: &str,
        columns: &[FieldSpec],
        of: fn(&Results) -> &Kept,
    ) -> Result<History, RunError> {
        let path = self.folder.join(name);
        Ok(match &self.keeps {
            Some(kept) => History::reopen(path, columns, of(kept))?,
            None => History::create(path, columns, &self.provenance)?,
        })
    }
}

/// What the recorder carries from step to step, once all rows are handed to the writer.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct RecorderState {
    /// When the next snapshot of the fields is due (s).
    pub(crate) next_fields: f64,
    pub(crate) means: Means,
    /// Wall time of output so far.
    pub(crate) wall: Duration,
}

impl Recorder {
    pub(crate) fn new(
        case: &Case,
        model: &Model,
        simulation: &Simulation,
        basis: &RecordBasis<'_>,
    ) -> Result<Self, RunError> {
        let contact = simulation.contact().ok_or(RunError::NoContact)?;
        let tables = [DISK, BAR].map(|side| contact.nodal_table_of(side, &model.zones[side]));
        let points = [DISK, BAR].map(|side| {
            tables[side].nodes.iter().map(|&n| model.mesh.nodes[n as usize]).collect::<Vec<_>>()
        });
        let hertz_pressure = basis.hertz_pressure;
        let mesh_mode =
            WatchedFaces::new(case, model, &tables, contact.enforced_on(), hertz_pressure)?;
        let images = Images::new(&model.mesh, &points);
        let mut whole_bar = Vec::with_capacity(images.counts()[BAR]);
        images.of_side(BAR, &points[BAR], mirrored, &mut whole_bar);
        let surface = ContactSurfaces {
            tables: &tables,
            points: &points,
            faces: mesh_mode.faces(),
            images: &images,
        };
        let files = RunFiles {
            fields: create_fields(case, model, basis)?,
            contact: create_contact(case, &surface, contact.enforced_on(), basis)?,
            history: basis.history(
                file::HISTORY,
                &HISTORY.each().map(FieldSpec::clone),
                |results| &results.history,
            )?,
        };
        let count = tables[DISK].nodes.len() + tables[BAR].nodes.len();
        let centreline = centreline(&points[BAR], case.mesh.zone.size);
        let steps_in = |interval: f64| (interval / simulation.dt()).round().max(1.0) as u64;
        let window = |w: &Window| {
            let step = |t: f64| (t / simulation.dt()).round() as u64;
            (step(w.from), step(w.to), w.every)
        };
        Ok(Self {
            writer: BackgroundWriter::start(files)?,
            probes: Probes::new(case, model, simulation, basis)?,
            line: Vec::with_capacity(centreline.len()),
            zones: Zones {
                tables,
                pairing: pairing(contact.enforced_on()),
                displacement: vec![[0.0; 3]; count],
                velocity: vec![[0.0; 3]; count],
            },
            enforced_on: contact.enforced_on(),
            fields: Schedule { interval: case.fields_interval(), next: 0.0 },
            contact_every: steps_in(case.output.contact_interval),
            windows: case.output.window.iter().map(window).collect(),
            history_every: case.output.history_interval,
            rows: Vec::with_capacity(HISTORY_BATCH * HISTORY.each().len()),
            stress: case.output.stress,
            disk: model.mesh.bodies[DISK].nodes.clone(),
            whole_pressure: Vec::with_capacity(whole_bar.len()),
            whole_bar,
            images,
            points,
            centreline,
            shape: patch_shape(case),
            effective_radius: basis.effective_radius,
            speed: case.drive.speed,
            parts: model.parts,
            hertz_pressure,
            evaluate: case.evaluation_window(),
            mesh_mode,
            means: Means::default(),
            wall: Duration::ZERO,
        })
    }

    /// The state, after all rows are handed to the writer.
    pub(crate) fn snapshot(&mut self) -> Result<RecorderState, RunError> {
        self.flush_history()?;
        if let Some(probes) = &mut self.probes {
            probes.flush()?;
        }
        let (next_fields, means) = (self.fields.next, self.means.clone());
        Ok(RecorderState { next_fields, means, wall: self.wall })
    }

    /// Takes over the state of the recorder that began the files.
    pub(crate) fn restore(&mut self, state: &RecorderState) {
        self.fields.next = state.next_fields;
        self.means = state.means.clone();
        self.wall = state.wall;
    }

    /// Has the writer write the checkpoint that `make` returns, after everything sent before.
    pub(crate) fn keep(
        &mut self,
        make: impl FnOnce(Results) -> Result<Checkpoint, OutputError> + Send + 'static,
        folder: &Path,
    ) -> Result<(), RunError> {
        let probes = self.probes.as_ref().map(Probes::file);
        let beside = probes.map(|history| (history.path().to_owned(), history.kept()));
        Ok(self.writer.keep(make, folder, beside)?)
    }

    /// Whether step `n` writes a row of the history, and so needs the energies.
    pub(crate) fn reads(&self, n: u64) -> bool {
        n.is_multiple_of(self.history_every)
    }

    fn records_contact(&self, n: u64) -> bool {
        n.is_multiple_of(self.contact_every)
            || self.windows.iter().any(|&(from, to, every)| {
                (from..=to).contains(&n) && (n - from).is_multiple_of(every)
            })
    }

    /// To be called with the state at t^n, before the step moves it on.
    pub(crate) fn before_step(&mut self, simulation: &Simulation) -> Result<(), RunError> {
        let clock = Instant::now();
        let n = simulation.steps() as u64;
        if simulation.time() >= self.fields.next {
            self.write_fields(simulation)?;
            self.fields.advance(simulation.time());
        }
        if self.records_contact(n) {
            let nodes = self.zones.tables.iter().flat_map(|t| &t.nodes);
            for (u, &node) in self.zones.displacement.iter_mut().zip(nodes) {
                *u = moved(simulation.displacement()[node as usize].xyz(), simulation.travel());
            }
            if self.zones.pairing == Pairing::Before {
                self.zones.copy_velocity(simulation);
            }
        }
        self.wall += clock.elapsed();
        Ok(())
    }

    /// To be called after the step from t^n, with what it found at t^n.
    pub(crate) fn after_step(
        &mut self,
        simulation: &Simulation,
        report: &StepReport,
    ) -> Result<(), RunError> {
        let clock = Instant::now();
        let n = report.step as u64;
        let resultants =
            Resultants::of(report, self.effective_radius, self.speed, self.parts > 1.0);
        let inside = (self.evaluate[0]..=self.evaluate[1]).contains(&report.time);
        self.means.add_step(report, &resultants, inside);
        if let Some(probes) = &mut self.probes {
            probes.record(simulation, report)?;
        }
        let (reads, records) = (self.reads(n), self.records_contact(n));
        if let Some(contact) = simulation.contact()
            && (reads || records)
        {
            self.zones.tables.iter_mut().for_each(|t| contact.nodal(t));
        }
        if records {
            if self.zones.pairing == Pairing::After {
                self.zones.copy_velocity(simulation);
            }
            self.write_contact(report.time)?;
        }
        if reads && inside {
            self.mesh_mode.slip(&self.zones.tables, &mut self.means.mesh_mode);
        }
        if inside {
            let (solid, displacement) = (simulation.solid(), simulation.displacement());
            let step = [report.time, simulation.dt()];
            self.mesh_mode.energy(step, solid, displacement, &mut self.means.mesh_mode);
        }
        if reads {
            let energies = report.energies.unwrap_or_default();
            let hub = simulation.hub().map(|h| h.state).unwrap_or_default();
            let patch = self.patch(hub.x);
            self.means.add_patch(&patch, &energies, inside);
            let travel = simulation.travel();
            let at = Whereabouts {
                hub_x: hub.x + travel.x,
                hub_z: hub.z,
                window_x: travel.x,
                window_energy: simulation.ledger().moved,
                imbalance: simulation.ledger().imbalance(&energies),
            };
            self.rows.extend(row(report, &resultants, &patch, &at).each());
            if self.rows.len() >= HISTORY_BATCH * HISTORY.each().len() {
                self.flush_history()?;
            }
        }
        self.wall += clock.elapsed();
        Ok(())
    }

    /// The patch on the bar by the present tables, with the hub at `hub_x` (m).
    fn patch(&mut self, hub_x: f64) -> PatchMeasures {
        let bar = &self.zones.tables[BAR];
        self.whole_pressure.clear();
        self.images.of_side(BAR, &bar.pressure, |p| p, &mut self.whole_pressure);
        let fit = patch::fit(self.shape, &self.whole_bar, &self.whole_pressure);
        let fit = fit.map_or([f64::NAN; 4], |f| [f.a, f.b, f.p0, f.xc - hub_x]);
        let areas = patch::areas(&bar.pressure, &bar.area, &bar.state);
        PatchMeasures {
            fit,
            areas: patch::PatchAreas { contact: self.parts * areas.contact, ..areas },
            peak_shear: bar.shear.iter().map(|s| length(*s)).fold(0.0, f64::max),
            cone_excess: self.cone_excess(),
            stick_border: self.stick_border(hub_x + fit[3]),
        }
    }

    /// Writes the remaining rows and the final state, and closes the files. Returns the means, and the wall time of
    /// output.
    pub(crate) fn finish(mut self, simulation: &Simulation) -> Result<(Means, Duration), RunError> {
        let clock = Instant::now();
        self.flush_history()?;
        self.write_fields(simulation)?;
        if let Some(probes) = &mut self.probes {
            probes.flush()?;
        }
        self.writer.finish()?;
        Ok((self.means, self.wall + clock.elapsed()))
    }

    fn flush_history(&mut self) -> Result<(), RunError> {
        if !self.rows.is_empty() {
            self.writer.append_history(&self.rows)?;
            self.rows.clear();
        }
        Ok(())
    }

    fn write_fields(&mut self, simulation: &Simulation) -> Result<(), RunError> {
        let (stress, disk) = (self.stress, &self.disk);
        let rigid = simulation.hub().map(Hub::rigid_motion);
        let reference = simulation.solid().reference();
        let deformation = |(node, u): (usize, &Padded)| match &rigid {
            Some(motion) if disk.contains(&node) => {
                let (u, carried) = (u.xyz(), motion(reference[node].xyz()));
                [0, 1, 2].map(|i| u[i] - carried[i])
            }
            _ => u.xyz(),
        };
        let (displacement, solid) = (simulation.displacement(), simulation.solid());
        let cauchy = |to: &mut Snapshot<'_>| {
            to.tensors(solid.elements(), |out| solid.cauchy_stress(displacement, out));
        };
        let fields = BodyFields::<Option<&dyn Fn(&mut Snapshot<'_>)>> {
            displacement: Some(&|to| {
                to.vectors(displacement.iter().map(|u| moved(u.xyz(), simulation.travel())));
            }),
            deformation: Some(&|to| to.vectors(displacement.iter().enumerate().map(deformation))),
            velocity: Some(&|to| to.vectors(simulation.velocity().iter().map(|v| v.xyz()))),
            stress: stress.then_some(&cauchy),
        };
        Ok(self.writer.append_fields_with(simulation.time(), |snapshot| {
            fields.each().into_iter().flatten().for_each(|fill| fill(snapshot));
        })?)
    }

    fn write_contact(&mut self, time: f64) -> Result<(), RunError> {
        let Zones { tables: [disk, bar], pairing, displacement, velocity } = &self.zones;
        let images = &self.images;
        let sides = |values: &'_ [[f64; 3]]| {
            let (disk, bar) = values.split_at(disk.nodes.len());
            images.vectors([disk, bar])
        };
        let pressure = images.scalars([&disk.pressure, &bar.pressure]);
        let shear = images.vectors([&disk.shear, &bar.shear]);
        let slip_velocity = images.vectors([&disk.slip_velocity, &bar.slip_velocity]);
        let slip = images.vectors([&disk.slip, &bar.slip]);
        let mu = images.scalars([&disk.mu, &bar.mu]);
        let state = images.scalars([&disk.state[..], &bar.state]);
        let gap = images.scalars([&disk.gap, &bar.gap]);
        let pass_pressure = images.scalars([&disk.pass_pressure, &bar.pass_pressure]);
        let (velocity, displacement) = (sides(velocity), sides(displacement));
        let values = ContactFields {
            pressure: Some(Values::Scalar(&pressure)),
            shear: Some(Values::Vector(&shear)),
            slip_velocity: Some(Values::Vector(&slip_velocity)),
            slip: Some(Values::Vector(&slip)),
            mu: Some(Values::Scalar(&mu)),
            state: Some(Values::Integer(&state)),
            gap: Some(Values::Scalar(&gap)),
            velocity: Some(Values::Vector(&velocity)),
            displacement: Some(Values::Vector(&displacement)),
            pass_pressure: Some(Values::Scalar(&pass_pressure))
                .filter(|_| *pairing == Pairing::Before),
        };
        let values: Vec<_> = values.each().into_iter().copied().flatten().collect();
        Ok(self.writer.append_contact(time, &values)?)
    }

    /// Largest (|shear| - mu p) over the Hertz peak pressure, on the surfaces at whose nodes friction is
    /// enforced.
    fn cone_excess(&self) -> f64 {
        let excess = |t: &NodalContact| {
            (0..t.nodes.len())
                .map(|i| (length(t.shear[i]) - t.mu[i] * t.pressure[i]) / self.hertz_pressure)
                .fold(f64::NEG_INFINITY, f64::max)
        };
        let sides =
            [DISK, BAR].into_iter().filter(|side| self.enforced_on.is_none_or(|on| on == *side));
        sides
            .map(|side| excess(&self.zones.tables[side]))
            .fold(f64::NEG_INFINITY, f64::max)
            .max(0.0)
    }

    /// Rear end of the longest run of sticking nodes on the bar's centre line, half a spacing
    /// behind its last node, relative to `centre` (m).
    fn stick_border(&mut self, centre: f64) -> f64 {
        let bar = &self.zones.tables[BAR];
        self.line.clear();
        for &i in &self.centreline {
            if bar.pressure[i] > patch::IN_CONTACT * self.hertz_pressure {
                self.line.push((self.points[BAR][i][0], bar.state[i] == 1));
            }
        }
        let (mut best, mut start) = ((0, f64::NAN), None);
        for (k, &(x, sticks)) in self.line.iter().enumerate() {
            if !sticks {
                start = None;
                continue;
            }
            let (first, rear) = *start.get_or_insert_with(|| {
                let behind = if k > 0 { self.line[k - 1].0 } else { x };
                (k, 0.5 * (behind + x))
            });
            if k + 1 - first > best.0 {
                best = (k + 1 - first, rear);
            }
        }
        best.1 - centre
    }
}

/// Nodes of the line along x that lies nearest to y = 0, in ascending x. Of two lines at the same distance, as on a
/// slice or with an odd number of elements across, the one at y > 0.
fn centreline(points: &[[f64; 3]], size: f64) -> Vec<usize> {
    let least = points.iter().map(|x| x[1].abs()).fold(f64::INFINITY, f64::min);
    let slack = 0.1 * size;
    let near = |i: usize, y: f64| (points[i][1] - y).abs() <= slack;
    let y = if (0..points.len()).any(|i| near(i, least)) { least } else { -least };
    let on_it = |&i: &usize| near(i, y);
    let mut line: Vec<usize> = (0..points.len()).filter(on_it).collect();
    line.sort_by(|&i, &j| points[i][0].total_cmp(&points[j][0]));
    line
}

fn create_fields(
    case: &Case,
    model: &Model,
    basis: &RecordBasis<'_>,
) -> Result<TransientGrid, RunError> {
    let body = labels(&model.mesh.bodies.iter().map(|b| b.hexes.len()).collect::<Vec<_>>());
    let mut specs = BODIES.each().map(FieldSpec::clone).to_vec();
    specs.retain(|spec| case.output.stress || *spec != BODIES.stress);
    let grid = GridSpec {
        points: &model.mesh.nodes,
        cells: Cells::Hexahedra(&model.mesh.hexes),
        constant: &[StaticField::body(&body)],
    };
    basis.grid(file::FIELDS, &grid, &specs, &basis.provenance, |results| &results.fields)
}

/// The recorded surfaces of both bodies.
struct ContactSurfaces<'a> {
    tables: &'a [NodalContact; 2],
    points: &'a [Vec<[f64; 3]>; 2],
    /// Faces, their nodes as rows of the tables.
    faces: &'a [Vec<[u32; 4]>; 2],
    images: &'a Images,
}

fn create_contact(
    case: &Case,
    &ContactSurfaces { tables, points, faces, images }: &ContactSurfaces<'_>,
    enforced_on: Option<usize>,
    basis: &RecordBasis<'_>,
) -> Result<TransientGrid, RunError> {
    let mut provenance = basis.provenance.clone();
    if let Some(side) = enforced_on {
        let rows = match case.contact.rows.unwrap_or_default() {
            case::schema::Rows::NodeToFace => NODE_TO_FACE,
            case::schema::Rows::Mortar => MORTAR,
        };
        let texts = [
            (attribute::SLIP_PAIRING, pairing(enforced_on).name()),
            (attribute::ENFORCED_ON, BODY_NAMES[side]),
            (attribute::CONTACT_ROWS, rows),
        ];
        provenance.attributes.extend(texts.map(|(name, text)| (name.into(), text.into())));
    }
    let offset = images.counts()[DISK] as u32;
    let faces = [DISK, BAR].map(|side| images.faces(side, &faces[side]));
    let bar = faces[BAR].iter().map(|face| face.map(|node| node + offset));
    let quads: Vec<_> = faces[DISK].iter().copied().chain(bar).collect();
    let area = images.areas([&tables[DISK].area, &tables[BAR].area]);
    let body = labels(&[faces[DISK].len(), faces[BAR].len()]);
    let grid = GridSpec {
        points: &images.vectors([&points[DISK], &points[BAR]]),
        cells: Cells::Quads(&quads),
        constant: &[StaticField::body(&body), StaticField::area(&area)],
    };
    let fields = CONTACT.of_run(pairing(enforced_on));
    basis.grid(file::CONTACT, &grid, &fields, &provenance, |results| &results.contact)
}

/// Which velocities belong to a record: conditions that are enforced hold with the slip velocity of the step that
/// leaves x^n.
fn pairing(enforced_on: Option<usize>) -> Pairing {
    enforced_on.map_or(Pairing::Before, |_| Pairing::After)
}

/// 0 for the first `counts[0]` entries, 1 for the next, and so on.
fn labels(counts: &[usize]) -> Vec<u8> {
    counts.iter().enumerate().flat_map(|(k, &n)| std::iter::repeat_n(k as u8, n)).collect()
}

/// A displacement (m) in a mesh that has moved, from the place of the node at the start.
pub(crate) fn moved([x, y, z]: [f64; 3], travel: Travel) -> [f64; 3] {
    [x + travel.x, y, z]
}

fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps at which snapshots are due.
    fn due(interval: f64, dt: f64, steps: u32) -> Vec<u32> {
        let mut schedule = Schedule { interval, next: 0.0 };
        let mut due = Vec::new();
        for n in 0..steps {
            let time = f64::from(n) * dt;
            if time >= schedule.next {
                schedule.advance(time);
                due.push(n);
            }
        }
        due
    }

    #[test]
    fn snapshots_are_due_an_interval_apart_and_at_every_step_where_it_is_shorter() {
        assert_eq!(due(2.5, 1.0, 12), [0, 3, 5, 8, 10]);
        assert_eq!(due(1.0, 1.0, 5), [0, 1, 2, 3, 4]);
        for interval in [0.3, 1e-6, 1e-30, 5e-324] {
            assert_eq!(due(interval, 1.0, 5), [0, 1, 2, 3, 4], "{interval}");
        }
    }
}
