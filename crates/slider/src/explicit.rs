//! The explicit method, Eqs (28)-(32) as printed.

use crate::{Parameters, State};

/// One step: friction with the slip velocity of the step before, Euler forward for the velocity,
/// the trapezoidal rule for the position.
pub fn explicit_step(p: &Parameters, state: State) -> State {
    let friction = p.friction(state.v - p.belt); // (28), (29)
    let v = state.v + p.dt / p.mass * (-p.damping * state.v - p.spring * state.x + friction); // (30)
    State { x: state.x + 0.5 * p.dt * (state.v + v), v } // (31); (32) gives the next slip
}
