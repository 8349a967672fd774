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
    /// Whether to replace the run that is already in `out`.
    pub force: bool,
    /// Whether to go on with the run in `out` from its last checkpoint; with `force`, the run begins anew where that
    /// is not possible.
    pub resume: bool,
    /// Folder in which preloads are kept for other runs that have the same; without it none is kept.
    pub preload_cache: Option<PathBuf>,
    /// The case file, for the log; with `force` no file that the case is made of is replaced.
    pub source: PathBuf,
    /// The friction law of a case with `friction.law = "python"`; with another law it is refused.
    pub law: Option<Arc<dyn OwnLaw>>,
}
