//! The motion that contact answers to.

use mesh::Padded;

/// The motion that contact answers to; all slices have one entry per mesh node.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// Reference positions `X` (m).
    pub reference: &'a [Padded],
    /// Displacements `u^n` (m).
    pub displacement: &'a [Padded],
    /// Velocities `v^{n-1/2}` of the step that led to `u^n` (m/s).
    pub velocity: &'a [Padded],
    /// Inverse lumped masses (1/kg), zero for nodes that are held.
    pub inverse_mass: &'a [f64],
    /// Time t^n (s).
    pub time: f64,
    /// Time step (s).
    pub dt: f64,
}
