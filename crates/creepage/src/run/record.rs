//! What a run writes while it rolls, and when.

mod basis;
pub(crate) mod contact;
mod images;
mod patch;
pub(crate) mod row;
pub(crate) mod surfaces;

pub(crate) use self::basis::RecordBasis;
use self::contact::{ContactRecord, RollingStep};
use self::row::Whereabouts;
use self::surfaces::{Surfaces, labels};
use crate::case::schema::{Case, StressField, StressOutput};
use crate::run::error::RunError;
use crate::run::means::Means;
use crate::run::mesh_mode::WatchedFaces;
use crate::run::probes::Probes;
use crate::scenario::{BAR, DISK, Model};
use ::contact::{ContactTables, NodalContact};
use dynamics::{Hub, Simulation, StepReport, Travel};
use mesh::Padded;
use nalgebra::Vector3;
use output::layout::{BODIES, BodyFields, Pairing, file};
use output::{
    Cells, Checkpoint, FieldSpec, GridSpec, OutputError, Results, RunFiles, Snapshot, StaticField,
    TransientGrid,
};
use serde::{Deserialize, Serialize};
use solid::invariants;
use std::ops::Range;
use std::path::Path;
use std::time::{Duration, Instant};

/// Writes fields, contact surfaces, history and probes, and gathers the means over the evaluation window.
pub(crate) struct Recorder {
    contact: ContactRecord,
    /// Displacement (m) and velocity (m/s) of the nodes of both contact zones, copied for a record of contact.
    displacement: Vec<Vector3<f64>>,
    velocity: Vec<Vector3<f64>>,
    fields: Schedule,
    probes: Option<Probes>,
    stress: StressOutput,
    /// Stress of the elements (Pa) at a snapshot.
    cauchy: Vec<[f64; 6]>,
    /// Nodes of the disk, which moves with the hub but for its deformation.
    disk: Range<usize>,
    mesh_mode: WatchedFaces,
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
    /// Writes into `files`, or where there are none into those that `basis` says it goes on with.
    pub(crate) fn new(
        case: &Case,
        model: &Model,
        simulation: &Simulation,
        effective_radius: f64,
        files: Option<RunFiles>,
        basis: &RecordBasis,
    ) -> Result<Self, RunError> {
        let contact = simulation.contact().ok_or(RunError::NoContact)?;
        let files = match files {
            Some(files) => files,
            None => result_files(case, model, contact, basis)?,
        };
        let tables = tables(model, contact);
        let mesh_mode = watched(case, model, contact, &tables, basis)?;
        let surfaces = surfaces(model, contact, tables, &mesh_mode);
        let step = RollingStep { dt: simulation.dt(), effective_radius };
        let contact = ContactRecord::new(case, surfaces, &step, basis.hertz_pressure, files)?;
        let count = contact.nodes().count();
        Ok(Self {
            probes: Probes::new(case, model, simulation, basis)?,
            contact,
            displacement: vec![Vector3::zeros(); count],
            velocity: vec![Vector3::zeros(); count],
            fields: Schedule { interval: case.fields_interval(), next: 0.0 },
            stress: case.output.stress.clone(),
            cauchy: Vec::new(),
            disk: model.mesh.bodies[DISK].nodes.clone(),
            mesh_mode,
            wall: Duration::ZERO,
        })
    }

    /// The state, after all rows are handed to the writer.
    pub(crate) fn snapshot(&mut self) -> Result<RecorderState, RunError> {
        self.contact.flush()?;
        if let Some(probes) = &mut self.probes {
            probes.flush()?;
        }
        let (next_fields, means) = (self.fields.next, self.contact.means.clone());
        Ok(RecorderState { next_fields, means, wall: self.wall })
    }

    /// Takes over the state of the recorder that began the files.
    pub(crate) fn restore(&mut self, state: &RecorderState) {
        self.fields.next = state.next_fields;
        self.contact.means = state.means.clone();
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
        self.contact.keep(make, folder, beside)
    }

    /// Whether step `n` writes a row of the history, and so needs the energies.
    pub(crate) fn reads(&self, n: u64) -> bool {
        self.contact.reads(n)
    }

    /// Whether a snapshot of the fields is due at `time` (s), of both bodies.
    pub(crate) fn writes_fields(&self, time: f64) -> bool {
        time >= self.fields.next
    }

