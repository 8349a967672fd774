//! The parameters of a deck: `*PARAMETER`, and `&name` in a field.

use std::collections::BTreeMap;

use crate::ls_dyna::cards::{Card, number};
use crate::ls_dyna::error::{DeckError, DeckLine, Fault, second, syntax, unsupported};

/// Values of parameters by their names in lower case.
#[derive(Clone, Debug, Default)]
pub(super) struct Parameters(BTreeMap<String, Defined>);

#[derive(Clone, Debug)]
struct Defined {
    value: f64,
    place: DeckLine,
}

/// Those of cards that are read before the deck's parameters are known.
pub(super) static NO_PARAMETERS: Parameters = Parameters(BTreeMap::new());

impl Parameters {
    /// The parameters that the cards `*PARAMETER` among these give.
    ///
    /// # Errors
    /// A name that stands twice, a type other than R and I, a value that is no number.
    pub(super) fn of(cards: &[Card]) -> Result<Self, DeckError> {
        let mut found = Self::default();
        for line in cards.iter().filter(|card| card.name == "PARAMETER").flat_map(Card::lines) {
            for pair in line.words()?.chunks(2) {
                match (pair[0], pair.get(1).copied().unwrap_or_default()) {
                    ("", "") => {}
                    (name, value) => found.define(name, value, &line.place())?,
                }
            }
        }
        Ok(found)
    }

    /// Takes a parameter, whose name comes after the letter of its type.
    fn define(&mut self, typed: &str, value: &str, place: &DeckLine) -> Result<(), DeckError> {
        let mut letters = typed.chars();
        let kind = letters.next().map(|letter| letter.to_ascii_uppercase());
        let name = letters.as_str().trim().to_lowercase();
        if !matches!(kind, Some('R' | 'I')) {
            let what = format!("*PARAMETER `{typed}`, whose type is neither R nor I,");
            let remedy = "write R or I in front of the name: parameters are numbers";
            return Err(unsupported(place, what, remedy));
        }
        if name.is_empty() || value.is_empty() {
            return Err(syntax(place, "a parameter needs a name and a value"));
        }
        if let Some(before) = self.0.get(&name) {
            let what = format!("parameter `{name}`");
            return Err(second(place, what, &before.place, "keep one of the two"));
        }
        let value = number(value, self).map_err(|fault| fault.at(place))?;
        if kind == Some('I') && value.fract() != 0.0 {
            let what =
                format!("parameter `{name}` of type I is {value}: a whole number is expected");
            return Err(syntax(place, what));
        }
        self.0.insert(name, Defined { value, place: place.clone() });
        Ok(())
    }

    /// The value of a parameter.
    pub(super) fn value(&self, name: &str) -> Result<f64, Fault> {
        let defined = self.0.get(&name.trim().to_lowercase()).map(|defined| defined.value);
        defined.ok_or_else(|| Fault::Parameter { name: name.trim().to_owned() })
    }
}
