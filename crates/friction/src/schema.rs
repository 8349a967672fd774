//! What the JSON Schema of a case file says of laws and their parameters.

use crate::{Declaration, Kind, LAWS, LeftOut, NUMBERS, Number, Values};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};
use std::borrow::Cow;

impl JsonSchema for Kind {
    fn schema_name() -> Cow<'static, str> {
        "Kind".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let word = |law: &Declaration| json!({ "type": "string", "const": law.word, "description": law.sentence });
        json_schema!({ "oneOf": LAWS.map(word) })
    }
}

impl JsonSchema for Values {
    fn schema_name() -> Cow<'static, str> {
        "Values".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let property = |number: &Number| {
            let description = format!("{} {}", number.sentence, number.use_in_laws());
            let value = json!({ "type": "number", "format": "double", "description": description });
            (number.key().to_owned(), value)
        };
        let properties: Map<String, Value> = NUMBERS.iter().map(property).collect();
        json_schema!({ "type": "object", "properties": properties, "additionalProperties": false })
    }
}

impl Number {
    /// Which laws need it, what it is where it is left out, and that others refuse it.
    fn use_in_laws(&self) -> String {
        // laws by what they do with it
        let mut groups: Vec<(String, Vec<&str>)> = Vec::new();
        for law in LAWS {
            let own = law.numbers.iter().find(|(number, _)| number.path == self.path);
            let Some((_, left_out)) = own else { continue };
            let does = left_out.said();
            match groups.iter_mut().find(|(other, _)| *other == does) {
                Some((_, laws)) => laws.push(law.word),
                None => groups.push((does, vec![law.word])),
            }
        }
        let alone = matches!(&*groups, [(_, laws)] if laws.len() == 1);
        let said = groups.iter().map(|(does, laws)| match alone {
            true => does.clone(),
            false => format!("{does} with {}", quoted(laws)),
        });
        let mut said = said.collect::<Vec<_>>().join(", ");
        if let Some(first) = said.get_mut(..1) {
            first.make_ascii_uppercase();
        }
        format!("{said}, refused with others.")
    }
}

impl LeftOut {
    fn said(&self) -> String {
        match self {
            Self::Refused => "required".into(),
            Self::Default(value) => format!("default {}", plain(*value)),
            Self::Follows { said, .. } => format!("default {said}"),
        }
    }
}

/// A number as a person would write it.
fn plain(x: f64) -> String {
    if (1e-3..1e6).contains(&x.abs()) { format!("{x}") } else { format!("{x:e}") }
}

/// Words in quotes, with commas and "and".
fn quoted(words: &[&str]) -> String {
    let words: Vec<_> = words.iter().map(|word| format!("`\"{word}\"`")).collect();
    match words.split_last() {
        Some((last, before)) if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        _ => words.concat(),
    }
}

/// What the key `law` chooses from.
pub(crate) fn all_laws() -> String {
    let laws = LAWS.map(|law| match law.coefficient {
        "" => format!("`\"{}\"`", law.word),
        said => format!("`\"{}\"` ({said})", law.word),
    });
    let (before, last) = laws.split_at(LAWS.len() - 1);
    format!("{} or {}. Default `\"{}\"`.", before.join(", "), last.concat(), LAWS[0].word)
}

/// A sentence about the key of a parameter that is no number, and the laws that take it.
pub(crate) fn with_laws(key: &str, sentence: &str) -> String {
    let takers: Vec<_> = LAWS.into_iter().filter(|law| law.has(key)).map(|law| law.word).collect();
    format!("{sentence} Used by the laws {}, refused with others.", quoted(&takers))
}
