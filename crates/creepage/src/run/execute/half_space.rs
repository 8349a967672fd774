//! The run of two half-spaces.

mod ending;
mod recorder;

use super::observer::Observer;
use super::opening::{OpenRun, Opening, open};
use super::{basis, complete, stage};
use crate::case::schema::Case;
use crate::run::checkpoint::{Clock, RunState};
use crate::run::error::RunError;
use crate::run::held::FolderLock;
use crate::run::log::Log;
use crate::run::options::RunOptions;
use crate::run::progress_lines;
use crate::run::record::RecordBasis;
use crate::run::resume::ResumePoint;
use crate::run::text_file::remove;
use crate::scenario::progress::{Progress, Stage};
use crate::scenario::{HalfSpaceModel, ScenarioError, drive, half_space};
use dynamics::Energies;
use ending::{Ended, conclude};
use halfspace::{Rolling, RollingState, StepSums};
use output::NotWritten;
use output::layout::file;
use output::summary::{Status, Summary};
use recorder::{HalfSpaceRecorder, HalfSpaceRecorderState};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A step whose friction converged no better than this (of the largest trial velocity, which is some hundred times the
/// largest slip velocity) ends the run.
const UNCONVERGED: f64 = 1e-6;

/// The arithmetic of half-spaces is that of every machine.
const KERNELS: solid::Level = solid::Level::Portable;

type State = RunState<RollingState, HalfSpaceRecorderState, ()>;

/// Runs a case with half-spaces; arguments and errors as of [`run`](super::run).
pub(super) fn run(
    case: &Case,
    options: &RunOptions,
    wall: Instant,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
) -> Result<Summary, RunError> {
    observe(&stage(case, Stage::Mesh));
    let make = |_: Option<&ResumePoint<State>>| Ok(half_space(case, options.law.as_ref())?);
    let opened = match open(case, options, make, tell)? {
        Opening::Complete(summary) => return Ok(complete(&options.folder(case), *summary)),
        Opening::Run(opened) => *opened,
    };
    let OpenRun { held, mut log, mut model, point } = opened;
    let observe = &mut log.progress(progress_lines::INTERVAL)?.beside(observe);
    let point = point.map(|point| point.tell(&options.folder(case), &mut log)).transpose()?;
    if point.is_none() {
        model.warnings.iter().try_for_each(|line| log.warn(line))?;
    }
    let basis = basis(case, options, point.as_ref());
    held.check_owner()?;
    if point.is_some() {
        remove(&options.folder(case).join(file::SUMMARY))?;
    }
    let mut recorder = HalfSpaceRecorder::new(case, &model, &basis)?;
    let (mut energies, mut before) = (Energies::default(), [Duration::ZERO; 2]);
    if let Some(ResumePoint { state, .. }) = point {
        model.rolling.restore(&state.simulation).map_err(ScenarioError::from)?;
        recorder.restore(&state.recorder);
        (energies, before) = (state.energies, state.wall);
    }
    let mut under_way = UnderWay {
        case,
        held: &held,
        model,
        recorder,
        energies,
        before,
        since: [wall, Instant::now()],
        keeping: Duration::ZERO,
    };
    let (status, diagnosis) = under_way.roll(options, &basis, stop, observe)?;
    if let Some(line) = &diagnosis {
        log.say(line)?;
    }
    let UnderWay { model, recorder, energies, before, since, keeping, .. } = under_way;
    held.check_owner()?;
    let facts = recorder.facts();
    let ended = Ended {
        status,
        diagnosis,
        energies,
        means: recorder.finish()?,
        facts,
        wall: before[0] + wall.elapsed(),
        rolling: before[1] + since[1].elapsed(),
        keeping,
    };
    conclude(case, options, &model, ended, &basis, &held, &mut log)
}

fn tell(model: &HalfSpaceModel, log: &mut Log) -> Result<(), NotWritten> {
    let [nx, ny] = model.rolling.grid();
    let (memory, faded) = model.rolling.memory();
    log.say(&format!(
        "half-spaces: grid of {nx} x {ny} points that the patch rolls around, memory of {memory} steps, {:.1} MB",
        model.rolling.bytes() as f64 / 1e6
    ))?;
    if faded > 0.0 {
        log.say(&format!(
            "plane strain: {:.1} % of the static compliance across the patch acts without waves, since the memory fades",
            100.0 * faded
        ))?;
    }
    model.position.iter().flat_map(|at| at.lines()).try_for_each(|line| log.say(&line))?;
    log.say(&format!("step: {:.4e} s; {} steps", model.rolling.step_length(), model.steps))?;
    model.numbers.line().iter().try_for_each(|line| log.say(line))
}

/// A run under way.
struct UnderWay<'a> {
    case: &'a Case,
    held: &'a FolderLock,
    model: HalfSpaceModel,
    recorder: HalfSpaceRecorder,
    /// Summed up to the last step.
    energies: Energies,
    /// Wall time before this process: of the whole run, and of rolling.
    before: [Duration; 2],
    /// When this process began, and when it began to roll.
    since: [Instant; 2],
    /// Wall time of checkpoints on the time loop's side.
    keeping: Duration,
}

