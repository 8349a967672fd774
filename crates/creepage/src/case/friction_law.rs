//! The friction law of a case.

use crate::case::hertz::hertz;
use crate::case::key::Form::{Curve, Number, Text};
use crate::case::key::{Key, key, needed, within, word};
use crate::case::schema::Case;
use crate::case::section::rows;
use friction::{Domain, Expression, LawError, NodeFriction, OwnLaw, USES};
use std::sync::Arc;

rows! {
    /// The keys of `[friction]`; the crate `friction` declares the parameters.
    "friction.law" => word(&LAWS);
    "friction.static"
        => needed(Number(within(0.0, 5.0)), "-", "give the coefficient of friction: `static = 0.5`");
    "friction.dynamic" => key(Number(within(0.0, 5.0)), "-", "give a coefficient of friction: 0.32");
    "friction.decay" => key(Number(within(0.0, 1e4)), "s/m", "give the decay in s/m: 6.0");
    "friction.distance"
        => key(Number(within(1e-12, 10.0)), "m",
            "give the slip over which friction changes, in metres: `distance = 10e-6`");
    "friction.relaxation_speed" => key(Number(within(1e-9, 1e3)), "m/s", "give V* of the law in m/s: 1.0");
    "friction.reference" => key(Number(within(1e-3, 5.0)), "-", "give a coefficient of friction: 0.6");
    "friction.reference_speed" => key(Number(within(1e-12, 100.0)), "m/s", "give V_0 in m/s: 1e-6");
    "friction.direct" => key(Number(within(1e-4, 1.0)), "-", "give the direct effect a: 0.008");
    "friction.evolution" => key(Number(within(0.0, 1.0)), "-", "give the effect b: 0.012");
    "friction.state" => word(&["ageing", "slip"]);
    "friction.age" => key(Number(within(1e-14, 1e13)), "s", "give the state theta in seconds: 10");
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

/// The words of `friction.law`.
const LAWS: [&str; USES.len()] = {
    let mut words = [""; USES.len()];
    let mut law = 0;
    while law < words.len() {
        words[law] = USES[law].word;
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
