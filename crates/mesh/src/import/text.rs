//! Words, numbers and lines of a text file.

use super::error::{Fault, ImportError};
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
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self, ImportError> {
        let rest = utf8(bytes)?;
        Ok(Self { rest: rest.strip_prefix('\u{feff}').unwrap_or(rest), rest_of_line: "", line: 0 })
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

/// Bytes as UTF-8 text, or the error at the first line that is none.
pub(super) fn utf8(bytes: &[u8]) -> Result<&str, ImportError> {
    str::from_utf8(bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|&&b| b == b'\n').count() + 1;
        Fault::Syntax { what: "the line is not UTF-8 text".into() }.at(line)
    })
}

/// A word as a number; `what` says in the error what was expected.
pub(super) fn number<T: FromStr>(word: &str, what: &str) -> Result<T, Fault> {
    word.parse().map_err(|_| {
        let word: String = word.chars().take(40).collect();
        Fault::Syntax { what: format!("{what} is expected, found `{word}`") }
    })
}
