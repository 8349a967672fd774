//! A run at its start: preloaded, or in the state of the checkpoint that it goes on from.

use super::opening::OpenRun;
use crate::case::schema::Case;
use crate::run::checkpoint::State;
use crate::run::error::RunError;
use crate::run::log::{Log, REFUSED};
use crate::run::options::RunOptions;
use crate::run::record::{RecordBasis, result_files};
use crate::run::resume::ResumePoint;
use crate::run::summary::without_rolling;
use crate::run::text_file::remove;
use crate::scenario::{Model, Start};
use crate::scenario::{Progress, ScenarioError};
use crate::scenario::{restart, start};
use output::layout::file;
use output::summary::Summary;
use output::{LOG_END, NotWritten, RunFiles};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// How a run begins.
pub(super) enum Preloaded {
    /// No preload was found, or a stop was asked for: the summary that says so.
    NotPreloaded(Box<Summary>),
    /// The simulation can be stepped; with the files of a run that begins, or the state of one that goes on.
    Rolling(Box<Start>, Option<Box<RunFiles>>, Option<Box<State>>),
}

/// Preloads the model of a run, or takes the state of its checkpoint. The files of a run that begins are there from
/// before its preload, without records.
pub(super) fn begin(
    case: &Case,
    options: &RunOptions,
    opened: &mut OpenRun<Model, State>,
    basis: &RecordBasis,
    wall: Instant,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
) -> Result<Preloaded, RunError> {
    if let Some(point) = opened.point.take() {
        return resume(case, options, opened, point);
    }
    let OpenRun { held, model, log, .. } = opened;
    let nodes = model.contact_nodes(case).or_else(|error| refuse(error, log))?;
    let files = result_files(case, model, &*nodes, basis)?;
    drop(nodes);
    let cache = options.preload_cache.as_deref();
    match start(case, model, cache, stop, observe, &mut |line| log.say(line)) {
        Ok(start) => {
            start.facts.preload.iter().try_for_each(|preload| log.say(&preload.line()))?;
            Ok(Preloaded::Rolling(Box::new(start), Some(Box::new(files)), None))
        }
        Err(error) => {
            drop(files);
            // another process may have taken the folder: its files are not removed
            held.check_owner()?;
            remove_results(&options.folder(case))?;
            let ScenarioError::Preload(error) = error else { return refuse(error, log) };
            let summary = without_rolling(case, model, options.threads(), wall, &error);
            let summary = summary.write(&options.folder(case), &basis.provenance)?;
            if let Some(status) = summary.status {
                log.say(&format!("{LOG_END}{status:?} before rolling: {error}"))?;
            }
            Ok(Preloaded::NotPreloaded(Box::new(summary)))
        }
    }
}

/// Removes the files of a run that does not come to roll: without a record they would say less than none.
fn remove_results(folder: &Path) -> Result<(), NotWritten> {
    let files = [file::FIELDS, file::CONTACT, file::HISTORY];
    files.iter().try_for_each(|name| remove(&folder.join(name)))
}

/// Says in the log why the run is refused.
fn refuse<T>(error: ScenarioError, log: &mut Log) -> Result<T, RunError> {
    log.say(&format!("{REFUSED}{error}"))?;
    Err(error.into())
}

fn resume(
    case: &Case,
    options: &RunOptions,
    opened: &mut OpenRun<Model, State>,
    point: ResumePoint<State>,
) -> Result<Preloaded, RunError> {
    let ResumePoint { state, .. } = point.tell(&options.folder(case), &mut opened.log)?;
    let start = restart(case, &opened.model, state.found.clone(), &state.simulation)?;
    Ok(Preloaded::Rolling(Box::new(start), None, Some(Box::new(state))))
}
