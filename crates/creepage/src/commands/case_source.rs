//! The case that a command computes from, and errors about its keys.

use std::path::{Path, PathBuf};

use crate::case::Case;
use crate::run::RunError;
use serde::Deserialize;

use crate::{Error, Listener};

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
    /// Reads and checks the case, and says its warnings.
    ///
    /// # Errors
    /// What is wrong with the case, with the place where it is written.
    pub fn load(&self, listener: &mut dyn Listener) -> Result<Case, Error> {
        let case = match &self.text {
            Some(text) => Case::from_text(text, &self.path, &self.sets)?,
            None => Case::load(&self.path, &self.sets)?,
        };
        case.warnings().iter().for_each(|warning| listener.remark(&format!("warning: {warning}")));
        Ok(case)
    }

    /// An error about a key of the case, with the line where the key was written.
    pub(crate) fn placed(&self, error: RunError) -> Error {
        let Some(key) = error.key() else { return error.into() };
        let (text, remedy) = (self.text.as_deref(), error.remedy());
        crate::case::error_at_key(&self.path, text, &self.sets, key, &error.to_string(), &remedy)
            .into()
    }
}
