//! The friction law of a case.

use crate::case::form::Form::{self, Curve, Text};
use crate::case::form::within;
use crate::case::hertz::hertz;
use crate::case::key::{Key, key, word};
use crate::case::schema::Case;
use crate::case::section::Section;
use friction::{
    Domain, Expression, LAWS, LawError, NUMBERS, NodeFriction, Number, OwnLaw, Parameters,
};
use std::sync::{Arc, LazyLock};

/// The words of `friction.law`.
static WORDS: LazyLock<Vec<&str>> = LazyLock::new(|| LAWS.iter().map(|law| law.word).collect());

/// The key of the law, those of its numbers, which the crate `friction` declares, and those that are no numbers.
impl Section for Parameters {
    fn keys(_: &str) -> Vec<Key> {
        let number = |number: &Number| {
            let [low, high] = number.range;
            let row = key(Form::Number(within(low, high)), number.unit, number.remedy);
            (number.key(), Key { needed: number.is_needed_by_default(), ..row })
        };
        let others = [
            ("state", word(&["ageing", "slip"])),
            (
                "table",
                key(
                    Curve(within(0.0, 1e4), within(0.0, 100.0)),
                    "",
                    "give the path of a CSV file, relative to this one, or pairs of slip velocity (m/s), rising from 0, \
                     and coefficient: `table = [[0, 0.5], [1, 0.32]]`",
                ),
            ),
            (
                "expression",
                key(
                    Text,
                    "",
                    "give a formula in s, p, t and x in quotes: `expression = \"0.32 + 0.18*exp(-6*s)\"`",
                ),
            ),
            ("source", key(Text, "", "give the source of the function in quotes")),
            ("mode", word(&["lagged", "exact"])),
            (
                "memory.distance",
                key(
                    Form::Number(within(1e-12, 1.0)),
                    "m",
                    "give the slip over which friction adapts, in metres: 10e-6 for 10 micrometres",
                ),
            ),
            (
                "memory.floor",
                key(
                    Form::Number(within(1e-12, 100.0)),
                    "m/s",
                    "give the slip speed below which friction adapts in time: 10e-3",
                ),
            ),
        ];
        let law = [("law", word(&WORDS))];
        let rows = law.into_iter().chain(NUMBERS.iter().map(number)).chain(others);
        rows.map(|(name, row)| row.at(path(name))).collect()
    }
}

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
