//! The parameters of the laws: which law has which, their defaults, and the law that they define.

use crate::{
    Coulomb, Exponential, Expression, ExpressionError, Implicit, Lagged, Memory, NodeFriction, Own,
    OwnLaw, PrakashClifton, RateState, Remembering, SlipWeakening, StateLaw, SteadyLaw, Table,
    TableError,
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
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// `"coulomb"` (one coefficient, `static`), `"exponential"` (Eq 8 of the paper:
    /// mu(s) = dynamic + (static - dynamic) exp(-decay |s|)), `"slip_weakening"` (linear from `static`
    /// to `dynamic` over `distance`), `"rate_state"` (Dieterich-Ruina), `"prakash_clifton"` (shear
    /// strength that follows `static` times the pressure over `distance`), `"table"`, `"expression"` or
    /// `"python"` (a function that the Python package hands over with the run).
    /// Default `"coulomb"`.
    #[serde(default)]
    pub law: Kind,
    /// Coefficient of friction at zero slip velocity (dimensionless). Required; refused with the laws
    /// `"rate_state"`, `"table"`, `"expression"` and `"python"`.
    #[serde(rename = "static", default, skip_serializing_if = "Option::is_none")]
    pub static_: Option<f64>,
    /// Coefficient at high slip velocity, or after slip (dimensionless), at most `static`. Default 0.32
    /// with the laws `"exponential"` and `"slip_weakening"`, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dynamic: Option<f64>,
    /// Decay of the coefficient with slip velocity (s/m). Default 6 with
    /// `law = "exponential"`, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decay: Option<f64>,
    /// Slip over which friction changes (m): d_0 of `"slip_weakening"`, L of `"rate_state"` and
    /// `"prakash_clifton"`. Required with these, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// V* of `"prakash_clifton"` (m/s): the strength follows the pressure at rest in the time
    /// `distance` over this. Default 1, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relaxation_speed: Option<f64>,
    /// f_0 of `"rate_state"` (dimensionless), the coefficient of steady sliding at `reference_speed`.
    /// Default 0.6, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<f64>,
    /// V_0 of `"rate_state"` (m/s). Default 1e-6, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_speed: Option<f64>,
    /// Direct effect a of `"rate_state"` (dimensionless). Default 0.008, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direct: Option<f64>,
    /// Effect of the state b of `"rate_state"` (dimensionless); friction falls with slip velocity in the
    /// long run where it is above `direct`. Default 0.012, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evolution: Option<f64>,
    /// How the state of `"rate_state"` evolves: `"ageing"` (also at rest) or `"slip"` (in slip alone).
    /// Default `"ageing"`, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state: Option<StateLaw>,
    /// State theta of `"rate_state"` with which contact begins (s). Default `distance` over
    /// `reference_speed`, refused with others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub age: Option<f64>,
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
    /// Which slip velocity the coefficient belongs to: `"lagged"`, that of the step before, or
    /// `"exact"`, that of the same instant, which needs `contact.enforcement = "exact"`. Used by the
    /// laws `"exponential"`, `"table"`, `"expression"`, `"python"` and `"rate_state"`. Default `"lagged"`; of
    /// `"rate_state"` with exact enforcement `"exact"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<Mode>,
    /// Memory of the coefficient: it follows the law over a distance of slip. Only with the laws
    /// `"exponential"`, `"table"`, `"expression"` and `"python"`; default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<Memory>,
}

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

/// The friction laws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A constant coefficient.
    #[default]
    Coulomb,
    /// A coefficient that falls exponentially with slip velocity.
    Exponential,
    /// A coefficient that falls linearly with slip.
    SlipWeakening,
    /// Dieterich and Ruina's law.
    RateState,
    /// A shear strength that follows the pressure.
    PrakashClifton,
    /// A coefficient by points.
    Table,
    /// A coefficient by a formula.
    Expression,
    /// A coefficient by a function that is handed over with the run.
    Python,
}

/// A law with the names of the parameters that it uses, as keys of the case file's table `[friction]`.
pub struct Uses {
    /// The law.
    pub law: Kind,
    /// The value of the key `law` that selects it.
    pub word: &'static str,
    /// Parameters that must be given.
    pub needs: &'static [&'static str],
    /// Parameters that may be given.
    pub takes: &'static [&'static str],
}

