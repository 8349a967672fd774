//! When a run must stop, and what to say.

use crate::ledger::{Energies, Ledger};
use std::fmt;

/// Why the guards stopped a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// The time step is larger than the stability limit.
    UnstableStep {
        /// Step over the limit 2/omega_max.
        ratio: f64,
    },
    /// Energy appears that nothing supplies, although the step was within its limit.
    EnergyGrowth,
    /// Positions or energies are not numbers.
    NotFinite,
}

/// Where the trouble is worst.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The node that moves fastest relative to its body's rigid motion.
    pub node: usize,
    /// Its reference position (m).
    pub position: [f64; 3],
    /// Its relative speed (m/s).
    pub speed: f64,
    /// The element with the smallest det F.
    pub element: usize,
    /// That determinant; negative where the element is inside out.
    pub jacobian: f64,
}

/// What the guards found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagnosis {
    /// Step number.
    pub step: usize,
    /// Simulated time (s).
    pub time: f64,
    /// Likely cause.
    pub cause: Cause,
    /// Energy that nothing supplied (J).
    pub imbalance: f64,
    /// Where.
    pub place: Place,
}

impl fmt::Display for Diagnosis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { step, time, imbalance, place, .. } = self;
        write!(f, "stopped at step {step}, t = {:.6} ms: ", time * 1e3)?;
        match self.cause {
            Cause::UnstableStep { ratio } => write!(
                f,
                "the time step is {ratio:.2} times the stability limit 2/omega_max and the motion \
                 grows without bound ({imbalance:.3e} J from nowhere)"
            )?,
            Cause::EnergyGrowth => write!(
                f,
                "{imbalance:.3e} J appeared that neither load nor drive supplied, although the \
                 time step was within its limit; contact springs are the likely source"
            )?,
            Cause::NotFinite => write!(f, "positions are no longer numbers")?,
        }
        let [x, y, z] = place.position.map(|c| c * 1e3);
        write!(
            f,
            ". Worst at node {} (reference position {x:.3}, {y:.3}, {z:.3} mm), {:.3e} m/s \
             relative to its body; smallest det F {} in element {}",
            place.node,
            place.speed,
            // what has blown up would fill the line with digits
            if place.jacobian.abs() < 1e3 {
                format!("{:.4}", place.jacobian)
            } else {
                format!("{:.3e}", place.jacobian)
            },
            place.element
        )
    }
}

impl Diagnosis {
    /// What to change.
    pub fn remedy(&self) -> &'static str {
        match self.cause {
            Cause::UnstableStep { .. } => "set time.factor below 1; 0.67 is the default",
            Cause::EnergyGrowth => {
                "lower time.factor or the contact stiffness (contact.penalty.normal and .tangential)"
            }
            Cause::NotFinite => "lower time.factor and look at the last readable results",
        }
    }
}

/// Whether `now` can no longer be a solution: not finite, or energy from nowhere beyond a quarter
/// of all that was exchanged (with a floor of 1e-5 of the initial energy, far above round-off).
pub(crate) fn violated(ledger: &Ledger, now: &Energies) -> bool {
    let total = now.total() - now.external_work;
    let floor = ledger.initial().map_or(0.0, |i| 1e-5 * i.total().abs());
    !total.is_finite() || ledger.imbalance(now).abs() > 0.25 * ledger.largest_exchange() + floor
}
