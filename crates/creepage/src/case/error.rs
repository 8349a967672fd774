//! The errors of a case file, with the place in its text.

use std::path::PathBuf;

use miette::{Diagnostic, MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use output::files::Line;
use thiserror::Error;

/// Why a case could not be loaded.
#[derive(Debug, Error, Diagnostic)]
pub enum CaseError {
    /// A file that cannot be read at all.
    #[error("{}: {problem}", output::files::printable(&path.display().to_string()))]
    #[diagnostic(help("{remedy}"))]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
        /// What to do.
        remedy: String,
    },
    /// Something wrong at one place, or at several, of a file or of `--set`.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Key(#[from] Box<KeyError>),
}

/// One thing wrong at a place of a case file, with the others found in the same reading.
#[derive(Debug, Error, Diagnostic)]
#[error("{message}")]
pub struct KeyError {
    /// Place, key, value and allowed range in one sentence.
    pub message: String,
    /// The key, dotted; empty for malformed TOML.
    pub key: String,
    #[source_code]
    pub(crate) source_code: Option<Excerpt>,
    #[label("{label}")]
    pub(crate) span: Option<SourceSpan>,
    pub(crate) label: String,
    /// What to do.
    #[help]
    pub help: Option<String>,
    /// Further problems of the same reading, each without `others` of its own.
    #[related]
    pub others: Vec<KeyError>,
}

impl From<KeyError> for CaseError {
    fn from(error: KeyError) -> Self {
        Self::Key(Box::new(error))
    }
}

/// The errors as one, if there are any.
///
/// # Errors
/// The first of `errors`, with the rest in [`KeyError::others`].
pub fn raise(errors: Vec<KeyError>) -> Result<(), CaseError> {
    let mut errors = errors.into_iter();
    match errors.next() {
        Some(first) => Err(KeyError { others: errors.collect(), ..first }.into()),
        None => Ok(()),
    }
}

/// A line of a file: a message has no more of it to show.
#[derive(Clone, Debug)]
pub struct Excerpt {
    name: String,
    line: Line,
}

impl Excerpt {
    /// The line of `text` in which `span` (bytes of `text`) begins, and the part of that line to point at (bytes
    /// of the line); none where the line is too long to be shown. `name` is that of the text.
    pub fn of(name: &str, text: &str, span: std::ops::Range<usize>) -> Option<(Self, SourceSpan)> {
        let line = output::files::line_of(text, span)?;
        let at = SourceSpan::new(line.span.start.into(), line.span.len());
        Some((Self { name: output::files::printable(name), line }, at))
    }
}

impl SourceCode for Excerpt {
    /// The line whole, whatever is asked for.
    fn read_span<'a>(
        &'a self,
        _: &SourceSpan,
        _: usize,
        _: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let text = self.line.text.as_bytes();
        let whole = SourceSpan::new(0.into(), text.len());
        let (name, line) = (self.name.clone(), self.line.number - 1);
        let column = self.line.text[..self.line.span.start].chars().count();
        Ok(Box::new(MietteSpanContents::new_named(name, text, whole, line, column, 1)))
    }
}
