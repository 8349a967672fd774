//! Equilibrium of two elastic bodies in contact: the preload of a rolling run and the quasi-static
//! reference.
//!
//! The reference reduces the bodies to their contact surface: a sparse Cholesky factorisation
//! gives the compliance of the surface nodes ([`SurfaceCompliance`]), two bodies make an influence
//! matrix W = G K^-1 G^T ([`Influence`]), and on it stand normal contact ([`press`]), the Cattaneo
//! shift and rolling ([`Rolling`]) with exact contact conditions: no penalty, no inertia, the
//! finite bodies as meshed. SI units.

mod block;
mod compliance;
mod dissection;
mod friction;
mod influence;
mod measures;
mod normal;
mod rolling;
mod sparse;
mod supports;

pub use block::{Block, BlockError, Lateral};
pub use compliance::{FactorSize, SurfaceCompliance};
pub use friction::{FrictionError, Rigid};
pub use influence::{Influence, InfluenceError, Point};
pub use measures::{Ellipsoid, ellipsoid, peak_shear, stick_border, stick_fraction};
pub use normal::{Press, PressError, Pressed, press};
pub use rolling::{Adhesion, Rolling, RollingError};
pub use sparse::{ElementStiffness, Factor, SparseError, Stiffness, Symbolic, Unknowns};
pub use supports::{Axis, Supports, Tied};
