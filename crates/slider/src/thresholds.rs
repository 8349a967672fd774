//! The two thresholds of the explicit method's time step: by formula, and by bisection on runs.
//!
//! With `Lambda = dt mu_S F_n/(m s_adhes)` a step in adhesion maps the slip velocity as
//! `s -> (1 - Lambda) s + Lambda p s_adhes`, where p is the pull of the spring over static friction.
//! - The map is stable up to `Lambda = 2`, the step **dt_1**. Above, the block chatters in adhesion.
//! - The largest excursion of chatter starts at the edge of the adhesion zone; two steps later the slip velocity is
//!   `s_adhes (1 + Lambda (Lambda - 2)(1 - p))`. If friction at this velocity is less than the pull, the
//!   block collapses. With the slope `kappa = -mu'(0)` that happens at pulls well below static
//!   friction once `Lambda (Lambda - 2) kappa s_adhes >= mu_S`, from the step **dt_2** on.

use crate::{ParameterError, Parameters, State, explicit_step};
use serde::Serialize;

/// A threshold of the time step, found in two ways.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Threshold {
    /// By the formula (s).
    pub formula: f64,
    /// By bisection on runs (s); `None` if runs at a third and at three times `formula` do not
    /// bracket the threshold.
    pub bisection: Option<f64>,
}

/// Both thresholds of the explicit method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Thresholds {
    /// dt_1: above it the block chatters in adhesion.
    #[serde(rename = "dt_1")]
    pub chatter: Threshold,
    /// dt_2: above it chatter makes the block collapse too early; `None` for a law that does not
    /// fall with slip speed.
    #[serde(rename = "dt_2")]
    pub collapse: Option<Threshold>,
}

/// dt_1 = 2 m s_adhes/(mu_S F_n) (s).
pub fn chatter_step(p: &Parameters) -> f64 {
    2.0 * p.mass * p.adhesion / (p.mu_static() * p.normal_force)
}

/// dt_2 = m s_adhes/(mu_S F_n) (1 + sqrt(1 + mu_S/(kappa s_adhes))) (s) with kappa = -mu'(0), which
/// is k (mu_S - mu_D) for Eq (17); `None` where friction does not fall.
pub fn collapse_step(p: &Parameters) -> Option<f64> {
    let fall = p.law.fall_at_rest() * p.adhesion;
    (fall > 0.0).then(|| 0.5 * chatter_step(p) * (1.0 + (1.0 + p.mu_static() / fall).sqrt()))
}

/// Most steps of a run up to the static pull: with 16 starts and 20 bisections about a minute.
const MOST_STEPS: f64 = 2e7;

/// Both thresholds for the parameters `p`, whose time step, start and end are not used.
///
/// The damper is taken as weak: its force at the velocity of the belt must be far below static friction.
///
/// # Errors
/// A parameter with which the block never sticks or never breaks loose, or sticks for so many steps that the
/// bisection would take too long.
pub fn thresholds(p: &Parameters) -> Result<Thresholds, ParameterError> {
    let needed = [
        ("normal_force", p.normal_force, "N"),
        ("spring", p.spring, "N/m"),
        ("mu_static", p.mu_static(), ""),
        ("belt", p.belt.abs(), "m/s"),
    ];
    for (key, value, unit) in needed {
        if value == 0.0 {
            let allowed = "other than 0: the thresholds are those of a block that sticks to a \
                           moving belt until its spring pulls it off";
            return Err(ParameterError { key, value, unit, allowed: allowed.into() });
        }
    }
    let shortest = collapse_step(p).unwrap_or(f64::INFINITY).min(10.0 * chatter_step(p));
    if p.reach() / p.belt.abs() > MOST_STEPS * shortest {
        let allowed = "larger: the block would stick for so many steps that the bisection would \
                       take hours";
        return Err(ParameterError {
            key: "spring",
            value: p.spring,
            unit: "N/m",
            allowed: allowed.into(),
        });
    }
    let threshold = |formula: f64, above: fn(&Parameters, f64) -> bool| Threshold {
        formula,
        bisection: bisect(p, [formula / 3.0, 3.0 * formula], above),
    };
    Ok(Thresholds {
        chatter: threshold(chatter_step(p), chatters),
        collapse: collapse_step(p).map(|formula| threshold(formula, collapses_early)),
    })
}

/// Width at which a bisection ends, relative to the step.
const RESOLUTION: f64 = 1e-4;

