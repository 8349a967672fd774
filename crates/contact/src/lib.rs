//! Contact of two deformable surfaces: search, gap and slip kinematics, penalty enforcement in
//! two passes with a friction spring, friction laws, patch measures.
//!
//! Side 0 is the first surface given (the disk's tread), side 1 the second (the bar's top). In
//! pass `i` the nodes of side `i` are slaves and the faces of the other side are masters; the
//! forces of both passes add. SI units.

mod error;
mod face;
mod friction;
mod gap;
mod nodal;
mod pair;
pub mod patch;
mod penalty;
#[cfg(test)]
mod plates;
mod search;
mod stiffness;
mod surface;
#[cfg(test)]
mod tests;
mod vector;

pub use error::ContactError;
pub use friction::{
    Coulomb, Exponential, Expression, ExpressionError, Falling, FrictionLaw, Interface, Memory,
    SteadyLaw, Strengthens, Table, TableError, falling, nucleation_length, spring_number,
};
pub use gap::Gap;
pub use nodal::NodalContact;
pub use penalty::{ContactSums, Motion, PenaltyContact, PenaltySettings};
pub use stiffness::{BodyMaterial, StabilityScale, Stiffness};
