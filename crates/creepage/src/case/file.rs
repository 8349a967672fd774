//! Where a case or a sweep is read from.

use std::fmt;
use std::path::{Path, PathBuf};

use output::files::input::{self, InputError};

use crate::case::error::CaseError;
use crate::case::reference::{ReferenceCase, did_you_mean};

/// Where a case or a sweep is read from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CaseFile {
    /// A file.
    Disk(PathBuf),
    /// A reference case, which is part of the program.
    Reference(&'static ReferenceCase),
}

impl CaseFile {
    /// What a path of the command line means: the file there, or else the reference case of that name.
    pub fn named(path: &Path) -> Self {
        match ReferenceCase::named(path) {
            Some(reference) if !path.is_file() => Self::Reference(reference),
            _ => Self::Disk(path.to_owned()),
        }
    }

    /// The path of the file, on the disk or in the folder `cases`.
    pub fn path(&self) -> PathBuf {
        match self {
            Self::Disk(path) => path.clone(),
            Self::Reference(reference) => reference.file().into(),
        }
    }

    /// The path of a file on the disk.
    pub fn on_disk(&self) -> Option<&PathBuf> {
        match self {
            Self::Disk(path) => Some(path),
            Self::Reference(_) => None,
        }
    }

    /// The file at `path`, relative to this one; beside a reference case another one.
    pub fn beside(&self, path: &str) -> Self {
        match self {
            Self::Disk(file) => Self::Disk(file.parent().unwrap_or(Path::new("")).join(path)),
            Self::Reference(reference) => {
                reference.beside(path).map_or_else(|| Self::Disk(path.into()), Self::Reference)
            }
        }
    }

    /// The same file by its only name.
    pub(crate) fn canonical(&self) -> Self {
        match self {
            Self::Disk(path) => Self::Disk(path.canonicalize().unwrap_or_else(|_| path.clone())),
            Self::Reference(_) => self.clone(),
        }
    }

    /// Its text.
    pub(crate) fn text(&self) -> Result<String, InputError> {
        match self {
            Self::Disk(path) => input::text(path, input::CASE),
            Self::Reference(reference) => Ok(reference.text.to_owned()),
        }
    }

    /// The text of the file that a command is given.
    ///
    /// # Errors
    /// A file that is missing, too large, or not UTF-8.
    pub(crate) fn first_text(&self) -> Result<String, CaseError> {
        self.text().map_err(|error| {
            let path = self.path();
            let meant = did_you_mean(&path).filter(|_| error.is_missing());
            let remedy = meant.map_or_else(String::new, |meant| format!("; {meant}"));
            CaseError::File { problem: error.problem(), remedy: error.remedy() + &remedy, path }
        })
    }
}

impl fmt::Display for CaseFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Disk(path) => write!(f, "{}", path.display()),
            Self::Reference(reference) => write!(f, "{} (reference case)", reference.file()),
        }
    }
}
