//! A formula of named numbers, parsed once.

use crate::ExpressionError;
use crate::operators::Operators;
use exmex::{Express, FlatEx, MatchLiteral};
use std::sync::Arc;

/// Numbers as people write them, with a decimal exponent: `2`, `.5`, `1e-9`.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Numeral;

impl MatchLiteral for Numeral {
    fn is_literal(text: &str) -> Option<&str> {
        let digits = |from: usize| {
            text.as_bytes()[from..].iter().take_while(|byte| byte.is_ascii_digit()).count()
        };
        let byte = |at: usize| text.as_bytes().get(at).copied();
        let mut end = digits(0);
        let mut mantissa = end;
        if byte(end) == Some(b'.') {
            let fraction = digits(end + 1);
            mantissa += fraction;
            end += 1 + fraction;
        }
        if mantissa == 0 {
            return None;
        }
        if matches!(byte(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(byte(end + 1), Some(b'+' | b'-')));
            let start = end + 1 + sign;
            if byte(start).is_some_and(|byte| byte.is_ascii_digit()) {
                end = start + digits(start);
            }
        }
        Some(&text[..end])
    }
}

/// A formula, for example `0.32 + 0.18*exp(-6*s)`, with the same bits on every machine.
#[derive(Clone, Debug)]
pub struct Formula {
    text: String,
    formula: Arc<FlatEx<f64, Operators, Numeral>>,
    /// Which of the values each name of the formula is, in the order in which it takes them.
    arguments: Vec<usize>,
}

impl Formula {
    /// Parses a formula that may use the names `allowed`; `names` says for messages what they mean.
    ///
    /// # Errors
    /// A formula that does not parse or has other names.
    pub fn parse(
        text: &str,
        allowed: &[&str],
        names: &'static str,
    ) -> Result<Self, ExpressionError> {
        let wrong = |reason: String| ExpressionError::Syntax { text: text.into(), reason };
        let signed = signs_after_powers(text).map_err(|reason| wrong(reason.into()))?;
        let formula = FlatEx::parse(&signed).map_err(|error| wrong(error.to_string()))?;
        let mut arguments = Vec::new();
        for name in formula.var_names() {
            let Some(argument) = allowed.iter().position(|other| other == name) else {
                let (position, name) = (position(text, name), name.clone());
                return Err(ExpressionError::Name { text: text.into(), name, position, names });
            };
            arguments.push(argument);
        }
        Ok(Self { text: text.into(), formula: Arc::new(formula), arguments })
    }

    /// The formula as it was given.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether it uses the name at this place among those allowed.
    pub fn uses(&self, name: usize) -> bool {
        self.arguments.contains(&name)
    }

    /// Its value for those of the names allowed, in their order; NaN where it has none.
    pub fn value<const N: usize>(&self, values: [f64; N]) -> f64 {
        let mut taken = [f64::NAN; N];
        for (argument, &name) in taken.iter_mut().zip(&self.arguments) {
            *argument = values.get(name).copied().unwrap_or(f64::NAN);
        }
        // the number of arguments is right where there are as many values as names
        let taken = taken.get(..self.arguments.len());
        taken.and_then(|taken| self.formula.eval(taken).ok()).unwrap_or(f64::NAN)
    }
}

/// The formula with a zero before each minus whose operand is raised to a power: -x^2 is -(x^2), but exmex takes it for (-x)^2.
fn signs_after_powers(text: &str) -> Result<String, &'static str> {
    let mut signed = String::with_capacity(text.len());
    // the last character that is no space
    let mut before = None;
    for (at, c) in text.char_indices() {
        if c == '-' && is_raised(&text[at + 1..]) {
            match before {
                None | Some('(' | ',' | '+') => signed.push('0'),
                Some('-' | '*' | '/' | '^') => {
                    return Err("a power behind two signs must stand in parentheses: 2*(-x^2)");
                }
                // a difference, or the exponent of 1e-6
                _ => {}
            }
        }
        signed.push(c);
        if !c.is_whitespace() {
            before = Some(c);
        }
    }
    Ok(signed)
}

/// Whether a text begins with an operand that is raised to a power: signs, words and a number, then parentheses or none.
fn is_raised(text: &str) -> bool {
    let mut rest = text.trim_start_matches(|c: char| c.is_whitespace() || "+-".contains(c));
    loop {
        let number = Numeral::is_literal(rest).map_or(0, str::len);
        let word = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        if number.max(word) == 0 {
            break;
        }
        rest = rest[number.max(word)..].trim_start();
    }
    if rest.starts_with(['(', '{']) {
        let mut depth = 0;
        let end = rest.find(|c: char| {
            depth += i32::from("({".contains(c)) - i32::from(")}".contains(c));
            depth == 0
        });
        rest = end.map_or("", |end| rest[end + 1..].trim_start());
    }
    rest.starts_with('^')
}

/// Position of a name as a whole word, in characters from 1.
fn position(text: &str, name: &str) -> usize {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let found = text.match_indices(name).find(|(at, _)| {
        let before = text[..*at].chars().next_back();
        let after = text[at + name.len()..].chars().next();
        !before.is_some_and(word) && !after.is_some_and(word)
    });
    found.map_or(1, |(at, _)| text[..at].chars().count() + 1)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_minus_comes_after_the_power_behind_it_as_in_a_book() {
        let at = |text: &str| Formula::parse(text, &["x"], "x").map(|formula| formula.value([3.0]));
        for (text, expected) in [
            ("-x^2", -9.0),
            ("2 - x^2", -7.0),
            ("2 + -x^2", -7.0),
            ("max(-4, -x^2)", -4.0),
            ("abs(-(x - 1)^2)", 4.0),
            ("- sqrt(x + 1)^3", -8.0),
            ("-2.5e-1^2", -0.0625),
            ("1e-1^2 + 0*x", 0.01),
            ("x^-1^2", f64::NAN),
            ("2*-x^2", f64::NAN),
            ("-+x^2", -9.0),
            ("-sqrt x^2", -3.0),
            ("-{x}^2", -9.0),
            ("2*-x", -6.0),
            ("x - -x", 6.0),
            ("(-x)^2", 9.0),
            ("-x", -3.0),
        ] {
            match at(text) {
                Ok(value) => assert!((value - expected).abs() < 1e-12, "{text}: {value}"),
                Err(error) => {
                    assert!(expected.is_nan(), "{text}: {error}");
                    assert!(error.to_string().contains("parentheses"), "{error}");
                }
            }
        }
    }
}
