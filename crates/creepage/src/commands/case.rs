//! The case that a command computes from, and errors about its keys.

use crate::case::{Case, CaseSource};
use crate::run::RunError;

use crate::{Error, Listener};

impl CaseSource {
    /// Reads and checks the case, and says its warnings.
    ///
    /// # Errors
    /// What is wrong with the case, with the place where it is written.
    pub fn load(&self, listener: &mut dyn Listener) -> Result<Case, Error> {
        let case = self.read()?;
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
