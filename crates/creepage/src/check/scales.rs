//! The scales of a check, from the run's files or from its records.

use crate::check::PostError;
use crate::check::basis::{Basis, Bound};
use crate::check::frames::ContactHistory;
use crate::check::patch_series;

/// The scales of a check (SI).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scales {
    /// p0 (Pa).
    pub peak_pressure: f64,
    /// Hertz's approach (m).
    pub approach: Option<f64>,
    /// s_c (m/s).
    pub slip_speed: f64,
    /// A tenth of a contact transit (s).
    pub roughness_span: Option<f64>,
    /// Edge of a surface element (m).
    pub size: f64,
    /// Speed of shear waves (m/s).
    pub shear_wave: Option<f64>,
    /// Time step (s).
    pub dt: Option<f64>,
}

impl Scales {
    /// The scales that the basis knows, completed from the records where possible.
    ///
    /// # Errors
    /// A scale that cannot be found; no bound of friction; a record that cannot be read.
    pub fn resolve(
        basis: &mut Basis,
        history: &ContactHistory,
        records: &std::ops::Range<usize>,
    ) -> Result<Self, PostError> {
        let surface = &history.surface;
        if basis.scale("peak_pressure").is_none() || basis.scale("half_length").is_none() {
            let last = history.record(records.end - 1)?;
            let body = surface.bodies().last().copied().unwrap_or(0);
            let row = patch_series::measure(surface, &last, body, 0.0, basis.shape);
            let [a, b, _, fitted, raw, ..] = row.values;
            let top = if fitted.is_finite() { fitted } else { raw };
            basis.offer("peak_pressure", top, "pressure of the last record");
            basis.offer("half_length", a, "pressure of the last record");
            basis.offer("half_width", b, "pressure of the last record");
        }
        let area = surface.area.iter().sum::<f64>() / surface.area.len() as f64;
        basis.offer("size", area.sqrt(), "mean nodal area");
        basis.complete();
        let unknown = |name, remedy| PostError::Unknown { name, remedy };
        let peak_pressure = basis.scale("peak_pressure").ok_or_else(|| {
            unknown(
                "the pressure scale p0",
                "no node carries pressure at the end of the window; give --scale peak_pressure=PA",
            )
        })?;
        let slip_speed = basis.scale("slip_speed").ok_or_else(|| {
            unknown(
                "the scale of slip s_c",
                "give --scale slip_speed=M/S, or --case CASE.toml with drive.speed and \
                 drive.creepage",
            )
        })?;
        if basis.bound == Bound::Used && !history.has.mu {
            return Err(unknown(
                "the bound of friction",
                "the file has no field mu; give --case CASE.toml with friction.law and its \
                 coefficients",
            ));
        }
        let transit = basis
            .scale("half_length")
            .zip(basis.scale("speed"))
            .map(|(a, speed)| 2.0 * a / speed.abs());
        Ok(Self {
            peak_pressure,
            approach: basis.scale("approach"),
            slip_speed,
            roughness_span: transit.map(|transit| transit / 10.0),
            size: basis.scale("size").unwrap_or(area.sqrt()),
            shear_wave: basis.scale("shear_wave"),
            dt: basis.scale("dt"),
        })
    }
}
