//! The measures of the contact conditions, each declared once: name, unit, statistic, definition, limits.

use crate::check::limits::Limit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// What a measure is.
#[derive(Clone, Copy, Debug)]
pub struct Definition {
    /// Its name in documents and options, on which scripts rely.
    pub name: &'static str,
    /// Other names, which options take, and under which documents hold its value too.
    pub aliases: &'static [&'static str],
    /// Unit of its value.
    pub units: &'static str,
    /// The statistic over nodes and times that its value is: `max`, `rms`, `share` and so on.
    pub statistic: &'static str,
    /// Its definition, in a phrase.
    pub about: &'static str,
    /// Limit for methods that enforce the conditions exactly.
    pub exact: Option<Limit>,
    /// Limit for a usable penalty method.
    pub penalty: Option<Limit>,
}

/// Declares the measures, in the order in which tables show them: name, alias, unit, statistic, definition, limit for
/// exact methods, limit for penalty methods.
macro_rules! measures {
    ($($Measure:ident $name:literal $(alias $alias:literal)? ($units:literal, $statistic:literal, $about:literal, $exact:expr, $penalty:expr))*) => {
        /// A measure of the contact conditions; `docs/checks.md` defines each.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, JsonSchema, Serialize, Deserialize)]
        pub enum Measure {
            $(#[doc = concat!($about, " (", $units, ", ", $statistic, ")")] #[serde(rename = $name $(, alias = $alias)?)] $Measure,)*
        }

        impl Measure {
            /// All of them, in the order in which tables show them.
            pub const ALL: &[Self] = &[$(Self::$Measure),*];

            /// What it is.
            pub const fn definition(self) -> Definition {
                match self {
                    $(Self::$Measure => Definition {
                        name: $name, aliases: &[$($alias)?], units: $units, statistic: $statistic, about: $about,
                        exact: $exact, penalty: $penalty,
                    },)*
                }
            }
        }
    };
}

measures! {
    Penetration "penetration" ("1", "max", "penetration over Hertz's approach", most(1e-3), None)
    Tension "tension" ("1", "max", "tension over p0", most(0.0), most(0.0))
    Complementarity "complementarity" ("1", "max", "|gap| p_n/(delta p0)", most(1e-3), None)
    Cone "cone" ("1", "max", "p_f/(mu_S p_n) - 1 above the cone", most(1e-10), most(1e-10))
    AdhesionSlip "adhesion_slip" ("1", "max", "|s|/s_c below 0.98 of the bound", most(1e-3), None)
    MuError "mu_error"
        ("1", "max", "mu used over the law's, recomputed from the records, - 1", most(1e-10), most(TWO_PASSES))
    MuErrorUncertain "mu_error_uncertain" alias "mu_error_blurred"
        ("1", "median", "the same beyond the uncertainty, where not every step is recorded", most(MU_UNCERTAIN),
            most(MU_UNCERTAIN))
    LawError "law_error" ("1", "rms", "p_f/(mu(|s|) p_n) - 1 in slip", None, most(0.02))
    LawErrorOwn "law_error_own" ("1", "rms", "the same with the mu used", most(1e-8), None)
    LawErrorSlipState "law_error_slip_state" alias "law_error_let_slip"
        ("1", "rms", "law_error where the algorithm's state is slip", None, most(0.02))
    Direction "direction" ("deg", "rms", "angle of the shear from -s in slip", most(0.1), most(5.0))
    DirectionSlipState "direction_slip_state" alias "direction_let_slip"
        ("deg", "rms", "direction where the algorithm's state is slip", None, most(5.0))
    WrongDirection "wrong_direction" ("1", "share", "slip with that angle above 90 deg", None, None)
    Dissipation "dissipation" ("1", "share", "contact power of the wrong sign", most(0.0), None)
    ViolatingFraction "violating_fraction" ("1", "share", "of the contact area", most(0.0), most(0.05))
    ViolatingFractionSlipState "violating_fraction_slip_state"
        ("1", "share", "violating_fraction where the algorithm's state is slip", None, most(0.05))
    RoughnessRatio "roughness_ratio"
        ("1", "ratio", "sd_t(p_f/p_n) over sd_t(mu(|s|)) in slip", between(0.999, 1.001), between(0.8, 1.25))
    LawScatter "law_scatter" ("1", "rms", "distance from the law's graph", most(1e-8), None)
    SwitchingRate "switching_rate" ("1", "rate", "stick-slip switches per h/c_s", None, None)
    MeshMode "mesh_mode" ("1", "rms", "slip that alternates from node to node", None, None)
}

/// Limit of `mu_error` for penalty springs: the coefficient of a node is the mean over both passes, whose
/// projections are recomputed to a tenth of this.
const TWO_PASSES: f64 = 1e-4;
/// Limit of `mu_error_uncertain`.
const MU_UNCERTAIN: f64 = 5e-3;

const fn most(value: f64) -> Option<Limit> {
    Some(Limit::Most(value))
}

const fn between(low: f64, high: f64) -> Option<Limit> {
    Some(Limit::Between(low, high))
}

impl Measure {
    /// Its name in documents and options.
    pub const fn name(self) -> &'static str {
        self.definition().name
    }

    /// The same measure where the algorithm's state is slip: without the deformation of penalty springs in stick.
    pub const fn in_slip_state(self) -> Option<Self> {
        match self {
            Self::LawError => Some(Self::LawErrorSlipState),
            Self::Direction => Some(Self::DirectionSlipState),
            Self::ViolatingFraction => Some(Self::ViolatingFractionSlipState),
            _ => None,
        }
    }

    /// Its name and its aliases.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        let Definition { name, aliases, .. } = self.definition();
        std::iter::once(name).chain(aliases.iter().copied())
    }
}

impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Measure {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::ALL
            .iter()
            .copied()
            .find(|measure| measure.names().any(|known| known == name))
            .ok_or_else(|| {
                let names: Vec<_> = Self::ALL.iter().map(|measure| measure.name()).collect();
                format!("there is no measure '{name}'; the measures are {}", names.join(", "))
            })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// A limit as the documents write it.
    fn written(limit: Option<Limit>) -> String {
        match limit {
            None => "-".into(),
            Some(Limit::Most(value)) if value > 0.0 && value < 0.01 => format!("{value:e}"),
            Some(Limit::Most(value)) => value.to_string(),
            Some(Limit::Between(low, high)) => format!("{low}..{high}"),
        }
    }

    #[test]
    fn the_table_of_the_documents_has_every_measure_in_order_with_its_limits() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/checks.md");
        let text = std::fs::read_to_string(path).unwrap();
        let (_, table) = text.split_once("| measure | value | exact | penalty |\n").unwrap();
        let rows = table.lines().skip(1).take_while(|line| line.starts_with('|'));
        let found = rows.map(|row| {
            let cells: Vec<&str> = row.trim_matches('|').split(" | ").map(str::trim).collect();
            format!("{} {} {}", cells[0], cells[cells.len() - 2], cells[cells.len() - 1])
        });
        let wanted = Measure::ALL.iter().map(|measure| {
            let Definition { name, exact, penalty, .. } = measure.definition();
            format!("`{name}` {} {}", written(exact), written(penalty))
        });
        assert_eq!(found.collect::<Vec<_>>(), wanted.collect::<Vec<_>>());
    }
}
