//! The 1-D slider of Vollebregt (2017), section 6: a block on a moving belt, held by a spring and a damper, with
//! friction that falls with slip velocity. Equation, table and figure numbers are those of that paper. SI units;
//! positions, velocities and forces are along the belt, in a fixed frame, positive towards +x.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod exact;
mod explicit;
mod implicit;
mod map;
mod parameters;
mod penalty;
mod run;
mod state;
mod stick;
pub mod tables;
mod thresholds;

pub use exact::{exact_step, memory_step};
pub use explicit::explicit_step;
pub use implicit::{ImplicitEquation, Iterations, implicit_step};
pub use map::{MapPoint, SMALLEST_STEP, map, map_end};
pub use parameters::{MOST_STEPS, ParameterError, Parameters};
pub use penalty::{penalty_stable_step, penalty_step};
pub use run::{BlowUp, Method, Outcome, run, unobserved};
pub use state::State;
pub use stick::Ringing;
pub use thresholds::{Threshold, Thresholds, chatter_step, collapse_step, thresholds};

#[cfg(test)]
mod tests;
