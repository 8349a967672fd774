//! The cards of a keyword file: keywords, and data in columns or between commas.
//!
//! Source: LS-DYNA Keyword User's Manual, vol. I, "Getting started: description of keyword input".
//!
//! Read here, since no library for this format was found.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use crate::ls_dyna::error::{DeckError, DeckLine, Fault, syntax, unsupported};
use crate::ls_dyna::fields::{Field, Layout, Role, Taken, zero};
use crate::ls_dyna::parameters::{NO_PARAMETERS, Parameters};

/// A keyword with its data.
#[derive(Clone, Debug)]
pub(super) struct Card<'a> {
    /// The keyword in capitals, without its asterisk, the mark of its format, and the options `_TITLE` and `_ID`.
    pub(super) name: String,
    pub(super) place: DeckLine,
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

/// The name that stands for what follows `*END`.
pub(super) const AFTER_END: &str = "END";

/// Cuts a keyword file into its cards, up to `*END`; where keywords follow that, the last card is [`AFTER_END`] at the
/// first of them. `format` is that of the cards without a mark of their own.
pub(super) fn cards<'a>(
    bytes: &'a [u8],
    file: &Arc<Path>,
    mut format: Format,
) -> Result<Vec<Card<'a>>, DeckError> {
    let mut cards: Vec<Card> = Vec::new();
    let at = |line| DeckLine { file: file.clone(), line };
    let bytes = without_mark(bytes, &at(1))?;
    // lines of old Macs end with a carriage return alone
    let line_end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut ended = false;
    for (i, line) in bytes.split(|&b| b == line_end).enumerate() {
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        // a comment may hold anything
        if line.first() == Some(&b'$') {
            continue;
        }
        // headings are written in any encoding; a number with a letter of one is none
        let text = String::from_utf8_lossy(line);
        if ended && !text.starts_with('*') {
            continue;
        }
        let place = at(i + 1);
        if let Some(keyword) = text.strip_prefix('*') {
            let keyword = keyword.trim().to_uppercase();
            // LS-PrePost writes a remark beside some: (ten nodes format)
            let (keyword, _) = keyword.split_once('(').unwrap_or((&keyword, ""));
            let card = |name: &str, format| Card {
                name: name.to_owned(),
                place: place.clone(),
                format,
                data: Vec::new(),
                parameters: &NO_PARAMETERS,
            };
            if keyword == "END" {
                ended = true;
                continue;
            }
            if ended {
                cards.push(card(AFTER_END, format));
                break;
            }
            if keyword.starts_with("KEYWORD") {
                format = deck_format(keyword, &place)?.unwrap_or(format);
            }
            let (name, of_card) = marked(keyword.trim_end(), format);
            cards.push(card(name, of_card));
            continue;
        }
        if let Some(keyword) = late_keyword(&text) {
            let what = format!("`{keyword}`, a keyword that does not begin in column 1,");
            let remedy = "take out what stands before the asterisk: LS-DYNA would read the line as data of the card before";
            return Err(unsupported(&place, what, remedy));
        }
        match cards.last_mut() {
            Some(card) => card.data.push((i + 1, text)),
            None if text.trim().is_empty() => {}
            None => return Err(syntax(&place, "a keyword that starts with * is expected")),
        }
    }
    Ok(cards)
}

/// The text after the byte order mark of UTF-8, if there is one.
fn without_mark<'a>(bytes: &'a [u8], first: &DeckLine) -> Result<&'a [u8], DeckError> {
    // a letter of an 8-bit encoding has no zero byte beside it
    let wide = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
    if wide || bytes.iter().take(4).any(|byte| *byte == 0) {
        let remedy = "save it as UTF-8 or in an 8-bit encoding, such as Latin-1";
        return Err(unsupported(first, "text in UTF-16 or UTF-32", remedy));
    }
    Ok(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))
}

/// The keyword of a line that has blanks, or characters that look like none, in front of it.
fn late_keyword(text: &str) -> Option<&str> {
    let shown = text.trim_start_matches(|c: char| !c.is_ascii_graphic()).trim_end();
    let name = shown.strip_prefix('*')?.trim_start();
    name.starts_with(|c: char| c.is_ascii_alphabetic()).then_some(shown)
}