/// Which law uses which parameters, one entry per [`Kind`].
pub const USES: [Uses; 8] = [
    Uses { law: Kind::Coulomb, word: "coulomb", needs: &["static"], takes: &[] },
    Uses {
        law: Kind::Exponential,
        word: "exponential",
        needs: &["static"],
        takes: &["dynamic", "decay", "mode", "memory"],
    },
    Uses {
        law: Kind::SlipWeakening,
        word: "slip_weakening",
        needs: &["static", "distance"],
        takes: &["dynamic"],
    },
    Uses {
        law: Kind::RateState,
        word: "rate_state",
        needs: &["distance"],
        takes: &["reference", "reference_speed", "direct", "evolution", "state", "age", "mode"],
    },
    Uses {
        law: Kind::PrakashClifton,
        word: "prakash_clifton",
        needs: &["static", "distance"],
        takes: &["relaxation_speed"],
    },
    Uses { law: Kind::Table, word: "table", needs: &["table"], takes: &["mode", "memory"] },
    Uses {
        law: Kind::Expression,
        word: "expression",
        needs: &["expression"],
        takes: &["mode", "memory"],
    },
    Uses { law: Kind::Python, word: "python", needs: &["source"], takes: &["mode", "memory"] },
];

impl Uses {
    /// The entry of a law in [`USES`].
    pub fn of(law: Kind) -> &'static Self {
        USES.iter().find(|uses| uses.law == law).unwrap_or(&USES[0])
    }

    /// Whether the law uses a parameter.
    pub fn has(&self, key: &str) -> bool {
        self.needs.contains(&key) || self.takes.contains(&key)
    }
}

/// Every parameter that some law uses, each once.
pub fn all_parameters() -> impl Iterator<Item = &'static str> {
    let keys = |i: usize| USES[i].needs.iter().chain(USES[i].takes).copied();
    (0..USES.len()).flat_map(move |i| {
        keys(i).filter(move |key| !USES[..i].iter().any(|before| before.has(key)))
    })
}

