//! The time loop of a run: steps, output, guards, checkpoints.

use super::observer::Observer;
use crate::case::schema::Case;
use crate::run::checkpoint::{Clock, State};
use crate::run::error::RunError;
use crate::run::held::FolderLock;
use crate::run::means::Means;
use crate::run::options::RunOptions;
use crate::run::record::{RecordBasis, Recorder};
use crate::scenario::InitialState;
use crate::scenario::progress::{Progress, Stage};
use crate::scenario::remedy::Remedy;
use dynamics::{Diagnosis, Energies, Moved, Simulation, StepReport};
use output::summary::Status;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Steps between two readings of the energies, at most: `output.history_interval` may be larger.
const READING: u64 = 100;

/// A run under way.
pub(super) struct TimeLoop<'a> {
    case: &'a Case,
    facts: &'a InitialState,
    held: &'a FolderLock,
    simulation: Simulation,
    recorder: Recorder,
    /// The last energies read.
    energies: Energies,
    /// Wall time before this process: of the whole run, and of rolling.
    before: [Duration; 2],
    /// When this process began, and when it began to roll.
    since: [Instant; 2],
    /// Wall time of checkpoints on the time loop's side.
    keeping: Duration,
}

/// Why a run stopped.
pub(super) struct Stopped {
    pub(super) status: Status,
    /// What was wrong and what to do, in a sentence.
    pub(super) diagnosis: Option<String>,
    /// The diagnosis of the guard that stopped the run, if one did.
    pub(super) guard: Option<Diagnosis>,
}

/// A run whose files are closed.
pub(super) struct FinishedRun {
    pub(super) simulation: Simulation,
    pub(super) energies: Energies,
    pub(super) means: Means,
    /// Wall time before this process.
    pub(super) before: Duration,
    /// Wall time of rolling, and of output and checkpoints on the time loop's side.
    pub(super) rolling: Duration,
    pub(super) output: Duration,
    pub(super) keeping: Duration,
}

impl<'a> TimeLoop<'a> {
    /// The run in a process that began at `wall`; `simulation` and `recorder` are those of its first step.
    pub(super) fn new(
        case: &'a Case,
        facts: &'a InitialState,
        held: &'a FolderLock,
        simulation: Simulation,
        recorder: Recorder,
        wall: Instant,
    ) -> Self {
        Self {
            case,
            facts,
            held,
            simulation,
            recorder,
            energies: Energies::default(),
            before: [Duration::ZERO; 2],
            since: [wall, Instant::now()],
            keeping: Duration::ZERO,
        }
    }

    /// Goes on from `state`, which the simulation is in.
    pub(super) fn resume(&mut self, state: State) {
        self.recorder.restore(&state.recorder);
        (self.energies, self.before) = (state.energies, state.wall);
    }

    /// Steps to the end of the case, to a stop request, or until something is wrong.
    pub(super) fn roll(
        &mut self,
        options: &RunOptions,
        basis: &RecordBasis,
        stop: &AtomicBool,
        observe: &mut (dyn FnMut(&Progress) + Send),
    ) -> Result<Stopped, RunError> {
        let (first, steps) = (self.simulation.steps() as u64, self.facts.steps);
        let mut clock = Clock::new(&self.case.checkpoint, self.simulation.dt(), first);
        let mut observer = Observer::new(observe);
        for n in first..steps {
            let stops = stop.load(Ordering::Relaxed);
            // a state that the guards are about to stop must not replace a good checkpoint
            if stops || clock.is_due(n) {
                self.simulation.gather();
                if self.simulation.is_sound() {
                    self.keep(basis)?;
                }
            }
            if stops {
                return Ok(Stopped { status: Status::Interrupted, diagnosis: None, guard: None });
            }
            let moved = self.simulation.move_window().map_err(RunError::of_processes)?;
            if let Some(Moved { lost: lost @ 1.. }) = moved {
                return Ok(self.left_behind(lost));
            }
            if self.recorder.writes_fields(self.simulation.time()) {
                self.simulation.gather();
            }
            self.recorder.before_step(&self.simulation)?;
            let due = self.recorder.reads(n) || n + 1 == steps || n.is_multiple_of(READING);
            let read = due || moved.is_some();
            let report = self.simulation.step(read);
            if let Some(failure) = options.law.as_ref().and_then(|law| law.failure()) {
                let diagnosis = format!("the friction law failed at step {n}: {failure}");
                let status = Status::Failed;
                return Ok(Stopped { status, diagnosis: Some(diagnosis), guard: None });
            }
            if let Some(guard) = self.simulation.check(&report) {
                let diagnosis = Some(format!("{guard}; remedy: {}", guard.remedy()));
                return Ok(Stopped { status: Status::Failed, diagnosis, guard: Some(guard) });
            }
            self.energies = report.energies.unwrap_or(self.energies);
            if self.recorder.reads_bodies(report.time, self.simulation.dt()) {
                self.simulation.gather();
            }
            self.recorder.after_step(&self.simulation, &report)?;
            observer.after_step(n, || self.progress(n - first, &report));
        }
        Ok(Stopped { status: Status::Completed, diagnosis: None, guard: None })
    }

    /// The end of a run whose window does not hold the patch.
    fn left_behind(&self, lost: usize) -> Stopped {
        let diagnosis = format!(
            "stopped at step {}, t = {:.6} ms: {lost} contact points lie outside of the fine zone that follows the contact; \
             remedy: lengthen mesh.window, or widen mesh.zone.width",
            self.simulation.steps(),
            1e3 * self.simulation.time()
        );
        Stopped { status: Status::Failed, diagnosis: Some(diagnosis), guard: None }
    }

    /// Keeps a checkpoint.
    fn keep(&mut self, basis: &RecordBasis) -> Result<(), RunError> {
        let begun = Instant::now();
        self.held.check_owner()?;
        let state = State {
            simulation: self.simulation.snapshot(),
            recorder: self.recorder.snapshot()?,
            energies: self.energies,
            found: self.facts.found(),
            wall: [0, 1].map(|i: usize| self.before[i] + self.since[i].elapsed()),
        };
        let kernels = self.simulation.solid().level().name();
        let provenance = basis.provenance.clone();
        let step = self.simulation.steps() as u64;
        let make = move |results| state.checkpoint(step, provenance, kernels, results);
        self.recorder.keep(make, &basis.folder)?;
        self.keeping += begun.elapsed();
        Ok(())
    }

    /// How far the run is after `done` steps of this process.
    fn progress(&self, done: u64, report: &StepReport) -> Progress {
        let per_s = done as f64 / self.since[1].elapsed().as_secs_f64();
        Progress {
            stage: Stage::Roll,
            step: report.step as u64,
            steps: self.facts.steps,
            time: report.time,
            end_time: self.case.duration(),
            normal_force: report.contact.force[0][2],
            tangential_force: report.contact.force[0][0],
            element_steps_per_s: self.simulation.solid().elements() as f64 * per_s,
            cost: None,
        }
    }

    /// Closes the files.
    pub(super) fn end(mut self) -> Result<FinishedRun, RunError> {
        self.simulation.gather();
        let rolling = self.before[1] + self.since[1].elapsed();
        self.held.check_owner()?;
        let (means, output) = self.recorder.finish(&self.simulation)?;
        Ok(FinishedRun {
            simulation: self.simulation,
            energies: self.energies,
            means,
            before: self.before[0],
            rolling,
            output,
            keeping: self.keeping,
        })
    }
}
