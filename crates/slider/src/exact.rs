//! Exact friction: no penalty and no adhesion zone, Eqs (6) and (7) hold at the end of each step.

use crate::{Parameters, State};
use friction::{FrictionLaw, slip_speed};

/// One step of the central difference method with friction found from the contact conditions.
///
/// Without friction the slip velocity would become `s_free`; friction takes away `T f/F_n` with
/// `T = dt F_n/m`. The block sticks if that can be all of it, `|s_free| <= T mu(0)`; else it slips
/// with the root of `|s| + T mu(|s|) = |s_free|`. Where both are possible (friction falls faster
/// than 1/T) the block stays on the branch it is on until that branch ends (perfect delay).
pub fn exact_step(p: &Parameters, state: State) -> State {
    let free = free_slip(p, &state);
    let curve = |speed: f64| (p.law.mu(speed), p.law.slope(speed));
    let slipped = state.slip * free > 0.0;
    let slip = slip_speed::solve(free.abs(), reach(p), slipped, &curve);
    let slip = slip.map_or(0.0, |(speed, _)| speed).copysign(free);
    let mu = if slip == 0.0 { p.mu_static() } else { p.mu(slip) };
    advanced(p, &state, free, slip, mu)
}

/// One step with friction that remembers: the coefficient is the state's own, so that stick and
/// slip are never both possible, and then adapts to the slip of the step.
pub fn memory_step(p: &Parameters, state: State) -> State {
    let free = free_slip(p, &state);
    let slip = (free.abs() - reach(p) * state.mu).max(0.0).copysign(free);
    let mu = p.memory.advance(state.mu, p.mu(slip), slip.abs(), p.dt);
    advanced(p, &state, free, slip, mu)
}

/// Slip velocity after a step without friction (m/s).
fn free_slip(p: &Parameters, state: &State) -> f64 {
    state.slip + p.dt / p.mass * (-p.damping * state.v - p.spring * state.x)
}

/// T = dt F_n/m (m/s): the slip velocity that a coefficient of friction of 1 takes away.
fn reach(p: &Parameters) -> f64 {
    p.dt * p.normal_force / p.mass
}

/// The step's end, with the friction that changed the slip velocity from `free` to `slip`.
fn advanced(p: &Parameters, state: &State, free: f64, slip: f64, mu: f64) -> State {
    let v = p.belt + slip;
    State { x: state.x + p.dt * v, v, slip, friction: p.mass / p.dt * (slip - free), mu }
}
