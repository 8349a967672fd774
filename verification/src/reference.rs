//! Reference solutions of rolling contact without inertia: exact contact conditions on meshed finite bodies, without
//! penalty and without time stepping. SI units.
//!
//! The bodies are condensed to their contact surface. A sparse Cholesky factorisation gives the compliance of
//! the surface nodes ([`SurfaceCompliance`]), and two bodies give an influence matrix W = G K^-1 G^T
//! ([`Influence`]). With it, normal contact ([`press`]), the Cattaneo shift and rolling ([`Rolling`]) are solved, with
//! constant friction or a friction law ([`SlipLaw`]).
//! One factorisation serves all of these problems.
//!
//! Global frame: x is the direction of rolling, y lateral, z up.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod block;
mod compliance;
mod dissection;
mod friction;
mod influence;
mod measures;
mod normal;
mod rolling;
mod rolling_in_parts;
mod slip_law;
mod sparse;

pub use block::{Block, BlockError, Lateral};
pub use compliance::{FactorSize, SurfaceCompliance};
pub use friction::{FrictionError, Rigid};
pub use influence::{Influence, InfluenceError, Point};
pub use measures::{Ellipsoid, ellipsoid, peak_shear, stick_border, stick_fraction};
pub use normal::{Press, PressError, Pressed, press};
pub use rolling::{Adhesion, Rolling, RollingError};
pub use rolling_in_parts::RollingInParts;
pub use slip_law::SlipLaw;
pub use sparse::{ElementStiffness, Factor, SparseError, StiffnessMatrix, Symbolic, Unknowns};
