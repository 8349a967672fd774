//! Friction laws: the coefficient of friction as a function of the slip speed, of place, time and pressure,
//! and of a state; each declared once for the solver, the slider, the checks and the case file.
//!
//! A [`FrictionLaw`] is steady: it has no state. [`Lagged`], [`Implicit`] and [`Remembering`] turn it into the law
//! of a contact node, a [`NodeFriction`]. Laws with a state implement [`NodeFriction`] themselves. [`Parameters`]
//! builds any law from the keys of a case file; what a law is to those who choose one is its [`Declaration`]. [`slip_speed`] solves a node's tangential problem. SI units.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod declaration;
mod formula;
mod law;
mod memory;
mod node;
mod numbers;
mod operators;
mod parameters;
mod schema;
pub mod slip_speed;
mod values;

declaration::laws! {
    Coulomb: coulomb;
    Exponential: exponential;
    Polach: polach;
    SlipWeakening: slip_weakening;
    RateState: rate_state;
    PrakashClifton: prakash_clifton;
    Table: table;
    Expression: expression;
    Python: own;
}

pub use coulomb::{Coulomb, STATIC};
pub use declaration::{Declaration, LeftOut, NUMBERS, Number};
pub use exponential::{DYNAMIC, Exponential};
pub use expression::{Domain, Expression, ExpressionError};
pub use formula::Formula;
pub use law::{FrictionLaw, NodeConditions, Strengthens};
pub use memory::Memory;
pub use node::{Implicit, Lagged, NodeFriction, NodeHistory, Remembering, Remembers};
pub use numbers::{Falling, Interface, falling, nucleation_length, spring_number};
pub use own::{Own, OwnLaw, sampled};
pub use parameters::{LawError, Mode, OTHERS, Parameters, all_parameters};
pub use prakash_clifton::PrakashClifton;
pub use rate_state::{RateState, StateLaw};
pub use slip_weakening::SlipWeakening;
pub use table::{Table, TableError};
pub use values::Values;
