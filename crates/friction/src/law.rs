//! The coefficient of friction at a slip speed.

use std::fmt::Debug;

/// Where a contact node is, when, and what presses it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// Position (m).
    pub position: [f64; 3],
    /// Time (s).
    pub time: f64,
    /// Contact pressure (Pa).
    pub pressure: f64,
}

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
