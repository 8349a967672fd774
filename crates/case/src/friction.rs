//! The keys of the friction law, and which law uses which.

mod own;
mod recorded;

pub use own::OwnLaw;
pub(crate) use recorded::sampled;
pub use recorded::{SAMPLED_LAW, recorded_law};

use crate::hertz::hertz;
use crate::schema::Case;
use contact::{
    ContactError, Coulomb, Domain, Exponential, Expression, ExpressionError, Implicit, Lagged,
    Memory, NodeFriction, PrakashClifton, RateState, Remembering, SlipWeakening, SteadyLaw, Table,
};
use own::Own;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The friction law.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// `"coulomb"` (one coefficient, `static`), `"exponential"` (Eq 8 of the paper:
    /// mu(s) = dynamic + (static - dynamic) exp(-decay |s|)), `"slip_weakening"` (linear from `static`
    /// to `dynamic` over `distance`), `"rate_state"` (Dieterich-Ruina), `"prakash_clifton"` (shear
    /// strength that follows `static` times the pressure over `distance`), `"table"`, `"expression"` or
    /// `"python"` (a function that the Python package hands over with the run).
    /// Default `"coulomb"`.
    #[serde(default)]
    pub law: FrictionLaw,
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
    /// the columns slip velocity (m/s), rising from 0, and coefficient; or a list of such pairs, which
    /// the resolved case holds. Linear in between, constant beyond the last. Required with this law,
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
    pub mode: Option<FrictionMode>,
    /// Memory of the coefficient: it follows the law over a distance of slip. Only with the laws
    /// `"exponential"`, `"table"`, `"expression"` and `"python"`; default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub memory: Option<FrictionMemory>,
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
pub enum FrictionMode {
    /// That of the step before.
    #[default]
    Lagged,
    /// That of the same instant.
    Exact,
}

/// How the state of rate-and-state friction evolves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum StateLaw {
    /// Also at rest (Dieterich).
    #[default]
    Ageing,
    /// In slip alone (Ruina).
    Slip,
}

/// Memory of friction: d(mu)/dt = -(max(|s|, floor)/distance) (mu - mu_law(|s|)), back at mu_law(0)
/// out of contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FrictionMemory {
    /// Distance of slip over which the coefficient adapts (m). Default 1e-6, as in CONTACT.
    pub distance: f64,
    /// Slip speed below which it adapts in time instead (m/s). Default 10e-3, as in CONTACT.
    pub floor: f64,
}

impl Default for FrictionMemory {
    fn default() -> Self {
        Self { distance: 1e-6, floor: 10e-3 }
    }
}

/// The friction laws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FrictionLaw {
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

/// A law with the keys of `[friction]` that it uses.
pub(crate) struct Uses {
    pub(crate) law: FrictionLaw,
    pub(crate) word: &'static str,
    /// Those that must be given.
    pub(crate) needs: &'static [&'static str],
    /// The others.
    pub(crate) takes: &'static [&'static str],
}

/// Which law uses which keys.
pub(crate) const USES: [Uses; 8] = [
    Uses { law: FrictionLaw::Coulomb, word: "coulomb", needs: &["static"], takes: &[] },
    Uses {
        law: FrictionLaw::Exponential,
        word: "exponential",
        needs: &["static"],
        takes: &["dynamic", "decay", "mode", "memory"],
    },
    Uses {
        law: FrictionLaw::SlipWeakening,
        word: "slip_weakening",
        needs: &["static", "distance"],
        takes: &["dynamic"],
    },
    Uses {
        law: FrictionLaw::RateState,
        word: "rate_state",
        needs: &["distance"],
        takes: &["reference", "reference_speed", "direct", "evolution", "state", "age", "mode"],
    },
    Uses {
        law: FrictionLaw::PrakashClifton,
        word: "prakash_clifton",
        needs: &["static", "distance"],
        takes: &["relaxation_speed"],
    },
    Uses { law: FrictionLaw::Table, word: "table", needs: &["table"], takes: &["mode", "memory"] },
    Uses {
        law: FrictionLaw::Expression,
        word: "expression",
        needs: &["expression"],
        takes: &["mode", "memory"],
    },
    Uses {
        law: FrictionLaw::Python,
        word: "python",
        needs: &["source"],
        takes: &["mode", "memory"],
    },
];

impl Uses {
    /// The keys of a law.
    pub(crate) fn of(law: FrictionLaw) -> &'static Self {
        USES.iter().find(|uses| uses.law == law).unwrap_or(&USES[0])
    }

    pub(crate) fn has(&self, key: &str) -> bool {
        self.needs.contains(&key) || self.takes.contains(&key)
    }
}

/// Dotted path of a key that some law uses.
pub(crate) fn path(key: &str) -> String {
    format!("friction.{key}")
}

/// Every key that some law uses, each once.
pub(crate) fn all_keys() -> impl Iterator<Item = &'static str> {
    let keys = |i: usize| USES[i].needs.iter().chain(USES[i].takes).copied();
    (0..USES.len()).flat_map(move |i| {
        keys(i).filter(move |key| !USES[..i].iter().any(|before| before.has(key)))
    })
}

impl Friction {
    /// The keys given besides the law.
    pub(crate) fn given(&self) -> impl Iterator<Item = &'static str> {
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

