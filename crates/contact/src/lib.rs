//! Contact of two deformable surfaces: search, gap and slip kinematics, enforcement by penalty in
//! two passes with a friction spring or exactly in one, patch measures.
//!
//! Side 0 is the first surface given (of the upper body), side 1 the second (of the lower). In
//! pass `i` the nodes of side `i` are slaves and the faces of the other side are masters; the
//! forces of both passes of penalty contact add. SI units.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod constraint;
mod enforcement;
mod error;
mod exact;
mod face;
mod gap;
mod gap_function;
mod lift;
pub mod mesh_mode;
mod method;
mod mortar;
mod motion;
mod nodal;
mod nodal_normals;
pub mod patch;
mod penalty;
mod penalty_enforcement;
mod penalty_point;
mod penalty_springs;
mod point;
mod renumber;
mod search;
mod segment;
mod snapshot;
mod stiffness;
mod sums;
mod surface;
mod symmetry;
#[cfg(test)]
mod tests;
mod trace;

pub use constraint::Rows;
pub use enforcement::{
    Contact, ContactRenumbering, ContactRestart, ContactStep, ContactTables, FreeMotion,
};
pub use error::ContactError;
pub use exact::{Corrected, ExactContact, ExactSettings};
pub use gap::Gap;
pub use gap_function::GapFunction;
pub use method::Method;
pub use motion::Motion;
pub use nodal::NodalContact;
pub use nodal_normals::Normals;
pub use penalty::{PenaltyContact, PenaltySettings};
pub use point::finer;
pub use renumber::Renumbering;
pub use snapshot::{ContactState, StateError};
pub use stiffness::{BodyMaterial, StabilityScale, Stiffness};
pub use sums::ContactSums;
pub use trace::{Trace, TraceFields, TraceStep};
