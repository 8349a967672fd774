//! The runs of a sweep in this process, so many at a time as cores and memory allow.
//!
//! A kill of the process ends all of them; a sweep that is resumed goes on from their checkpoints.

use std::any::Any;
use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use serde::Serialize;

use crate::scenario::memory::{BYTES_PER_ELEMENT, free_mb};
use crate::sweep::collect::{State, collect_with, state};
use crate::sweep::plan::{Plan, SweepError, run_folder};
use crate::sweep::points::Point;
use crate::sweep::result::SweepResult;

/// How often a sweep looks how far it is.
const LOOK: Duration = Duration::from_millis(20);
/// Part of the free memory that a sweep uses where its budget does not say how much.
const SHARE: f64 = 0.9;
/// Stack of the thread of a run (bytes), as the first thread of a program has it.
const STACK: usize = 8 << 20;

/// What a sweep may use at a time.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Runs at a time, at least one.
    pub jobs: usize,
    /// Memory of all runs together (MB); without it, nine tenths of what is free.
    pub memory_mb: Option<f64>,
}

/// How far a sweep is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Watched {
    /// Runs in all.
    pub runs: usize,
    /// Runs that are completed and checked, by this call or before.
    pub completed: usize,
    /// Runs that failed.
    pub failed: usize,
    /// Runs under way.
    pub running: usize,
    /// Part of this call's work that is done, from 0 to 1, by a rough cost of each run.
    pub fraction: f64,
}

/// What is done with a run.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// It runs to its end, from its checkpoint if it has one.
    Run,
    /// The contact conditions are checked in it.
    Check,
}

/// How far a run is, from 0 to 1.
#[derive(Debug, Default)]
pub struct Done(AtomicU64);

impl Done {
    /// Says it.
    pub fn set(&self, part: f64) {
        self.0.store(part.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
    }

    fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }
}

/// Does the work of a stage of a run, and says what kept it from its end.
pub type Work<'a> = &'a (dyn Fn(&Point, Stage, &Done) -> Result<(), String> + Sync);

/// The runs that a call of [`run`] does.
struct Pool<'a> {
    plan: &'a Plan,
    work: Work<'a>,
    stop: &'a AtomicBool,
    waiting: Mutex<VecDeque<(usize, Stage)>>,
    counts: Mutex<Counts>,
    done: Vec<Done>,
}

/// What has become of the runs.
struct Counts {
    watched: Watched,
    /// Cost of the runs that this call has ended.
    ended: f64,
    /// Indices of the runs under way.
    running: Vec<usize>,
    /// Why runs failed that left no reason in their folders, by name.
    failures: BTreeMap<String, String>,
}

/// Does the runs of `plan` that are not yet done, each by `work`, and returns the sweep's results.
///
/// A run that fails does not stop the others. `stop` is also the flag of the runs: those under way end with a
/// checkpoint, the others are not begun, and the results say which are missing. `observe` is called many times a second.
///
/// # Errors
/// A run that needs more memory than there is, before any is begun; a thread that cannot be started; results that
/// cannot be written.
pub fn run(
    plan: &Plan,
    work: Work<'_>,
    budget: &Budget,
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Watched),
) -> Result<SweepResult, SweepError> {
    let mut watched =
        Watched { runs: plan.runs.len(), completed: 0, failed: 0, running: 0, fraction: 0.0 };
    let mut waiting: Vec<(usize, Stage)> = Vec::new();
    for (index, point) in plan.runs.iter().enumerate() {
        match state(&run_folder(&plan.folder, &point.name), point) {
            State::Completed => watched.completed += 1,
            State::Failed(_) => watched.failed += 1,
            State::Unchecked => waiting.push((index, Stage::Check)),
            State::Undone(_) => waiting.push((index, Stage::Run)),
        }
    }
    let jobs = at_a_time(plan, &waiting, budget)?.min(waiting.len());
    // The longest first, so that none is left alone at the end; equals keep their order.
    waiting.sort_by(|a, b| cost(&plan.runs[b.0]).total_cmp(&cost(&plan.runs[a.0])));
    let total: f64 = waiting.iter().map(|&(index, _)| cost(&plan.runs[index])).sum();
    let counts = Counts { watched, ended: 0.0, running: Vec::new(), failures: BTreeMap::new() };
    let pool = Pool {
        plan,
        work,
        stop,
        waiting: Mutex::new(waiting.into()),
        counts: Mutex::new(counts),
        done: plan.runs.iter().map(|_| Done::default()).collect(),
    };
    std::thread::scope(|scope| {
        let mut threads = Vec::new();
        for _ in 0..jobs {
            let thread = std::thread::Builder::new().stack_size(STACK);
            let thread = thread.spawn_scoped(scope, || pool.work_off());
            threads.push(
                thread.map_err(|cause| SweepError::File { path: plan.folder.clone(), cause })?,
            );
        }
        while !threads.iter().all(|thread| thread.is_finished()) {
            observe(&pool.watched(total));
            std::thread::sleep(LOOK);
        }
        observe(&pool.watched(total));
        Ok::<(), SweepError>(())
    })?;
    collect_with(plan, &[], &held(&pool.counts).failures)
}

