//! Friction given by a formula.

use crate::declaration::{Make, no_defaults};
use crate::law::trial_speeds;
use crate::formula::Formula;
use crate::{Declaration, FrictionLaw, NodeConditions};
use std::sync::Arc;
use thiserror::Error;

pub(crate) const DECLARATION: Declaration = Declaration {
    word: "expression",
    sentence: "A coefficient by a formula.",
    coefficient: "",
    numbers: &[],
    needs: &["expression"],
    takes: &["mode", "memory"],
    write_defaults: no_defaults,
    make: Make::Steady(|p, beside| {
        Ok(Arc::new((beside.formula)(p.expression.as_deref().unwrap_or_default())?))
    }),
};

/// The names of a formula: slip speed (m/s), contact pressure (Pa), time (s), position along `x` (m).
const NAMES: [&str; 4] = ["s", "p", "t", "x"];

/// `mu` by a formula, for example `0.32 + 0.18*exp(-6*s)`, parsed once. It may use the slip speed `s` (m/s) and,
/// at a contact node, the contact pressure `p` (Pa), the time `t` (s) and the position `x` (m).
///
/// Where its value is negative or not finite, [`FrictionLaw::mu`] and [`FrictionLaw::mu_at`] return NaN, which stops a
/// run at its guards.
#[derive(Clone, Debug)]
pub struct Expression {
    formula: Formula,
    at_rest: f64,
}

/// Spans of pressure, time and position in which a formula must give a coefficient of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Domain {
    /// Largest contact pressure (Pa); the least is zero.
    pub pressure: f64,
    /// Duration (s), from zero.
    pub duration: f64,
    /// First and last position along x (m).
    pub along: [f64; 2],
}

/// Why a text is no friction law.
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
    /// It has a name that it may not use.
    #[error(
        "the formula '{text}' has the unknown name '{name}' at position {position}; it may use {names}, numbers, + - * / ^ ( ), and functions such as exp, ln, sqrt, abs, tanh, min, max"
    )]
    Name {
        /// The formula.
        text: String,
        /// The unknown name.
        name: String,
        /// Where it stands, in characters from 1.
        position: usize,
        /// The names that it may use, with what they mean.
        names: &'static str,
    },
    /// It gives no coefficient of friction.
    #[error(
        "the formula '{text}' gives mu = {mu} at the slip speed {speed} m/s{place}; it must be finite and at least 0"
    )]
    Value {
        /// The formula.
        text: String,
        /// Slip speed (m/s).
        speed: f64,
        /// Pressure, time and position, as far as the formula uses them.
        place: String,
        /// What it gives.
        mu: f64,
    },
}

impl Expression {
    /// Parses a formula in `s` alone and tests it at rest and at slip speeds from 1e-9 to 1e3 m/s.
    ///
    /// # Errors
    /// A formula that does not parse, has names other than `s`, or gives a value that is no
    /// coefficient of friction.
    pub fn new(text: &str) -> Result<Self, ExpressionError> {
        let law = Self::parse(text, &NAMES[..1], "s, the slip speed in m/s")?;
        law.checked(&Domain { pressure: 0.0, duration: 0.0, along: [0.0; 2] })
    }

    /// Parses a formula in `s`, `p`, `t` and `x` and tests it over `domain` at the slip speeds of [`Self::new`], for
    /// nine pressures (zero and seven decades up to the largest), nine times and nine positions.
    ///
    /// # Errors
    /// A formula that does not parse, has other names, or gives a value that is no coefficient of
    /// friction somewhere in the domain.
    pub fn over(text: &str, domain: &Domain) -> Result<Self, ExpressionError> {
        let names = "s, the slip speed in m/s, p, the pressure in Pa, t, the time in s, x, the \
                     position along the bar in m";
        Self::parse(text, &NAMES, names)?.checked(domain)
    }

    /// Parses a formula in `s`, `p`, `t` and `x` without testing it, for the records of a run that has tested it. Its
    /// static coefficient is the value at `s = p = t = x = 0`.
    ///
    /// # Errors
    /// A formula that does not parse or has other names.
    pub fn untried(text: &str) -> Result<Self, ExpressionError> {
        let law = Self::parse(text, &NAMES, "s, p, t and x")?;
        let at_rest = law.value([0.0; 4]);
        Ok(Self { at_rest, ..law })
    }

    fn parse(text: &str, allowed: &[&str], names: &'static str) -> Result<Self, ExpressionError> {
        Ok(Self { formula: Formula::parse(text, allowed, names)?, at_rest: f64::NAN })
    }

    fn checked(mut self, domain: &Domain) -> Result<Self, ExpressionError> {
        // a name that the formula does not use needs one value only
        let steps = |name: usize, most: u32| if self.formula.uses(name) { most } else { 0 };
        for i in 0..=steps(1, 8) {
            let decades = f64::from(i) - 8.0;
            let p = if i == 0 { 0.0 } else { domain.pressure * libm::pow(10f64, decades) };
            for j in 0..=steps(2, 8) {
                let t = domain.duration * f64::from(j) / 8.0;
                for k in 0..=steps(3, 8) {
                    let [first, last] = domain.along;
                    let x = first + (last - first) * f64::from(k) / 8.0;
                    for speed in trial_speeds() {
                        let mu = self.raw([speed, p, t, x]);
                        if !(mu >= 0.0 && mu.is_finite()) {
                            let text = self.text().to_owned();
                            let place = self.place([("p", p, "Pa"), ("t", t, "s"), ("x", x, "m")]);
                            return Err(ExpressionError::Value { text, speed, place, mu });
                        }
                    }
                }
            }
        }
        self.at_rest = self.value([0.0, domain.pressure, 0.0, 0.0]);
        Ok(self)
    }