    /// Whether the energies of elements are sampled after the step `dt` from `time` (s).
    pub(crate) fn reads_bodies(&self, time: f64, dt: f64) -> bool {
        self.mesh_mode.samples([time, dt])
    }

    /// To be called with the state at t^n, before the step moves it on.
    pub(crate) fn before_step(&mut self, simulation: &Simulation) -> Result<(), RunError> {
        let clock = Instant::now();
        if self.writes_fields(simulation.time()) {
            self.write_fields(simulation)?;
            self.fields.advance(simulation.time());
        }
        if self.contact.records(simulation.steps() as u64) {
            for (u, node) in self.displacement.iter_mut().zip(self.contact.nodes()) {
                *u = moved(simulation.displacement()[node as usize], simulation.travel());
            }
            if self.contact.pairing() == Pairing::Before {
                self.copy_velocity(simulation);
            }
        }
        self.wall += clock.elapsed();
        Ok(())
    }

    fn copy_velocity(&mut self, simulation: &Simulation) {
        for (v, node) in self.velocity.iter_mut().zip(self.contact.nodes()) {
            *v = simulation.step_velocity()[node as usize].vector();
        }
    }

    /// To be called after the step from t^n, with what it found at t^n.
    pub(crate) fn after_step(
        &mut self,
        simulation: &Simulation,
        report: &StepReport,
    ) -> Result<(), RunError> {
        let clock = Instant::now();
        let n = report.step as u64;
        let step = self.contact.add_step(report);
        if let Some(probes) = &mut self.probes {
            probes.record(simulation, report)?;
        }
        let (reads, records) = (self.contact.reads(n), self.contact.records(n));
        if let Some(contact) = simulation.contact()
            && (reads || records)
        {
            self.contact.tables.iter_mut().for_each(|t| contact.nodal(t));
        }
        if records {
            if self.contact.pairing() == Pairing::After {
                self.copy_velocity(simulation);
            }
            self.contact.write(report.time, &self.displacement, &self.velocity)?;
        }
        if step.inside {
            let sums = &mut self.contact.means.mesh_mode;
            if reads {
                self.mesh_mode.slip(&self.contact.tables, sums);
            }
            let (solid, displacement) = (simulation.solid(), simulation.displacement());
            self.mesh_mode.energy([report.time, simulation.dt()], solid, displacement, sums);
        }
        if reads {
            let energies = report.energies.unwrap_or_default();
            let hub = simulation.hub().map(|h| h.state).unwrap_or_default();
            let patch = self.contact.patch(hub.x);
            let travel = simulation.travel();
            let at = Whereabouts {
                hub_x: hub.x + travel.x,
                hub_z: hub.z,
                window_x: travel.x,
                window_energy: simulation.ledger().moved,
                imbalance: simulation.ledger().imbalance(&energies),
            };
            self.contact.add_row(report, &step, &patch, &at)?;
        }
        self.wall += clock.elapsed();
        Ok(())
    }

    /// Writes the remaining rows and the final state, and closes the files. Returns the means, and the wall time of
    /// output.
    pub(crate) fn finish(mut self, simulation: &Simulation) -> Result<(Means, Duration), RunError> {
        let clock = Instant::now();
        self.contact.flush()?;
        self.write_fields(simulation)?;
        if let Some(probes) = &mut self.probes {
            probes.flush()?;
        }
        let means = self.contact.finish()?;
        Ok((means, self.wall + clock.elapsed()))
    }

