//! The values of an MSH file one after another: words of a text, or numbers in binary form.

use super::super::error::{Fault, ImportError, Place};
use super::super::text::{Text, line, number};
use std::borrow::Cow;

/// An MSH file that is read from beginning to end.
pub(super) enum Values<'a> {
    Text(Text<'a>),
    Binary(Binary<'a>),
}

/// Whether a file is binary, by its first lines, which are text.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    let mut lines = bytes[..bytes.len().min(200)].split(|&b| b == b'\n');
    lines.next().is_some_and(|l| l.trim_ascii() == b"$MeshFormat")
        && lines
            .next()
            .and_then(|l| str::from_utf8(l).ok())
            .is_some_and(|l| l.split_whitespace().nth(1) == Some("1"))
}

/// A binary MSH file: its sections begin and end with lines of text, and hold numbers between them.
pub(super) struct Binary<'a> {
    bytes: &'a [u8],
    /// Where the next value begins.
    next: usize,
    /// Where the value that was read last begins.
    last: usize,
    big_endian: bool,
}

impl<'a> Values<'a> {
    pub(super) fn text(text: &'a str) -> Self {
        Self::Text(Text::new(text))
    }

    pub(super) fn binary(bytes: &'a [u8]) -> Self {
        Self::Binary(Binary { bytes, next: 0, last: 0, big_endian: false })
    }

    /// Where the value that was read last stands.
    pub(super) fn place(&self) -> Place {
        match self {
            Self::Text(text) => Place::Line(text.line),
            Self::Binary(binary) => Place::Byte(binary.last),
        }
    }

    /// The error that `what` is expected where the value that was read last stands.
    pub(super) fn syntax(&self, what: &str) -> ImportError {
        Fault::Syntax { what: what.into() }.at(self.place())
    }

    /// The error of a file that ends where `what` is expected.
    pub(super) fn ends(&self, what: &str) -> ImportError {
        match self {
            Self::Text(text) => text.ends(what),
            Self::Binary(binary) => binary.ends(what),
        }
    }

    /// The next line of text, trimmed; `None` at the end of the file.
    pub(super) fn next_line(&mut self) -> Result<Option<&'a str>, ImportError> {
        match self {
            Self::Text(text) => Ok(text.next_line()),
            Self::Binary(binary) => binary.next_line(),
        }
    }

    /// The next line, which holds a name; `None` at the end of the file.
    pub(super) fn named_line(&mut self) -> Option<Cow<'a, str>> {
        match self {
            Self::Text(text) => text.next_line().map(Cow::Borrowed),
            Self::Binary(binary) => binary.bytes_of_line().map(line),
        }
    }

    /// The next word of text, on this line or a later one; `None` at the end of the file.
    pub(super) fn word(&mut self) -> Result<Option<&'a str>, ImportError> {
        match self {
            Self::Text(text) => Ok(text.word()),
            Self::Binary(binary) => binary.word(),
        }
    }

    /// Passes over everything up to the words `end`, and over them.
    pub(super) fn skip(&mut self, end: &str) -> Result<(), ImportError> {
        match self {
            Self::Text(text) => {
                while let Some(line) = text.next_line() {
                    if line == end {
                        return Ok(());
                    }
                }
                Err(text.ends(end))
            }
            Self::Binary(binary) => binary.skip(end),
        }
    }

    /// Whether the file is binary.
    pub(super) fn are_binary(&self) -> bool {
        matches!(self, Self::Binary(_))
    }

    /// Reads the number that tells the order of the bytes of a binary file.
    pub(super) fn byte_order(&mut self) -> Result<(), ImportError> {
        let Self::Binary(binary) = self else { return Ok(()) };
        let what = "the number 1 in four bytes, which tells the order of bytes,";
        binary.big_endian = match binary.take(what)? {
            [1, 0, 0, 0] => false,
            [0, 0, 0, 1] => true,
            other => {
                let what = format!("{what} is expected, found {other:?}");
                return Err(Fault::Syntax { what }.at(Place::Byte(binary.last)));
            }
        };
        Ok(())
    }

    /// A number that stands as text in binary files too, by itself on a line there.
    pub(super) fn written(&mut self, what: &str) -> Result<u64, ImportError> {
        match self {
            Self::Text(text) => text.number(what),
            Self::Binary(binary) => {
                let line = binary.next_line()?.ok_or_else(|| binary.ends(what))?;
                number(line, what).map_err(|fault| fault.at(Place::Byte(binary.last)))
            }
        }
    }

    /// A count or the number of a node or element of format 4.1: 8 bytes.
    pub(super) fn size(&mut self, what: &str) -> Result<u64, ImportError> {
        match self {
            Self::Text(text) => text.number(what),
            Self::Binary(binary) => binary.word_of(what).map(u64::from_le_bytes),
        }
    }

    /// A whole number: 4 bytes.
    pub(super) fn int(&mut self, what: &str) -> Result<i64, ImportError> {
        match self {
            Self::Text(text) => text.number(what),
            Self::Binary(binary) => Ok(i64::from(i32::from_le_bytes(binary.word_of(what)?))),
        }
    }

    /// A whole number that `N` can hold, such as one from 0 for an unsigned type.
    pub(super) fn small<N: TryFrom<i64>>(&mut self, what: &str) -> Result<N, ImportError> {
        let found = self.int(what)?;
        N::try_from(found).map_err(|_| self.syntax(&format!("{what} is expected, found `{found}`")))
    }

    /// A coordinate or the like: 8 bytes.
    pub(super) fn real(&mut self, what: &str) -> Result<f64, ImportError> {
        match self {
            Self::Text(text) => text.number(what),
            Self::Binary(binary) => binary.word_of(what).map(f64::from_le_bytes),
        }
    }
}

