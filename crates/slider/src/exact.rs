//! Exact friction: without penalty and adhesion zone; Eqs (6) and (7) hold at the end of each step.

use crate::{Parameters, State};
use friction::{FrictionLaw, slip_speed};

/// One step of the central difference method with friction found from the contact conditions.
///
/// Without friction the slip velocity would become `s_free`. With `c = dt F_n/m` the block sticks if
/// `|s_free| <= c mu(0)`; otherwise it slips at the root of `|s| + c mu(|s|) = |s_free|`. Where both are possible
/// (friction falls faster than 1/c) the block stays on its branch until that branch ends (perfect delay,
/// [`friction::slip_speed`]).
pub fn exact_step(p: &Parameters, state: State) -> State {
    let free = free_slip(p, &state);
    let curve = |speed: f64| (p.law.mu(speed), p.law.slope(speed));
    let slipped = state.slip * free > 0.0;
    let slip = slip_speed::solve(free.abs(), speed_per_mu(p), slipped, &curve);
    let slip = slip.map_or(0.0, |(speed, _)| speed).copysign(free);
    let mu = if slip == 0.0 { p.mu_static() } else { p.mu(slip) };
    advanced(p, &state, free, slip, mu)
}

/// One step with friction with memory. The coefficient is that of `state`, so that stick and slip are never both
/// possible; it then adapts to the slip velocity of the step.
pub fn memory_step(p: &Parameters, state: State) -> State {
    let free = free_slip(p, &state);
    let slip = (free.abs() - speed_per_mu(p) * state.mu).max(0.0).copysign(free);
    let mu = p.memory.advance(state.mu, p.mu(slip), slip.abs(), p.dt);
    advanced(p, &state, free, slip, mu)
}

/// Slip velocity after a step without friction (m/s).
fn free_slip(p: &Parameters, state: &State) -> f64 {
    state.slip + p.dt / p.mass * (-p.damping * state.v - p.spring * state.x)
}

/// c = dt F_n/m (m/s): the slip speed that a coefficient of friction of 1 removes in a step.
fn speed_per_mu(p: &Parameters) -> f64 {
    p.dt * p.normal_force / p.mass
}

/// The state at the end of the step, with the friction force that changed the slip velocity from `free` to `slip`.
fn advanced(p: &Parameters, state: &State, free: f64, slip: f64, mu: f64) -> State {
    let v = p.belt + slip;
    State { x: state.x + p.dt * v, v, slip, friction: p.mass / p.dt * (slip - free), mu }
}