    /// Writes the law's defaults out. `exact` says whether contact is enforced exactly.
    pub(crate) fn write_defaults(&mut self, exact: bool) {
        match self.law {
            FrictionLaw::Exponential => {
                self.dynamic.get_or_insert(DYNAMIC);
                self.decay.get_or_insert(DECAY);
            }
            FrictionLaw::SlipWeakening => {
                self.dynamic.get_or_insert(DYNAMIC);
            }
            FrictionLaw::RateState => {
                self.reference.get_or_insert(REFERENCE);
                let speed = *self.reference_speed.get_or_insert(REFERENCE_SPEED);
                self.direct.get_or_insert(DIRECT);
                self.evolution.get_or_insert(EVOLUTION);
                self.state.get_or_insert_default();
                self.age.get_or_insert(self.distance.unwrap_or(0.0) / speed);
                self.mode.get_or_insert(if exact {
                    FrictionMode::Exact
                } else {
                    FrictionMode::Lagged
                });
            }
            FrictionLaw::PrakashClifton => {
                self.relaxation_speed.get_or_insert(RELAXATION_SPEED);
            }
            FrictionLaw::Coulomb
            | FrictionLaw::Table
            | FrictionLaw::Expression
            | FrictionLaw::Python => {}
        }
    }

    /// The coefficient `static`; zero for a law without it.
    fn at_rest(&self) -> f64 {
        self.static_.unwrap_or(0.0)
    }

    /// Eq. (8) with the keys of the case.
    fn eq_8(&self) -> Exponential {
        Exponential {
            mu_static: self.at_rest(),
            mu_dynamic: self.dynamic.unwrap_or(DYNAMIC),
            decay: self.decay.unwrap_or(DECAY),
        }
    }

    /// Eq. (8), of a case with this law.
    pub(crate) fn exponential(&self) -> Option<Exponential> {
        (self.law == FrictionLaw::Exponential).then(|| self.eq_8())
    }
}

/// Coefficient at high slip velocity, or after slip, where a case gives none.
pub(crate) const DYNAMIC: f64 = 0.32;
/// Decay (s/m) where an exponential law gives none.
const DECAY: f64 = 6.0;
/// Rate and state where a case gives none: the benchmarks TPV101 and 102 (Harris et al. 2009).
const REFERENCE: f64 = 0.6;
const REFERENCE_SPEED: f64 = 1e-6;
const DIRECT: f64 = 0.008;
const EVOLUTION: f64 = 0.012;
/// V* (m/s) where a case gives none: the benchmarks TPV6 and 7 (Harris et al. 2009).
const RELAXATION_SPEED: f64 = 1.0;

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

/// The friction law of a case; `own` is what was handed over with the run. Without it the law
/// `"python"` is no friction: nothing that does without it rolls.
pub(crate) fn law(
    case: &Case,
    own: Option<&Arc<dyn OwnLaw>>,
) -> Result<Box<dyn NodeFriction>, ContactError> {
    let formula = |text: &str| Expression::over(text, &domain(case));
    node_friction(&case.friction, formula, own)
}

/// The friction law that the keys of `[friction]` say, with `formula` to read an expression.
fn node_friction(
    friction: &Friction,
    formula: impl FnOnce(&str) -> Result<Expression, ExpressionError>,
    own: Option<&Arc<dyn OwnLaw>>,
) -> Result<Box<dyn NodeFriction>, ContactError> {
    let distance = friction.distance.unwrap_or(0.0);
    let memory =
        friction.memory.map(|memory| Memory { distance: memory.distance, floor: memory.floor });
    let mode = friction.mode.unwrap_or_default();
    let steady = match friction.law {
        FrictionLaw::Coulomb => return Ok(Box::new(Coulomb { mu: friction.at_rest() })),
        FrictionLaw::SlipWeakening => {
            return Ok(Box::new(SlipWeakening {
                mu_static: friction.at_rest(),
                mu_dynamic: friction.dynamic.unwrap_or(DYNAMIC),
                distance,
            }));
        }
        FrictionLaw::RateState => {
            let reference_speed = friction.reference_speed.unwrap_or(REFERENCE_SPEED);
            return Ok(Box::new(RateState {
                reference: friction.reference.unwrap_or(REFERENCE),
                reference_speed,
                direct: friction.direct.unwrap_or(DIRECT),
                evolution: friction.evolution.unwrap_or(EVOLUTION),
                distance,
                law: match friction.state.unwrap_or_default() {
                    StateLaw::Ageing => contact::StateLaw::Ageing,
                    StateLaw::Slip => contact::StateLaw::Slip,
                },
                initial: friction.age.unwrap_or(distance / reference_speed),
                lagged: friction.mode.unwrap_or_default() == FrictionMode::Lagged,
            }));
        }
        FrictionLaw::PrakashClifton => {
            return Ok(Box::new(PrakashClifton {
                mu: friction.at_rest(),
                distance,
                speed: friction.relaxation_speed.unwrap_or(RELAXATION_SPEED),
            }));
        }
        FrictionLaw::Exponential => SteadyLaw::Exponential(friction.eq_8()),
        FrictionLaw::Table => {
            SteadyLaw::Table(Table::new(friction.table.clone().unwrap_or_default())?)
        }
        FrictionLaw::Expression => {
            let text = friction.expression.as_deref().unwrap_or_default();
            SteadyLaw::Expression(formula(text)?)
        }
        FrictionLaw::Python => {
            let Some(own) = own else { return Ok(Box::new(Coulomb { mu: 0.0 })) };
            let implicit = memory.is_none() && mode == FrictionMode::Exact;
            return Ok(Box::new(Own::new(Arc::clone(own), memory, implicit)));
        }
    };
    Ok(match (memory, mode) {
        (Some(memory), _) => Box::new(Remembering { steady, memory }),
        (None, FrictionMode::Lagged) => Box::new(Lagged(steady)),
        (None, FrictionMode::Exact) => Box::new(Implicit(steady)),
    })
}
