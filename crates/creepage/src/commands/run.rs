//! A run of a case.

use std::path::PathBuf;
use std::sync::Arc;

use crate::check::{Basis, RunPaths};
use friction::OwnLaw;
use output::summary::{Status, Summary};
use serde::Deserialize;

use crate::commands::error::{INTERRUPTED, STOPPED_BY_GUARD};
use crate::commands::values::{THREADS, threads};
use crate::{CaseSource, Error, Listener};

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
}

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
    let folder = options.out.clone().unwrap_or_else(|| crate::run::folder::default_folder(&case));
    let how = crate::run::RunOptions {
        out: folder.clone(),
        threads: threads(options.threads, listener),
        force: options.force,
        resume: options.resume,
        preload_cache: options.preload_cache.clone(),
        source: source.path.clone(),
        law: options.law.clone(),
    };
    let stop = listener.stop();
    listener.folder(&folder);
    let summary = crate::run::run(&case, &how, &stop, &mut |progress| listener.run(progress));
    Ok(Ran { folder, summary: summary.map_err(|error| source.placed(error))? })
}
