//! The parameters of a law, and the law that they define.

use crate::declaration::{Beside, Make};
use crate::schema::{all_laws, with_laws};
use crate::{
    Declaration, Exponential, Expression, ExpressionError, FrictionLaw, Implicit, Kind, Lagged,
    LeftOut, Memory, NUMBERS, NodeFriction, Number, OwnLaw, RateState, Remembering, StateLaw,
    TableError, Values,
};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Why parameters define no friction law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawError {
    /// The formula of an expression is not valid.
    #[error(transparent)]
    Expression(#[from] ExpressionError),
    /// The points of a table are not valid.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// A friction law and its parameters, as a table of a case file has them.
///
/// A parameter that is not given has its default or belongs to another law.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("additionalProperties" = false))]
pub struct Parameters {
    /// The law.
    #[serde(default)]
    #[schemars(description = all_laws())]
    pub law: Kind,
    /// Its numbers.
    #[serde(flatten)]
    pub numbers: Values,
    /// How the state of `"rate_state"` evolves: `"ageing"` (also at rest) or `"slip"` (in slip alone).
    /// Default `"ageing"`, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<StateLaw>,
    /// Coefficient against slip velocity for `law = "table"`: a CSV file, relative to this one, with
    /// the columns slip velocity (m/s, unless a heading names another unit), rising from 0, and coefficient; or a list
    /// of such pairs, which the resolved case holds. Linear in between, constant beyond the last. Required with this law,
    /// refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "file_or_points")]
    pub table: Option<Vec<[f64; 2]>>,
    /// Coefficient for `law = "expression"`, a formula in the slip velocity s (m/s), the pressure p
    /// (Pa), the time t (s) and the position x along the bar (m), such as
    /// `"0.32 + 0.18*exp(-6*s)"`. Required with this law, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expression: Option<String>,
    /// What the function of `law = "python"` is: its source, for the record. Required with this law,
    /// refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Which slip velocity the coefficient belongs to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(description = with_laws("mode", "Which slip velocity the coefficient belongs to: `\"lagged\"`, that of the \
        step before, or `\"exact\"`, that of the same instant (with penalty that of the step just taken). Default `\"lagged\"`; of `\"rate_state\"` with exact enforcement and on half-spaces `\"exact\"`."))]
    pub mode: Option<Mode>,
    /// Memory of the coefficient.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(description = with_laws("memory", "Memory of the coefficient: it follows the law over a distance of slip. \
        Default none."))]
    pub memory: Option<Memory>,
}

/// The keys of the parameters that are no numbers.
pub const OTHERS: [&str; 6] = ["state", "table", "expression", "source", "mode", "memory"];

fn file_or_points(_: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "anyOf": [
            { "type": "string" },
            { "type": "array", "items": {
                "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2
            } }
        ]
    })
}

/// Which slip velocity the coefficient belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// That of the step before.
    #[default]
    Lagged,
    /// That of the same instant.
    Exact,
}

/// The key of every parameter that some law has, each once.
pub fn all_parameters() -> impl Iterator<Item = &'static str> {
    NUMBERS.iter().map(Number::key).chain(OTHERS)
}

impl Parameters {
    /// The declaration of the law.
    pub fn declaration(&self) -> &'static Declaration {
        self.law.declaration()
    }

    /// The number with this key, if it is given.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.numbers.get(key)
    }

    /// A number; its default if it is not given, and zero if it has none.
    pub fn value(&self, number: Number) -> f64 {
        self.number(number.key()).unwrap_or_else(|| {
            let own = self.declaration().numbers.iter().find(|(other, _)| *other == number);
            own.and_then(|(_, left_out)| self.default(left_out)).unwrap_or(0.0)
        })
    }

    fn default(&self, left_out: &LeftOut) -> Option<f64> {
        match left_out {
            LeftOut::Refused => None,
            LeftOut::Default(value) => Some(*value),
            LeftOut::Follows { of, .. } => Some(of(self)),
        }
    }

    /// The keys of the parameters that are given, without `law`.
    pub fn given(&self) -> impl Iterator<Item = &'static str> {
        let others = [
            self.state.is_some(),
            self.table.is_some(),
            self.expression.is_some(),
            self.source.is_some(),
            self.mode.is_some(),
            self.memory.is_some(),
        ];
        let others = OTHERS.into_iter().zip(others).filter_map(|(key, given)| given.then_some(key));
        self.numbers.given().map(|(number, _)| number.key()).chain(others)
    }

    /// Sets parameters of the law that are not given to their defaults. `exact`: contact is enforced exactly, by
    /// Lagrange multipliers. A missing number counts as zero; [`missing`](Self::missing) reports it.
    pub fn write_defaults(&mut self, exact: bool) {
        let law = self.declaration();
        for (number, left_out) in law.numbers {
            if self.number(number.key()).is_none()
                && let Some(value) = self.default(left_out)
            {
                self.numbers.set(number, value);
            }
        }
        (law.write_defaults)(self, exact);
    }

    /// The first parameter that the law needs and that is not given.
    pub fn missing(&self) -> Option<&'static str> {
        let given = |key: &str| self.given().any(|given| given == key);
        self.declaration().needs().find(|key| !given(key))
    }

    /// The law that the parameters define. `formula` parses the text of an expression; `own` is the user's function of
    /// the law `"python"`. Without `own` that law has the coefficient zero, for callers that only read the case.
    ///
    /// Parameters that are not given have their defaults, and needed ones count as zero or empty.
    ///
    /// # Errors
    /// [`LawError`]: `formula` refuses the text, or the points of a table are not valid.
    pub fn node_friction(
        &self,
        formula: impl Fn(&str) -> Result<Expression, ExpressionError>,
        own: Option<&Arc<dyn OwnLaw>>,
    ) -> Result<Box<dyn NodeFriction>, LawError> {
        let beside = Beside { formula: &formula, own };
        let steady = match self.declaration().make {
            Make::Constant(make) => return Ok(Box::new(make(self))),
            Make::AtNode(make) => return Ok(make(self, &beside)),
            Make::Steady(make) => make(self, &beside)?,
        };
        Ok(match (self.memory, self.mode.unwrap_or_default()) {
            (Some(memory), _) => Box::new(Remembering { steady, memory }),
            (None, Mode::Lagged) => Box::new(Lagged(steady)),
            (None, Mode::Exact) => Box::new(Implicit(steady)),
        })
    }

    /// The law that the parameters define, if it has no state; `formula` parses the text of an expression.
    ///
    /// # Errors
    /// As [`node_friction`](Self::node_friction).
    pub fn steady(
        &self,
        formula: impl Fn(&str) -> Result<Expression, ExpressionError>,
    ) -> Option<Result<Arc<dyn FrictionLaw>, LawError>> {
        match self.declaration().make {
            Make::Constant(make) => Some(Ok(Arc::new(make(self)))),
            Make::Steady(make) => Some(make(self, &Beside { formula: &formula, own: None })),
            Make::AtNode(_) => None,
        }
    }

    /// The law as Eq. (8), if it is of that form.
    pub fn exponential(&self) -> Option<Exponential> {
        self.steady(Expression::untried)?.ok()?.as_exponential()
    }

    /// The law as one of rate and state, if it is one.
    pub fn rate_state(&self) -> Option<RateState> {
        (self.law == Kind::RateState).then(|| RateState::of(self))
    }
}