impl UnderWay<'_> {
    /// Steps to the end of the case, to a stop request, or until something is wrong; then with what is wrong and what to do.
    fn roll(
        &mut self,
        options: &RunOptions,
        basis: &RecordBasis,
        stop: &AtomicBool,
        observe: &mut (dyn FnMut(&Progress) + Send),
    ) -> Result<(Status, Option<String>), RunError> {
        let first = self.model.rolling.steps() as u64;
        let dt = self.model.rolling.step_length();
        let mut clock = Clock::new(&self.case.checkpoint, dt, first);
        let mut observer = Observer::new(observe);
        for n in first..self.model.steps {
            let stops = stop.load(Ordering::Relaxed);
            if stops || clock.is_due(n) {
                self.keep(basis)?;
            }
            if stops {
                return Ok((Status::Interrupted, None));
            }
            let time = (n + 1) as f64 * dt;
            let sums = self.model.rolling.step(drive(
                self.case,
                &self.model.motion,
                time,
                self.model.width,
            ));
            if let Some(failure) = options.law.as_ref().and_then(|law| law.failure()) {
                let diagnosis = format!("the friction law failed at step {}: {failure}", n + 1);
                return Ok((Status::Failed, Some(diagnosis)));
            }
            if let Some(diagnosis) = unsound(&sums) {
                return Ok((Status::Failed, Some(diagnosis)));
            }
            add_work(&mut self.energies, &sums, dt * self.model.width);
            self.recorder.after_step(self.case, &self.model, &sums, &self.energies)?;
            observer.after_step(n, || self.progress(n - first, &sums));
        }
        Ok((Status::Completed, None))
    }

    /// Keeps a checkpoint.
    fn keep(&mut self, basis: &RecordBasis) -> Result<(), RunError> {
        let begun = Instant::now();
        self.held.check_owner()?;
        let state = State {
            simulation: self.model.rolling.snapshot(),
            recorder: self.recorder.snapshot()?,
            energies: self.energies,
            found: (),
            wall: [0, 1].map(|i: usize| self.before[i] + self.since[i].elapsed()),
        };
        let (step, provenance) = (self.model.rolling.steps() as u64, basis.provenance.clone());
        let make = move |results| state.checkpoint(step, provenance, KERNELS.name(), results);
        self.recorder.keep(make, &basis.folder)?;
        self.keeping += begun.elapsed();
        Ok(())
    }

    /// How far the run is after `done` steps of this process.
    fn progress(&self, done: u64, sums: &StepSums) -> Progress {
        let per_s = done as f64 / self.since[1].elapsed().as_secs_f64();
        Progress {
            stage: Stage::Roll,
            step: sums.step as u64,
            steps: self.model.steps,
            time: sums.time,
            end_time: self.case.duration(),
            normal_force: self.model.width * sums.normal,
            tangential_force: self.model.width * sums.shear[0],
            element_steps_per_s: points(&self.model.rolling) * per_s,
            cost: None,
        }
    }
}

/// Points of the grid.
fn points(rolling: &Rolling) -> f64 {
    rolling.grid().iter().product::<usize>() as f64
}

/// Adds what a step stores and dissipates over `time` (s, times the width in plane strain): the energy of the half-spaces,
/// elastic and kinetic, is the work of the tractions on them.
fn add_work(energies: &mut Energies, sums: &StepSums, time: f64) {
    energies.internal += time * sums.stored;
    energies.friction_dissipated += time * sums.dissipated;
    energies.external_work += time * sums.driven;
}

/// What is wrong with a step, and what to do.
fn unsound(sums: &StepSums) -> Option<String> {
    let at = format!("stopped at step {}, t = {:.6} ms", sums.step, 1e3 * sums.time);
    let finite = sums.shear.iter().chain([&sums.normal, &sums.stored]).all(|x| x.is_finite());
    if !finite || sums.unconverged.is_infinite() {
        return Some(format!("{at}: a traction is not a number; remedy: check the friction law"));
    }
    (sums.unconverged > UNCONVERGED).then(|| {
        format!(
            "{at}: no tractions that obey the friction law were found; the last of {} iterations still changed the slip velocity by \
             {:.1e} of the largest trial velocity; remedy: a shorter time.step, or friction with memory",
            sums.iterations, sums.unconverged
        )
    })
}
