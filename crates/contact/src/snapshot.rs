//! What contact keeps from step to step: enough to go on with the same bits.
//!
//! serde makes the state of the contact points, the means and the search themselves; `serde(skip)` leaves out
//! what a step computes anew and nothing reads before. The search keeps where the surfaces were when it last looked:
//! that decides when the lists are made anew, and so the order in which forces are added.

use crate::constraint::{Constraint, MasterNode};
use crate::mortar::Mean;
use crate::penalty_point::PenaltyPoint;
use crate::point::{ContactPoint, Enforced};
use crate::search::{Listed, Search};
use crate::surface::ContactSurface;
use serde::{Deserialize, Serialize};

/// State of contact between two steps, of either method of enforcement.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ContactState {
    pub(crate) points: Points,
    pub(crate) search: Search,
    /// Of the coordinates, as the surfaces have it (m).
    pub(crate) origin: f64,
}

/// The listed slave nodes of a method.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) enum Points {
    /// The springs of each pass.
    Penalty([Vec<PenaltyPoint>; 2]),
    /// The rows of the slaves' side with their master_nodes, and of mortar rows the means that they follow.
    Exact(Vec<Constraint>, Vec<MasterNode>, Vec<Mean>),
}

/// A state that is not of the contact that is to go on from it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum StateError {
    /// Of another method.
    #[error("the state of contact is of another method of enforcement")]
    Method,
    /// Of rows against one face where this contact has mortar rows, or the other way round.
    #[error("the state of contact is of other rows: node to face, or mortar")]
    Rows,
    /// An index out of range, or another number of entries.
    #[error("`{name}` in the state of contact has an entry that this contact cannot have")]
    Range {
        /// Which index or list.
        name: &'static str,
    },
}

/// That points are slaves on `slaves`, in their order, and have projections on `masters`.
pub(crate) fn check_points<E: Enforced>(
    points: &[ContactPoint<E>],
    slaves: &ContactSurface,
    masters: &ContactSurface,
) -> Result<(), StateError> {
    let known = |point: &ContactPoint<E>| (point.slave as usize) < slaves.len();
    if !points.iter().all(known) || !points.is_sorted_by(|a, b| a.slave < b.slave) {
        return Err(StateError::Range { name: "slave" });
    }
    let projects = |point: &ContactPoint<E>| (point.face as usize) < masters.faces.len();
    if points.iter().all(projects) { Ok(()) } else { Err(StateError::Range { name: "face" }) }
}

/// That the closed constraints have master_nodes, which are nodes of `masters`.
pub(crate) fn check_legs(
    constraints: &[Constraint],
    master_nodes: &[MasterNode],
    masters: &ContactSurface,
) -> Result<(), StateError> {
    let mut closed = constraints.iter().filter(|constraint| constraint.is_closed());
    let fits = closed.all(|constraint| master_nodes.get(constraint.master_nodes()).is_some())
        && master_nodes.iter().all(|master_node| (master_node.node as usize) < masters.len());
    if fits { Ok(()) } else { Err(StateError::Range { name: "master_nodes" }) }
}

impl Search {
    /// Takes over when the next search is due.
    pub(crate) fn restore(
        &mut self,
        state: &Self,
        sides: &[ContactSurface; 2],
    ) -> Result<(), StateError> {
        for (side, surface) in sides.iter().enumerate() {
            // empty before the first search
            let nodes = if state.at[0].is_empty() { 0 } else { surface.len() };
            let counts =
                [state.at[side].len(), state.moved[side].len(), state.allowance[side].len()];
            if counts != [nodes; 3] {
                return Err(StateError::Range { name: "search" });
            }
        }
        let margin = self.margin;
        self.clone_from(state);
        self.margin = margin;
        Ok(())
    }
}
