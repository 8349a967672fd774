//! What no sound run does.

use crate::ledger::{Energies, Ledger};

/// Steps between two looks at the shape of every element; a look happens at steps alone whose energies were read.
pub const SHAPE_STEPS: usize = 500;

/// What no sound run does. Energy from nowhere and numbers that are none need no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardLimits {
    /// Hourglass over strain energy (dimensionless), with the usual coefficient 0.05 where that of the
    /// run is smaller: weak hourglass stiffness lets elements hourglass, with little energy.
    pub hourglass: f64,
    /// Energies below this are too small to judge a share (J).
    pub least_energy: f64,
    /// Penetration (m).
    pub penetration: f64,
    /// Time without contact, once there was contact (s).
    pub without_contact: f64,
    /// Normal force below which there is no contact (N).
    pub least_force: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// First and last x of the lower body, which the hub must not pass (m).
    pub track: [f64; 2],
}

impl Default for GuardLimits {
    /// None.
    fn default() -> Self {
        Self {
            hourglass: f64::INFINITY,
            least_energy: 0.0,
            penetration: f64::INFINITY,
            without_contact: f64::INFINITY,
            least_force: 0.0,
            friction: f64::INFINITY,
            track: [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}

/// What the guards carry from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LostContact {
    /// Whether there was contact.
    pub touched: bool,
    /// Since when there is none (s), if there was.
    pub lost: Option<f64>,
}

/// Whether `now` can no longer be a solution: not finite, or energy from nowhere beyond what is allowed.
pub(crate) fn violated(ledger: &Ledger, now: &Energies) -> bool {
    let total = now.total() - now.external_work;
    !total.is_finite() || ledger.imbalance(now).abs() > allowed(ledger)
}

/// Energy that may be in error (J): a quarter of all that was exchanged, with a floor of 1e-5 of the initial energy, far
/// above round-off.
pub(crate) fn allowed(ledger: &Ledger) -> f64 {
    let floor = ledger.initial().map_or(0.0, |i| 1e-5 * i.total().abs());
    0.25 * ledger.largest_exchange() + floor
}

/// Whether the shape of the elements is looked at after a step.
pub(crate) fn looks_at_shape(step: usize) -> bool {
    let early = step < SHAPE_STEPS && step.is_multiple_of(10) && (step / 10).is_power_of_two();
    early || step.is_multiple_of(SHAPE_STEPS)
}
