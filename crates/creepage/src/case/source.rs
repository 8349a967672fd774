//! Where a case comes from.

use std::path::{Path, PathBuf};

use crate::case::{Case, CaseError};
use serde::Deserialize;

/// A case: a file, and what is laid over it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CaseSource {
    /// The case file
    #[cfg_attr(feature = "clap", arg(value_name = "CASE.toml"))]
    pub path: PathBuf,
    /// Set a key of the case, for example mesh.zone.size=2e-3; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "set", value_name = "KEY=VALUE"))]
    pub sets: Vec<String>,
    /// The text of the case, where it is not in a file; `path` then only names it.
    #[cfg_attr(feature = "clap", arg(skip))]
    pub text: Option<String>,
}

impl<P: AsRef<Path>> From<P> for CaseSource {
    /// The case of a file, as it is.
    fn from(path: P) -> Self {
        Self { path: path.as_ref().to_owned(), ..Self::default() }
    }
}

impl CaseSource {
    /// Reads and checks the case.
    ///
    /// # Errors
    /// What is wrong with the case, with the place where it is written.
    pub fn read(&self) -> Result<Case, CaseError> {
        match &self.text {
            Some(text) => Case::from_text(text, &self.path, &self.sets),
            None => Case::load(&self.path, &self.sets),
        }
    }
}
