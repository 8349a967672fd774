//! The history of a run as CSV.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use output::files::made::SLIDER_HEADING;
use slider::{Parameters, State};

/// A CSV file with a line per step; the first error is kept for the end.
pub struct CsvFile {
    path: PathBuf,
    out: BufWriter<File>,
    error: Option<std::io::Error>,
}

/// A file that cannot be written.
pub struct Unwritable {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub cause: std::io::Error,
}

impl CsvFile {
    /// A file with its heading.
    pub fn new(path: &Path) -> Result<Self, Unwritable> {
        let open = || -> std::io::Result<BufWriter<File>> {
            let mut out = BufWriter::new(File::create(path)?);
            out.write_all(SLIDER_HEADING)?;
            Ok(out)
        };
        let out = open().map_err(|cause| Unwritable { path: path.into(), cause })?;
        Ok(Self { path: path.into(), out, error: None })
    }

    /// Writes the line of a step.
    pub fn row(&mut self, p: &Parameters, time: f64, state: &State) {
        let State { x, v, slip, friction, mu } = state;
        let spring = -p.damping * v - p.spring * x;
        if self.error.is_none() {
            let written = writeln!(self.out, "{time},{x},{v},{slip},{mu},{friction},{spring}");
            self.error = written.err();
        }
    }

    /// Whether a line could not be written.
    pub fn failed(&self) -> bool {
        self.error.is_some()
    }

    /// Ends the file.
    pub fn finish(mut self) -> Result<(), Unwritable> {
        match self.error.take().or(self.out.flush().err()) {
            None => Ok(()),
            Some(cause) => Err(Unwritable { path: self.path, cause }),
        }
    }
}
