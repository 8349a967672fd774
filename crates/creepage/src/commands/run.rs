//! A run of a case.

use std::path::PathBuf;
use std::sync::Arc;

use crate::check::{Basis, RunPaths};
use output::summary::{Status, Summary};

use crate::commands::error::{INTERRUPTED, STOPPED_BY_GUARD};
use crate::commands::values::threads;
use crate::rule::{THREADS, all_cores};
use crate::{Error, Listener, Ranks, RunOptions};

/// A run that came to its end, was interrupted, or was stopped by its own guards: its results are in its
/// folder.
#[derive(Clone, Debug)]
pub struct Ran {
    /// Folder of the run.
    pub folder: PathBuf,
    /// What `creepage run --json` prints, also `summary.json` in the folder.
    pub summary: Summary,
}

impl Ran {
    /// Why the run's own guards stopped it, where they did.
    pub fn diagnosis(&self) -> Option<&str> {
        self.summary.diagnosis.as_deref()
    }

    /// Whether the run was interrupted: with [`RunOptions::resume`] it goes on.
    pub fn interrupted(&self) -> bool {
        self.summary.status == Some(Status::Interrupted)
    }

    /// What to try where much of the slip fluctuates, in one sentence; `None` also where the run has no contact to judge.
    pub fn fluctuating_slip(&self) -> Option<String> {
        let paths = RunPaths::of(&self.folder).ok()?;
        let mut basis = Basis::read(&paths).ok()?;
        crate::check::fluctuating_slip(&paths, &mut basis).ok()?
    }

    /// Exit code of the command line: 0, 3 where the run's own guards stopped it, 130 when interrupted.
    pub fn exit_code(&self) -> u8 {
        match self.summary.status {
            Some(Status::Interrupted) => INTERRUPTED,
            Some(Status::Failed) => STOPPED_BY_GUARD,
            Some(Status::Completed) | None => 0,
        }
    }
}

/// Runs a case.
///
/// The listener hears the folder, then how far the run is; its flag ends the run in order, with a checkpoint.
///
/// # Errors
/// A case, a mesh or a folder that cannot be used; a preload that is not found; results that cannot be written.
pub fn run(options: &RunOptions, listener: &mut dyn Listener) -> Result<Ran, Error> {
    THREADS.check("--threads", options.threads.as_ref())?;
    let mut source = options.case.clone();
    source.sets.extend(options.deterministic.then(|| "deterministic=true".to_owned()));
    let case = source.load(listener)?;
    let threads = Some(threads(options.threads, listener));
    let options = RunOptions { threads, ..options.clone() };
    let (folder, stop) = (options.folder(&case), listener.stop());
    listener.folder(&folder);
    let summary = crate::run::run(&case, &options, &stop, &mut |progress| listener.run(progress));
    Ok(Ran { folder, summary: summary.map_err(|error| case.placed(error))? })
}

/// Shares the steps of the run of process 0, until they are done.
///
/// # Errors
/// A mesh that cannot be made here, kernels or memory that are not here.
pub fn assist(ranks: &Arc<dyn Ranks>, threads: Option<usize>) -> Result<(), Error> {
    Ok(crate::run::assist(ranks, threads.unwrap_or_else(all_cores))?)
}
