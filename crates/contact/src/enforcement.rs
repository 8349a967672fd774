//! What a time loop asks of a method of contact.

use crate::face::Positions;
use crate::point::follow_first;
use crate::renumber::{Renumbered, Renumbering};
use crate::snapshot::{Points, check_points};
use crate::{
    ContactState, ContactSums, ExactContact, Motion, NodalContact, PenaltyContact, StateError,
    Trace,
};
use mesh::{Face, Padded};
use std::fmt::Debug;

/// The motion that a step would have without contact.
#[derive(Clone, Copy)]
pub struct FreeMotion<'a> {
    /// Velocity `v^{n+1/2}` (m/s) of a node of the trace under a force (N): the step's own update of velocities.
    pub velocity: &'a (dyn Fn(u32, [f64; 3]) -> [f64; 3] + Sync),
}

/// Enforcement of contact and friction in dynamics.
///
/// A step works on the [trace](Self::trace): motion and forces have one entry per node of it. Tables, pairs and the
/// product with the stiffness have the numbers of the mesh.
pub trait Contact: Send + Debug {
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

    /// The contact as one that implicit steps can solve for; none for a method that they cannot.
    fn exact_mut(&mut self) -> Option<&mut ExactContact> {
        None
    }

    /// Gives the second slave of each pair of nodes of the mesh the state of the first, of nodes that move as one:
    /// no round-off then sets them apart. The pairs ascend by the first.
    fn follow_first(&mut self, pairs: &[[u32; 2]]);

    /// Carries its state along as the mesh moves along the material. Returns how many closed slaves or faces under them
    /// have no successor: their contact is forgotten.
    fn renumber(&mut self, renumbering: Renumbering<'_>) -> usize;

    /// `y += K_c x` with the springs closed at the last call; nothing for a method without springs.
    ///
    /// # Panics
    /// If a slice has fewer entries than the mesh has nodes.
    fn add_stiffness_product(&self, x: &[Padded], y: &mut [Padded]);

    /// An output table for all nodes of side `side`.
    fn nodal_table(&self, side: usize) -> NodalContact;

    /// An output table for the nodes of `faces`, a part of the surface of side `side`.
    fn nodal_table_of(&self, side: usize, faces: &[Face]) -> NodalContact;

    /// Fills a `table` of this contact with the values of the last call.
    fn nodal(&self, table: &mut NodalContact);

    /// The side at whose nodes the conditions of contact hold, with the slip velocity of the step that
    /// leaves `x^n`; none for a method that violates them everywhere.
    fn enforced_on(&self) -> Option<usize>;

    /// Everything that goes on from step to step.
    fn snapshot(&self) -> ContactState;

    /// Takes over the state of a contact of the same surfaces, method and settings: the next steps
    /// have the same bits as those of the contact that it was taken from.
    ///
    /// # Errors
    /// A state of another contact. This one is then in no state to go on.
    fn restore(&mut self, state: &ContactState) -> Result<(), StateError>;
}

impl Contact for PenaltyContact {
    fn trace(&self) -> &Trace {
        &self.trace
    }

    fn follow(&mut self, motion: &Motion<'_>) {
        self.follow(motion);
    }

    fn loaded(&self) -> &[u32] {
        &self.loaded
    }

    fn apply(
        &mut self,
        motion: &Motion<'_>,
        _: &FreeMotion<'_>,
        force: &mut [Padded],
    ) -> ContactSums {
        self.load(&Positions(motion.position), force)
    }

    fn follow_first(&mut self, pairs: &[[u32; 2]]) {
        for (side, points) in self.points.iter_mut().enumerate() {
            follow_first(points, self.trace.side(side), pairs);
        }
    }

    fn renumber(&mut self, renumbering: Renumbering<'_>) -> usize {
        let Self { sides, trace, search, points, .. } = self;
        let in_mesh = [trace.side(0), trace.side(1)];
        Renumbered { sides, in_mesh, search }.passes(points, renumbering)
    }

    fn add_stiffness_product(&self, x: &[Padded], y: &mut [Padded]) {
        self.stiffness_product(x, y);
    }

    fn nodal_table(&self, side: usize) -> NodalContact {
        self.nodal_table(side)
    }

    fn nodal_table_of(&self, side: usize, faces: &[Face]) -> NodalContact {
        NodalContact::part(&self.trace, &self.sides, side, faces)
    }

    fn nodal(&self, table: &mut NodalContact) {
        self.nodal(table);
    }

    fn enforced_on(&self) -> Option<usize> {
        None
    }

    fn snapshot(&self) -> ContactState {
        let points = Points::Penalty(self.points.clone());
        ContactState { points, search: self.search.clone(), origin: self.sides[0].origin }
    }

    fn restore(&mut self, state: &ContactState) -> Result<(), StateError> {
        let Points::Penalty(passes) = &state.points else { return Err(StateError::Method) };
        for (slave, points) in passes.iter().enumerate() {
            check_points(points, &self.sides[slave], &self.sides[1 - slave])?;
        }
        self.points.clone_from(passes);
        self.sides.iter_mut().for_each(|side| side.origin = state.origin);
        self.search.restore(&state.search, &self.sides)
    }
}
