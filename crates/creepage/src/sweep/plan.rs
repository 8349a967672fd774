//! The folder of a sweep: what is to be run in it, and as what commands.
//!
//! | file | what |
//! |---|---|
//! | `plan.json` | the sweep: its hash, axes, step, and the runs with their parameters |
//! | `cases/NAME.toml` | the resolved case of each run |
//! | `runs/NAME/` | the run, with `check.json` beside its own files |
//! | `preload/` | preloads that runs share |
//! | `sweep.json`, `sweep.csv` | the results |
//! | `sweep.lock` | locked by the process that works in the folder |

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use miette::Diagnostic;
use output::files::{InputError, input};
use serde::Serialize;
use thiserror::Error;

use crate::case::error::CaseError;
use crate::run::folder::FolderError;
use crate::scenario::ScenarioError;
use crate::sweep::file::{StepRule, Sweep};
use crate::sweep::points::Point;
use crate::sweep::result::{PlanFile, PlannedRun, PlannedStep, SweepPlan};

/// The plan of a sweep in its folder.
pub const PLAN: &str = "plan.json";
/// The results of a sweep in its folder, and the same as a table.
pub const RESULTS: [&str; 2] = ["sweep.json", "sweep.csv"];
/// The checks of a run, in its folder.
pub const CHECK: &str = "check.json";
const LOCK: &str = "sweep.lock";

/// Why a sweep could not be run.
#[derive(Debug, Error, Diagnostic)]
pub enum SweepError {
    /// The sweep file, or a case that it leads to.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Case(#[from] CaseError),
    /// The folder cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Folder(#[from] FolderError),
    /// The folder holds this sweep already, with [`Existing::Refuse`].
    #[error("{} already holds this sweep", path.display())]
    #[diagnostic(help("go on with --resume, or run everything anew with --force"))]
    Begun {
        /// The folder.
        path: PathBuf,
    },
    /// The folder is not one of a sweep, so there is nothing to go on with, to replace or to gather.
    #[error("{} holds no sweep, or files of another kind", path.display())]
    #[diagnostic(help("choose another folder with --out DIR"))]
    NoSweep {
        /// The folder.
        path: PathBuf,
    },
    /// A run that needs more memory than there may be used.
    #[error(
        "the run {run} needs about {needed_mb:.0} MB of memory, more than the {free_mb:.0} MB \
             that the sweep may use"
    )]
    #[diagnostic(help("raise --memory, or enlarge the elements of that run"))]
    Memory {
        /// The run.
        run: String,
        /// What it needs (MB).
        needed_mb: f64,
        /// What there is (MB).
        free_mb: f64,
    },
    /// The smallest stability limit could not be found.
    #[error("the stability limit of the run {run} cannot be found: {cause}")]
    #[diagnostic(help("rule = \"fixed\" needs the limit of every run; rule = \"bound\" does not"))]
    Limit {
        /// The run.
        run: String,
        /// Why.
        cause: Box<ScenarioError>,
    },
    /// The sweep was asked to stop before its first run.
    #[error("interrupted before the first run began")]
    Interrupted,
    /// A file of the sweep that cannot be read: too large, or no regular file.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Input(#[from] InputError),
    /// A file of the sweep cannot be read or written.
    #[error("{}: {cause}", path.display())]
    #[diagnostic(help("check that the folder is there, that you may write to it, and its room"))]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        cause: io::Error,
    },
    /// Results cannot be written.
    #[error(transparent)]
    Output(#[from] output::OutputError),
    /// Threads cannot be started.
    #[error("threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl SweepError {
    /// Exit code of the process: 2 for bad input, 130 when interrupted, 3 else.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Interrupted => 130,
            Self::File { .. } | Self::Output(_) => 3,
            _ => 2,
        }
    }
}

/// A sweep laid out in its folder.
#[derive(Debug)]
pub struct Plan {
    /// The folder.
    pub folder: PathBuf,
    /// Its `plan.json`.
    pub file: PlanFile,
    /// The runs, in order.
    pub runs: Vec<Point>,
    /// Lock against a second process in the folder; none where only results are gathered.
    _lock: Option<File>,
}

