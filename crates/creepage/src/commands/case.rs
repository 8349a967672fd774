//! The case that a command computes from, and errors about its keys.

use crate::case::{Case, CaseFile, CaseSource};
use crate::run::RunError;

use crate::{Error, Listener};

impl CaseSource {
    /// Reads and checks the case, and says its warnings.
    ///
    /// # Errors
    /// What is wrong with the case, with the place where it is written.
    pub fn load(&self, listener: &mut dyn Listener) -> Result<Case, Error> {
        let case = match &self.text {
            Some(text) => Case::from_text(text, &self.path, &self.sets)?,
            None => Case::read(&tell(self.file(), listener), &self.sets)?,
        };
        case.warnings().iter().for_each(|warning| listener.remark(&format!("warning: {warning}")));
        Ok(case)
    }
}

/// Says where the file is a reference case.
pub(crate) fn tell(file: CaseFile, listener: &mut dyn Listener) -> CaseFile {
    if let CaseFile::Reference(reference) = file {
        let name = reference.name;
        listener.remark(&format!("{file}; for a copy to change: creepage cases {name}"));
    }
    file
}

impl Case {
    /// The error of a run; one about a key of the case has the line where the key was written.
    pub(crate) fn placed(&self, error: RunError) -> Error {
        match error.key() {
            Some(key) => self.error_at(key, &error.to_string(), &error.remedy()).into(),
            None => error.into(),
        }
    }
}
