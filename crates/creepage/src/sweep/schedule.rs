//! The runs of a sweep as child processes, so many at a time as cores and memory allow.
//!
//! The standard input of a child is a pipe from this process (`--leash`). [`STOP`] on a line of it asks the run to stop
//! with a checkpoint; the end of the pipe, which a kill of this process also brings about, ends the child. So no run
//! outlives its sweep, and a sweep that is resumed meets no run of the process before it.

use std::collections::{BTreeMap, VecDeque};
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use output::files::input;
use serde::Serialize;
use serde_json::Value;

use crate::scenario::memory::{BYTES_PER_ELEMENT, free_mb};
use crate::sweep::collect::{State, collect_with, state};
use crate::sweep::plan::{CHECK, Plan, SweepError, arguments, log_file, run_folder};
use crate::sweep::points::Point;

/// How often the children are polled.
const LOOK: Duration = Duration::from_millis(20);
/// Part of the free memory that a sweep uses where its budget does not say how much.
const SHARE: f64 = 0.9;

/// The line on a child's standard input that asks it to stop in order.
pub const STOP: &str = "stop";

/// What a sweep may use at a time.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Runs at a time, at least one.
    pub jobs: usize,
    /// Threads of each run, at least one.
    pub threads: usize,
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

/// What a job does.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    Run,
    Check,
}

/// A run under way.
struct Job {
    index: usize,
    stage: Stage,
    child: Child,
    /// The pipe to the child's standard input; none for a check.
    stdin: Option<ChildStdin>,
    /// Part of the run that is done, as the bits of a double.
    progress: Arc<AtomicU64>,
}

/// Runs the runs of `plan` that are not yet done, and returns the sweep's results. `program` is the command to start:
/// its file, and the arguments that come before those of a run.
///
/// A run that fails does not stop the others. A `stop` stops the runs under way with a checkpoint each; the results
/// then say which runs are missing. `observe` is called many times a second.
///
/// # Errors
/// A run that needs more memory than there is, before any is begun; a program that cannot be
/// started; results that cannot be written.
pub fn run(
    plan: &Plan,
    program: &[OsString],
    budget: &Budget,
    stop: &AtomicBool,
    observe: &mut dyn FnMut(&Watched),
) -> Result<Value, SweepError> {
    let memory = budget.memory_mb.unwrap_or_else(|| SHARE * free_mb());
    let needs = |index: usize| plan.runs[index].elements as f64 * BYTES_PER_ELEMENT / 1e6;
    let mut waiting: VecDeque<(usize, Stage)> = VecDeque::new();
    let mut watched =
        Watched { runs: plan.runs.len(), completed: 0, failed: 0, running: 0, fraction: 0.0 };
    for (index, point) in plan.runs.iter().enumerate() {
        match state(&run_folder(&plan.folder, &point.name), point) {
            State::Completed => watched.completed += 1,
            State::Failed(_) => watched.failed += 1,
            State::Unchecked => waiting.push_back((index, Stage::Check)),
            State::Undone(_) => {
                let needed_mb = needs(index);
                if needed_mb > memory {
                    let run = point.name.clone();
                    return Err(SweepError::Memory { run, needed_mb, free_mb: memory });
                }
                waiting.push_back((index, Stage::Run));
            }
        }
    }
    // The longest first, so that none is left alone at the end; equals keep their order.
    let mut by_cost = Vec::from(waiting);
    by_cost.sort_by(|a, b| cost(&plan.runs[b.0]).total_cmp(&cost(&plan.runs[a.0])));
    let mut waiting = VecDeque::from(by_cost);
    let total: f64 = waiting.iter().map(|&(index, _)| cost(&plan.runs[index])).sum();
    let mut ended = 0.0;
    let mut failures: BTreeMap<String, String> = BTreeMap::new();
    let mut jobs: Vec<Job> = Vec::new();
    let mut stopping = false;
    while !jobs.is_empty() || !(waiting.is_empty() || stopping) {
        if stop.load(Ordering::Relaxed) && !stopping {
            stopping = true;
            jobs.iter_mut().for_each(Job::ask_to_stop);
        }
        while !stopping && jobs.len() < budget.jobs {
            let used: f64 = jobs.iter().map(|job| needs(job.index)).sum();
            let fits = |&(index, _): &(usize, Stage)| used + needs(index) <= memory;
            let Some(next) = waiting.iter().position(fits).and_then(|at| waiting.remove(at)) else {
                break;
            };
            jobs.push(Job::begin(plan, program, budget.threads, next)?);
        }
        let mut at = 0;
        while at < jobs.len() {
            let failed = |cause| SweepError::File { path: program_file(program), cause };
            let Some(exit) = jobs[at].child.try_wait().map_err(failed)? else {
                at += 1;
                continue;
            };
            let job = jobs.swap_remove(at);
            let point = &plan.runs[job.index];
            let folder = run_folder(&plan.folder, &point.name);
            // A check exits with 1 where a measure is beyond its limit: its document is complete all the same.
            if job.stage == Stage::Check && matches!(exit.code(), Some(0 | 1)) {
                let failed = |cause| SweepError::File { path: folder.join(CHECK), cause };
                fs::rename(partial_check(&folder), folder.join(CHECK)).map_err(failed)?;
            }
            match state(&folder, point) {
                State::Completed => watched.completed += 1,
                State::Unchecked if job.stage == Stage::Run => {
                    waiting.push_front((job.index, Stage::Check));
                    continue;
                }
                State::Failed(_) => watched.failed += 1,
                State::Unchecked | State::Undone(_) if stopping => {}
                State::Unchecked | State::Undone(_) => {
                    let reason = reason(&log_file(&plan.folder, &point.name));
                    let what = if job.stage == Stage::Check { "its check: " } else { "" };
                    failures.insert(point.name.clone(), format!("{what}{reason} ({exit})"));
                    watched.failed += 1;
                }
            }
            ended += cost(point);
        }
        watched.running = jobs.len();
        let under_way: f64 = jobs.iter().map(|job| cost(&plan.runs[job.index]) * job.done()).sum();
        watched.fraction = if total > 0.0 { (ended + under_way) / total } else { 1.0 };
        observe(&watched);
        std::thread::sleep(LOOK);
    }
    collect_with(plan, &[], &failures)
}

