//! Friction given by a formula.

use super::FrictionLaw;
use exmex::{Express, FlatEx};
use std::sync::Arc;
use thiserror::Error;

/// `mu` by a formula in the slip speed `s` (m/s), for example `0.32 + 0.18*exp(-6*s)`: the user's
/// hook without writing Rust. Parsed once.
#[derive(Clone, Debug)]
pub struct Expression {
    text: String,
    formula: Arc<FlatEx<f64>>,
    depends: bool,
    at_rest: f64,
}

/// Why a text makes no friction law.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ExpressionError {
    /// It does not parse.
    #[error("cannot read the formula '{text}': {reason}")]
    Syntax {
        /// The formula.
        text: String,
        /// What the parser says.
        reason: String,
    },
    /// It has a name other than `s`.
    #[error(
        "the formula '{text}' has the unknown name '{name}' at position {position}; it may use s, the slip speed in m/s, numbers, + - * / ^ ( ), and functions such as exp, log, sqrt, abs, tanh, min, max"
    )]
    Name {
        /// The formula.
        text: String,
        /// The unknown name.
        name: String,
        /// Where it stands, in characters from 1.
        position: usize,
    },
    /// It gives no coefficient of friction.
    #[error(
        "the formula '{text}' gives mu = {mu} at the slip speed {speed} m/s; it must be finite and at least 0"
    )]
    Value {
        /// The formula.
        text: String,
        /// Slip speed (m/s).
        speed: f64,
        /// What it gives.
        mu: f64,
    },
}

/// Slip speeds at which a formula is tried: at rest and from 1e-9 to 1e3 m/s.
pub(super) fn trial_speeds() -> impl Iterator<Item = f64> {
    std::iter::once(0.0).chain((0..=240).map(|i| 10f64.powf(-9.0 + f64::from(i) / 20.0)))
}

impl Expression {
    /// Parses a formula and tries it at rest and at slip speeds from 1e-9 to 1e3 m/s.
    ///
    /// # Errors
    /// A formula that does not parse, has names other than `s`, or gives a value that is no
    /// coefficient of friction.
    pub fn new(text: &str) -> Result<Self, ExpressionError> {
        let formula = FlatEx::<f64>::parse(text).map_err(|error| ExpressionError::Syntax {
            text: text.into(),
            reason: error.to_string(),
        })?;
        if let Some(name) = formula.var_names().iter().find(|name| *name != "s") {
            let at = position(text, name);
            let (text, name) = (text.into(), name.clone());
            return Err(ExpressionError::Name { text, name, position: at });
        }
        let depends = !formula.var_names().is_empty();
        let mut law =
            Self { text: text.into(), formula: Arc::new(formula), depends, at_rest: f64::NAN };
        law.at_rest = law.mu(0.0);
        for speed in trial_speeds() {
            let mu = law.mu(speed);
            if !(mu >= 0.0 && mu.is_finite()) {
                return Err(ExpressionError::Value { text: text.into(), speed, mu });
            }
        }
        Ok(law)
    }

    /// The formula as it was given.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// Where a name stands as a word of its own, in characters from 1.
fn position(text: &str, name: &str) -> usize {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let found = text.match_indices(name).find(|(at, _)| {
        let before = text[..*at].chars().next_back();
        let after = text[at + name.len()..].chars().next();
        !before.is_some_and(word) && !after.is_some_and(word)
    });
    found.map_or(1, |(at, _)| text[..at].chars().count() + 1)
}

impl FrictionLaw for Expression {
    fn mu(&self, slip_speed: f64) -> f64 {
        let arguments = [slip_speed];
        // the number of arguments is right by construction; NaN would stop a run at its guards
        self.formula.eval(&arguments[..usize::from(self.depends)]).unwrap_or(f64::NAN)
    }

    fn mu_static(&self) -> f64 {
        self.at_rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Exponential;

    #[test]
    fn a_formula_gives_the_law_it_writes() {
        let law = Expression::new("0.32 + 0.18*exp(-6*s)").unwrap();
        let same = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
        for s in [0.0, 1e-3, 0.1, 1.0, 50.0] {
            assert!((law.mu(s) - same.mu(s)).abs() < 1e-15, "{s}");
        }
        assert_eq!(law.mu_static(), 0.5);
        assert_eq!(Expression::new("0.3").unwrap().mu(5.0), 0.3);
    }

    #[test]
    fn a_formula_with_an_unknown_name_is_refused_with_its_position() {
        let error = Expression::new("0.3 + speed*s").unwrap_err();
        assert!(
            matches!(&error, ExpressionError::Name { name, position: 7, .. } if name == "speed")
        );
    }

    #[test]
    fn formulas_that_give_no_coefficient_are_refused() {
        let infinite = Expression::new("0.3/s").unwrap_err();
        assert!(matches!(infinite, ExpressionError::Value { speed: 0.0, .. }), "{infinite}");
        let negative = Expression::new("0.5 - s").unwrap_err();
        assert!(matches!(negative, ExpressionError::Value { .. }), "{negative}");
        assert!(matches!(Expression::new("0.3 +"), Err(ExpressionError::Syntax { .. })));
        assert!(Expression::new("").is_err());
    }
}
