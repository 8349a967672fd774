//! The explicit method, Eqs (28)-(32) as printed.

use crate::{Parameters, State};

/// One step: friction at the slip velocity of the step before, forward Euler for the velocity,
/// the trapezoidal rule for the position.
pub fn explicit_step(p: &Parameters, state: State) -> State {
    let mu = p.mu(state.slip); // (28)
    let friction = p.regularised(mu, state.slip); // (29)
    let v = state.v + p.dt / p.mass * (-p.damping * state.v - p.spring * state.x + friction); // (30)
    let x = state.x + 0.5 * p.dt * (state.v + v); // (31)
    State { x, v, slip: v - p.belt, friction, mu } // (32)
}
