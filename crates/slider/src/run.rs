//! A run and its characteristic values.

use crate::stick::{Ringing, StickWatch};
use crate::{
    Parameters, State, exact_step, explicit_step, implicit_step, memory_step, penalty_step,
};
use serde::Serialize;
use std::ops::ControlFlow;
use thiserror::Error;

/// The time-stepping methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Backward Euler, Eqs (19)-(27).
    Implicit,
    /// Eqs (28)-(32).
    Explicit,
    /// The friction spring of Eqs (10) and (11), explicit.
    Penalty,
    /// Explicit with exact friction.
    Exact,
    /// Explicit with exact friction with memory.
    Memory,
}

impl Method {
    /// All methods.
    pub const ALL: [Self; 5] =
        [Self::Implicit, Self::Explicit, Self::Penalty, Self::Exact, Self::Memory];

    /// Its name on the command line and in figures.
    pub fn name(self) -> &'static str {
        match self {
            Self::Implicit => "implicit",
            Self::Explicit => "explicit",
            Self::Penalty => "penalty",
            Self::Exact => "exact",
            Self::Memory => "memory",
        }
    }
}

/// The characteristic values of the paper's tables, the quality of adhesion, and the effort.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Smallest position (m).
    pub x_min: f64,
    /// Largest position after t = 0.7 s (m); NaN for a run that ends before.
    pub x_max: f64,
    /// Largest velocity (m/s), with its sign.
    pub v_max: f64,
    /// Root mean square of the slip velocity (m/s) in the first adhesion, from t = 0 until the
    /// spring pulls with half of static friction; NaN if the block does not start at rest on the
    /// belt.
    pub adhesion_slip: f64,
    /// Slip in the two windows after the first capture; `None` if the run ends or collapses before they have passed.
    pub ringing: Option<Ringing>,
    /// Steps taken.
    pub steps: u64,
    /// Whether the observer stopped the run before its end.
    #[serde(skip)]
    pub stopped: bool,
    /// Picard iterations of all steps; like the next two, zero for methods other than the implicit one.
    #[serde(rename = "picard_iterations")]
    pub picard: u64,
    /// Most Picard iterations of one step.
    #[serde(rename = "most_picard_iterations")]
    pub most_picard: u32,
    /// Steps that needed the bracketing fallback.
    #[serde(rename = "fallback_steps")]
    pub fallbacks: u64,
}

/// A run whose position or velocity grew beyond 1e30 or is not a number.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "the {} method blew up in step {step}, t = {time:.6e} s: x = {:e} m, v = {:e} m/s; a smaller dt is needed",
    method.name(), state.x, state.v
)]
pub struct BlowUp {
    /// The method.
    pub method: Method,
    /// The first step, from 1, with such a number.
    pub step: u64,
    /// Its time (s).
    pub time: f64,
    /// The state after it.
    pub state: State,
}

/// Position and velocity beyond which a run is taken for blown up (m, m/s).
const RUNAWAY: f64 = 1e30;

/// Start of the time over which `x_max` is taken (s): after the first collapse.
const AFTER_COLLAPSE: f64 = 0.7;

/// Runs the slider from t = 0 to `p.end`, at least one step. `observe` is called with time (s) and state at t = 0 and
/// after every step, and may stop the run. The parameters are not checked ([`Parameters::checked`]).
///
/// # Errors
/// [`BlowUp`]; `observe` was called for all steps before it.
pub fn run(
    p: &Parameters,
    method: Method,
    observe: impl FnMut(f64, &State) -> ControlFlow<()>,
) -> Result<Outcome, BlowUp> {
    match method {
        Method::Explicit => steps(p, method, |state, _| explicit_step(p, state), observe),
        Method::Penalty => steps(p, method, |state, _| penalty_step(p, state), observe),
        Method::Exact => steps(p, method, |state, _| exact_step(p, state), observe),
        Method::Memory => steps(p, method, |state, _| memory_step(p, state), observe),
        Method::Implicit => {
            let implicit = |state, out: &mut Outcome| {
                let (next, count) = implicit_step(p, state);
                out.picard += u64::from(count.picard);
                out.most_picard = out.most_picard.max(count.picard);
                out.fallbacks += u64::from(count.bracketing > 0);
                next
            };
            steps(p, method, implicit, observe)
        }
    }
}

/// An observer for [`run`] that does nothing.
pub fn unobserved(_: f64, _: &State) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn steps(
    p: &Parameters,
    method: Method,
    mut advance: impl FnMut(State, &mut Outcome) -> State,
    mut observe: impl FnMut(f64, &State) -> ControlFlow<()>,
) -> Result<Outcome, BlowUp> {
    let steps = (p.end / p.dt).round().max(1.0) as u64;
    let mut state = p.start();
    let mut out = Outcome {
        x_min: state.x,
        x_max: f64::NAN,
        v_max: state.v,
        adhesion_slip: f64::NAN,
        ringing: None,
        steps: 0,
        stopped: false,
        picard: 0,
        most_picard: 0,
        fallbacks: 0,
    };
    let mut watch = StickWatch::new(p);
    if observe(0.0, &state).is_break() {
        return Ok(Outcome { stopped: true, ..out });
    }
    for step in 1..=steps {
        state = advance(state, &mut out);
        let time = step as f64 * p.dt;
        if !(state.x.abs() < RUNAWAY && state.v.abs() < RUNAWAY) {
            return Err(BlowUp { method, step, time, state });
        }
        out.x_min = out.x_min.min(state.x);
        out.v_max = out.v_max.max(state.v);
        if time > AFTER_COLLAPSE {
            out.x_max = out.x_max.max(state.x);
        }
        watch.observe(p, time, &state);
        out.steps = step;
        if observe(time, &state).is_break() {
            out.stopped = step < steps;
            break;
        }
    }
    out.adhesion_slip = watch.adhesion_slip();
    out.ringing = watch.ringing();
    Ok(out)
}
