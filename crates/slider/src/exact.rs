//! Exact friction: no penalty and no adhesion zone, Eqs (6) and (7) hold at the end of each step.

use crate::{Parameters, State};
use contact::FrictionLaw;

/// One step of the central difference method with friction found from the contact conditions.
///
/// Without friction the slip velocity would become `s_free`; friction takes away `T f/F_n` with
/// `T = dt F_n/m`. The block sticks if that can be all of it, `|s_free| <= T mu(0)`; else it slips
/// with the root of `|s| + T mu(|s|) = |s_free|`. Where both are possible (friction falls faster
/// than 1/T) the block stays on the branch it is on until that branch ends (perfect delay).
pub fn exact_step(p: &Parameters, state: State) -> State {
    let (free, reach) = (free_slip(p, &state), reach(p));
    let speed = free.abs();
    let sticks = speed <= reach * p.mu_static();
    let slipped_on = state.slip * free > 0.0;
    let slip = match (sticks, slipped_on) {
        (true, false) => 0.0,
        (true, true) => slipping(p, speed, reach).unwrap_or(0.0),
        // no stick: a root exists, since the left-hand side is below at rest and above at s_free
        (false, _) => slipping(p, speed, reach).unwrap_or(0.0),
    };
    let slip = slip.copysign(free);
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

/// Steps of the descent and of the bisection: far more than either takes.
const MOST: usize = 200;

/// The largest root s >= 0 of `g(s) = s + T mu(s) - speed`, if there is one.
///
/// Newton's method from `s = speed`, where g >= 0, falls monotonically onto the largest root of a
/// convex g, as Eq (17) gives. Where it steps over a root of another law, the root is bracketed;
/// where the slope turns before g does, the branch has ended.
fn slipping(p: &Parameters, speed: f64, reach: f64) -> Option<f64> {
    let g = |s: f64| s + reach * p.law.mu(s) - speed;
    let mut s = speed;
    for _ in 0..MOST {
        let value = g(s);
        let (right, left) = (s + 1e-6 * s.max(1e-9), s - 1e-6 * s);
        let slope = 1.0 + reach * (p.law.mu(right) - p.law.mu(left)) / (right - left);
        if slope <= 0.0 {
            return None;
        }
        let next = (s - value / slope).max(0.0);
        if g(next) < 0.0 {
            return Some(bisected(g, next, s));
        }
        if next >= s * (1.0 - 1e-15) {
            return Some(next);
        }
        if next == 0.0 {
            return None; // g > 0 at rest: the block can stick
        }
        s = next;
    }
    None
}

/// The root of g between `low` (g < 0) and `high` (g >= 0).
fn bisected(g: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..MOST {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if g(middle) < 0.0 { low = middle } else { high = middle }
    }
    high
}
