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
        let formula = FlatEx::parse(text).map_err(|error| ExpressionError::Syntax {
            text: text.into(),
            reason: error.to_string(),
        })?;
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
    pub(crate) fn uses(&self, name: usize) -> bool {
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
