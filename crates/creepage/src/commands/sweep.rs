//! A case many times, over a grid of parameters.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::chart::{Format, Paper};
use crate::check::PostError;
use crate::scenario::{Progress, Stage as StageOfRun};
use crate::sweep::plan::{self, CHECK, Existing};
use crate::sweep::points::Point;
use crate::sweep::pool::{self, Done, Stage};
use crate::sweep::result::{PlanFile, SweepResult, SweepRun};
use crate::sweep::{Budget, Plan, Sweep, collect};
use output::files::made::PLAN;
use serde::{Deserialize, Serialize};

use crate::commands::case::tell;
use crate::commands::error::{FAILED, INTERRUPTED};
use crate::commands::outputs::claim;
use crate::commands::report::{claim_sweep, write_sweep};
use crate::commands::values::{MEGABYTES, exclude};
use crate::commands::{CheckOptions, check, run};
use crate::rule::{THREADS, all_cores};
use crate::{Error, Listener, RunOptions};

/// Which sweep, and how its runs are done.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SweepOptions {
    /// The sweep file, or the name of a reference sweep: `creepage cases` lists them
    #[cfg_attr(feature = "clap", arg(value_name = "SWEEP"))]
    pub sweep: PathBuf,
    /// Folder of the sweep [default: runs/NAME, by the name of the sweep]
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR"))]
    pub out: Option<PathBuf>,
    /// Runs at a time [default: one per core]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = |n: &str| THREADS.read(n)))]
    pub jobs: Option<usize>,
    /// Threads of each run [default: cores over jobs]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = |n: &str| THREADS.read(n)))]
    pub threads: Option<usize>,
    /// Memory that the runs may take together, in MB [default: nine tenths of what is free]
    #[cfg_attr(feature = "clap", arg(long, value_name = "MB", allow_hyphen_values = true,
        value_parser = |mb: &str| MEGABYTES.read(mb)))]
    pub memory: Option<f64>,
    /// Take the kernels whose bits every processor can give in every run; the same as
    /// deterministic = true in [set]
    #[allow(rustdoc::broken_intra_doc_links)] // a section of the sweep file, in the words of --help
    #[cfg_attr(feature = "clap", arg(long))]
    pub deterministic: bool,
    /// Go on with the sweep in the folder: keep the runs that are done, do the others
    #[cfg_attr(feature = "clap", arg(long, conflicts_with = "force"))]
    pub resume: bool,
    /// Replace the sweep that is in the folder
    #[cfg_attr(feature = "clap", arg(long))]
    pub force: bool,
    /// Run nothing: write the runs as shell commands, one a line, for an engine of your own
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE", conflicts_with = "collect"))]
    pub plan: Option<PathBuf>,
    /// Run nothing: gather the results of runs from the sweep's folder and these
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR", num_args = 0..))]
    pub collect: Option<Vec<PathBuf>>,
}

impl SweepOptions {
    /// Reads the sweep file and everything that it names.
    ///
    /// # Errors
    /// What is wrong with the sweep file or the case of a run.
    pub fn load(&self) -> Result<Sweep, Error> {
        let mut sweep = Sweep::load(&self.sweep)?;
        if self.deterministic {
            sweep.sets.push(("deterministic".into(), true.into()));
        }
        Ok(sweep)
    }

    /// What to do with a sweep that is in the folder.
    fn existing(&self, folder: &Path) -> Existing {
        match (self.force, self.resume, &self.plan) {
            (true, ..) => Existing::Replace,
            // A plan runs nothing, so that writing it once more harms no run.
            (false, false, None) => Existing::Refuse,
            (false, true, _) => Existing::Resume,
            (false, false, Some(_)) if folder.join(plan::PLAN).exists() => Existing::Resume,
            (false, false, Some(_)) => Existing::Refuse,
        }
    }
}

/// What a sweep came to.
#[derive(Clone, Debug)]
pub struct Swept {
    /// Its folder.
    pub folder: PathBuf,
    /// What `creepage sweep --json` prints.
    pub result: SweepFound,
    /// The page about it; none for a plan.
    pub page: Option<PathBuf>,
    /// Whether it was interrupted before all runs were done: with [`SweepOptions::resume`] it goes on.
    pub interrupted: bool,
}

/// What a sweep gave: what its runs gave, or its plan alone.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum SweepFound {
    /// Of [`SweepOptions::plan`], also `plan.json` in the folder.
    Plan(PlanFile),
    /// Parameters and runs with what they gave, also `sweep.json` in the folder.
    Result(SweepResult),
}

impl Swept {
    /// Exit code of the command line: 0, 1 unless every run came to its end, 130 when interrupted.
    pub fn exit_code(&self) -> u8 {
        match &self.result {
            _ if self.interrupted => INTERRUPTED,
            SweepFound::Result(result) if !result.runs.iter().all(SweepRun::completed) => FAILED,
            _ => 0,
        }
    }
}

