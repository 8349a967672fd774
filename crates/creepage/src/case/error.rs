//! The errors of a case file, with the place in its text.

use std::path::PathBuf;

use miette::{Diagnostic, SourceSpan};
use thiserror::Error;

use crate::case::excerpt::Excerpt;

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
