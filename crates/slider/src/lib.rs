//! The 1-D slider of Vollebregt (2017), section 6: a block on a belt, held by a spring, with
//! friction that falls with slip velocity. Equation numbers are that paper's.

mod explicit;
mod implicit;
mod parameters;
mod run;
pub mod tables;

pub use explicit::explicit_step;
pub use implicit::{Iterations, implicit_step};
pub use parameters::{ParameterError, Parameters};
pub use run::{Method, Outcome, State, run};