fn bisect(
    p: &Parameters,
    [mut low, mut high]: [f64; 2],
    above: fn(&Parameters, f64) -> bool,
) -> Option<f64> {
    if above(p, low) || !above(p, high) {
        return None;
    }
    while high - low > RESOLUTION * high {
        let middle = 0.5 * (low + high);
        if above(p, middle) { high = middle } else { low = middle }
    }
    Some(0.5 * (low + high))
}

/// Steps over which a disturbance may grow.
const GROWTH: u64 = 100_000;

/// Whether a disturbance of half the adhesion zone has not decayed while the spring is almost unloaded.
fn chatters(p: &Parameters, dt: f64) -> bool {
    let p = Parameters { dt, x0: 0.0, v0: p.belt + 0.5 * p.adhesion, ..p.clone() };
    // the load stays below a tenth of static friction
    let steps = (0.1 * p.reach() / (p.belt.abs() * dt)).min(GROWTH as f64) as u64;
    let (mut state, mut change) = (p.start(), 0.0);
    for _ in 0..steps.max(2) {
        let next = explicit_step(&p, state);
        change = (next.slip - state.slip).abs();
        state = next;
    }
    change.is_nan() || change >= 1e-3 * p.adhesion
}

/// Number of starts: chatter is chaotic, and a single run may miss the excursions that are large enough.
const STARTS: u32 = 16;

/// Share of the static pull below which a collapse counts as early.
const EARLY: f64 = 0.99;

/// Whether the block, from any of several starts, collapses before the spring pulls with 99 % of the friction that
/// adhesion can bear, mu(s_adhes) F_n.
fn collapses_early(p: &Parameters, dt: f64) -> bool {
    let bearable = p.mu(p.adhesion) * p.normal_force / p.spring;
    // twice as many as a block that sticks needs: one that a strong damper holds back never gets there
    let steps = (2.0 * bearable / (p.belt.abs() * dt)).ceil() as u64;
    (0..STARTS).any(|start| {
        let share = f64::from(start) / f64::from(STARTS);
        let p = Parameters { dt, x0: 0.0, v0: p.belt + share * p.adhesion, ..p.clone() };
        let mut state: State = p.start();
        for _ in 0..steps {
            if state.x.abs() >= EARLY * bearable {
                return false;
            }
            state = explicit_step(&p, state);
            // a collapse: the spring drives the block back
            if state.v * p.belt < 0.0 && state.x * p.belt > 0.0 {
                return true;
            }
        }
        false
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use friction::{Coulomb, Exponential};
    use std::sync::Arc;

    /// Relative differences of the bisections from the formulas.
    fn differences(p: &Parameters) -> [f64; 2] {
        let found = thresholds(p).unwrap();
        [found.chatter, found.collapse.unwrap()].map(|t| t.bisection.unwrap() / t.formula - 1.0)
    }

    #[test]
    fn table_1_has_the_thresholds_2_and_22_54_microseconds() {
        let p = Parameters::default();
        assert!((chatter_step(&p) - 2.0e-6).abs() < 1e-18);
        assert!((collapse_step(&p).unwrap() - 2.254e-5).abs() < 5e-9);
        assert!(differences(&p).iter().all(|d| d.abs() < 0.02), "{:?}", differences(&p));
    }

    #[test]
    fn formulas_and_bisection_agree_for_other_parameters() {
        let law = Exponential { mu_static: 0.4, mu_dynamic: 0.3, decay: 2.0 };
        for p in [
            Parameters { mass: 0.1, ..Parameters::default() },
            Parameters { spring: 100.0, ..Parameters::default() },
            Parameters { law: Arc::new(law), ..Parameters::default() },
        ] {
            assert!(differences(&p).iter().all(|d| d.abs() < 0.05), "{:?}", differences(&p));
        }
    }

    #[test]
    fn a_damper_that_holds_the_block_back_ends_the_search_too() {
        let p = Parameters { damping: 20.0, ..Parameters::default() };
        assert!(!collapses_early(&p, 1e-5));
    }

    #[test]
    fn friction_that_does_not_fall_never_collapses_early() {
        let law = Arc::new(Coulomb { mu: 0.4 });
        let p = Parameters { law, ..Parameters::default() };
        assert_eq!(thresholds(&p).unwrap().collapse, None);
    }

    #[test]
    fn a_block_that_never_sticks_or_never_breaks_loose_is_refused() {
        for p in [
            Parameters { spring: 0.0, ..Parameters::default() },
            Parameters { spring: 1e-9, ..Parameters::default() },
            Parameters { belt: 0.0, v0: 0.0, ..Parameters::default() },
            Parameters { normal_force: 0.0, ..Parameters::default() },
        ] {
            assert!(thresholds(&p).is_err());
        }
    }
}
