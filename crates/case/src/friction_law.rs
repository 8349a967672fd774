//! The friction law of a case.

use crate::hertz::hertz;
use crate::keys::Form::{Curve, Number, Text};
use crate::keys::{Key, key, needed, over, within, word};
use crate::schema::Case;
use friction::{Domain, Expression, LawError, NodeFriction, OwnLaw, USES};
use std::sync::Arc;

/// The keys of a friction law, whose parameters the crate of the laws declares.
pub(crate) const KEYS: &[Key] = &[
    Key { path: "friction.law", ..word(&LAWS) },
    Key {
        path: "friction.static",
        ..needed(Number(within(0.0, 5.0)), "-", "give the coefficient of friction: `static = 0.5`")
    },
    Key {
        path: "friction.dynamic",
        ..key(Number(within(0.0, 5.0)), "-", "give a coefficient of friction: 0.32")
    },
    Key {
        path: "friction.decay",
        ..key(Number(within(0.0, 1e4)), "s/m", "give the decay in s/m: 6.0")
    },
    Key {
        path: "friction.distance",
        ..key(
            Number(over(0.0, 10.0)),
            "m",
            "give the slip over which friction changes, in metres: `distance = 10e-6`",
        )
    },
    Key {
        path: "friction.relaxation_speed",
        ..key(Number(over(0.0, 1e3)), "m/s", "give V* of the law in m/s: 1.0")
    },
    Key {
        path: "friction.reference",
        ..key(Number(over(0.0, 5.0)), "-", "give a coefficient of friction: 0.6")
    },
    Key {
        path: "friction.reference_speed",
        ..key(Number(over(0.0, 100.0)), "m/s", "give V_0 in m/s: 1e-6")
    },
    Key {
        path: "friction.direct",
        ..key(Number(within(1e-4, 1.0)), "-", "give the direct effect a: 0.008")
    },
    Key {
        path: "friction.evolution",
        ..key(Number(within(0.0, 1.0)), "-", "give the effect b: 0.012")
    },
    Key { path: "friction.state", ..word(&["ageing", "slip"]) },
    Key {
        path: "friction.age",
        ..key(Number(over(0.0, 1e12)), "s", "give the state theta in seconds: 10")
    },
    Key {
        path: "friction.table",
        ..key(
            Curve,
            "",
            "give the path of a CSV file, relative to this one, or pairs of slip velocity (m/s), rising from 0, \
         and coefficient: `table = [[0, 0.5], [1, 0.32]]`",
        )
    },
    Key {
        path: "friction.expression",
        ..key(
            Text,
            "",
            "give a formula in s, p, t and x in quotes: `expression = \"0.32 + 0.18*exp(-6*s)\"`",
        )
    },
    Key { path: "friction.source", ..key(Text, "", "give the source of the function in quotes") },
    Key { path: "friction.mode", ..word(&["lagged", "exact"]) },
    Key {
        path: "friction.memory.distance",
        ..key(
            Number(over(0.0, 1.0)),
            "m",
            "give the slip over which friction adapts, in metres: 10e-6 for 10 micrometres",
        )
    },
    Key {
        path: "friction.memory.floor",
        ..key(
            Number(over(0.0, 100.0)),
            "m/s",
            "give the slip speed below which friction adapts in time: 10e-3",
        )
    },
];

/// The names of the laws.
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
pub(crate) fn path(key: &str) -> String {
    format!("friction.{key}")
}

/// Where a formula must give a coefficient: pressures up to three times Hertz's, which shocks and
/// coarse meshes may reach, the time of rolling, and the fine zone.
pub(crate) fn domain(case: &Case) -> Domain {
    let zone = &case.mesh.zone;
    Domain {
        pressure: 3.0 * hertz(case).p0,
        duration: case.duration(),
        along: [zone.start, zone.start + zone.length],
    }
}

/// The friction law of a case; `own` is what was handed over with the run.
pub(crate) fn law(
    case: &Case,
    own: Option<&Arc<dyn OwnLaw>>,
) -> Result<Box<dyn NodeFriction>, LawError> {
    let formula = |text: &str| Expression::over(text, &domain(case));
    case.friction.node_friction(formula, own)
}