/// The format that `*KEYWORD` gives to all cards after it, if it gives one.
fn deck_format(keyword: &str, place: &DeckLine) -> Result<Option<Format>, DeckError> {
    let words = keyword.replace(" =", "=").replace("= ", "=");
    let mut words = words.split([' ', ',']).filter(|word| !word.is_empty());
    let mut format = None;
    let name = words.next().unwrap_or_default();
    if !matches!(name.trim_end_matches(['+', '-', '%']), "KEYWORD" | "KEYWORD_ID") {
        return Err(unsupported(place, format!("*{name}"), "begin the deck with *KEYWORD"));
    }
    for word in words {
        let refused = |remedy| Err(unsupported(place, format!("*KEYWORD with {word}"), remedy));
        match word.split_once('=') {
            Some(("LONG", "Y")) => format = Some(Format::Long),
            // standard input; S is about what LS-DYNA writes
            Some(("LONG", "S")) if format.is_none() => format = Some(Format::Standard),
            Some(("LONG", "S")) => {}
            Some(("LONG", _)) => return refused("use LONG=Y for the long format"),
            Some(("I10", "Y")) => format = Some(Format::I10),
            Some(("I10", "N") | ("MEMORY" | "MEMORY2" | "NCPU", _)) => {}
            // the memory that LS-DYNA is to take, such as 100M
            None if word.starts_with(|c: char| c.is_ascii_digit()) => {}
            _ => return refused("leave the word out, or use LONG=Y, I10=Y"),
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

/// Keywords with one card, to which `_TITLE` or `_ID` adds a line.
const HEADED: [&str; 14] = [
    "CONSTRAINED_NODAL_RIGID_BODY",
    "CONSTRAINED_NODAL_RIGID_BODY_INERTIA",
    "CONTACT_AUTOMATIC_ONE_WAY_SURFACE_TO_SURFACE",
    "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE",
    "CONTACT_AUTOMATIC_SURFACE_TO_SURFACE_MORTAR",
    "CONTACT_ONE_WAY_SURFACE_TO_SURFACE",
    "CONTACT_SURFACE_TO_SURFACE",
    "DEFINE_CURVE",
    "KEYWORD",
    "SET_NODE",
    "SET_NODE_LIST",
    "SET_PART",
    "SET_PART_LIST",
    "SET_SEGMENT",
];

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
        } else if !HEADED.contains(&bare.as_str()) {
            return self;
        } else if !self.data.is_empty() {
            self.data.remove(0);
        }
        Self { name: bare, ..self }
    }

    /// The card, whose fields may name these parameters.
    pub(super) fn with(self, parameters: &'a Parameters) -> Self {
        Self { parameters, ..self }
    }

    /// Whether the card is about the file itself, and was read with it.
    pub(super) fn is_of_the_file(&self) -> Result<bool, DeckError> {
        if self.name.starts_with("KEYWORD") {
            self.ends_after(0)?;
            return Ok(true);
        }
        Ok(matches!(&*self.name, "INCLUDE" | "PARAMETER"))
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

    /// Data line `i`, counted from 0; a blank one where the card ends before it.
    pub(super) fn line_or_blank(&self, i: usize) -> Line<'_> {
        let blank = Line { card: self, at: self.place.line, text: "" };
        self.all_lines().nth(i).unwrap_or(blank)
    }

    /// Refuses data lines after the first `count`.
    pub(super) fn ends_after(&self, count: usize) -> Result<(), DeckError> {
        let mut further = self.all_lines().skip(count);
        let Some(line) = further.find(|line| !line.text.trim().is_empty()) else { return Ok(()) };
        let what = format!("data line {} of *{}", count + 1, self.name);
        Err(unsupported(&line.place(), what, "leave the line out, or give it to its own card"))
    }
}

/// A data line of a card.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    card: &'a Card<'a>,
    at: usize,
    pub(super) text: &'a str,
}

impl<'a> Line<'a> {
    pub(super) fn place(&self) -> DeckLine {
        DeckLine { file: self.card.place.file.clone(), line: self.at }
    }

    /// The numbers of the fields that a case takes, in their order.
    ///
    /// # Errors
    /// A number that is none; a field that is not taken and neither blank nor at its default; text after the last field.
    pub(super) fn take<const N: usize>(self, layout: &Layout<N>) -> Result<[f64; N], DeckError> {
        let width = |field: &Field| match (self.card.format, field.width) {
            (Format::Long, _) => 20,
            (Format::I10, 8) => 10,
            (_, width) => width,
        };
        let read = if self.card.format == Format::Long { 160 } else { 80 };
        let mut rest = self.within(read.max(layout.0.iter().map(width).sum()))?;
        let commas = rest.contains(',');
        if !commas && rest.trim_end().contains('\t') {
            let what = "a tab between columns: write blanks, or put commas between the fields";
            return Err(syntax(&self.place(), what));
        }
        let mut taken = [0.0; N];
        let mut next = taken.iter_mut();
        for field in layout.0 {
            let (word, after) = match rest.split_once(',') {
                Some(at_comma) if commas => at_comma,
                None if commas => (rest, ""),
                _ => split_at_column(rest, width(field)),
            };
            rest = after;
            let value = self.value(field, word.trim_matches([' ', '\t']))?;
            if let (Some(value), Some(place)) = (value, value.and_then(|_| next.next())) {
                *place = value;
            }
        }
        let mut further = rest.split([',', ' ']).filter(|word| !word.trim().is_empty());
        if further.any(|word| self.number(word).ok() != Some(0.0)) {
            let last = layout.0.last().map_or("", |field| field.name);
            let name = &self.card.name;
            let what = format!(
                "`{}` stands after the last field of *{name}, {last}; a remark begins with $ on a line of its own",
                rest.trim()
            );
            return Err(syntax(&self.place(), what));
        }
        Ok(taken)
    }

