//! Equilibrium of two elastic bodies in contact: the preload of a rolling run and the quasi-static
//! reference.

mod supports;

pub use supports::{Axis, Supports, Tied};