/// How many runs at a time the memory holds of those that wait, at most as many as the budget says.
fn at_a_time(
    plan: &Plan,
    waiting: &[(usize, Stage)],
    budget: &Budget,
) -> Result<usize, SweepError> {
    let memory = budget.memory_mb.unwrap_or_else(|| SHARE * free_mb());
    let needed = |point: &Point| point.elements as f64 * BYTES_PER_ELEMENT / 1e6;
    let runs = waiting.iter().filter(|(_, stage)| *stage == Stage::Run);
    let points = runs.map(|&(index, _)| &plan.runs[index]);
    let Some(largest) = points.max_by(|a, b| needed(a).total_cmp(&needed(b))) else {
        return Ok(budget.jobs);
    };
    let needed_mb = needed(largest);
    if needed_mb > memory {
        let run = largest.name.clone();
        return Err(SweepError::Memory { run, needed_mb, free_mb: memory });
    }
    Ok(budget.jobs.min((memory / needed_mb.max(1.0)) as usize).max(1))
}

impl Pool<'_> {
    /// Takes runs from those that wait until there are none, or the sweep stops.
    fn work_off(&self) {
        while let Some((index, stage)) = self.next() {
            held(&self.counts).running.push(index);
            let point = &self.plan.runs[index];
            let folder = run_folder(&self.plan.folder, &point.name);
            let mut outcome = self.do_stage(index, stage);
            if stage == Stage::Run && state(&folder, point) == State::Unchecked {
                outcome = self.do_stage(index, Stage::Check);
            }
            self.enter(index, &state(&folder, point), outcome);
        }
    }

    fn next(&self) -> Option<(usize, Stage)> {
        if self.stop.load(Ordering::Relaxed) {
            return None;
        }
        held(&self.waiting).pop_front()
    }

    fn do_stage(&self, index: usize, stage: Stage) -> Result<(), String> {
        let of = if stage == Stage::Check { "its check: " } else { "" };
        let work = || (self.work)(&self.plan.runs[index], stage, &self.done[index]);
        let outcome = catch_unwind(AssertUnwindSafe(work));
        outcome.unwrap_or_else(|panic| Err(reason(&*panic))).map_err(|why| format!("{of}{why}"))
    }

    /// Enters what a run has come to.
    fn enter(&self, index: usize, state: &State, outcome: Result<(), String>) {
        let point = &self.plan.runs[index];
        let mut counts = held(&self.counts);
        counts.running.retain(|running| *running != index);
        counts.ended += cost(point);
        match state {
            State::Completed => counts.watched.completed += 1,
            State::Failed(_) => counts.watched.failed += 1,
            State::Unchecked | State::Undone(_) => {
                // a run that was asked to stop ends without an error
                if let Err(why) = outcome {
                    counts.failures.insert(point.name.clone(), why);
                    counts.watched.failed += 1;
                }
            }
        }
    }

    fn watched(&self, total: f64) -> Watched {
        let counts = held(&self.counts);
        let under_way =
            counts.running.iter().map(|&i| cost(&self.plan.runs[i]) * self.done[i].get());
        let done = counts.ended + under_way.sum::<f64>();
        Watched {
            running: counts.running.len(),
            fraction: if total > 0.0 { done / total } else { 1.0 },
            ..counts.watched.clone()
        }
    }
}

/// What a mutex holds; a thread that panicked while it held it has left it as it was.
fn held<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// What a panic says.
fn reason(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    format!("the program panicked: {}", text.as_deref().unwrap_or("without a message"))
}

/// A rough cost of a run: elements times the steps at the speed of pressure waves in steel. Only ratios matter.
fn cost(point: &Point) -> f64 {
    const WAVE_SPEED: f64 = 6e3;
    let case = &point.case;
    let step = case.step().under(case.mesh.zone.size / WAVE_SPEED);
    point.elements.max(1) as f64 * case.duration() / step
}
