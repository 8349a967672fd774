//! Friction laws: the coefficient of friction as a function of the slip speed, of place, time and pressure,
//! and of a state; each declared once for the solver, the slider, the checks and the case file.
//!
//! A steady law is a [`FrictionLaw`]; [`Lagged`], [`Implicit`] and [`Remembering`] make a law of a contact
//! node of it, a [`NodeFriction`], which the laws with a state are by themselves. [`Parameters`] makes any of
//! them from its parameters. [`slip_speed`] solves a node's tangential problem with a law. SI units.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod expression;
mod memory;
mod node;
mod numbers;
mod operators;
mod own;
mod parameters;
mod prakash_clifton;
mod rate_state;
pub mod slip_speed;
mod slip_weakening;
mod steady;
mod table;

pub use expression::{Domain, Expression, ExpressionError};
pub use memory::Memory;
pub use node::{Implicit, Lagged, NodeFriction, Place, Remembering, Remembers, Slid};
pub use numbers::{Falling, Interface, falling, nucleation_length, spring_number};
pub use own::{Own, OwnLaw, sampled};
pub use parameters::{DYNAMIC, Kind, LawError, Mode, Parameters, USES, Uses, all_parameters};
pub use prakash_clifton::PrakashClifton;
pub use rate_state::{RateState, StateLaw};
pub use slip_weakening::SlipWeakening;
pub use steady::{SteadyLaw, Strengthens};
pub use table::{Table, TableError};

use std::fmt::Debug;

/// The coefficient of friction `mu(|s|)`: `|p_tau| <= mu p_n`. A law may also look at place, time and
/// pressure: then [`mu_at`](Self::mu_at) is the law.
pub trait FrictionLaw: Send + Sync + Debug {
    /// Coefficient of friction at the slip speed `slip_speed >= 0` (m/s).
    fn mu(&self, slip_speed: f64) -> f64;
    /// Coefficient of friction at rest, `mu(0)`.
    fn mu_static(&self) -> f64;
    /// Slope `mu'(|s|)` (s/m); by central difference unless the law knows it.
    fn slope(&self, slip_speed: f64) -> f64 {
        let step = 1e-6 * (1.0 + slip_speed);
        let low = (slip_speed - step).max(0.0);
        (self.mu(slip_speed + step) - self.mu(low)) / (slip_speed + step - low)
    }
    /// Coefficient of friction at the slip speed `slip_speed >= 0` (m/s) of a node.
    fn mu_at(&self, slip_speed: f64, _at: &Place) -> f64 {
        self.mu(slip_speed)
    }
    /// Slope of [`mu_at`](Self::mu_at) over the slip speed (s/m).
    fn slope_at(&self, slip_speed: f64, _at: &Place) -> f64 {
        self.slope(slip_speed)
    }
}

/// Coulomb's law: one coefficient at every slip speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coulomb {
    /// Coefficient of friction.
    pub mu: f64,
}

impl FrictionLaw for Coulomb {
    fn mu(&self, _slip_speed: f64) -> f64 {
        self.mu
    }

    fn mu_static(&self) -> f64 {
        self.mu
    }

    fn slope(&self, _slip_speed: f64) -> f64 {
        0.0
    }
}

/// Friction that falls exponentially with the slip speed, Eq. (8) of Vollebregt (2017):
/// `mu(s) = mu_dynamic + (mu_static - mu_dynamic) exp(-decay |s|)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponential {
    /// Coefficient at rest.
    pub mu_static: f64,
    /// Coefficient at infinite slip speed.
    pub mu_dynamic: f64,
    /// Rate of decay `k` (s/m).
    pub decay: f64,
}

impl FrictionLaw for Exponential {
    fn mu(&self, slip_speed: f64) -> f64 {
        self.mu_dynamic + (self.mu_static - self.mu_dynamic) * libm::exp(-self.decay * slip_speed)
    }

    fn mu_static(&self) -> f64 {
        self.mu_static
    }

    fn slope(&self, slip_speed: f64) -> f64 {
        -self.decay * (self.mu_static - self.mu_dynamic) * libm::exp(-self.decay * slip_speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponential_law_is_static_at_rest_and_dynamic_at_high_speed() {
        let law = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
        assert_eq!(law.mu(0.0), 0.5);
        assert_eq!(law.mu_static(), 0.5);
        assert_eq!(law.mu(1e3), 0.32);
    }

    #[test]
    fn exponential_law_has_the_values_of_equation_8() {
        // 0.32 + 0.18 exp(-6 s) by an independent calculation (25-digit decimals).
        let law = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
        for (s, mu) in [
            (0.01, 0.489_517_616_045_164_8),
            (0.1, 0.418_786_094_496_924_8),
            (1.0, 0.320_446_175_391_799_9),
        ] {
            assert!((law.mu(s) - mu).abs() < 1e-15, "{s}: {} {mu}", law.mu(s));
        }
    }

    #[test]
    fn coulomb_law_ignores_the_slip_speed() {
        let law = Coulomb { mu: 0.3 };
        assert_eq!(FrictionLaw::mu(&law, 0.0), FrictionLaw::mu(&law, 40.0));
        assert_eq!(FrictionLaw::mu_static(&law), 0.3);
    }
}
