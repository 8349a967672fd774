//! The measures at each node over time, as a VTKHDF file for ParaView.

use crate::check::PostError;
use crate::check::Scales;
use crate::check::conditions::{IN_CONTACT, Judge, Node};
use crate::check::frames::Frame;
use crate::check::surface::Surface;
use output::layout::attribute;
use output::{
    Cells, FieldSpec, GridFile, GridSpec, Provenance, StaticField, TransientGrid, Values,
};
use std::path::Path;

/// Fields of the file: name, unit, meaning. Where a field does not apply (no contact, or no slip) it is NaN,
/// which ParaView leaves blank.
const FIELDS: [(&str, &str, &str); 10] = [
    ("penetration", "1", "penetration over Hertz's approach"),
    ("cone", "1", "p_f/(mu_S p_n) - 1 above the cone"),
    ("traction_ratio", "1", "p_f/p_n"),
    ("slip_speed", "m/s", "|s|"),
    ("adhesion_slip", "1", "|s|/s_c below 0.98 of the bound"),
    ("law_error", "1", "p_f/(mu(|s|) p_n) - 1 in slip"),
    ("law_error_own", "1", "the same with the mu that the algorithm used"),
    ("direction", "deg", "angle of the shear from -s in slip"),
    ("law_scatter", "1", "distance from the law's graph"),
    ("power", "W/m2", "heat of friction, negative where friction gives energy"),
];

/// Writer of the file, one record after the other.
pub(crate) struct MapWriter {
    grid: TransientGrid,
    columns: Vec<Vec<f64>>,
    violates: Vec<u8>,
}

impl MapWriter {
    /// Creates the file at `path` with the mesh of `surface` and the provenance of the contact history `source`.
    pub fn create(path: &Path, surface: &Surface, source: &Path) -> Result<Self, PostError> {
        let source = GridFile::open(source)?;
        let text = |name: &str| source.provenance(name).unwrap_or_default();
        let provenance = Provenance {
            creepage_version: env!("CARGO_PKG_VERSION").into(),
            case_hash: text(attribute::CASE_HASH),
            created: text(attribute::CREATED),
            attributes: Vec::new(),
        };
        let mut fields: Vec<FieldSpec> = FIELDS
            .iter()
            .map(|(name, units, about)| FieldSpec::scalar(name, units, about))
            .collect();
        let about = "0 none or no contact, 1 the contact conditions are violated";
        fields.push(FieldSpec::label("violates", "1", about));
        let points: Vec<[f64; 3]> = surface.points.iter().map(|&x| x.into()).collect();
        let grid = GridSpec {
            points: &points,
            cells: Cells::Quads(&surface.faces),
            constant: &[StaticField::body(&surface.face_body)],
        };
        let count = surface.points.len();
        Ok(Self {
            grid: TransientGrid::create(path, &grid, &fields, &provenance)?,
            columns: vec![vec![f64::NAN; count]; FIELDS.len()],
            violates: vec![0; count],
        })
    }

    /// Appends a record: its tractions judged with the slip velocity of the same record, and with the coefficient
    /// that `mu_recomputed` gives for a node.
    pub fn write(
        &mut self,
        surface: &Surface,
        frame: &Frame,
        mu_recomputed: impl Fn(usize) -> Option<f64>,
        judge: &Judge,
        scales: &Scales,
    ) -> Result<(), PostError> {
        self.columns.iter_mut().for_each(|column| column.fill(f64::NAN));
        self.violates.fill(0);
        for row in 0..surface.points.len() {
            let pressure = frame.pressure[row];
            if let (Some(gap), Some(approach)) = (&frame.gap, scales.approach) {
                self.columns[0][row] = (-gap[row]).max(0.0) / approach;
            }
            if pressure <= IN_CONTACT * scales.peak_pressure {
                continue;
            }
            let mu_used = frame.mu.as_ref().map(|mu| mu[row]);
            let node = Node {
                pressure,
                shear: frame.shear[row],
                slip: frame.slip_velocity[row],
                mu_used,
                mu_recomputed: mu_recomputed(row),
                state: None,
            };
            let judged = judge.judge(&node);
            let mu_static = judge.law.map(|law| law.mu_static()).or(mu_used);
            let cone = mu_static.map(|mu| (judged.ratio / mu - 1.0).max(0.0));
            let values = [
                cone,
                Some(judged.ratio),
                Some(judged.speed),
                judged.adhesion_slip,
                judged.law_error,
                judged.law_error_own,
                judged.direction,
                judged.law_scatter,
                Some(judged.power),
            ];
            for (column, value) in self.columns[1..].iter_mut().zip(values) {
                column[row] = value.unwrap_or(f64::NAN);
            }
            self.violates[row] = judged.violates.into();
        }
        let mut values: Vec<Values<'_>> =
            self.columns.iter().map(|column| Values::Scalar(column)).collect();
        values.push(Values::Integer(&self.violates));
        Ok(self.grid.append(frame.time, &values)?)
    }
}
