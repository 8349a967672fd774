//! The verification ladder: problems with a known answer, from the patch test to rolling contact,
//! that any user can run.
//!
//! A [`Problem`] gives [`Row`]s: a computed quantity beside its reference. The limit of a row
//! does not depend on its own error. It is round-off for what the method does exactly; the uncertainty that the
//! problem's mesh convergence shows ([`Convergence`]); or a number that the problem prescribes ([`Row::asked`]).

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod convergence;
mod corrugation;
mod problem;
mod problems;
mod rolling_dynamic;
mod rolling_limits;
mod rolling_memory;
mod rolling_sideways;
mod rolling_steps;
mod row;

mod body;
mod carter;
mod cattaneo;
mod collision;
mod contact_examples;
mod contact_turn;
mod dispersion;
mod finite_body;
mod free_block;
mod grading_reflection;
mod half_space;
mod half_space_rolling;
mod half_space_rupture;
mod half_space_waves;
mod hertz;
mod hertz_stress;
mod implicit;
mod interface_patch;
mod kalker;
mod lamb;
mod lysmer;
mod manchester;
mod mindlin;
mod patch;
mod perturbation_growth;
#[cfg(test)]
mod planted;
pub mod reference;
mod rupture;
mod shear_column;
mod shear_column_penalty;
mod slider_tables;
mod sliding;
mod steady_rolling;
mod unlike;
mod waves;

pub use convergence::{Convergence, Sample};
pub use problem::{Cause, Problem, Size, VerifyError};
pub use problems::{PROBLEMS, find};
pub use row::{Field, Row};
