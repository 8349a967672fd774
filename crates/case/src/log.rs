//! `run.log`.

use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

use crate::run_error::RunError;

/// How the last line of the log begins where a run was refused after its mesh was made.
pub const REFUSED: &str = "end: refused before rolling: ";

/// `run.log`: what the run said, line by line.
pub(crate) struct Log {
    path: PathBuf,
    file: File,
}

impl Log {
    pub(crate) fn new(path: PathBuf) -> Result<Self, RunError> {
        match File::create(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(cause) => Err(RunError::Text { path, cause }),
        }
    }

    /// Goes on with the log of a run.
    pub(crate) fn append(path: PathBuf) -> Result<Self, RunError> {
        match File::options().append(true).create(true).open(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(cause) => Err(RunError::Text { path, cause }),
        }
    }

    pub(crate) fn say(&mut self, line: &str) -> Result<(), RunError> {
        tracing::info!("{line}");
        self.write(line)
    }

    /// What the user should know whether or not more is to be said.
    pub(crate) fn warn(&mut self, line: &str) -> Result<(), RunError> {
        tracing::warn!("{line}");
        self.write(&format!("warning: {line}"))
    }

    fn write(&mut self, line: &str) -> Result<(), RunError> {
        writeln!(self.file, "{line}")
            .map_err(|cause| RunError::Text { path: self.path.clone(), cause })
    }
}
