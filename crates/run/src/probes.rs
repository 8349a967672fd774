//! Surface nodes recorded at every step, in `probes.h5`: those of the fine zones nearest to the points of the case.

use crate::error::RunError;
use crate::record::RecordBasis;
use case::schema::Case;
use contact::NodalContact;
use dynamics::{Simulation, StepReport};
use mesh::Face;
use output::layout::{BODY_NAMES, HISTORY, PROBE, ProbeRow, file, of_probe};
use output::{FieldSpec, History};
use scenario::{BAR, DISK, Model};

/// Surface nodes recorded at every step.
pub(crate) struct Probes {
    history: History,
    tables: [NodalContact; 2],
    /// Side, row in that side's table, and sign of y of each probe: -1 for the mirror image of a node.
    rows: Vec<(usize, usize, f64)>,
    buffer: Vec<f64>,
}

impl Probes {
    /// The probes of a case, if it has any.
    pub(crate) fn new(
        case: &Case,
        model: &Model,
        simulation: &Simulation,
        basis: &RecordBasis<'_>,
    ) -> Result<Option<Self>, RunError> {
        let probes = &case.output.probes;
        if probes.bar.is_empty() && probes.disk.is_empty() {
            return Ok(None);
        }
        let contact = simulation.contact().ok_or(RunError::NoContact)?;
        let radius = case.disk.radius;
        // The tread point at arc length s lies at angle s/R from the lowest point.
        let on_disk = |[s, y]: [f64; 2]| {
            let angle = s / radius;
            [radius * libm::sin(angle), y, radius * (1.0 - libm::cos(angle))]
        };
        let wanted: Vec<(usize, [f64; 3])> = (probes.disk.iter().map(|p| (DISK, on_disk(*p))))
            .chain(probes.bar.iter().map(|p| (BAR, [p[0], p[1], 0.0])))
            .collect();
        let sign =
            |point: &[f64; 3]| if model.mesh.symmetric && point[1] < 0.0 { -1.0 } else { 1.0 };
        let mut chosen = Vec::new();
        for (side, point) in &wanted {
            let distance = |n: u32| {
                let x = model.mesh.nodes[n as usize];
                // height is ignored on the bar, whose crown the user need not compute
                let dz = if *side == BAR { 0.0 } else { x[2] - point[2] };
                (x[0] - point[0]).powi(2) + (x[1] - sign(point) * point[1]).powi(2) + dz * dz
            };
            let nodes = model.zones[*side].iter().flat_map(|f| f.nodes);
            let nearest = nodes.min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
            let node = nearest.ok_or(RunError::NoContact)?;
            let on_plane = model.mesh.nodes[node as usize][1] == 0.0;
            chosen.push((*side, node, if on_plane { 1.0 } else { sign(point) }));
        }
        let tables = [DISK, BAR].map(|side| {
            let around: Vec<Face> = model.zones[side]
                .iter()
                .filter(|f| chosen.iter().any(|&(s, n, _)| s == side && f.nodes.contains(&n)))
                .copied()
                .collect();
            contact.nodal_table_of(side, &around)
        });
        let rows = chosen
            .iter()
            .map(|&(side, n, sign)| {
                let row = tables[side].nodes.binary_search(&n).map_err(|_| RunError::NoContact)?;
                Ok((side, row, sign))
            })
            .collect::<Result<Vec<_>, RunError>>()?;
        let mut columns = vec![HISTORY.time.clone()];
        for (k, &(side, n, sign)) in chosen.iter().enumerate() {
            let [x, y, z] = model.mesh.nodes[n as usize];
            let y = sign * y;
            let body = BODY_NAMES[side];
            columns.extend(PROBE.each().map(|column| {
                FieldSpec {
                    description: format!(
                        "{}; node {n} of the {body} at {x:.6}, {y:.6}, {z:.6} m",
                        column.description
                    )
                    .into(),
                    ..of_probe(k, column)
                }
            }));
        }
        let history = basis.history(file::PROBES, &columns, |results| &results.probes)?;
        Ok(Some(Self { history, tables, rows, buffer: Vec::new() }))
    }

    pub(crate) fn record(
        &mut self,
        contact: &dyn contact::Contact,
        report: &StepReport,
    ) -> Result<(), RunError> {
        self.tables.iter_mut().for_each(|t| contact.nodal(t));
        self.buffer.push(report.time);
        for &(side, row, sign) in &self.rows {
            let t = &self.tables[side];
            let ([shear_x, shear_y, shear_z], [slip_velocity_x, slip_velocity_y, slip_velocity_z]) =
                (t.shear[row], t.slip_velocity[row]);
            let probe = ProbeRow {
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
            };
            self.buffer.extend(probe.each());
        }
        if self.buffer.len() >= 256 * self.history.columns().len() {
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
        Ok(())
    }
}
