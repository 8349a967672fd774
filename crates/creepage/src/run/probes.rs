//! Surface nodes recorded at every step, in `probes.h5`: those of the fine zones nearest to the points of the case. A point
//! stays at its material: where the fine zone follows the contact, the node there changes with every move.

use crate::case::schema::Case;
use crate::run::error::RunError;
use crate::run::record::RecordBasis;
use crate::run::record::contact::LONGEST_HELD;
use crate::scenario::{BAR, DISK, Model};
use contact::NodalContact;
use dynamics::{Simulation, StepReport, Travel};
use mesh::{Face, Padded};
use output::layout::{BODY_NAMES, HISTORY, PROBE, ProbeRow, file, of_probe};
use output::{FieldSpec, History};
use std::f64::consts::PI;
use std::time::Instant;

/// Surface nodes recorded at every step.
pub(crate) struct Probes {
    history: History,
    places: Places,
    tables: [NodalContact; 2],
    probes: Vec<Probe>,
    /// Where the mesh was when the nodes were chosen.
    travel: Travel,
    buffer: Vec<f64>,
    /// When rows were last written.
    flushed: Instant,
}

/// A point of the material of a surface, and the node there.
struct Probe {
    side: usize,
    /// Arc length or x, and y (m).
    point: [f64; 2],
    /// Of y: -1 for the mirror image of a node.
    sign: f64,
    /// Row in its side's table; none while the fine zone does not hold the point.
    row: Option<usize>,
}

/// The nodes of the fine zones.
struct Places {
    zones: [Vec<Face>; 2],
    /// Radius of the disk, and element size of the zones (m).
    radius: f64,
    size: f64,
    symmetric: bool,
    /// Whether the zones follow the contact.
    follows: bool,
}

impl Places {
    /// Arc length or x, and y, of a node with this reference position (m).
    fn of(&self, side: usize, x: Padded) -> [f64; 2] {
        let [x, y, z] = x.xyz();
        let along = if side == DISK { self.radius * libm::atan2(x, self.radius - z) } else { x };
        [along, y]
    }

    /// How far ahead a place is that lies `distance` away (m): on the disk at most half a turn.
    fn ahead(&self, side: usize, distance: f64) -> f64 {
        let turn = 2.0 * PI * self.radius;
        if side == DISK { distance - turn * (distance / turn).round() } else { distance }
    }

    /// The node of a zone nearest to a point now, and the sign of y. None where a zone that follows the contact does not
    /// hold the point.
    fn nearest(
        &self,
        side: usize,
        [s, y]: [f64; 2],
        reference: &[Padded],
        travel: Travel,
    ) -> Option<(u32, f64)> {
        // of two nodes at the same distance always the same one
        let s = if self.follows { s - 1e-6 * self.size } else { s };
        let passed = if side == DISK { self.radius * travel.angle } else { travel.x };
        let sign = if self.symmetric && y < 0.0 { -1.0 } else { 1.0 };
        let distance = |n: u32| {
            let place = self.of(side, reference[n as usize]);
            libm::hypot(self.ahead(side, place[0] + passed - s), place[1] - sign * y)
        };
        let nodes = self.zones[side].iter().flat_map(|f| f.nodes);
        let node = nodes.min_by(|a, b| distance(*a).total_cmp(&distance(*b)))?;
        let along = self.of(side, reference[node as usize])[0];
        let held = !self.follows || self.ahead(side, along + passed - s).abs() <= 0.51 * self.size;
        let on_plane = reference[node as usize][1] == 0.0;
        held.then_some((node, if on_plane { 1.0 } else { sign }))
    }

    /// The tables of the nodes of the probes now; sets their rows.
    fn tables(&self, probes: &mut [Probe], simulation: &Simulation) -> Option<[NodalContact; 2]> {
        let contact = simulation.contact()?;
        let (reference, travel) = (simulation.solid().reference(), simulation.travel());
        let found: Vec<_> =
            probes.iter().map(|p| self.nearest(p.side, p.point, reference, travel)).collect();
        let tables = [DISK, BAR].map(|side| {
            let chosen = |n: &u32| {
                let mut of_side = found.iter().zip(&*probes).filter(|(_, p)| p.side == side);
                of_side.any(|(found, _)| found.is_some_and(|(node, _)| node == *n))
            };
            let around = self.zones[side].iter().filter(|f| f.nodes.iter().any(chosen));
            contact.nodal_table_of(side, &around.copied().collect::<Vec<Face>>())
        });
        for (probe, found) in probes.iter_mut().zip(found) {
            probe.row = found.and_then(|(node, sign)| {
                probe.sign = sign;
                tables[probe.side].nodes.binary_search(&node).ok()
            });
        }
        Some(tables)
    }
}