    /// The values of pressure, time and position that the formula uses, for a message.
    fn place(&self, values: [(&str, f64, &str); 3]) -> String {
        let used = (1..).zip(values).filter(|(argument, _)| self.formula.uses(*argument));
        used.map(|(_, (name, value, unit))| format!(", {name} = {value} {unit}")).collect()
    }

    /// The formula as it was given.
    pub fn text(&self) -> &str {
        self.formula.text()
    }

    fn raw(&self, values: [f64; 4]) -> f64 {
        self.formula.value(values)
    }

    fn value(&self, values: [f64; 4]) -> f64 {
        let mu = self.raw(values);
        if mu >= 0.0 && mu.is_finite() { mu } else { f64::NAN }
    }
}

impl FrictionLaw for Expression {
    fn mu(&self, slip_speed: f64) -> f64 {
        self.value([slip_speed, 0.0, 0.0, 0.0])
    }

    /// At rest; with [`Self::over`] at the largest pressure of the domain, at `t = 0` and `x = 0`.
    fn mu_static(&self) -> f64 {
        self.at_rest
    }

    /// By a one-sided difference of second order.
    fn fall_at_rest(&self) -> f64 {
        let h = 1e-6;
        (3.0 * self.mu_static() - 4.0 * self.mu(h) + self.mu(2.0 * h)) / (2.0 * h)
    }

    fn mu_at(&self, slip_speed: f64, at: &NodeConditions) -> f64 {
        self.value([slip_speed, at.pressure, at.time, at.position[0]])
    }

    fn slope_at(&self, slip_speed: f64, at: &NodeConditions) -> f64 {
        let step = 1e-6 * (1.0 + slip_speed);
        let low = (slip_speed - step).max(0.0);
        (self.mu_at(slip_speed + step, at) - self.mu_at(low, at)) / (slip_speed + step - low)
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

    const DOMAIN: Domain = Domain { pressure: 2e9, duration: 1e-3, along: [-0.03, 0.05] };

    #[test]
    fn a_formula_of_place_time_and_pressure_takes_each_where_it_stands() {
        let law = Expression::over("0.1 + x + 2*t + p*1e-10 + exp(-s)", &DOMAIN).unwrap();
        let at = NodeConditions { position: [0.02, 7.0, 9.0], time: 5e-4, pressure: 3e8 };
        let expected = 0.1 + 0.02 + 1e-3 + 0.03 + libm::exp(-0.5f64);
        assert!((law.mu_at(0.5, &at) - expected).abs() < 1e-15);
        assert!((law.slope_at(0.5, &at) + libm::exp(-0.5f64)).abs() < 1e-8);
        let wave = Expression::over("0.3 + 0.05*sin(628*x)", &DOMAIN).unwrap();
        let mu = wave.mu_at(1.0, &NodeConditions { position: [2.5e-3, 0.0, 0.0], ..at });
        assert!((mu - (0.3 + 0.05 * libm::sin(1.57f64))).abs() < 1e-15);
    }

    #[test]
    fn only_a_node_has_a_place() {
        let error = Expression::new("0.3 + p").unwrap_err();
        assert!(matches!(&error, ExpressionError::Name { name, position: 7, .. } if name == "p"));
        let error = Expression::over("0.3 + y*s", &DOMAIN).unwrap_err().to_string();
        for words in ["'y' at position 7", "p, the pressure in Pa", "x, the position"] {
            assert!(error.contains(words), "{error}");
        }
    }

    #[test]
    fn a_formula_must_hold_over_all_of_its_domain() {
        for (text, words) in [
            ("0.3*1e8/p", "p = 0 Pa"),
            ("0.3 - 10*x", "x = 0.04"),
            ("0.3 - 400*t", "t = 0.0008"),
            ("0.3/(s - 1)", "s"),
            ("0.01*ln(s)", "-inf"),
        ] {
            let error = Expression::over(text, &DOMAIN).unwrap_err();
            assert!(error.to_string().contains(words), "{error}");
        }
        assert!(Expression::over("0.3*1e8/max(p, 1e8)", &DOMAIN).is_ok());
    }

    #[test]
    fn outside_its_domain_a_bad_value_is_no_number() {
        let law = Expression::over("0.5 - 9*x", &DOMAIN).unwrap();
        let at = NodeConditions { position: [0.07, 0.0, 0.0], ..NodeConditions::default() };
        assert!(law.mu_at(0.0, &at).is_nan());
    }

    #[test]
    fn numbers_may_have_an_exponent() {
        for (text, value) in
            [("1e-1", 0.1), (".5", 0.5), ("2.", 2.0), ("2.5E+2", 250.0), ("3e2*1e-3", 0.3)]
        {
            assert_eq!(Expression::new(text).unwrap().mu(0.0), value, "{text}");
        }
        assert!(Expression::new("1.2.3").is_err());
        assert!(Expression::new(".").is_err());
    }

    #[test]
    fn texts_that_are_no_formulas_are_refused() {
        for text in
            ["", " ", "(", ")", "s s", "exp", "exp(", "s,", "µ + s", "0.3 + ü", "\u{1F980}", "+-*"]
        {
            assert!(Expression::new(text).is_err(), "{text}");
        }
    }
}
