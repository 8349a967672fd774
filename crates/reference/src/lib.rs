//! References for rolling contact without inertia: exact contact conditions on finite bodies as meshed. No
//! penalty, no time stepping. SI units.
//!
//! The bodies are reduced to their contact surface: a sparse Cholesky factorisation gives the compliance of
//! the surface nodes ([`SurfaceCompliance`]), two bodies make an influence matrix W = G K^-1 G^T
//! ([`Influence`]), and on it stand normal contact ([`press`]), the Cattaneo shift and rolling ([`Rolling`]).
//! One factorisation meets many right-hand sides.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod block;
mod compliance;
mod dissection;
mod friction;
mod influence;
mod measures;
mod normal;
mod rolling;
mod sparse;

pub use block::{Block, BlockError, Lateral};
pub use compliance::{FactorSize, SurfaceCompliance};
pub use friction::{FrictionError, Rigid};
pub use influence::{Influence, InfluenceError, Point};
pub use measures::{Ellipsoid, ellipsoid, peak_shear, stick_border, stick_fraction};
pub use normal::{Press, PressError, Pressed, press};
pub use rolling::{Adhesion, Rolling, RollingError};
pub use sparse::{ElementStiffness, Factor, SparseError, StiffnessMatrix, Symbolic, Unknowns};
