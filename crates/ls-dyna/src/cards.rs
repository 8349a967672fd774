//! The cards of a keyword file: keywords, and data in columns or between commas.
//!
//! Source: LS-DYNA Keyword User's Manual, vol. I, "Getting started: description of keyword input".
//!
//! Read here, since no library for this format was found.

use mesh::import::{Fault, ImportError};

/// A keyword with its data.
#[derive(Clone, Debug)]
pub(super) struct Card<'a> {
    /// The keyword in capitals, without its asterisk.
    pub(super) name: String,
    /// Its line, counted from 1.
    pub(super) line: usize,
    /// Its data lines without comments.
    pub(super) data: Vec<Line<'a>>,
}

/// A data line.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    /// Its number, counted from 1.
    pub(super) at: usize,
    /// Its text.
    pub(super) text: &'a str,
}

/// Cuts a keyword file into its cards, up to `*END`.
pub(super) fn cards(bytes: &[u8]) -> Result<Vec<Card<'_>>, ImportError> {
    let mut cards: Vec<Card> = Vec::new();
    for (i, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let at = i + 1;
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        // a comment may hold anything
        if line.first() == Some(&b'$') {
            continue;
        }
        let text = str::from_utf8(line).ok().filter(|text| text.is_ascii());
        let text = text.ok_or_else(|| syntax(at, "the line is not ASCII text"))?;
        if let Some(name) = text.strip_prefix('*') {
            let name = name.trim().to_uppercase();
            if name == "END" {
                break;
            }
            let long = name.ends_with(['+', '%'])
                || name.starts_with("KEYWORD")
                    && ["LONG=", "I10="].iter().any(|w| name.contains(w));
            if long {
                let what = format!("*{name}: the long format");
                return Err(unsupported(at, what, "write the file in the standard format"));
            }
            cards.push(Card { name, line: at, data: Vec::new() });
            continue;
        }
        if text.contains('&') {
            let what = "a parameter (&)".to_owned();
            return Err(unsupported(at, what, "write its value in its place"));
        }
        match cards.last_mut() {
            Some(card) => card.data.push(Line { at, text }),
            None if text.trim().is_empty() => {}
            None => return Err(syntax(at, "a keyword that starts with * is expected")),
        }
    }
    Ok(cards)
}

pub(super) fn syntax(at: usize, what: impl Into<String>) -> ImportError {
    ImportError { line: Some(at), fault: Fault::Syntax { what: what.into() } }
}

pub(super) fn unsupported(at: usize, what: impl Into<String>, remedy: &'static str) -> ImportError {
    ImportError { line: Some(at), fault: Fault::Unsupported { what: what.into(), remedy } }
}

/// The usual columns: eight fields of ten.
pub(super) const TENS: [usize; 8] = [10; 8];

impl<'a> Line<'a> {
    /// The fields, by commas if there are any, or else by columns of these widths.
    pub(super) fn fields(&self, widths: &[usize]) -> Fields<'a> {
        let words = if self.text.contains(',') {
            self.text.split(',').map(str::trim).collect()
        } else {
            let mut rest = self.text;
            let cut = |&width: &usize| {
                let (field, after) = rest.split_at(width.min(rest.len()));
                rest = after;
                field.trim()
            };
            widths.iter().map(cut).collect()
        };
        Fields { at: self.at, words }
    }
}

/// The fields of a data line.
pub(super) struct Fields<'a> {
    at: usize,
    words: Vec<&'a str>,
}

impl Fields<'_> {
    /// Field `i`, counted from 0, as a number; `default` where it is blank.
    pub(super) fn real(&self, i: usize, default: f64) -> Result<f64, ImportError> {
        let word = self.words.get(i).copied().unwrap_or_default();
        if word.is_empty() {
            return Ok(default);
        }
        // 1.0+5 and 1d5 are numbers in Fortran
        let mut number = word.to_lowercase().replace('d', "e");
        if let Some(sign) = number.rfind(['+', '-']).filter(|&s| s > 0 && !number.contains('e')) {
            number.insert(sign, 'e');
        }
        let value = number.parse().ok().filter(|x: &f64| x.is_finite());
        value.ok_or_else(|| syntax(self.at, format!("a number is expected, found `{word}`")))
    }

    /// Field `i` as a whole number; 0 where it is blank.
    pub(super) fn whole(&self, i: usize) -> Result<i64, ImportError> {
        let x = self.real(i, 0.0)?;
        if x.fract() != 0.0 || x.abs() > 1e15 {
            return Err(syntax(self.at, format!("a whole number is expected, found {x}")));
        }
        Ok(x as i64)
    }

    /// Field `i` as the number of something; 0 where it is blank.
    pub(super) fn id(&self, i: usize) -> Result<u64, ImportError> {
        let n = self.whole(i)?;
        u64::try_from(n)
            .map_err(|_| syntax(self.at, format!("a number from 1 is expected, found {n}")))
    }

    /// Refuses the line where one of `fields`, by index and name, is neither blank nor 0.
    pub(super) fn unused(
        &self,
        keyword: &str,
        fields: &[(usize, &str)],
    ) -> Result<(), ImportError> {
        for &(i, name) in fields {
            let x = self.real(i, 0.0)?;
            if x != 0.0 {
                let what = format!("*{keyword} with {name} = {x}");
                return Err(unsupported(self.at, what, "leave the field blank or 0"));
            }
        }
        Ok(())
    }
}
