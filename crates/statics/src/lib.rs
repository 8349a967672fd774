//! Equilibrium of two elastic bodies in contact: the preload of a rolling run and the quasi-static
//! reference. SI units.
//!
//! Two routes to it:
//! - [`solve`]: Newton's method on the elements and the contact of the dynamic stage; the linear
//!   systems are solved by preconditioned conjugate gradients on the products of the element
//!   kernel, without a matrix. For the preload of large meshes.
//! - The reference reduces the bodies to their contact surface: a sparse Cholesky factorisation
//!   gives the compliance of the surface nodes ([`SurfaceCompliance`]), two bodies make an influence
//!   matrix W = G K^-1 G^T ([`Influence`]), and on it stand normal contact ([`press`]), the Cattaneo
//!   shift and rolling ([`Rolling`]) with exact contact conditions: no penalty, no inertia, the
//!   finite bodies as meshed. One factorisation meets many right-hand sides.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod block;
mod cg;
mod coarse;
mod compliance;
mod components;
mod dissection;
mod error;
mod exact;
mod friction;
mod influence;
mod link;
mod measures;
mod newton;
mod normal;
mod problem;
mod rolling;
mod skyline;
mod space;
mod sparse;
mod supports;
mod system;

pub use block::{Block, BlockError, Lateral};
pub use compliance::{FactorSize, SurfaceCompliance};
pub use error::StaticsError;
pub use friction::{FrictionError, Rigid};
pub use influence::{Influence, InfluenceError, Point};
pub use measures::{Ellipsoid, ellipsoid, peak_shear, stick_border, stick_fraction};
pub use normal::{Press, PressError, Pressed, press};
pub use problem::{Ending, Enforcement, Equilibrium, Iteration, Problem, Report, Spin, solve};
pub use rolling::{Adhesion, Rolling, RollingError};
pub use sparse::{ElementStiffness, Factor, SparseError, Stiffness, Symbolic, Unknowns};
pub use supports::{Axis, Supports, Tied};