impl Parameters {
    /// The names of the parameters that are given, without `law`.
    pub fn given(&self) -> impl Iterator<Item = &'static str> {
        [
            ("static", self.static_.is_some()),
            ("dynamic", self.dynamic.is_some()),
            ("decay", self.decay.is_some()),
            ("distance", self.distance.is_some()),
            ("relaxation_speed", self.relaxation_speed.is_some()),
            ("reference", self.reference.is_some()),
            ("reference_speed", self.reference_speed.is_some()),
            ("direct", self.direct.is_some()),
            ("evolution", self.evolution.is_some()),
            ("state", self.state.is_some()),
            ("age", self.age.is_some()),
            ("table", self.table.is_some()),
            ("expression", self.expression.is_some()),
            ("source", self.source.is_some()),
            ("mode", self.mode.is_some()),
            ("memory", self.memory.is_some()),
        ]
        .into_iter()
        .filter_map(|(key, given)| given.then_some(key))
    }

    /// Sets parameters of the law that are not given to their defaults. `exact`: contact is enforced exactly, by
    /// Lagrange multipliers. A missing `distance` counts as zero; [`missing`](Self::missing) reports it.
    pub fn write_defaults(&mut self, exact: bool) {
        match self.law {
            Kind::Exponential => {
                self.dynamic.get_or_insert(DYNAMIC);
                self.decay.get_or_insert(DECAY);
            }
            Kind::SlipWeakening => {
                self.dynamic.get_or_insert(DYNAMIC);
            }
            Kind::RateState => {
                self.reference.get_or_insert(REFERENCE);
                let speed = *self.reference_speed.get_or_insert(REFERENCE_SPEED);
                self.direct.get_or_insert(DIRECT);
                self.evolution.get_or_insert(EVOLUTION);
                self.state.get_or_insert_default();
                self.age.get_or_insert(self.distance.unwrap_or(0.0) / speed);
                self.mode.get_or_insert(if exact { Mode::Exact } else { Mode::Lagged });
            }
            Kind::PrakashClifton => {
                self.relaxation_speed.get_or_insert(RELAXATION_SPEED);
            }
            Kind::Coulomb | Kind::Table | Kind::Expression | Kind::Python => {}
        }
    }

    /// The first parameter that the law needs and that is not given.
    pub fn missing(&self) -> Option<&'static str> {
        let given = |key: &str| self.given().any(|given| given == key);
        Uses::of(self.law).needs.iter().copied().find(|key| !given(key))
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
        formula: impl FnOnce(&str) -> Result<Expression, ExpressionError>,
        own: Option<&Arc<dyn OwnLaw>>,
    ) -> Result<Box<dyn NodeFriction>, LawError> {
        let distance = self.distance.unwrap_or(0.0);
        let memory = self.memory;
        let mode = self.mode.unwrap_or_default();
        let steady = match self.law {
            Kind::Coulomb => return Ok(Box::new(Coulomb { mu: self.at_rest() })),
            Kind::SlipWeakening => {
                return Ok(Box::new(SlipWeakening {
                    mu_static: self.at_rest(),
                    mu_dynamic: self.dynamic.unwrap_or(DYNAMIC),
                    distance,
                }));
            }
            Kind::RateState => {
                let reference_speed = self.reference_speed.unwrap_or(REFERENCE_SPEED);
                return Ok(Box::new(RateState {
                    reference: self.reference.unwrap_or(REFERENCE),
                    reference_speed,
                    direct: self.direct.unwrap_or(DIRECT),
                    evolution: self.evolution.unwrap_or(EVOLUTION),
                    distance,
                    law: self.state.unwrap_or_default(),
                    initial: self.age.unwrap_or(distance / reference_speed),
                    lagged: self.mode.unwrap_or_default() == Mode::Lagged,
                }));
            }
            Kind::PrakashClifton => {
                return Ok(Box::new(PrakashClifton {
                    mu: self.at_rest(),
                    distance,
                    speed: self.relaxation_speed.unwrap_or(RELAXATION_SPEED),
                }));
            }
            Kind::Exponential => SteadyLaw::Exponential(self.eq_8()),
            Kind::Table => SteadyLaw::Table(Table::new(self.table.clone().unwrap_or_default())?),
            Kind::Expression => {
                let text = self.expression.as_deref().unwrap_or_default();
                SteadyLaw::Expression(formula(text)?)
            }
            Kind::Python => {
                let Some(own) = own else { return Ok(Box::new(Coulomb { mu: 0.0 })) };
                let implicit = memory.is_none() && mode == Mode::Exact;
                return Ok(Box::new(Own::new(Arc::clone(own), memory, implicit)));
            }
        };
        Ok(match (memory, mode) {
            (Some(memory), _) => Box::new(Remembering { steady, memory }),
            (None, Mode::Lagged) => Box::new(Lagged(steady)),
            (None, Mode::Exact) => Box::new(Implicit(steady)),
        })
    }

    /// The coefficient `static`; zero for a law without it.
    fn at_rest(&self) -> f64 {
        self.static_.unwrap_or(0.0)
    }

    /// Eq. (8) with these parameters.
    fn eq_8(&self) -> Exponential {
        Exponential {
            mu_static: self.at_rest(),
            mu_dynamic: self.dynamic.unwrap_or(DYNAMIC),
            decay: self.decay.unwrap_or(DECAY),
        }
    }

    /// Eq. (8) with these parameters, if the law is [`Kind::Exponential`].
    pub fn exponential(&self) -> Option<Exponential> {
        (self.law == Kind::Exponential).then(|| self.eq_8())
    }
}

/// Default of `dynamic`: the coefficient at high slip velocity, or after slip.
pub const DYNAMIC: f64 = 0.32;
/// Default of `decay` (s/m).
const DECAY: f64 = 6.0;
/// Defaults of rate and state: the benchmarks TPV101 and 102 (Harris et al. 2009).
const REFERENCE: f64 = 0.6;
const REFERENCE_SPEED: f64 = 1e-6;
const DIRECT: f64 = 0.008;
const EVOLUTION: f64 = 0.012;
/// Default of V* (m/s): the benchmarks TPV6 and 7 (Harris et al. 2009).
const RELAXATION_SPEED: f64 = 1.0;
