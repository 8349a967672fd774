//! The state that every method carries from step to step.

/// The block at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Position (m).
    pub x: f64,
    /// Velocity (m/s); of the methods of central difference, at the half step before.
    pub v: f64,
    /// Slip velocity s = v - v_ref (m/s).
    pub slip: f64,
    /// Friction force F_fric on the block in the step (N).
    pub friction: f64,
    /// Coefficient of friction used in the step; with memory, its value at the end of the step.
    pub mu: f64,
}
