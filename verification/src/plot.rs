//! Figures of the rows of problems.

pub mod convergence;
pub mod rupture;
