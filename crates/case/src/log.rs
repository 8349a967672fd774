//! `run.log`.

use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

use crate::run_error::RunError;

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

    pub(crate) fn say(&mut self, line: &str) -> Result<(), RunError> {
        tracing::info!("{line}");
        writeln!(self.file, "{line}")
            .map_err(|cause| RunError::Text { path: self.path.clone(), cause })
    }
}
