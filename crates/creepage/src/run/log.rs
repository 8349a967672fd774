//! `run.log`.

use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

use output::NotWritten;

/// How the last line of the log begins where a run was refused after its mesh was made.
pub const REFUSED: &str = "end: refused before rolling: ";

/// `run.log`: a line for every event of a run.
pub(crate) struct Log {
    path: PathBuf,
    file: File,
}

impl Log {
    pub(crate) fn new(path: PathBuf) -> Result<Self, NotWritten> {
        match File::create(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(cause) => Err(NotWritten { path, cause }),
        }
    }

    /// The log of a run that goes on.
    pub(crate) fn append(path: PathBuf) -> Result<Self, NotWritten> {
        match File::options().append(true).create(true).open(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(cause) => Err(NotWritten { path, cause }),
        }
    }

    /// Writes a line, and passes it on to the subscriber of `tracing`.
    pub(crate) fn say(&mut self, line: &str) -> Result<(), NotWritten> {
        tracing::info!("{line}");
        self.write(line)
    }

    /// Writes a warning, which the user sees also where other lines are not shown.
    pub(crate) fn warn(&mut self, line: &str) -> Result<(), NotWritten> {
        tracing::warn!("{line}");
        self.write(&format!("warning: {line}"))
    }

    fn write(&mut self, line: &str) -> Result<(), NotWritten> {
        writeln!(self.file, "{line}").map_err(|cause| NotWritten { path: self.path.clone(), cause })
    }
}
