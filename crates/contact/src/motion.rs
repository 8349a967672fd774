//! The motion that contact answers to.

use mesh::Padded;

/// The motion that contact answers to; all slices have one entry per node of the [trace](crate::Trace).
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// Positions `x^n` (m).
    pub position: &'a [Padded],
    /// Velocities `v^{n-1/2}` of the step that led to `x^n` (m/s).
    pub velocity: &'a [Padded],
    /// Inverse lumped masses (1/kg), zero for nodes that are held.
    pub inverse_mass: &'a [f64],
    /// Time t^n (s).
    pub time: f64,
    /// Time step (s).
    pub dt: f64,
}
