//! The coefficient of friction at a slip speed.

use std::fmt::Debug;

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
}
