//! Words, numbers and lines of a text file.

use super::error::{Fault, ImportError};
use std::str::FromStr;

/// A text that is read from its beginning to its end, by lines or by words.
#[derive(Default)]
pub(super) struct Text<'a> {
    /// What follows the line begun.
    rest: &'a str,
    /// What is left of the line begun.
    open: &'a str,
    /// Number of the line begun; 0 before the first.
    pub(super) line: usize,
}

impl<'a> Text<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Result<Self, ImportError> {
        let rest = utf8(bytes)?;
        Ok(Self { rest: rest.strip_prefix('\u{feff}').unwrap_or(rest), open: "", line: 0 })
    }

    /// The next line, without blanks at its ends; what is left of the one begun is dropped.
    pub(super) fn next_line(&mut self) -> Option<&'a str> {
        if self.rest.is_empty() {
            return None;
        }
        let (line, rest) = self.rest.split_once('\n').unwrap_or((self.rest, ""));
        (self.rest, self.open) = (rest, "");
        self.line += 1;
        Some(line.trim())
    }

    /// The next word, on this line or a later one.
    pub(super) fn word(&mut self) -> Option<&'a str> {
        loop {
            let line = self.open.trim_start();
            if !line.is_empty() {
                let end = line.find(char::is_whitespace).unwrap_or(line.len());
                let (word, open) = line.split_at(end);
                self.open = open;
                return Some(word);
            }
            self.open = self.next_line()?;
        }
    }

    /// The next word as a number.
    pub(super) fn number<T: FromStr>(&mut self, what: &str) -> Result<T, ImportError> {
        match self.word() {
            Some(word) => number(word, what).map_err(|fault| fault.at(self.line)),
            None => Err(self.ends(what)),
        }
    }

    /// The fault of a file that ends too early.
    pub(super) fn ends(&self, what: &str) -> ImportError {
        Fault::Syntax { what: format!("the file ends where {what} is expected") }.at(self.line)
    }
}

/// Bytes as text.
pub(super) fn utf8(bytes: &[u8]) -> Result<&str, ImportError> {
    str::from_utf8(bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|&&b| b == b'\n').count() + 1;
        Fault::Syntax { what: "the line is not UTF-8 text".into() }.at(line)
    })
}

/// A word as a number.
pub(super) fn number<T: FromStr>(word: &str, what: &str) -> Result<T, Fault> {
    word.parse().map_err(|_| {
        let word: String = word.chars().take(40).collect();
        Fault::Syntax { what: format!("{what} is expected, found `{word}`") }
    })
}
