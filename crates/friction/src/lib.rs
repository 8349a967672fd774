//! Friction laws: the coefficient of friction as a function of the slip speed, of place, time and pressure,
//! and of a state; each declared once for the solver, the slider, the checks and the case file.
//!
//! A [`FrictionLaw`] is steady: it has no state. [`Lagged`], [`Implicit`] and [`Remembering`] turn it into the law
//! of a contact node, a [`NodeFriction`]. Laws with a state implement [`NodeFriction`] themselves. [`Parameters`]
//! builds any law from the keys of a case file. [`slip_speed`] solves a node's tangential problem. SI units.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod coulomb;
mod exponential;
mod expression;
mod law;
mod memory;
mod node;
mod numbers;
mod operators;
mod own;
mod parameters;
mod prakash_clifton;
mod rate_state;
pub mod slip_speed;
mod slip_weakening;
mod steady;
mod table;

pub use coulomb::Coulomb;
pub use exponential::Exponential;
pub use expression::{Domain, Expression, ExpressionError};
pub use law::{FrictionLaw, NodeConditions};
pub use memory::Memory;
pub use node::{Implicit, Lagged, NodeFriction, NodeHistory, Remembering, Remembers};
pub use numbers::{Falling, Interface, falling, nucleation_length, spring_number};
pub use own::{Own, OwnLaw, sampled};
pub use parameters::{DYNAMIC, Kind, LawError, Mode, Parameters, USES, Uses, all_parameters};
pub use prakash_clifton::PrakashClifton;
pub use rate_state::{RateState, StateLaw};
pub use slip_weakening::SlipWeakening;
pub use steady::{SteadyLaw, Strengthens};
pub use table::{Table, TableError};
