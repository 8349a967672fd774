//! Keyword lines, and the names in lines.
//!
//! Source: Abaqus Analysis User's Guide, "Input syntax rules": a keyword line that ends with a comma goes on in the
//! next; blanks and letter case do not matter in it, save in quotes.

use super::{FLAT, INCLUDED};
use crate::import::error::{Fault, ImportError};

/// A keyword with its parameters. Who reads it takes the parameters that it knows, and [`Keyword::end`] refuses the others.
pub(super) struct Keyword {
    /// In capitals, without blanks.
    pub(super) name: String,
    /// The line where it begins.
    pub(super) at: usize,
    /// The parameters not taken yet, in capitals and without blanks, with their values.
    parameters: Vec<(String, Option<String>)>,
}

/// A name as it stands in a line.
#[derive(Clone, Copy)]
pub(super) struct Name<'a> {
    /// Without the quotes.
    pub(super) text: &'a str,
    pub(super) quoted: bool,
}

impl<'a> Name<'a> {
    pub(super) fn of(word: &'a str) -> Self {
        match word.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
            Some(text) => Self { text, quoted: true },
            None => Self { text: word, quoted: false },
        }
    }

    /// What two spellings of one name have in common.
    pub(super) fn key(&self) -> String {
        if self.quoted { self.text.to_uppercase() } else { capitals(self.text) }
    }

    /// The number of a node or element, if it is one.
    pub(super) fn number(&self) -> Option<u64> {
        if self.quoted { None } else { self.text.parse().ok() }
    }
}

/// What stands between the commas of a line; a comma in quotes separates nothing.
pub(super) fn fields(line: &str) -> impl Iterator<Item = &str> {
    let mut quoted = false;
    let comma = move |c| {
        quoted ^= c == '"';
        c == ',' && !quoted
    };
    line.split(comma).map(str::trim)
}

/// Whether a keyword line goes on in the next.
pub(super) fn goes_on(line: &str) -> bool {
    line.ends_with(',') && fields(line).last() == Some("")
}

fn capitals(text: &str) -> String {
    text.split_whitespace().collect::<String>().to_uppercase()
}

impl Keyword {
    /// The keyword of a line, without its `*`, and of the lines in which it goes on; it begins at line `at`.
    pub(super) fn of(line: &str, at: usize) -> Result<Self, ImportError> {
        let syntax = |what: String| Err(Fault::Syntax { what }.at(at));
        let mut fields = fields(line);
        let name = capitals(fields.next().unwrap_or_default());
        let mut keyword = Self { name, at, parameters: Vec::new() };
        let name = &keyword.name;
        if name.is_empty() {
            return syntax("a keyword is expected after *".into());
        }
        if name.contains('=') {
            return syntax("a comma is expected between the keyword and its parameters".into());
        }
        if !line.matches('"').count().is_multiple_of(2) {
            return syntax(format!("a quote of *{name} is not closed in its line"));
        }
        for field in fields.filter(|field| !field.is_empty()) {
            let (key, value) = match field.split_once('=') {
                Some((key, value)) => (key, Some(value.trim().to_owned())),
                None => (field, None),
            };
            keyword.parameters.push((capitals(key), value));
        }
        Ok(keyword)
    }

    fn take(&mut self, key: &str) -> Option<Option<String>> {
        let place = self.parameters.iter().position(|(known, _)| known == key)?;
        Some(self.parameters.remove(place).1)
    }

    /// Takes the value of a parameter that may be left out.
    pub(super) fn value(&mut self, key: &str) -> Result<Option<String>, ImportError> {
        match self.take(key) {
            None => Ok(None),
            Some(Some(value)) if !value.is_empty() => Ok(Some(value)),
            Some(_) => Err(self.lacks(key)),
        }
    }

    /// Takes a word, in capitals.
    pub(super) fn word(&mut self, key: &str) -> Result<Option<String>, ImportError> {
        Ok(self.value(key)?.map(|value| capitals(&value)))
    }

    /// Takes a parameter that has no value.
    pub(super) fn flag(&mut self, key: &str) -> Result<bool, ImportError> {
        match self.take(key) {
            None => Ok(false),
            Some(None) => Ok(true),
            Some(value) => Err(self.refused(key, value.as_deref())),
        }
    }

    /// Ends the reading: what was not taken and is not `harmless` is refused.
    pub(super) fn end(mut self, harmless: &[&str]) -> Result<(), ImportError> {
        self.parameters.retain(|(key, _)| !harmless.contains(&key.as_str()));
        match self.parameters.first() {
            None => Ok(()),
            Some((key, value)) => Err(self.refused(key, value.as_deref())),
        }
    }

    pub(super) fn lacks(&self, key: &str) -> ImportError {
        Fault::Syntax { what: format!("*{} needs {key}=", self.name) }.at(self.at)
    }

    pub(super) fn refused(&self, key: &str, value: Option<&str>) -> ImportError {
        let mut what = format!("*{} with {key}", self.name);
        if let Some(value) = value {
            what += &format!("={value}");
        }
        let remedy = match key {
            "INPUT" => INCLUDED,
            "INSTANCE" => FLAT,
            "SYSTEM" => "give rectangular coordinates",
            "COMBINE" => "list the faces of the surface",
            _ => {
                "leave the parameter out, or write it in full; a keyword line that ends with a comma \
                 goes on in the next"
            }
        };
        // a line of text may be taken for a parameter
        let what = what.chars().take(80).collect();
        Fault::Unsupported { what, remedy }.at(self.at)
    }
}
