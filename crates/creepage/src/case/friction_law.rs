//! The friction law of a case.

use crate::case::hertz::hertz;
use crate::case::key::Form::{Curve, Number, Text};
use crate::case::key::{Key, key, within, word};
use crate::case::schema::Case;
use crate::case::section::rows;
use friction::{Domain, Expression, LAWS, LawError, NUMBERS, NodeFriction, OwnLaw};
use std::sync::Arc;

rows! {
    /// The keys of `[friction]` that are no numbers.
    "friction.state" => word(&["ageing", "slip"]);
    "friction.table"
        => key(Curve(within(0.0, 1e4), within(0.0, 100.0)), "",
            "give the path of a CSV file, relative to this one, or pairs of slip velocity (m/s), rising from 0, \
         and coefficient: `table = [[0, 0.5], [1, 0.32]]`");
    "friction.expression"
        => key(Text, "", "give a formula in s, p, t and x in quotes: `expression = \"0.32 + 0.18*exp(-6*s)\"`");
    "friction.source" => key(Text, "", "give the source of the function in quotes");
    "friction.mode" => word(&["lagged", "exact"]);
    "friction.memory.distance"
        => key(Number(within(1e-12, 1.0)), "m",
            "give the slip over which friction adapts, in metres: 10e-6 for 10 micrometres");
    "friction.memory.floor"
        => key(Number(within(1e-12, 100.0)), "m/s", "give the slip speed below which friction adapts in time: 10e-3");
}

/// The key of the law and those of its numbers, which the crate `friction` declares.
pub(crate) const LAW: &[Key] = &{
    let mut rows = [Key { path: "friction.law", ..word(&WORDS) }; NUMBERS.len() + 1];
    let mut i = 0;
    while i < NUMBERS.len() {
        let [low, high] = NUMBERS[i].range;
        let row = key(Number(within(low, high)), NUMBERS[i].unit, NUMBERS[i].remedy);
        let needed = NUMBERS[i].is_needed_by_default();
        i += 1;
        rows[i] = Key { path: NUMBERS[i - 1].path, needed, ..row };
    }
    rows
};

/// The words of `friction.law`.
const WORDS: [&str; LAWS.len()] = {
    let mut words = [""; LAWS.len()];
    let mut law = 0;
    while law < words.len() {
        words[law] = LAWS[law].word;
        law += 1;
    }
    words
};

/// Dotted path of a key of `[friction]`.
pub fn path(key: &str) -> String {
    format!("friction.{key}")
}

/// Where a formula must give a coefficient of friction: pressures (Pa) up to three times Hertz's largest, which
/// shocks and coarse meshes may reach, the duration of rolling (s), and x in the fine zone (m).
pub fn domain(case: &Case) -> Domain {
    let [rear, front] = case.mesh.zone_along();
    let travel = if case.mesh.window.is_some() { case.rolled() } else { 0.0 };
    Domain {
        pressure: 3.0 * hertz(case).p0,
        duration: case.duration(),
        along: [rear, front + travel],
    }
}

/// The friction law of a case. `own` is the function of `friction.law = "python"`, which a run is given beside
/// its case; other laws do not use it.
///
/// # Errors
/// A formula or a table that gives no coefficient of friction.
pub fn law(case: &Case, own: Option<&Arc<dyn OwnLaw>>) -> Result<Box<dyn NodeFriction>, LawError> {
    let formula = |text: &str| Expression::over(text, &domain(case));
    case.friction.node_friction(formula, own)
}
