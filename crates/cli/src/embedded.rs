//! Commands in the service of another program instead of a terminal.

use std::ffi::OsString;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ::sweep::Watched;
use friction::OwnLaw;
use scenario::Progress;
use serde_json::Value;

/// What a command tells the program that holds it, instead of writing it to the terminal.
#[derive(Clone, Debug)]
pub enum Told {
    /// The folder of the run that begins.
    Folder(PathBuf),
    /// How far a run is.
    Run(Progress),
    /// How far a sweep is.
    Sweep(Watched),
    /// A warning or a remark.
    Said(String),
    /// What `--json` prints.
    Document(Value),
}

/// What the program that holds a command gives it.
#[derive(Clone)]
pub struct Embedded {
    /// Text of the case, in place of what its file holds.
    pub case: Option<String>,
    /// The friction law of a case with `friction.law = "python"`.
    pub law: Option<Arc<dyn OwnLaw>>,
    /// Ends the command in order; Ctrl-C is left to the program.
    pub stop: Arc<AtomicBool>,
    /// The program, and its first arguments, that does the runs of a sweep.
    pub program: Vec<OsString>,
    /// Listens.
    pub tell: Arc<dyn Fn(Told) + Send + Sync>,
}

impl fmt::Debug for Embedded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Embedded").field("program", &self.program).finish_non_exhaustive()
    }
}