/// What to do with a folder that holds this sweep already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Existing {
    /// Refuse it.
    Refuse,
    /// Keep the runs that are done.
    Resume,
    /// Remove every run.
    Replace,
}

/// Whether the sweep may use `folder`, which is left as it is.
fn look(folder: &Path, sweep: &Sweep, hash: &str, existing: Existing) -> Result<(), SweepError> {
    let path = || folder.to_path_buf();
    let Some(plan) = read_plan(folder)? else {
        // A sweep that was stopped before its plan was written leaves its lock, and perhaps preloads.
        if folder.join(LOCK).exists() {
            return Ok(());
        }
        return match crate::run::folder::check(folder, false) {
            Err(FolderError::Taken { path, .. }) => Err(SweepError::NoSweep { path }),
            other => Ok(other?),
        };
    };
    match existing {
        Existing::Replace => Ok(()),
        _ if plan.plan.hash != hash => Err(other_sweep(folder, sweep, &plan.plan).into()),
        Existing::Refuse => Err(SweepError::Begun { path: path() }),
        Existing::Resume => Ok(()),
    }
}

/// The error of a folder that holds another sweep, at the first difference of the two.
fn other_sweep(folder: &Path, sweep: &Sweep, plan: &SweepPlan) -> CaseError {
    let differs = |axis: &crate::sweep::file::Axis| plan.axes.get(&axis.key) != Some(&axis.values);
    let (at, what) = match sweep.axes.iter().position(differs) {
        Some(i) => (sweep.axis_place(i), format!("axis {}", sweep.axes[i].key)),
        None => ("base".into(), "base case, mode, [set] or [[derive]]".into()),
    };
    let file = if plan.file.is_empty() { "another file" } else { &plan.file };
    let message =
        format!("{} holds another sweep, of {file}: it differs in the {what}", folder.display());
    let remedy = "choose another folder with --out DIR, or replace that sweep with --force";
    sweep.layers.places.error(&at, &message, remedy).into()
}

