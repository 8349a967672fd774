//! What the parts of a run ask of a method of contact, a trait for each part.

use crate::renumber::Renumbering;
use crate::{ContactState, ContactSums, Motion, NodalContact, StateError, Trace};
use mesh::{Face, Padded};
use nalgebra::Vector3;
use std::fmt::Debug;

/// The motion that a step would have without contact.
#[derive(Clone, Copy)]
pub struct FreeMotion<'a> {
    /// Velocity `v^{n+1/2}` (m/s) of a node of the trace under a force (N): the step's own update of velocities.
    pub velocity: &'a (dyn Fn(u32, Vector3<f64>) -> Vector3<f64> + Sync),
}

/// What a step asks.
///
/// It works on the [trace](Self::trace): motion and forces have one entry per node of it.
pub trait ContactStep {
    /// The nodes of both surfaces.
    fn trace(&self) -> &Trace;

    /// Follows the surfaces to `x^n = X + u^n`: all that a step needs of positions and velocities alone, and
    /// may be done beside the internal force.
    ///
    /// # Panics
    /// If a slice has fewer entries than the trace has nodes.
    fn follow(&mut self, motion: &Motion<'_>);

    /// The nodes of the trace, some more than once, whose forces [`apply`](Self::apply) asks for or changes in
    /// this step, as they were [followed](Self::follow): no others need be gathered or scattered.
    fn loaded(&self) -> &[u32];

    /// Adds the contact forces (N) of the step from `x^n`, to which the surfaces have been
    /// [followed](Self::follow), to `force`, which holds all other forces on the [loaded](Self::loaded) nodes.
    ///
    /// # Panics
    /// If a slice has fewer entries than the trace has nodes.
    fn apply(
        &mut self,
        motion: &Motion<'_>,
        free_motion: &FreeMotion<'_>,
        force: &mut [Padded],
    ) -> ContactSums;

    /// Gives the second slave of each pair of nodes of the mesh the state of the first, of nodes that move as one:
    /// no round-off then sets them apart. The pairs ascend by the first.
    fn follow_first(&mut self, pairs: &[[u32; 2]]);
}

/// What output asks. Tables have the numbers of the mesh.
pub trait ContactTables {
    /// An output table for all nodes of side `side`.
    fn nodal_table(&self, side: usize) -> NodalContact;

    /// An output table for the nodes of `faces`, a part of the surface of side `side`.
    fn nodal_table_of(&self, side: usize, faces: &[Face]) -> NodalContact;

    /// Fills a `table` of this contact with the values of the last call.
    fn nodal(&self, table: &mut NodalContact);

    /// The side at whose nodes the conditions of contact hold, with the slip velocity of the step that
    /// leaves `x^n`; none for a method that violates them everywhere.
    fn enforced_on(&self) -> Option<usize>;
}

/// What a mesh asks that moves along the material.
pub trait ContactRenumbering {
    /// Carries its state along as the mesh moves along the material. Returns how many closed slaves or faces under them
    /// have no successor: their contact is forgotten.
    fn renumber(&mut self, renumbering: Renumbering<'_>) -> usize;
}

/// What a checkpoint asks.
pub trait ContactRestart {
    /// Everything that goes on from step to step.
    fn snapshot(&self) -> ContactState;

    /// Takes over the state of a contact of the same surfaces, method and settings: the next steps
    /// have the same bits as those of the contact that it was taken from.
    ///
    /// # Errors
    /// A state of another contact. This one is then in no state to go on.
    fn restore(&mut self, state: &ContactState) -> Result<(), StateError>;
}

/// Enforcement of contact and friction in dynamics: all that is asked of it.
pub trait Contact:
    ContactStep + ContactTables + ContactRenumbering + ContactRestart + Send + Debug
{
}

impl<T> Contact for T where
    T: ContactStep + ContactTables + ContactRenumbering + ContactRestart + Send + Debug
{
}
