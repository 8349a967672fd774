//! Equilibrium of two elastic bodies in contact: the preload of a rolling run and the quasi-static
//! reference.
//!
//! Newton's method on the elements and the contact of the dynamic stage; the linear systems are
//! solved by preconditioned conjugate gradients on the products of the element kernel, without a
//! matrix. SI units.

mod cg;
mod coarse;
mod components;
mod error;
mod exact;
mod link;
mod newton;
mod problem;
mod skyline;
mod space;
mod supports;
mod system;

pub use error::StaticsError;
pub use problem::{Ending, Enforcement, Equilibrium, Iteration, Problem, Report, Spin, solve};
pub use supports::{Axis, Supports, Tied};