    /// The value of a field where a case takes it.
    fn value(&self, field: &Field, word: &str) -> Result<Option<f64>, DeckError> {
        let number = |word: &str| self.number(word).map_err(|fault| fault.at(&self.place()));
        let whole = |word: &str, least: f64| match number(word)? {
            x if x.fract() == 0.0 && x >= least && x <= LARGEST => Ok(x),
            x => {
                let what = if least == 0.0 { "a number from 1" } else { "a whole number" };
                let what = format!("{} = {x}: {what} is expected", field.name);
                Err(syntax(&self.place(), what))
            }
        };
        let refused = |value: &str, allowed: String| {
            let what = format!("{} with {} = {value}", self.card.name, field.name);
            Err(Fault::Field { what, allowed }.at(&self.place()))
        };
        match field.role {
            Role::Idle => Ok(None),
            Role::Rests(_) | Role::Says(_) if word.is_empty() => Ok(None),
            Role::Says(words) if words.contains(&&*word.to_uppercase()) => Ok(None),
            Role::Says(words) => refused(word, words.join(" or ")),
            Role::Rests(defaults) => match number(word)? {
                x if x == 0.0 || defaults.contains(&x) => Ok(None),
                x => {
                    let allowed: Vec<_> = [0.0]
                        .iter()
                        .chain(defaults)
                        .map(|x| crate::case::value::number(*x))
                        .collect();
                    refused(&crate::case::value::number(x), allowed.join(" or "))
                }
            },
            Role::Taken(kind) => Ok(Some(match (kind, word) {
                (Taken::RealOr(default), "") => default,
                (_, "") => 0.0,
                (Taken::Real, _) => number(word)?,
                (Taken::RealOr(default), _) => match number(word)? {
                    0.0 => default,
                    x => x,
                },
                (Taken::Whole, _) => whole(word, -LARGEST)?,
                (Taken::Number, _) => whole(word, 0.0)?,
            })),
        }
    }

    /// A word of the line as a number: the value of a parameter, or what stands there.
    fn number(&self, word: &str) -> Result<f64, Fault> {
        number(word, self.card.parameters)
    }

    /// The words of a line of names and numbers in columns of ten.
    pub(super) fn words(self) -> Result<Vec<&'a str>, DeckError> {
        let width = if self.card.format == Format::Long { 20 } else { 10 };
        let mut rest = self.within(8 * width)?;
        if rest.contains(',') {
            return Ok(rest.split(',').map(str::trim).collect());
        }
        let cut = |_| {
            let (word, after) = split_at_column(rest, width);
            rest = after;
            word.trim()
        };
        Ok((0..8).map(cut).collect())
    }

    /// Refuses the line where its field `i`, counted from 0, is neither blank nor 0.
    pub(super) fn switched_off(self, i: usize, name: &'static str) -> Result<(), DeckError> {
        let words = self.words()?;
        self.value(&zero(name), words.get(i).copied().unwrap_or_default()).map(|_| ())
    }

    /// What LS-DYNA reads of the line: so many columns. What follows is a remark.
    fn within(self, columns: usize) -> Result<&'a str, DeckError> {
        let (text, beyond) = split_at_column(self.text, columns);
        let of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-');
        let cut_through = text.ends_with(of_number) && beyond.starts_with(of_number);
        let first = beyond.split([',', ' ']).find(|word| !word.is_empty());
        let goes_on = text.contains(',') && first.is_some_and(|word| self.number(word).is_ok());
        if cut_through || goes_on {
            let what = format!("numbers go on past column {columns}, where LS-DYNA stops reading");
            return Err(syntax(&self.place(), what));
        }
        Ok(text)
    }
}

/// The largest whole number of a field: all below it are exact.
const LARGEST: f64 = 1e15;

/// A text before and after a column, in characters.
fn split_at_column(text: &str, column: usize) -> (&str, &str) {
    let end = text.char_indices().nth(column).map_or(text.len(), |(end, _)| end);
    text.split_at(end)
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

/// A number as text, of six significant digits at most.
pub(crate) fn six(x: f64) -> String {
    crate::case::value::number(format!("{x:.5e}").parse().unwrap_or(x))
}
