//! What a verification problem is.

use crate::Row;
use serde::Serialize;
use thiserror::Error;

/// How large a problem is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Coarse meshes, seconds: for continuous integration.
    Quick,
    /// The meshes of the documentation.
    Full,
}

/// A verification problem.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Problem {
    /// Name on the command line, unique.
    pub name: &'static str,
    /// What it verifies, in one sentence.
    pub about: &'static str,
    #[serde(skip)]
    pub(crate) run: fn(Size) -> Outcome,
}

/// The error of a solver.
pub type Cause = Box<dyn std::error::Error + Send + Sync>;

/// Why a problem could not be run to its end.
#[derive(Debug, Error)]
#[error("verification problem '{name}': {cause}")]
pub struct VerifyError {
    /// The name of the problem.
    pub name: &'static str,
    /// The error of the solver.
    pub cause: Cause,
}

/// What a problem's own function returns: its rows, or the error of the solver that failed.
pub(crate) type Outcome = Result<Vec<Row>, Cause>;

impl Problem {
    /// Runs the problem.
    ///
    /// # Errors
    /// [`VerifyError`] if a solver fails; a row that does not pass is no error.
    pub fn run(&self, size: Size) -> Result<Vec<Row>, VerifyError> {
        let rows = (self.run)(size).map_err(|cause| VerifyError { name: self.name, cause })?;
        Ok(rows.into_iter().map(|row| Row { name: self.name, ..row }).collect())
    }
}
