//! The coefficient of friction at a slip speed.

use crate::Exponential;
use std::fmt::Debug;
use std::sync::Arc;
use thiserror::Error;

/// Position, time and pressure of a contact node, on which a law may depend.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeConditions {
    /// Current position in the global frame (m).
    pub position: [f64; 3],
    /// Time (s).
    pub time: f64,
    /// Contact pressure (Pa), positive in compression.
    pub pressure: f64,
}

/// A steady law: the coefficient of friction `mu(|s|)` in `|p_tau| <= mu p_n`, without state.
///
/// A law that also depends on position, time or pressure overrides [`mu_at`](Self::mu_at) and
/// [`slope_at`](Self::slope_at), which the solver calls.
pub trait FrictionLaw: Send + Sync + Debug {
    /// Coefficient of friction at the slip speed `slip_speed >= 0` (m/s).
    fn mu(&self, slip_speed: f64) -> f64;
    /// Coefficient of friction at rest, `mu(0)`.
    fn mu_static(&self) -> f64;
    /// Derivative of [`mu`](Self::mu) with respect to the slip speed (s/m); by central difference, one-sided at
    /// rest, unless the law overrides it.
    fn slope(&self, slip_speed: f64) -> f64 {
        let step = 1e-6 * (1.0 + slip_speed);
        let low = (slip_speed - step).max(0.0);
        (self.mu(slip_speed + step) - self.mu(low)) / (slip_speed + step - low)
    }
    /// Coefficient of friction at the slip speed `slip_speed >= 0` (m/s) of a node at `_at`.
    fn mu_at(&self, slip_speed: f64, _at: &NodeConditions) -> f64 {
        self.mu(slip_speed)
    }
    /// Derivative of [`mu_at`](Self::mu_at) with respect to the slip speed (s/m).
    fn slope_at(&self, slip_speed: f64, _at: &NodeConditions) -> f64 {
        self.slope(slip_speed)
    }
    /// `-mu'(0)`, the slope with which friction falls at the onset of slip (s/m).
    fn fall_at_rest(&self) -> f64 {
        -self.slope(0.0)
    }
    /// Two slip speeds between which friction rises, if it does; tried at rest and from 1e-9 to 1e3 m/s, at zero
    /// pressure, time and position.
    fn strengthens(&self) -> Option<Strengthens> {
        let tried: Vec<_> = trial_speeds().map(|s| [s, self.mu(s)]).collect();
        tried.windows(2).find_map(|pair| Strengthens::between([pair[0], pair[1]]))
    }
    /// The law as Eq. (8) of Vollebregt (2017), if it is of that form.
    fn as_exponential(&self) -> Option<Exponential> {
        None
    }
}

/// Slip speeds (m/s) at which a law is tried: at rest and from 1e-9 to 1e3 m/s.
pub(crate) fn trial_speeds() -> impl Iterator<Item = f64> {
    std::iter::once(0.0).chain((0..=240).map(|i| libm::pow(10f64, -9.0 + f64::from(i) / 20.0)))
}

/// A law in which friction rises with slip speed where that was not allowed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "friction rises with slip speed, from mu = {before} at {slower} m/s to {after} at {faster} m/s"
)]
pub struct Strengthens {
    /// A slip speed (m/s).
    pub slower: f64,
    /// A larger one (m/s).
    pub faster: f64,
    /// Coefficient at the first.
    pub before: f64,
    /// Coefficient at the second.
    pub after: f64,
}

impl Strengthens {
    /// The rise from one point (slip speed in m/s, coefficient) to the next, if it is one.
    pub(crate) fn between([[slower, before], [faster, after]]: [[f64; 2]; 2]) -> Option<Self> {
        // rounding in a formula does not count as a rise
        let rises = after > before * (1.0 + 1e-12);
        rises.then_some(Self { slower, faster, before, after })
    }
}

impl<L: FrictionLaw + ?Sized> FrictionLaw for Arc<L> {
    fn mu(&self, slip_speed: f64) -> f64 {
        (**self).mu(slip_speed)
    }
    fn mu_static(&self) -> f64 {
        (**self).mu_static()
    }
    fn slope(&self, slip_speed: f64) -> f64 {
        (**self).slope(slip_speed)
    }
    fn mu_at(&self, slip_speed: f64, at: &NodeConditions) -> f64 {
        (**self).mu_at(slip_speed, at)
    }
    fn slope_at(&self, slip_speed: f64, at: &NodeConditions) -> f64 {
        (**self).slope_at(slip_speed, at)
    }
    fn fall_at_rest(&self) -> f64 {
        (**self).fall_at_rest()
    }
    fn strengthens(&self) -> Option<Strengthens> {
        (**self).strengthens()
    }
    fn as_exponential(&self) -> Option<Exponential> {
        (**self).as_exponential()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Coulomb, Expression, Table};

    const PAPER: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };

    #[test]
    fn the_slope_at_rest_is_that_of_the_law() {
        assert_eq!(Coulomb { mu: 0.3 }.fall_at_rest(), 0.0);
        assert!((PAPER.fall_at_rest() - 1.08).abs() < 1e-15);
        let table = Table::new(vec![[0.0, 0.5], [0.5, 0.4], [9.0, 0.3]]).unwrap();
        assert!((table.fall_at_rest() - 0.2).abs() < 1e-15);
        let formula = Expression::new("0.32 + 0.18*exp(-6*s)").unwrap();
        assert!((formula.fall_at_rest() - 1.08).abs() < 1e-8);
    }

    #[test]
    fn laws_that_rise_with_slip_speed_are_found() {
        for decay in [1e-4, 6.0, 1e4] {
            let rising = Exponential { mu_static: 0.3, mu_dynamic: 0.4, decay };
            assert!(rising.strengthens().is_some());
        }
        assert_eq!(PAPER.strengthens(), None);
        let hump = Table::new(vec![[0.0, 0.5], [1.0, 0.4], [2.0, 0.45]]).unwrap();
        let found = hump.strengthens().unwrap();
        assert_eq!((found.slower, found.faster), (1.0, 2.0));
        let formula = |text| Expression::new(text).unwrap();
        assert!(formula("0.3 + 0.1*tanh(s)").strengthens().is_some());
        assert_eq!(formula("0.3 + 0.1*exp(-s)").strengthens(), None);
    }
}
