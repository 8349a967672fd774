//! A run and its characteristic values.

use crate::{Parameters, explicit_step, implicit_step};

/// Position (m) and velocity (m/s) of the block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Position.
    pub x: f64,
    /// Velocity.
    pub v: f64,
}

/// The time-stepping methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Backward Euler, Eqs (19)-(27).
    Implicit,
    /// Eqs (28)-(32).
    Explicit,
}

/// The characteristic values of the paper's tables, and the solver's effort.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Smallest position (m).
    pub x_min: f64,
    /// Largest position after t = 0.7 s (m); NaN for a run that ends before.
    pub x_max: f64,
    /// Largest velocity (m/s).
    pub v_max: f64,
    /// Steps taken.
    pub steps: u64,
    /// Picard iterations of all steps; zero for the explicit method.
    pub picard: u64,
    /// Steps that needed the bracketing fallback.
    pub fallbacks: u64,
}

/// Start of the time over which `x_max` is taken (s): after the first collapse.
const AFTER_COLLAPSE: f64 = 0.7;

/// Runs the slider; `observe` sees time and state at t = 0 and after every step.
pub fn run(p: &Parameters, method: Method, mut observe: impl FnMut(f64, State)) -> Outcome {
    let steps = (p.end / p.dt).round().max(1.0) as u64;
    let mut state = State { x: p.x0, v: p.v0 };
    let mut out =
        Outcome { x_min: state.x, x_max: f64::NAN, v_max: state.v, steps, picard: 0, fallbacks: 0 };
    observe(0.0, state);
    for n in 1..=steps {
        state = match method {
            Method::Explicit => explicit_step(p, state),
            Method::Implicit => {
                let (next, count) = implicit_step(p, state);
                out.picard += u64::from(count.picard);
                out.fallbacks += u64::from(count.bisection > 0);
                next
            }
        };
        let time = n as f64 * p.dt;
        out.x_min = out.x_min.min(state.x);
        out.v_max = out.v_max.max(state.v);
        if time > AFTER_COLLAPSE {
            out.x_max = out.x_max.max(state.x);
        }
        observe(time, state);
    }
    out
}
