//! The cards of a keyword file: keywords, and data in columns or between commas.
//!
//! Source: LS-DYNA Keyword User's Manual, vol. I, "Getting started: description of keyword input".
//!
//! Read here, since no library for this format was found.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use crate::error::{DeckError, Fault, Place, syntax, unsupported};
use crate::parameters::{NO_PARAMETERS, Parameters};

/// A keyword with its data.
#[derive(Clone, Debug)]
pub(super) struct Card<'a> {
    /// The keyword in capitals, without its asterisk, the mark of its format, and the options `_TITLE` and `_ID`.
    pub(super) name: String,
    pub(super) place: Place,
    pub(super) format: Format,
    /// Its data lines without comments, with their numbers.
    data: Vec<(usize, Cow<'a, str>)>,
    /// What its fields may name.
    parameters: &'a Parameters,
}

/// How wide the columns of a card are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Standard,
    /// 20 characters for each field: `LONG=Y`, or `+` after the keyword.
    Long,
    /// 10 characters for the numbers of nodes and elements, which otherwise have 8: `I10=Y`, or `%` after the keyword.
    I10,
}

/// Cuts a keyword file into its cards, up to `*END`. `format` is that of its cards without a mark of their own.
pub(super) fn cards<'a>(
    bytes: &'a [u8],
    file: &Arc<Path>,
    mut format: Format,
) -> Result<Vec<Card<'a>>, DeckError> {
    let mut cards: Vec<Card> = Vec::new();
    for (i, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        // a comment may hold anything
        if line.first() == Some(&b'$') {
            continue;
        }
        // headings are written in any encoding; a number with a letter of one is none
        let text = String::from_utf8_lossy(line);
        if let Some(keyword) = text.strip_prefix('*') {
            let place = Place { file: file.clone(), line: i + 1 };
            let keyword = keyword.trim().to_uppercase();
            if keyword == "END" {
                break;
            }
            if keyword.starts_with("KEYWORD") {
                format = deck_format(&keyword, &place)?.unwrap_or(format);
            }
            // LS-PrePost writes a remark beside some: (ten nodes format)
            let (keyword, _) = keyword.split_once('(').unwrap_or((&keyword, ""));
            let (name, format) = marked(keyword.trim_end(), format);
            let name = name.to_owned();
            cards.push(Card { name, place, format, data: Vec::new(), parameters: &NO_PARAMETERS });
            continue;
        }
        match cards.last_mut() {
            Some(card) => card.data.push((i + 1, text)),
            None if text.trim().is_empty() => {}
            None => {
                let place = Place { file: file.clone(), line: i + 1 };
                return Err(syntax(&place, "a keyword that starts with * is expected"));
            }
        }
    }
    Ok(cards)
}

/// The format that `*KEYWORD` gives to all cards after it, if it gives one.
fn deck_format(keyword: &str, place: &Place) -> Result<Option<Format>, DeckError> {
    let words = keyword.replace(" =", "=").replace("= ", "=");
    let mut format = None;
    for word in words.split([' ', ',']) {
        match word.split_once('=') {
            Some(("LONG", "Y")) => format = Some(Format::Long),
            // standard input; S is about what LS-DYNA writes
            Some(("LONG", "S")) if format.is_none() => format = Some(Format::Standard),
            Some(("LONG", "S")) => {}
            Some(("LONG", other)) => {
                let what = format!("*KEYWORD with LONG={other}");
                return Err(unsupported(place, what, "use LONG=Y for the long format"));
            }
            Some(("I10", "Y")) => format = Some(Format::I10),
            _ => {}
        }
    }
    Ok(format)
}

/// A keyword without the mark of its format, and that format.
fn marked(keyword: &str, format: Format) -> (&str, Format) {
    let marks = [('+', Format::Long), ('-', Format::Standard), ('%', Format::I10)];
    let found = marks.into_iter().find_map(|(mark, format)| {
        keyword.strip_suffix(mark).map(|name| (name.trim_end(), format))
    });
    found.unwrap_or((keyword, format))
}

/// Keywords whose cards repeat under one keyword, each with its own line of `_TITLE` or `_ID`.
const REPEATED: [&str; 7] = [
    "MAT_ELASTIC",
    "MAT_001",
    "SECTION_SOLID",
    "HOURGLASS",
    "BOUNDARY_SPC_SET",
    "BOUNDARY_SPC_NODE",
    "BOUNDARY_PRESCRIBED_MOTION_RIGID",
];

impl<'a> Card<'a> {
    /// The card without the option `_TITLE` or `_ID` and the lines that it adds.
    pub(super) fn without_headings(mut self) -> Self {
        let bare = self.name.strip_suffix("_TITLE").or_else(|| self.name.strip_suffix("_ID"));
        let Some(bare) = bare.map(str::to_owned) else { return self };
        if REPEATED.contains(&bare.as_str()) {
            let mut heading = false;
            self.data.retain(|_| {
                heading = !heading;
                !heading
            });
        } else if !self.data.is_empty() {
            self.data.remove(0);
        }
        Self { name: bare, ..self }
    }

