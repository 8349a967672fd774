//! A run at its start: preloaded, or in the state of the checkpoint that it goes on from.

use super::opening::Opened;
use super::options::RunOptions;
use crate::checkpoint::State;
use crate::error::RunError;
use crate::log::REFUSED;
use crate::resume::Point;
use crate::summary::{without_rolling, write as write_summary};
use case::schema::Case;
use output::{Checkpoint, LOG_END};
use scenario::{Model, Start};
use scenario::{Progress, ScenarioError};
use scenario::{restart, start};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The checkpoint that a run goes on from.
pub(super) struct Resumed {
    pub(super) checkpoint: Checkpoint,
    pub(super) state: State,
}

/// How a run begins.
pub(super) enum Begun {
    /// No preload was found, or a stop was asked for: the summary that says so.
    NotPreloaded(serde_json::Value),
    /// The simulation can be stepped; with the checkpoint of a resumed run.
    Rolling(Box<Start>, Option<Box<Resumed>>),
}

/// Preloads the model of a run, or takes the state of its checkpoint.
pub(super) fn begin(
    case: &Case,
    options: &RunOptions,
    opened: &mut Opened<Model, State>,
    wall: Instant,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
) -> Result<Begun, RunError> {
    if let Some(point) = opened.point.take() {
        return resume(case, options, opened, point);
    }
    let Opened { model, log, .. } = opened;
    let cache = options.preload_cache.as_deref();
    match start(case, model, cache, stop, observe, &mut |line| log.say(line)) {
        Err(ScenarioError::Preload(error)) => {
            let summary = without_rolling(case, model, options.threads, wall, &error);
            let document = write_summary(&options.out, &summary)?;
            log.say(&format!("{LOG_END}{:?} before rolling: {error}", summary.status))?;
            Ok(Begun::NotPreloaded(document))
        }
        Err(error) => {
            log.say(&format!("{REFUSED}{error}"))?;
            Err(error.into())
        }
        Ok(start) => {
            start.facts.preload.iter().try_for_each(|preload| log.say(&preload.line()))?;
            Ok(Begun::Rolling(Box::new(start), None))
        }
    }
}

fn resume(
    case: &Case,
    options: &RunOptions,
    opened: &mut Opened<Model, State>,
    point: Point<State>,
) -> Result<Begun, RunError> {
    let Point { checkpoint, state, .. } = point.tell(&options.out, &mut opened.log)?;
    let start = restart(case, &opened.model, state.found.clone(), &state.simulation)?;
    Ok(Begun::Rolling(Box::new(start), Some(Box::new(Resumed { checkpoint, state }))))
}
