//! The measures by name and their limits.

use crate::check::PostError;
use std::collections::BTreeMap;

/// A measure of the contact conditions; `docs/checks.md` defines each.
#[derive(Clone, Copy, Debug)]
pub struct Measure {
    /// Its name in documents and options, on which scripts rely.
    pub name: &'static str,
    /// Unit of its value.
    pub units: &'static str,
    /// The statistic over nodes and times that its value is: `max`, `rms`, `share` and so on.
    pub statistic: &'static str,
    /// Its definition, in a phrase.
    pub about: &'static str,
    /// Limit for methods that enforce the conditions exactly.
    exact: Option<Limit>,
    /// Limit for a usable penalty method.
    penalty: Option<Limit>,
}

/// The limit of a measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// At most this.
    Most(f64),
    /// From the first number to the second, both included.
    Between(f64, f64),
}

impl Limit {
    /// Whether a value is within it.
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::Most(most) => value <= most,
            Self::Between(low, high) => (low..=high).contains(&value),
        }
    }
}

/// All measures, in the order in which tables show them.
pub const MEASURES: [Measure; 19] = [
    measure("penetration", "1", "max", "penetration over Hertz's approach", most(1e-3), None),
    measure("tension", "1", "max", "tension over p0", most(0.0), most(0.0)),
    measure("complementarity", "1", "max", "|gap| p_n/(delta p0)", most(1e-3), None),
    measure("cone", "1", "max", "p_f/(mu_S p_n) - 1 above the cone", most(1e-10), most(1e-10)),
    measure("adhesion_slip", "1", "max", "|s|/s_c below 0.98 of the bound", most(1e-3), None),
    measure(
        "mu_error",
        "1",
        "max",
        "mu used over the law's, recomputed from the records, - 1",
        most(1e-10),
        most(TWO_PASSES),
    ),
    measure(
        "mu_error_blurred",
        "1",
        "median",
        "the same beyond the blur, where not every step is recorded",
        most(MU_BLURRED),
        most(MU_BLURRED),
    ),
    measure("law_error", "1", "rms", "p_f/(mu(|s|) p_n) - 1 in slip", None, most(0.02)),
    measure("law_error_own", "1", "rms", "the same with the mu used", most(1e-8), None),
    measure(
        "law_error_let_slip",
        "1",
        "rms",
        "law_error where the algorithm lets slip",
        None,
        most(0.02),
    ),
    measure("direction", "deg", "rms", "angle of the shear from -s in slip", most(0.1), most(5.0)),
    measure(
        "direction_let_slip",
        "deg",
        "rms",
        "direction where the algorithm lets slip",
        None,
        most(5.0),
    ),
    measure("wrong_direction", "1", "share", "slip with that angle above 90 deg", None, None),
    measure("dissipation", "1", "share", "contact power of the wrong sign", most(0.0), None),
    measure("violating_fraction", "1", "share", "of the contact area", most(0.0), most(0.05)),
    measure(
        "roughness_ratio",
        "1",
        "ratio",
        "sd_t(p_f/p_n) over sd_t(mu(|s|)) in slip",
        Some(Limit::Between(0.999, 1.001)),
        Some(Limit::Between(0.8, 1.25)),
    ),
    measure("law_scatter", "1", "rms", "distance from the law's graph", most(1e-8), None),
    measure("switching_rate", "1", "rate", "stick-slip switches per h/c_s", None, None),
    measure("mesh_mode", "1", "rms", "slip that alternates from node to node", None, None),
];

/// Limit of `mu_error` for penalty springs: the coefficient of a node is the mean over both passes, whose
/// projections are recomputed to a tenth of this.
const TWO_PASSES: f64 = 1e-4;
/// Limit of `mu_error_blurred`.
const MU_BLURRED: f64 = 5e-3;

const fn most(value: f64) -> Option<Limit> {
    Some(Limit::Most(value))
}

const fn measure(
    name: &'static str,
    units: &'static str,
    statistic: &'static str,
    about: &'static str,
    exact: Option<Limit>,
    penalty: Option<Limit>,
) -> Measure {
    Measure { name, units, statistic, about, exact, penalty }
}

/// The limits of a check.
#[derive(Clone, Debug)]
pub struct Limits {
    /// The kind of method that they are for: `exact` or `penalty`.
    pub set: &'static str,
    of: BTreeMap<&'static str, Limit>,
    asked: Vec<&'static str>,
}

impl Limits {
    /// The limits for `contact.enforcement` of a case: those of a usable penalty method for `penalty` and where
    /// nothing is known, those of exact enforcement for any other name.
    pub fn for_enforcement(enforcement: Option<&str>) -> Self {
        let exact = enforcement.is_some_and(|name| name != "penalty");
        let limit = |m: &Measure| Some((m.name, if exact { m.exact } else { m.penalty }?));
        Self {
            set: if exact { "exact" } else { "penalty" },
            of: MEASURES.iter().filter_map(limit).collect(),
            asked: Vec::new(),
        }
    }

    /// Sets the limit of a measure for the user. For `roughness_ratio`, `value` is one end of a range from 1/x to x.
    ///
    /// # Errors
    /// A name that is no measure, or a value that is negative or not finite.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), PostError> {
        let Some(measure) = MEASURES.iter().find(|m| m.name == name) else {
            let names: Vec<_> = MEASURES.iter().map(|m| m.name).collect();
            return Err(PostError::Asked(format!(
                "there is no measure '{name}'; the measures are {}",
                names.join(", ")
            )));
        };
        if !(value.is_finite() && value >= 0.0) {
            return Err(PostError::Asked(format!(
                "the limit {name}={value} must be a number of at least 0"
            )));
        }
        let limit = if measure.name == "roughness_ratio" {
            let end = value.max(1.0 / value);
            if end.is_infinite() {
                return Err(PostError::Asked(format!(
                    "the limit {name}={value} must be a number above 0: it is one end of a range from 1/x to x"
                )));
            }
            Limit::Between(1.0 / end, end)
        } else {
            Limit::Most(value)
        };
        self.of.insert(measure.name, limit);
        self.asked.push(measure.name);
        Ok(())
    }

    /// The limit of the measure `name`, if it has one.
    pub fn of(&self, name: &str) -> Option<Limit> {
        self.of.get(name).copied()
    }

    /// Whether the user set the limit of `name`: then the check fails where the measure has no value.
    pub fn was_asked(&self, name: &str) -> bool {
        self.asked.contains(&name)
    }
}
