//! Equilibrium of two elastic bodies in contact: the preload of a rolling run. SI units.
//!
//! [`solve`] is Newton's method on the elements and the contact of the dynamic stage; the linear systems are
//! solved by preconditioned conjugate gradients on the products of the element kernel, without a matrix but that of the
//! preconditioner's coarse level, which faer factorises.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod cholesky;
mod coarse;
mod components;
mod error;
mod exact;
mod linear;
mod link;
mod newton;
mod problem;
mod solve;
mod space;
mod springs;
mod supports;
mod system;

pub use error::StaticsError;
pub use linear::LinearStatics;
pub use problem::{Contact, Ending, Equilibrium, Iteration, NewtonReport, Problem, Spin};
pub use solve::solve;
pub use supports::{Axis, Supports, Tied};
