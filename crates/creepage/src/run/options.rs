//! Which case to run, and how.

use std::path::PathBuf;
use std::sync::Arc;

use crate::case::{Case, CaseSource};
#[cfg(feature = "clap")]
use crate::rule::THREADS;
use crate::rule::all_cores;
use crate::run::folder::default_folder;
use crate::run::processes::Leader;
use dynamics::Partition;
use friction::OwnLaw;
use serde::Deserialize;

/// What to run, and how.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct RunOptions {
    /// Folder of the run [default: runs/NAME, by the name of the case]
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR"))]
    pub out: Option<PathBuf>,
    /// The case.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub case: CaseSource,
    /// Number of threads, at most one per core [default: one per core]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = |n: &str| THREADS.read(n)))]
    pub threads: Option<usize>,
    /// Take the kernels whose bits every processor can give, at some cost in speed; the same as
    /// --set deterministic=true
    #[cfg_attr(feature = "clap", arg(long))]
    pub deterministic: bool,
    /// Go on with the run in the folder from its last checkpoint, to the same bits; with --force,
    /// begin anew where there is none of this case
    #[cfg_attr(feature = "clap", arg(long))]
    pub resume: bool,
    /// Replace the run that is already in the folder
    #[cfg_attr(feature = "clap", arg(long))]
    pub force: bool,
    /// Keep the preload in this folder, and take it from there if a run with the same has been
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR"))]
    pub preload_cache: Option<PathBuf>,
    /// The friction law of a case with `friction.law = "python"`; with another law it is refused.
    #[serde(skip)]
    #[cfg_attr(feature = "clap", arg(skip))]
    pub law: Option<Arc<dyn OwnLaw>>,
    /// The processes that share the steps of the run, of which this is the first; the others [`assist`](crate::run::assist) it.
    #[serde(skip)]
    #[cfg_attr(feature = "clap", arg(skip))]
    pub leader: Option<Arc<Leader>>,
    /// Which of them owns which nodes [default: equal work by bisection].
    #[serde(skip)]
    #[cfg_attr(feature = "clap", arg(skip))]
    pub partition: Option<Partition>,
}

impl RunOptions {
    /// The folder of a run of `case`.
    pub fn folder(&self, case: &Case) -> PathBuf {
        self.out.clone().unwrap_or_else(|| default_folder(case))
    }

    /// The number of its threads.
    pub(crate) fn threads(&self) -> usize {
        self.threads.unwrap_or_else(all_cores)
    }
}
