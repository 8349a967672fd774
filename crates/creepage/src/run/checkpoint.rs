//! The whole state of a run, and when it is written as a checkpoint.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::case::schema;
use crate::run::record::RecorderState;
use crate::run::text_file::remove;
use crate::scenario::KeptState;
use dynamics::{Energies, SimulationState};
use output::{CHECKPOINTS, Checkpoint, NotWritten, OutputError, Provenance, Results};
use serde::{Deserialize, Serialize};

/// Attribute: the instruction set of the kernels.
pub(crate) const KERNELS: &str = "kernels";

/// The state of a run of finite elements.
pub(crate) type State = RunState<SimulationState, RecorderState, KeptState>;

/// Everything that a run needs to go on with the same bits: the state of the bodies, of the recorder, and what was found
/// before they began to move.
#[derive(Serialize, Deserialize)]
pub(crate) struct RunState<S, R, F> {
    pub(crate) simulation: S,
    pub(crate) recorder: R,
    /// The last energies read.
    pub(crate) energies: Energies,
    pub(crate) found: F,
    /// Wall time so far: of the whole run, and of rolling.
    pub(crate) wall: [Duration; 2],
}

/// When the next checkpoint is due.
pub(crate) struct Clock {
    steps: Option<u64>,
    wall: Option<Duration>,
    /// Step and instant of the last checkpoint, or of the beginning.
    last: (u64, Instant),
    /// Whether none was written yet: the first is due at once.
    first: bool,
}

impl Clock {
    pub(crate) fn new(case: &schema::Checkpoint, dt: f64, step: u64) -> Self {
        let in_time = case.time.map(|time| (time / dt).round().max(1.0) as u64);
        Self {
            steps: case.steps.into_iter().chain(in_time).min(),
            wall: (case.wall_minutes > 0.0)
                .then(|| Duration::from_secs_f64(60.0 * case.wall_minutes)),
            last: (step, Instant::now()),
            first: step == 0,
        }
    }

    /// Whether one is due before step `step`; the next interval then begins.
    pub(crate) fn is_due(&mut self, step: u64) -> bool {
        let (at, instant) = self.last;
        // the preload took time: its result is kept at once
        let any = self.steps.is_some() || self.wall.is_some();
        let due = (self.first && any)
            || self.steps.is_some_and(|interval| step - at >= interval)
            || self.wall.is_some_and(|interval| instant.elapsed() >= interval);
        if due {
            self.first = false;
            self.last = (step, Instant::now());
        }
        due
    }
}

/// Removes the checkpoints of a run.
pub(crate) fn remove_checkpoints(folder: &Path) -> Result<(), NotWritten> {
    CHECKPOINTS.iter().try_for_each(|name| remove(&folder.join(name)))
}

impl<S: Serialize, R: Serialize, F: Serialize> RunState<S, R, F> {
    /// The checkpoint of this state at `step`; `results` says how much of the result files belongs to it.
    pub(crate) fn checkpoint(
        &self,
        step: u64,
        mut provenance: Provenance,
        kernels: &str,
        results: Results,
    ) -> Result<Checkpoint, OutputError> {
        provenance.attributes = vec![(KERNELS.into(), kernels.into())];
        Checkpoint::new(provenance, step, results, self)
    }
}
