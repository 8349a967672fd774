//! How to run a case.

use std::path::PathBuf;
use std::sync::Arc;

use friction::OwnLaw;

/// How to run a case, apart from what the case itself says.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder of the run.
    pub out: PathBuf,
    /// Number of threads, at least one.
    pub threads: usize,
    /// Replace the run that is already in `out`.
    pub force: bool,
    /// Go on with the run in `out` from its last checkpoint; with `force`, begin anew where that is
    /// not possible.
    pub resume: bool,
    /// Folder in which preloads are kept for other runs with the same, and taken from.
    pub preload_cache: Option<PathBuf>,
    /// The case file, for the log.
    pub source: PathBuf,
    /// The friction law of a case with `friction.law = "python"`.
    pub law: Option<Arc<dyn OwnLaw>>,
}
