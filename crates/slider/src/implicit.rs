//! The implicit method: backward Euler, Eqs (19)-(23), by Picard iteration, Eqs (25) and (27).

use crate::{Parameters, State};

/// How a step's equation was solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Iterations {
    /// Picard iterations.
    pub picard: u32,
    /// Bisections of the fallback; zero where Picard converged.
    pub bisection: u32,
}

/// Picard iterations after which the bracketing fallback takes over.
const MOST_PICARD: u32 = 2000;

/// Change of the velocity at which Picard has converged, relative to the belt's velocity or 1 m/s.
const TOLERANCE: f64 = 1e-13;

/// One step.
///
/// In sliding Picard iterates Eq (25); in adhesion, where friction is nearly linear in the slip,
/// Eq (27), which moves that part to the left-hand side. Iterates that jump over the whole adhesion
/// zone are set to v_ref, as in the paper. Where Picard does not converge, the root is bracketed.
pub fn implicit_step(p: &Parameters, state: State) -> (State, Iterations) {
    let (dt, belt) = (p.dt, p.belt);
    let left = p.mass + p.damping * dt + p.spring * dt * dt;
    let linear = dt * p.law.mu_static * p.normal_force / p.adhesion;
    let known = p.mass * state.v - dt * p.spring * state.x;
    let tolerance = TOLERANCE * belt.abs().max(1.0);
    let mut count = Iterations::default();
    let mut v = state.v;
    while count.picard < MOST_PICARD {
        count.picard += 1;
        let slip = v - belt;
        let right = known + dt * p.friction(slip);
        let mut next = if slip.abs() <= p.adhesion {
            (right + linear * v) / (left + linear) // (27)
        } else {
            right / left // (25)
        };
        let new_slip = next - belt;
        let skips = slip.abs() > p.adhesion && new_slip.abs() > p.adhesion;
        if skips && slip * new_slip < 0.0 {
            next = belt;
        }
        if (next - v).abs() < tolerance {
            return (advanced(p, state, next), count);
        }
        v = next;
    }
    // The residual rises without bound on both sides: left v - known - dt F(v - v_ref), |F| <= F_n mu.
    let residual = |v: f64| left * v - known - dt * p.friction(v - belt);
    let bound = dt * p.normal_force * p.law.mu_static.max(p.law.mu_dynamic);
    let (mut low, mut high) = ((known - bound) / left, (known + bound) / left);
    while count.bisection < 200 && low < high {
        count.bisection += 1;
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if residual(middle) > 0.0 { high = middle } else { low = middle }
    }
    (advanced(p, state, 0.5 * (low + high)), count)
}

/// Eq (19).
fn advanced(p: &Parameters, state: State, v: f64) -> State {
    State { x: state.x + p.dt * v, v }
}
