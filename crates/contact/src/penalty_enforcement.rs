//! What is asked of penalty contact.

use crate::enforcement::{
    ContactRenumbering, ContactRestart, ContactStep, ContactTables, FreeMotion,
};
use crate::face::Positions;
use crate::point::follow_first;
use crate::renumber::{Renumbered, Renumbering};
use crate::snapshot::{Points, check_points};
use crate::{ContactState, ContactSums, Motion, NodalContact, PenaltyContact, StateError, Trace};
use mesh::{Face, Padded};

impl ContactStep for PenaltyContact {
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
}

impl ContactRenumbering for PenaltyContact {
    fn renumber(&mut self, renumbering: Renumbering<'_>) -> usize {
        let Self { sides, trace, search, points, .. } = self;
        let in_mesh = [trace.side(0), trace.side(1)];
        Renumbered { sides, in_mesh, search }.passes(points, renumbering)
    }
}

impl ContactTables for PenaltyContact {
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
}

impl ContactRestart for PenaltyContact {
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