    fn write_fields(&mut self, simulation: &Simulation) -> Result<(), RunError> {
        let disk = &self.disk;
        let rigid = simulation.hub().map(Hub::rigid_motion);
        let reference = simulation.solid().reference();
        let deformation = |(node, u): (usize, &Padded)| match &rigid {
            Some(motion) if disk.contains(&node) => {
                (u.vector() - motion(reference[node].vector())).into()
            }
            _ => u.xyz(),
        };
        let (displacement, solid) = (simulation.displacement(), simulation.solid());
        let written: Vec<StressField> = self.stress.written().collect();
        if !written.is_empty() {
            self.cauchy.resize(solid.elements(), [0.0; 6]);
            solid.cauchy_stress(displacement, &mut self.cauchy);
        }
        let cauchy = &self.cauchy;
        let scalars = |of: fn(&[f64; 6]) -> f64| {
            move |to: &mut Snapshot<'_>| to.scalars(cauchy.iter().map(of))
        };
        let tensor = |to: &mut Snapshot<'_>| {
            to.tensors(cauchy.len(), |out| out.copy_from_slice(cauchy));
        };
        let principal =
            |to: &mut Snapshot<'_>| to.vectors(cauchy.iter().map(invariants::principal));
        let [von_mises, max_shear, hydrostatic] =
            [invariants::von_mises, invariants::max_shear, invariants::hydrostatic].map(scalars);
        type Fill<'a> = &'a dyn Fn(&mut Snapshot<'_>);
        let stress = |field: StressField, fill| written.contains(&field).then_some(fill);
        let fields = BodyFields::<Option<Fill<'_>>> {
            displacement: Some(&|to| {
                to.vectors(displacement.iter().map(|u| moved(*u, simulation.travel()).into()));
            }),
            deformation: Some(&|to| to.vectors(displacement.iter().enumerate().map(deformation))),
            velocity: Some(&|to| to.vectors(simulation.velocity().iter().map(|v| v.xyz()))),
            stress: stress(StressField::Tensor, &tensor as Fill<'_>),
            von_mises: stress(StressField::VonMises, &von_mises),
            max_shear: stress(StressField::MaxShear, &max_shear),
            hydrostatic: stress(StressField::Hydrostatic, &hydrostatic),
            principal: stress(StressField::Principal, &principal),
        };
        self.contact.write_fields(simulation.time(), |snapshot| {
            fields.each().into_iter().flatten().for_each(|fill| fill(snapshot));
        })
    }
}

/// Begins the result files of a run but for its probes, or goes on with them. Of `contact` only the nodes are asked: it
/// need not have touched yet.
pub(crate) fn result_files(
    case: &Case,
    model: &Model,
    contact: &dyn ContactTables,
    basis: &RecordBasis,
) -> Result<RunFiles, RunError> {
    let tables = tables(model, contact);
    let mesh_mode = watched(case, model, contact, &tables, basis)?;
    let surfaces = surfaces(model, contact, tables, &mesh_mode);
    let fields = create_fields(case, model, basis)?;
    ContactRecord::files(case, &surfaces, basis, Some(fields))
}

/// Tables of the nodes of both fine zones.
fn tables(model: &Model, contact: &dyn ContactTables) -> [NodalContact; 2] {
    [DISK, BAR].map(|side| contact.nodal_table_of(side, &model.zones[side]))
}

fn watched(
    case: &Case,
    model: &Model,
    contact: &dyn ContactTables,
    tables: &[NodalContact; 2],
    basis: &RecordBasis,
) -> Result<WatchedFaces, RunError> {
    WatchedFaces::new(case, model, tables, contact.enforced_on(), basis.hertz_pressure)
}

fn surfaces<'a>(
    model: &Model,
    contact: &dyn ContactTables,
    tables: [NodalContact; 2],
    mesh_mode: &'a WatchedFaces,
) -> Surfaces<'a> {
    let points = tables
        .each_ref()
        .map(|table| table.nodes.iter().map(|&n| model.mesh.at(n)).collect::<Vec<_>>());
    let (enforced_on, half) = (contact.enforced_on(), model.mesh.symmetric);
    Surfaces { tables, points, faces: mesh_mode.faces(), enforced_on, half }
}

fn create_fields(
    case: &Case,
    model: &Model,
    basis: &RecordBasis,
) -> Result<TransientGrid, RunError> {
    let body = labels(&model.mesh.bodies.iter().map(|b| b.hexes.len()).collect::<Vec<_>>());
    let mut specs = BODIES.each().map(FieldSpec::clone).to_vec();
    let written: Vec<StressField> = case.output.stress.written().collect();
    let left_out = StressField::ALL.into_iter().filter(|field| !written.contains(field));
    left_out.for_each(|field| specs.retain(|spec| spec != field.dataset()));
    let points: Vec<[f64; 3]> = model.mesh.nodes.iter().map(|&x| x.into()).collect();
    let grid = GridSpec {
        points: &points,
        cells: Cells::Hexahedra(&model.mesh.hexes),
        constant: &[StaticField::body(&body)],
    };
    basis.grid(file::FIELDS, &grid, &specs, &basis.provenance, |results| &results.fields)
}

/// A displacement (m) in a mesh that has moved, from the place of the node at the start.
pub(crate) fn moved(u: Padded, travel: Travel) -> Vector3<f64> {
    Vector3::new(u[0] + travel.x, u[1], u[2])
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