/// Runs a case over a grid of parameters; with [`SweepOptions::plan`] or
/// [`SweepOptions::collect`] it runs nothing.
///
/// The listener hears how far the sweep is; its flag ends the runs under way in order. A run that fails stands in the
/// result and stops no other.
///
/// # Errors
/// A sweep file, a case of it or a folder that cannot be used; results that cannot be written.
pub fn sweep(options: &SweepOptions, listener: &mut dyn Listener) -> Result<Swept, Error> {
    THREADS.check("--jobs", options.jobs.as_ref())?;
    THREADS.check("--threads", options.threads.as_ref())?;
    MEGABYTES.check("--memory", options.memory.as_ref())?;
    exclude(("--resume", options.resume), &[("--force", options.force)])?;
    exclude(("--plan", options.plan.is_some()), &[("--collect", options.collect.is_some())])?;
    let sweep = options.load()?;
    tell(sweep.path.clone(), listener);
    let folder = options.out.clone().unwrap_or_else(|| Path::new("runs").join(&sweep.name));
    if let Some(elsewhere) = &options.collect {
        if let Some(missing) = elsewhere.iter().find(|folder| !folder.is_dir()) {
            let problem = format!("--collect {}: there is no such folder", missing.display());
            return Err(Error::plain(problem));
        }
        let plan = plan::open(&sweep, &folder)?;
        return finish(&plan, collect(&plan, elsewhere)?);
    }
    if let Some(path) = &options.plan {
        one_line(&folder)?;
        claim("--plan", path, &PLAN, &sweep.inputs())?;
    } else {
        claim_sweep(&folder)?;
    }
    let stop = listener.stop();
    let existing = options.existing(&folder);
    let mut say = |line: &str| listener.remark(&format!("{}: {line}", sweep.name));
    let plan = plan::prepare(&sweep, &folder, existing, all_cores(), &stop, &mut say)?;
    if let Some(path) = &options.plan {
        let text = plan.commands(options.threads.unwrap_or(1)).join("\n") + "\n";
        fs::write(path, text).map_err(|error| {
            Error::plain(format!("--plan {}: cannot be written: {error}", path.display()))
        })?;
        let result = SweepFound::Plan(plan.file);
        return Ok(Swept { folder, result, page: None, interrupted: false });
    }
    let results = runs(options, &sweep.name, &plan, listener)?;
    let mut swept = finish(&plan, results)?;
    if stop.load(Ordering::SeqCst) && swept.exit_code() != 0 {
        listener.remark(&format!("{}: interrupted: --resume goes on", sweep.name));
        swept.interrupted = true;
    }
    Ok(swept)
}

/// Does the runs of a plan.
fn runs(
    options: &SweepOptions,
    name: &str,
    plan: &Plan,
    listener: &mut dyn Listener,
) -> Result<SweepResult, Error> {
    let cores = all_cores();
    let jobs = options.jobs.unwrap_or(cores).clamp(1, plan.runs.len());
    let threads = options.threads.unwrap_or((cores / jobs).max(1));
    let budget = Budget { jobs, memory_mb: options.memory };
    listener.remark(&format!(
        "{name}: {} runs in {}, {jobs} at a time, {threads} thread{} each",
        plan.runs.len(),
        plan.folder.display(),
        if threads == 1 { "" } else { "s" }
    ));
    let stop = listener.stop();
    let work = |point: &Point, stage: Stage, done: &Done| {
        let outcome = match stage {
            Stage::Run => run_one(plan, point, threads, OfRun { stop: &stop, done }),
            Stage::Check => check_one(plan, point),
        };
        outcome.map_err(|error| error.to_string())
    };
    let mut watch = |now: &_| listener.sweep(name, now);
    Ok(pool::run(plan, &work, &budget, &stop, &mut watch)?)
}

/// Hears a run for its sweep.
struct OfRun<'a> {
    stop: &'a Arc<AtomicBool>,
    done: &'a Done,
}

impl Listener for OfRun<'_> {
    fn stop(&mut self) -> Arc<AtomicBool> {
        Arc::clone(self.stop)
    }

    fn run(&mut self, progress: &Progress) {
        if progress.stage == StageOfRun::Roll {
            self.done.set(progress.step as f64 / progress.steps.max(1) as f64);
        }
    }
}

/// Runs a point of a plan: from its checkpoint, or else in the place of what is there.
fn run_one(
    plan: &Plan,
    point: &Point,
    threads: usize,
    mut listener: OfRun<'_>,
) -> Result<(), Error> {
    let folder = plan::run_folder(&plan.folder, &point.name);
    let options = RunOptions {
        case: plan::case_file(&plan.folder, &point.name).into(),
        threads: Some(threads),
        preload_cache: Some(plan::preloads(&plan.folder)),
        resume: folder.exists(),
        out: Some(folder),
        force: true,
        ..RunOptions::default()
    };
    run(&options, &mut listener).map(drop)
}

/// Checks a point of a plan. That a measure is beyond its limit is a result.
fn check_one(plan: &Plan, point: &Point) -> Result<(), Error> {
    let folder = plan::run_folder(&plan.folder, &point.name);
    let checked = check(&CheckOptions { run: folder.clone(), ..CheckOptions::default() })?;
    Ok(output::write_json_atomically(folder.join(CHECK), &checked.result)
        .map_err(crate::sweep::SweepError::from)?)
}

/// A plan has one command a line, in UTF-8: its folder must be written so.
fn one_line(folder: &Path) -> Result<(), Error> {
    match folder.to_str() {
        Some(text) if !text.chars().any(char::is_control) => Ok(()),
        _ => Err(Error::option(
            format!("--plan: the folder {folder:?} cannot stand in a line of commands"),
            "choose a folder without line ends and other control characters with --out DIR",
        )),
    }
}

/// Draws the results and writes their page.
fn finish(plan: &Plan, result: SweepResult) -> Result<Swept, Error> {
    let figures = plan.folder.join("figures");
    for (stem, figure) in crate::trends::sweep_figures(&plan.folder, &result) {
        for format in [Format::Svg, Format::Png] {
            figure.write_as(&figures, &stem, format, &Paper::SCREEN).map_err(PostError::from)?;
        }
    }
    let page = Some(write_sweep(&plan.folder, &result)?);
    let result = SweepFound::Result(result);
    Ok(Swept { folder: plan.folder.clone(), result, page, interrupted: false })
}
