//! The limits of the measures.

use crate::check::PostError;
use crate::check::measure::Measure;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The limit of a measure.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(untagged)]
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

/// The kind of method that limits are for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MethodKind {
    /// Methods that enforce the conditions exactly.
    Exact,
    /// Penalty methods.
    #[default]
    Penalty,
}

impl fmt::Display for MethodKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Exact => "exact",
            Self::Penalty => "penalty",
        })
    }
}

/// The limits of a check.
#[derive(Clone, Debug)]
pub struct Limits {
    /// The kind of method that they are for.
    pub kind: MethodKind,
    of: BTreeMap<Measure, Limit>,
    asked: Vec<Measure>,
}

impl Limits {
    /// The limits for `contact.enforcement` of a case: those of a usable penalty method for `penalty` and where
    /// nothing is known, those of exact enforcement for any other name.
    pub fn for_enforcement(enforcement: Option<&str>) -> Self {
        let exact = enforcement.is_some_and(|name| name != "penalty");
        let kind = if exact { MethodKind::Exact } else { MethodKind::Penalty };
        let limit = |measure: &Measure| {
            let definition = measure.definition();
            let limit = match kind {
                MethodKind::Exact => definition.exact,
                MethodKind::Penalty => definition.penalty,
            };
            Some((*measure, limit?))
        };
        Self { kind, of: Measure::ALL.iter().filter_map(limit).collect(), asked: Vec::new() }
    }

    /// Sets the limit of a measure for the user. For `roughness_ratio`, `value` is one end of a range from 1/x to x.
    ///
    /// # Errors
    /// A name that is no measure, or a value that is negative or not finite.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), PostError> {
        let measure: Measure = name.parse().map_err(PostError::Asked)?;
        if !(value.is_finite() && value >= 0.0) {
            return Err(PostError::Asked(format!(
                "the limit {name}={value} must be a number of at least 0"
            )));
        }
        let limit = if measure == Measure::RoughnessRatio {
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
        self.of.insert(measure, limit);
        self.asked.push(measure);
        Ok(())
    }

    /// The limit of a measure, if it has one.
    pub fn of(&self, measure: Measure) -> Option<Limit> {
        self.of.get(&measure).copied()
    }

    /// Whether the user set the limit of a measure: then the check fails where the measure has no value.
    pub fn was_asked(&self, measure: Measure) -> bool {
        self.asked.contains(&measure)
    }
}