/// A rough cost of a run: elements times the steps at the speed of pressure waves in steel. Only ratios matter.
fn cost(point: &Point) -> f64 {
    const WAVE_SPEED: f64 = 6e3;
    let case = &point.case;
    let step = case.step().under(case.mesh.zone.size / WAVE_SPEED);
    point.elements.max(1) as f64 * case.duration() / step
}

/// The file of a program.
fn program_file(program: &[OsString]) -> PathBuf {
    program.first().cloned().unwrap_or_default().into()
}

fn partial_check(folder: &Path) -> PathBuf {
    folder.join(format!("{CHECK}.partial"))
}

impl Job {
    fn begin(
        plan: &Plan,
        program: &[OsString],
        threads: usize,
        (index, stage): (usize, Stage),
    ) -> Result<Self, SweepError> {
        let name = &plan.runs[index].name;
        let folder = run_folder(&plan.folder, name);
        let log_path = log_file(&plan.folder, name);
        let failed = |path: &Path| {
            let path = path.to_path_buf();
            move |cause| SweepError::File { path, cause }
        };
        let log = match stage {
            Stage::Run => File::create(&log_path),
            Stage::Check => OpenOptions::new().append(true).create(true).open(&log_path),
        };
        let log = log.map_err(failed(&log_path))?;
        let [run, check] = arguments(&plan.folder, name, threads);
        let mut command = Command::new(program_file(program));
        command.args(program.iter().skip(1)).stderr(log);
        match stage {
            Stage::Run => {
                command.args(run).args(["--leash", "--quiet"]);
                command.stdin(Stdio::piped()).stdout(Stdio::piped());
            }
            Stage::Check => {
                let partial = partial_check(&folder);
                let document = File::create(&partial).map_err(failed(&partial))?;
                command.args(check).stdin(Stdio::null()).stdout(document);
            }
        }
        let mut child = command.spawn().map_err(failed(&program_file(program)))?;
        let progress = Arc::new(AtomicU64::new(0));
        if let Some(stdout) = child.stdout.take() {
            let progress = Arc::clone(&progress);
            let reads = std::thread::Builder::new().spawn(move || {
                for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                    if let Ok(done) = line.parse::<f64>() {
                        progress.store(done.clamp(0.0, 1.0).to_bits(), Ordering::Relaxed);
                    }
                }
            });
            // on an error the pipe is closed, and the child ends
            reads.map_err(failed(&program_file(program)))?;
        }
        let stdin = child.stdin.take();
        Ok(Self { index, stage, child, stdin, progress })
    }

    fn done(&self) -> f64 {
        match self.stage {
            Stage::Run => f64::from_bits(self.progress.load(Ordering::Relaxed)),
            Stage::Check => 1.0,
        }
    }

    /// Asks a run to stop in order; kills a check, which has nothing to save. Either may just have ended by itself, so
    /// that errors do not matter.
    fn ask_to_stop(&mut self) {
        match &mut self.stdin {
            Some(stdin) => {
                let _ = writeln!(stdin, "{STOP}");
                let _ = stdin.flush();
            }
            None => {
                let _ = self.child.kill();
            }
        }
    }
}

/// Why a process failed, by its log: the message of its error report, or its last line.
fn reason(log: &Path) -> String {
    let text = input::text(log, input::LOG).unwrap_or_default();
    let message = text.lines().find_map(|line| line.trim_start().strip_prefix('\u{d7}'));
    let last = || text.lines().rev().find(|line| !line.trim().is_empty());
    message.or_else(last).unwrap_or("it left no results and no message").trim().to_owned()
}