impl Probes {
    /// The probes of a case, if it has any.
    pub(crate) fn new(
        case: &Case,
        model: &Model,
        simulation: &Simulation,
        basis: &RecordBasis,
    ) -> Result<Option<Self>, RunError> {
        let given = &case.output.probes;
        if given.bar.is_empty() && given.disk.is_empty() {
            return Ok(None);
        }
        let places = Places {
            zones: model.zones.clone(),
            radius: case.axle_height(),
            size: case.mesh.zone.size,
            symmetric: model.mesh.symmetric,
            follows: case.mesh.window.is_some(),
        };
        let of_side = |side: usize, points: &[[f64; 2]]| {
            let probe = |&point: &[f64; 2]| Probe { side, point, sign: 1.0, row: None };
            points.iter().map(probe).collect::<Vec<_>>()
        };
        let mut probes = of_side(DISK, &given.disk);
        probes.extend(of_side(BAR, &given.bar));
        let tables = places.tables(&mut probes, simulation).ok_or(RunError::NoContact)?;
        let mut columns = vec![HISTORY.time.clone()];
        for (k, probe) in probes.iter().enumerate() {
            let body = BODY_NAMES[probe.side];
            let [s, y] = probe.point;
            let at = match probe.row {
                Some(row) if !places.follows => {
                    let n = tables[probe.side].nodes[row];
                    let [x, y, z] = model.mesh.at(n).into();
                    format!("node {n} of the {body} at {x:.6}, {:.6}, {z:.6} m", probe.sign * y)
                }
                _ => format!(
                    "the point of the {body} at {s:.6}, {y:.6} m; NaN while it lies outside of the fine zone"
                ),
            };
            columns.extend(PROBE.each().map(|column| FieldSpec {
                description: format!("{}; {at}", column.description).into(),
                ..of_probe(k, column)
            }));
        }
        let history = basis.history(file::PROBES, &columns, |results| &results.probes)?;
        let travel = simulation.travel();
        let (buffer, flushed) = (Vec::new(), Instant::now());
        Ok(Some(Self { history, places, tables, probes, travel, buffer, flushed }))
    }

    pub(crate) fn record(
        &mut self,
        simulation: &Simulation,
        report: &StepReport,
    ) -> Result<(), RunError> {
        let contact = simulation.contact().ok_or(RunError::NoContact)?;
        if self.travel != simulation.travel() {
            self.travel = simulation.travel();
            let tables = self.places.tables(&mut self.probes, simulation);
            self.tables = tables.ok_or(RunError::NoContact)?;
        }
        self.tables.iter_mut().for_each(|t| contact.nodal(t));
        self.buffer.push(report.time);
        for probe in &self.probes {
            let values = match probe.row {
                Some(row) => values(&self.tables[probe.side], row, probe.sign),
                None => NOTHING,
            };
            self.buffer.extend(values.each());
        }
        if self.buffer.len() >= 256 * self.history.columns().len()
            || self.flushed.elapsed() >= LONGEST_HELD
        {
            self.flush()?;
        }
        Ok(())
    }

    /// The file, which holds all but the rows that are not yet flushed.
    pub(crate) fn file(&self) -> &History {
        &self.history
    }

    pub(crate) fn flush(&mut self) -> Result<(), RunError> {
        if !self.buffer.is_empty() {
            self.history.append(&self.buffer)?;
            self.buffer.clear();
        }
        self.flushed = Instant::now();
        Ok(())
    }
}

/// What a table holds of a node.
fn values(t: &NodalContact, row: usize, sign: f64) -> ProbeRow<f64> {
    let [shear_x, shear_y, shear_z] = t.shear[row].into();
    let [slip_velocity_x, slip_velocity_y, slip_velocity_z] = t.slip_velocity[row].into();
    ProbeRow {
        pressure: t.pressure[row],
        shear_x,
        shear_y: sign * shear_y,
        shear_z,
        slip_velocity_x,
        slip_velocity_y: sign * slip_velocity_y,
        slip_velocity_z,
        slip_x: t.slip[row][0],
        mu: t.mu[row],
        state: f64::from(t.state[row]),
        gap: t.gap[row],
    }
}

/// The row of a point that the fine zone does not hold.
const NOTHING: ProbeRow<f64> = ProbeRow {
    pressure: f64::NAN,
    shear_x: f64::NAN,
    shear_y: f64::NAN,
    shear_z: f64::NAN,
    slip_velocity_x: f64::NAN,
    slip_velocity_y: f64::NAN,
    slip_velocity_z: f64::NAN,
    slip_x: f64::NAN,
    mu: f64::NAN,
    state: f64::NAN,
    gap: f64::NAN,
};