    /// The card, whose fields may name these parameters.
    pub(super) fn with(self, parameters: &'a Parameters) -> Self {
        Self { parameters, ..self }
    }

    /// All data lines.
    pub(super) fn all_lines(&self) -> impl Iterator<Item = Line<'_>> {
        self.data.iter().map(|(at, text)| Line { card: self, at: *at, text })
    }

    /// The data lines that are not blank.
    pub(super) fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        self.all_lines().filter(|line| !line.text.trim().is_empty())
    }

    /// The data lines after the first that are not blank.
    pub(super) fn further_lines(&self) -> impl Iterator<Item = Line<'_>> {
        self.all_lines().skip(1).filter(|line| !line.text.trim().is_empty())
    }

    /// Data line `i`, counted from 0.
    pub(super) fn line(&self, i: usize) -> Result<Line<'_>, DeckError> {
        let missing =
            || syntax(&self.place, format!("data line {} of *{} is missing", i + 1, self.name));
        self.all_lines().nth(i).ok_or_else(missing)
    }
}

/// The usual columns: eight fields of ten.
pub(super) const TENS: [usize; 8] = [10; 8];

/// A data line of a card.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    card: &'a Card<'a>,
    at: usize,
    pub(super) text: &'a str,
}

impl<'a> Line<'a> {
    pub(super) fn place(&self) -> Place {
        Place { file: self.card.place.file.clone(), line: self.at }
    }

    /// The fields, by commas if there are any, or else by columns: of these widths in the standard format.
    pub(super) fn fields(self, widths: &[usize]) -> Fields<'a> {
        let words = if self.text.contains(',') {
            self.text.split(',').map(str::trim).collect()
        } else {
            let mut rest = self.text;
            let cut = |&width: &usize| {
                let width = match (self.card.format, width) {
                    (Format::Long, _) => 20,
                    (Format::I10, 8) => 10,
                    _ => width,
                };
                let end = rest.char_indices().nth(width).map_or(rest.len(), |(end, _)| end);
                let (field, after) = rest.split_at(end);
                rest = after;
                field.trim()
            };
            widths.iter().map(cut).collect()
        };
        Fields { line: self, words }
    }
}

/// The fields of a data line.
pub(super) struct Fields<'a> {
    line: Line<'a>,
    words: Vec<&'a str>,
}

impl<'a> Fields<'a> {
    /// Field `i`, counted from 0, as it stands; empty where it is blank.
    pub(super) fn word(&self, i: usize) -> &'a str {
        self.words.get(i).copied().unwrap_or_default()
    }

    pub(super) fn place(&self) -> Place {
        self.line.place()
    }

    /// Field `i`, counted from 0, as a number; `default` where it is blank.
    pub(super) fn real(&self, i: usize, default: f64) -> Result<f64, DeckError> {
        match self.word(i) {
            "" => Ok(default),
            word => {
                number(word, self.line.card.parameters).map_err(|fault| fault.at(&self.place()))
            }
        }
    }

    /// Field `i` as a whole number; 0 where it is blank.
    pub(super) fn whole(&self, i: usize) -> Result<i64, DeckError> {
        let x = self.real(i, 0.0)?;
        if x.fract() != 0.0 || x.abs() > 1e15 {
            return Err(syntax(&self.place(), format!("a whole number is expected, found {x}")));
        }
        Ok(x as i64)
    }

    /// Field `i` as the number of something; 0 where it is blank.
    pub(super) fn id(&self, i: usize) -> Result<u64, DeckError> {
        let n = self.whole(i)?;
        u64::try_from(n)
            .map_err(|_| syntax(&self.place(), format!("a number from 1 is expected, found {n}")))
    }

    /// Refuses the line where one of `fields`, by index and name, is neither blank nor 0.
    pub(super) fn unused(&self, keyword: &str, fields: &[(usize, &str)]) -> Result<(), DeckError> {
        for &(i, name) in fields {
            let x = self.real(i, 0.0)?;
            if x != 0.0 {
                let what = format!("*{keyword} with {name} = {x}");
                return Err(unsupported(&self.place(), what, "leave the field blank or 0"));
            }
        }
        Ok(())
    }
}

/// A field as a number: the value of a parameter (`&name`, `-&name`), or what stands there.
pub(super) fn number(word: &str, parameters: &Parameters) -> Result<f64, Fault> {
    if let Some(name) = word.strip_prefix('&') {
        return parameters.value(name);
    }
    if let Some(name) = word.strip_prefix("-&") {
        return Ok(-parameters.value(name)?);
    }
    // 1.0+5 and 1d5 are numbers in Fortran
    let mut number = word.to_lowercase().replace('d', "e");
    if let Some(sign) = number.rfind(['+', '-']).filter(|&s| s > 0 && !number.contains('e')) {
        number.insert(sign, 'e');
    }
    let value = number.parse().ok().filter(|x: &f64| x.is_finite());
    value.ok_or_else(|| Fault::Syntax { what: format!("a number is expected, found `{word}`") })
}
