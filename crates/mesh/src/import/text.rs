//! Words, numbers and lines of a text file.

use super::error::{Fault, ImportError};
use std::borrow::Cow;
use std::str::FromStr;

/// A text that is read from beginning to end, by lines or by words.
#[derive(Default)]
pub(super) struct Text<'a> {
    /// The text after the current line.
    rest: &'a str,
    /// What is left of the current line.
    rest_of_line: &'a str,
    /// Number of the current line, counted from 1; 0 before the first.
    pub(super) line: usize,
}

impl<'a> Text<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text.strip_prefix('\u{feff}').unwrap_or(text), rest_of_line: "", line: 0 }
    }

    /// The next line, trimmed; what is left of the current one is dropped.
    pub(super) fn next_line(&mut self) -> Option<&'a str> {
        if self.rest.is_empty() {
            return None;
        }
        let (line, rest) = self.rest.split_once('\n').unwrap_or((self.rest, ""));
        (self.rest, self.rest_of_line) = (rest, "");
        self.line += 1;
        Some(line.trim())
    }

    /// The next word, on this line or a later one.
    pub(super) fn word(&mut self) -> Option<&'a str> {
        loop {
            let line = self.rest_of_line.trim_start();
            if !line.is_empty() {
                let end = line.find(char::is_whitespace).unwrap_or(line.len());
                let (word, rest) = line.split_at(end);
                self.rest_of_line = rest;
                return Some(word);
            }
            self.rest_of_line = self.next_line()?;
        }
    }

    /// The next word as a number; `what` says in the error what was expected.
    pub(super) fn number<T: FromStr>(&mut self, what: &str) -> Result<T, ImportError> {
        match self.word() {
            Some(word) => number(word, what).map_err(|fault| fault.at(self.line)),
            None => Err(self.ends(what)),
        }
    }

    /// The error of a file that ends where `what` is expected.
    pub(super) fn ends(&self, what: &str) -> ImportError {
        Fault::Syntax { what: format!("the file ends where {what} is expected") }.at(self.line)
    }
}

/// Bytes as text: a line that is not UTF-8, such as a comment or a heading of an older program, is in Latin-1.
pub(super) fn decoded(bytes: &[u8]) -> Result<Cow<'_, str>, ImportError> {
    // a mark, or the zero of a letter of ASCII
    if matches!(bytes, [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, _, ..] | [_, 0, ..]) {
        let (what, remedy) = ("a text in UTF-16".into(), "save the file as UTF-8");
        return Err(Fault::Unsupported { what, remedy }.at(1));
    }
    Ok(match str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => bytes.split_inclusive(|&b| b == b'\n').map(line).collect::<String>().into(),
    })
}

/// The text of a line in UTF-8, or else in Latin-1, where each byte is the character of its number.
pub(super) fn line(bytes: &[u8]) -> Cow<'_, str> {
    match str::from_utf8(bytes) {
        Ok(text) => text.into(),
        Err(_) => bytes.iter().copied().map(char::from).collect(),
    }
}

/// A word as a number; `what` says in the error what was expected.
pub(super) fn number<T: FromStr>(word: &str, what: &str) -> Result<T, Fault> {
    word.parse().map_err(|_| {
        let word: String = word.chars().take(40).collect();
        Fault::Syntax { what: format!("{what} is expected, found `{word}`") }
    })
}
