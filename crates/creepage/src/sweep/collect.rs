//! The results of a sweep, gathered from its runs wherever they ran.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use output::files::input;
use output::layout::{attribute, file};
use output::summary::Status;

use crate::check::result::CheckResult;
use crate::sweep::plan::{CHECK, Plan, RESULTS, SweepError, run_folder};
use crate::sweep::points::Point;
use crate::sweep::result::{COMPLETED, SweepResult, SweepRun};
use crate::sweep::{ensemble, table};

/// Fields of a run's summary that do not repeat: they depend on the clock, the memory and the number of threads, or
/// are checksums of files that hold the time at which they were made. All other numbers of a sweep are the same to
/// the bit on any number of threads and machines and after any number of interruptions, as long as program and
/// kernels are the same.
pub const NOT_REPEATED: [&str; 8] = [
    "wall_s",
    "element_steps_per_s",
    "peak_rss_mb",
    "stages",
    "threads",
    "checksums",
    "sha256",
    attribute::CREATED,
];

/// How far a run is.
#[derive(Clone, Debug, PartialEq)]
pub enum State {
    /// It ran to its end and was checked.
    Completed,
    /// A guard or its preload stopped it, or it could not begin; the reason.
    Failed(String),
    /// It ran to its end but has no checks yet.
    Unchecked,
    /// It was interrupted, or has not begun; the word for that in the results.
    Undone(&'static str),
}

impl State {
    /// The `status` in the results.
    pub fn word(&self) -> &str {
        match self {
            Self::Completed => COMPLETED,
            Self::Failed(_) => "failed",
            Self::Unchecked => "unchecked",
            Self::Undone(word) => word,
        }
    }
}

/// Writes `sweep.json` and `sweep.csv` into the sweep's folder, and returns the first. Runs are looked for there and
/// in the folders `elsewhere`, in subfolders that have a run's name.
///
/// # Errors
/// Results that cannot be written.
pub fn collect(plan: &Plan, elsewhere: &[PathBuf]) -> Result<SweepResult, SweepError> {
    collect_with(plan, elsewhere, &BTreeMap::new())
}

/// The same. `failures` are the reasons, by name, of runs that failed and left no reason in their folders.
pub(crate) fn collect_with(
    plan: &Plan,
    elsewhere: &[PathBuf],
    failures: &BTreeMap<String, String>,
) -> Result<SweepResult, SweepError> {
    let runs: Vec<SweepRun> =
        plan.runs.iter().map(|run| entry(plan, run, elsewhere, failures)).collect();
    let sweep = plan.file.plan.clone();
    let points = if sweep.ensemble.is_some() { ensemble::points(&runs) } else { Vec::new() };
    let not_repeated = NOT_REPEATED.map(str::to_owned).into();
    let result = SweepResult { plan: sweep, runs, points, not_repeated };
    table::write(&plan.folder.join(RESULTS[1]), &result)?;
    output::write_json_atomically(plan.folder.join(RESULTS[0]), &result)?;
    Ok(result)
}

fn entry(
    plan: &Plan,
    run: &Point,
    elsewhere: &[PathBuf],
    failures: &BTreeMap<String, String>,
) -> SweepRun {
    let own = run_folder(&plan.folder, &run.name);
    let others =
        elsewhere.iter().flat_map(|folder| [run_folder(folder, &run.name), folder.join(&run.name)]);
    let places: Vec<PathBuf> = std::iter::once(own.clone()).chain(others).collect();
    let done = |state: &State| matches!(state, State::Completed | State::Failed(_));
    let found = places.iter().map(|place| (state(place, run), place));
    let (state, folder) = found
        .clone()
        .find(|(state, _)| done(state))
        .or_else(|| found.clone().find(|(state, _)| *state != State::Undone(NOT_BEGUN)))
        .unwrap_or((State::Undone(NOT_BEGUN), &own));
    let state = match failures.get(&run.name) {
        Some(reason) => State::Failed(reason.clone()),
        None => state,
    };
    let shown = folder.strip_prefix(&plan.folder).unwrap_or(folder);
    let reason = match &state {
        State::Failed(reason) => Some(reason.clone()),
        _ => None,
    };
    SweepRun {
        name: Some(run.name.clone()),
        parameters: run.parameters.clone(),
        status: Some(state.word().into()),
        run: Some(shown.display().to_string()),
        summary: output::read_summary(folder).ok().flatten().map(Box::new),
        check: read(&folder.join(CHECK)).map(Box::new),
        reason,
    }
}

const NOT_BEGUN: &str = "not begun";

/// How far a run in `folder` is; where the folder holds a run of another case, it has not begun.
pub fn state(folder: &Path, run: &Point) -> State {
    let case = input::text(&folder.join(file::CASE), input::CASE).unwrap_or_default();
    // an earlier version wrote no units into it
    if case != run.case.to_toml_with_units() && case != run.case.to_toml() {
        return State::Undone(NOT_BEGUN);
    }
    let Ok(summary) = output::read_summary(folder) else {
        // damaged: `--resume --force` begins it anew
        return State::Undone("unfinished");
    };
    let Some(summary) = summary else {
        // A run that was refused says so last; one that was killed does not.
        return match last_words(folder) {
            Some(reason) => State::Failed(reason),
            None => State::Undone("unfinished"),
        };
    };
    match summary.status {
        Some(Status::Completed) if read(&folder.join(CHECK)).is_some() => State::Completed,
        Some(Status::Completed) => State::Unchecked,
        Some(Status::Failed) => {
            State::Failed(summary.diagnosis.unwrap_or_else(|| "no reason given".into()))
        }
        Some(Status::Interrupted) | None => State::Undone("interrupted"),
    }
}

/// The last line of the log of a run that was refused after its mesh was made: why.
fn last_words(folder: &Path) -> Option<String> {
    let log = input::text(&folder.join(file::LOG), input::LOG).ok()?;
    let last = log.lines().next_back()?;
    last.strip_prefix(crate::run::REFUSED).map(str::to_owned)
}

/// What the check of a run found, if it is there and well-formed.
fn read(path: &Path) -> Option<CheckResult> {
    serde_json::from_slice(&input::bytes(path, input::DOCUMENT).ok()?).ok()
}