impl<'a> Binary<'a> {
    fn ends(&self, what: &str) -> ImportError {
        let what = format!("the file ends where {what} is expected");
        Fault::Syntax { what }.at(Place::Byte(self.bytes.len()))
    }

    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.next..]
    }

    /// The next bytes as they stand.
    fn take<const N: usize>(&mut self, what: &str) -> Result<[u8; N], ImportError> {
        let found = self.rest().first_chunk().ok_or_else(|| self.ends(what))?;
        (self.last, self.next) = (self.next, self.next + N);
        Ok(*found)
    }

    /// The next bytes of a number, from the least significant.
    fn word_of<const N: usize>(&mut self, what: &str) -> Result<[u8; N], ImportError> {
        let mut word = self.take(what)?;
        if self.big_endian {
            word.reverse();
        }
        Ok(word)
    }

    /// The next `length` bytes, and `after` bytes passed over after them.
    fn pass(&mut self, length: usize, after: usize) -> &'a [u8] {
        let (bytes, _) = self.rest().split_at(length);
        (self.last, self.next) = (self.next, self.next + length + after);
        bytes
    }

    fn text(&self, bytes: &'a [u8]) -> Result<&'a str, ImportError> {
        str::from_utf8(bytes).map(str::trim).map_err(|_| {
            let what = "a line of text is expected: numbers before it are too many or too few";
            Fault::Syntax { what: what.into() }.at(Place::Byte(self.last))
        })
    }

    fn bytes_of_line(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest();
        match rest.iter().position(|&b| b == b'\n') {
            Some(length) => Some(self.pass(length, 1)),
            None if rest.is_empty() => None,
            None => Some(self.pass(rest.len(), 0)),
        }
    }

    fn next_line(&mut self) -> Result<Option<&'a str>, ImportError> {
        self.bytes_of_line().map(|bytes| self.text(bytes)).transpose()
    }

    fn word(&mut self) -> Result<Option<&'a str>, ImportError> {
        let white = self.rest().iter().take_while(|b| b.is_ascii_whitespace()).count();
        self.next += white;
        let length = self.rest().iter().take_while(|b| !b.is_ascii_whitespace()).count();
        if length == 0 {
            return Ok(None);
        }
        let bytes = self.pass(length, 0);
        self.text(bytes).map(Some)
    }

    fn skip(&mut self, end: &str) -> Result<(), ImportError> {
        let found = self.rest().windows(end.len()).position(|bytes| bytes == end.as_bytes());
        self.next += found.ok_or_else(|| self.ends(end))? + end.len();
        Ok(())
    }
}