fn read_plan(folder: &Path) -> Result<Option<PlanFile>, SweepError> {
    let path = folder.join(PLAN);
    match input::bytes(&path, input::DOCUMENT) {
        Ok(bytes) => match serde_json::from_slice(&bytes) {
            Ok(plan) => Ok(Some(plan)),
            Err(error) => Err(SweepError::File { path, cause: error.into() }),
        },
        // The check of the folder refuses a path through a file.
        Err(error) if error.is_missing() => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// Lays the sweep out in `folder`; nothing is written before everything has been checked.
///
/// So many `threads` make the meshes, and find the smallest stability limit for [`StepRule::Fixed`]; `say` takes a line
/// before work that takes time; `stop` ends the search for the limit.
///
/// # Errors
/// A case that is refused, a mesh that cannot be made, a stability limit that cannot be found, a folder that holds
/// something else or that another process works in, files that cannot be written, a `stop`.
pub fn prepare(
    sweep: &Sweep,
    folder: &Path,
    existing: Existing,
    threads: usize,
    stop: &AtomicBool,
    say: &mut dyn FnMut(&str),
) -> Result<Plan, SweepError> {
    let mut runs = sweep.points()?;
    let hash = sweep.hash(&runs);
    look(folder, sweep, &hash, existing)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    say(&format!("{} runs: building their meshes", runs.len()));
    pool.install(|| sweep.count_elements(&mut runs))?;
    let failed = |path: PathBuf| move |cause| SweepError::File { path, cause };
    fs::create_dir_all(folder)
        .map_err(|cause| FolderError::NotWritable { path: folder.into(), cause })?;
    let lock = lock(folder)?;
    // Checked again under the lock: another process may just have finished here.
    look(folder, sweep, &hash, existing)?;
    if existing == Existing::Replace {
        refuse_inputs(folder, sweep)?;
        clear(folder)?;
    }
    let kept = read_plan(folder)?;
    let kept_step = kept.as_ref().and_then(|file| file.plan.step.step);
    let step = match (sweep.step, kept_step) {
        (Some(StepRule::Fixed), Some(step)) => Some(step),
        (Some(StepRule::Fixed), None) => {
            say("finding the smallest stability limit");
            Some(pool.install(|| smallest_step(sweep, &runs, folder, stop))?)
        }
        _ => None,
    };
    if let Some(step) = step {
        for run in &mut runs {
            (run.case.time.step, run.case.time.factor) = (Some(step), None);
        }
    }
    let plan = SweepPlan {
        name: sweep.name.clone(),
        title: sweep.title.clone(),
        file: sweep.path.to_string(),
        base: sweep.base.to_string(),
        creepage_version: env!("CARGO_PKG_VERSION").into(),
        hash,
        mode: sweep.mode.word().into(),
        parameters: sweep.axes.iter().map(|axis| axis.key.clone()).collect(),
        axes: sweep.axes.iter().map(|axis| (axis.key.clone(), axis.values.clone())).collect(),
        ensemble: sweep.ensemble.then(|| crate::sweep::ensemble::AXIS.to_owned()),
        step: PlannedStep { rule: sweep.step.map(|rule| rule.word().to_owned()), step },
    };
    let planned =
        |run: &Point| PlannedRun { name: run.name.clone(), parameters: run.parameters.clone() };
    let file = PlanFile { plan, runs: runs.iter().map(planned).collect() };
    for name in ["cases", "runs"] {
        let path = folder.join(name);
        fs::create_dir_all(&path).map_err(failed(path))?;
    }
    for run in &runs {
        let path = case_file(folder, &run.name);
        fs::write(&path, run.case.to_toml()).map_err(failed(path))?;
    }
    output::write_json_atomically(folder.join(PLAN), &file)?;
    Ok(Plan { folder: folder.into(), file, runs, _lock: lock })
}

/// The plan in a folder in which this sweep was begun, to gather its results. The folder is not locked.
///
/// # Errors
/// A case that is refused, or a folder that holds no plan or that of another sweep.
pub fn open(sweep: &Sweep, folder: &Path) -> Result<Plan, SweepError> {
    let mut runs = sweep.points()?;
    let path = || folder.to_path_buf();
    let file = read_plan(folder)?.ok_or_else(|| SweepError::NoSweep { path: path() })?;
    if file.plan.hash != sweep.hash(&runs) {
        return Err(other_sweep(folder, sweep, &file.plan).into());
    }
    if let Some(step) = file.plan.step.step {
        for run in &mut runs {
            (run.case.time.step, run.case.time.factor) = (Some(step), None);
        }
    }
    Ok(Plan { folder: path(), file, runs, _lock: None })
}

/// Parts of cases as text, by which equal ones are found; `None` equals nothing.
pub(super) fn alike(parts: impl Serialize) -> Option<String> {
    serde_json::to_string(&parts).ok()
}

/// `time.factor` times the smallest stability limit of the sweep (s).
fn smallest_step(
    sweep: &Sweep,
    runs: &[Point],
    folder: &Path,
    stop: &AtomicBool,
) -> Result<f64, SweepError> {
    let mut known = Vec::new();
    let mut smallest = f64::INFINITY;
    for run in runs {
        let case = &run.case;
        // The limit does not depend on friction, on the drive but for its speed, on output or on the duration.
        let basis = alike((
            (&case.disk, &case.bar, &case.material, &case.mesh, &case.element, &case.load),
            (&case.contact, &case.damping, case.preload.undisturbed(), case.drive.speed),
            case.time.factor,
        ));
        if basis.is_some() && known.contains(&basis) {
            continue;
        }
        known.push(basis);
        let limit = crate::scenario::stable_limit(case, Some(&preloads(folder)), stop);
        let limit = limit.map_err(|error| match error {
            error if error.is_interruption() => SweepError::Interrupted,
            error if error.key().is_some() => sweep.refused(&error, case, &run.indices).into(),
            cause => SweepError::Limit { run: run.name.clone(), cause: Box::new(cause) },
        })?;
        smallest = smallest.min(case.factor() * limit);
    }
    Ok(smallest)
}

/// Refuses to replace a sweep that holds what this one is made of: its file, its base or what that extends.
fn refuse_inputs(folder: &Path, sweep: &Sweep) -> Result<(), SweepError> {
    let place = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
    let written = ["cases", "runs", "preload", PLAN, RESULTS[0], RESULTS[1]];
    let lost = |path: &PathBuf| {
        let path = path.canonicalize().unwrap_or_default();
        written.iter().any(|name| path.starts_with(place.join(name)))
    };
    match sweep.inputs().into_iter().find(lost) {
        Some(path) => Err(FolderError::Input { path }.into()),
        None => Ok(()),
    }
}

/// Removes what a sweep wrote, by its plan; other files in the folder stay.
fn clear(folder: &Path) -> Result<(), SweepError> {
    let Some(plan) = read_plan(folder)? else {
        return Ok(());
    };
    let gone = |path: PathBuf, result: io::Result<()>| match result {
        Err(cause) if cause.kind() != io::ErrorKind::NotFound => {
            Err(SweepError::File { path, cause })
        }
        _ => Ok(()),
    };
    // A name from a file must not lead out of the folder.
    let names = plan.runs.iter().map(|run| &run.name);
    for name in names.filter(|name| !name.contains(['/', '\\'])) {
        let path = case_file(folder, name);
        gone(path.clone(), fs::remove_file(path))?;
        let path = run_folder(folder, name);
        gone(path.clone(), fs::remove_dir_all(path))?;
    }
    let path = preloads(folder);
    gone(path.clone(), fs::remove_dir_all(path))?;
    for name in RESULTS.into_iter().chain([PLAN]) {
        let path = folder.join(name);
        gone(path.clone(), fs::remove_file(path))?;
    }
    Ok(())
}

fn lock(folder: &Path) -> Result<Option<File>, SweepError> {
    let path = folder.join(LOCK);
    let file = File::create(&path).map_err(|cause| SweepError::File { path, cause })?;
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Err(FolderError::Busy { path: folder.into() }.into()),
        // A file system without locks: nobody can be kept out.
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

/// Path of the resolved case of a run.
pub fn case_file(folder: &Path, name: &str) -> PathBuf {
    folder.join("cases").join(format!("{name}.toml"))
}

/// Path of the folder of a run.
pub fn run_folder(folder: &Path, name: &str) -> PathBuf {
    folder.join("runs").join(name)
}

/// Path of the folder of the preloads that the runs share.
pub fn preloads(folder: &Path) -> PathBuf {
    folder.join("preload")
}

/// The command-line arguments with which this program does the run `name` of the sweep in `folder`, and those with
/// which it checks that run.
pub fn arguments(folder: &Path, name: &str, threads: usize) -> [Vec<String>; 2] {
    let text = |path: PathBuf| path.display().to_string();
    let run = run_folder(folder, name);
    let words = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
    [
        words(&[
            "run",
            &text(case_file(folder, name)),
            "--out",
            &text(run.clone()),
            "--threads",
            &threads.to_string(),
            "--preload-cache",
            &text(preloads(folder)),
            // the run goes on from a checkpoint, or else replaces what is there
            "--resume",
            "--force",
        ]),
        words(&["check", &text(run), "--json"]),
    ]
}

impl Plan {
    /// The runs as commands for a shell, one line each. `$CREEPAGE` names the program where it
    /// is not on the path; paths are relative to where the sweep was planned.
    pub fn commands(&self, threads: usize) -> Vec<String> {
        let line = |run: &Point| {
            let [run_words, check_words] = arguments(&self.folder, &run.name, threads)
                .map(|words| words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" "));
            let check = quoted(&run_folder(&self.folder, &run.name).join(CHECK).to_string_lossy());
            // The check ends with 1 where a measure is beyond its limit: a result, not a failure.
            format!(
                "${{CREEPAGE:-creepage}} {run_words} && {{ ${{CREEPAGE:-creepage}} {check_words} \
                 > {check} || [ $? -eq 1 ]; }}"
            )
        };
        self.runs.iter().map(line).collect()
    }
}

/// A word as a POSIX shell takes it: in quotes where it must be.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=+:,@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
