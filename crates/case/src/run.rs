//! From a resolved case to a finished run.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime};

use crate::checkpoint::{Clock, State};
use crate::disk::Disk;
use crate::folder::{self, Content, LOG};
use crate::guards::READING;
use crate::hertz::hertz;
use crate::load::inputs;
use crate::log::Log;
use crate::memory::{BYTES_PER_ELEMENT, enough_for_zones, enough_memory};
use crate::model::Model;
use crate::postmortem::{self, POSTMORTEM};
use crate::progress::{Progress, Stage};
use crate::record::{Basis, Recorder};
use crate::remedy::Remedy;
use crate::resume::{self, Origin, Point};
use crate::run_error::RunError;
use crate::schema::Case;
use crate::start::{Start, restart, start};
use crate::summary::{Ending, summary, without_rolling, write as write_summary};
use crate::validation;
use dynamics::Energies;
use friction::{Kind, OwnLaw};
use output::summary::Status;
use output::{CHECKPOINTS, LOG_END, Provenance};

/// How the last line of the log begins where a run was refused after its mesh was made.
pub(crate) const REFUSED: &str = "end: refused before rolling: ";

/// How to run a case, apart from what the case itself says.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder of the run.
    pub out: PathBuf,
    /// Number of threads, at least one.
    pub threads: usize,
    /// Replace the run that is already in `out`.
    pub force: bool,
    /// Go on with the run in `out` from its last checkpoint; with `force`, begin anew where that is
    /// not possible.
    pub resume: bool,
    /// Folder in which preloads are kept for other runs with the same, and taken from.
    pub preload_cache: Option<PathBuf>,
    /// The case file, for the log.
    pub source: PathBuf,
    /// The friction law of a case with `friction.law = "python"`.
    pub law: Option<Arc<dyn OwnLaw>>,
}

/// Runs a case to its end, to a stop request or to a guard, and returns its summary.
///
/// A run that a guard stopped has the status `failed` and a `diagnosis`; one that was interrupted
/// has the status `interrupted`. In both cases the results so far are readable.
pub fn run(
    case: &Case,
    options: &RunOptions,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
) -> Result<serde_json::Value, RunError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads).build()?;
    // The whole run inside the pool: entering it costs microseconds, a step of a small case few more.
    let mut result = pool.install(|| run_in_pool(case, options, stop, observe));
    if let Err(RunError::Output(error)) = &result
        && (options.resume && options.force)
        && error.damaged().is_some()
    {
        // found only when the files were opened to be extended
        tracing::warn!("{error}; the run begins at its start");
        let anew = RunOptions { resume: false, ..options.clone() };
        result = pool.install(|| run_in_pool(case, &anew, stop, observe));
    }
    if let Err(error @ (RunError::Output(_) | RunError::Text { .. })) = &result {
        // as far as that is possible where files could not be written
        let _ = Log::append(options.out.join(LOG))
            .and_then(|mut log| log.say(&format!("{LOG_END}Failed, {error}")));
    }
    result
}

fn run_in_pool(
    case: &Case,
    options: &RunOptions,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
) -> Result<serde_json::Value, RunError> {
    let wall = Instant::now();
    if case.friction.law == Kind::Python && options.law.is_none() {
        return Err(RunError::NoLaw);
    }
    let begun = folder::is_run(&options.out) || folder::content(&options.out) == Content::Beginning;
    let held = if options.resume && begun { Some(folder::take(&options.out)?) } else { None };
    let (origin, why) = match origin(case, options)? {
        Some(Origin::Complete(summary)) => return Ok(complete(&options.out, summary)),
        Some(Origin::Checkpoint(point)) => (Some(*point), None),
        Some(Origin::Beginning(why)) => (None, Some(why)),
        None => (None, None),
    };
    let replaces = options.force || why.is_some();
    if origin.is_none() {
        // The same case begun anew from its own folder reads what it then writes.
        if options.force && !(options.resume && resume::is_of(case, &options.out)) {
            folder::spare(&options.out, &inputs(case, &options.source))?;
        }
        // A mesh that is refused must cost no earlier run its results.
        folder::check(&options.out, replaces)?;
    }
    enough_for_zones(case, BYTES_PER_ELEMENT)?;
    let mut model = Model::build(case)?;
    model.law = options.law.clone();
    if let Some(point) = &origin {
        model.kernels = point.kernels;
    }
    enough_memory(model.mesh.hexes.len())?;
    let log_file = options.out.join(LOG);
    let (held, mut log) = match (&origin, held) {
        (Some(_), Some(held)) => (held, Log::append(log_file)?),
        (_, held) => (folder::prepare(&options.out, replaces, held)?, Log::new(log_file)?),
    };
    write_text(options.out.join("case.toml"), &case.to_toml())?;
    log.say(&format!(
        "creepage {}: {} from {}",
        env!("CARGO_PKG_VERSION"),
        case.name,
        options.source.display()
    ))?;
    if let Some(why) = why {
        log.warn(&format!("nothing to go on from, the run begins at its start: {why}"))?;
    }
    case.warnings().iter().try_for_each(|w| log.say(&format!("warning: {w}")))?;
    model.notes.iter().try_for_each(|note| log.warn(&format!("mesh: {note}")))?;
    let elements = model.mesh.hexes.len();
    log.say(&format!("mesh: {elements} elements, {} nodes", model.mesh.nodes.len()))?;
    if model.fully_integrated() > 0 {
        log.say(&format!("fully integrated: {} elements", model.fully_integrated()))?;
    }
    observe(&stage(case, Stage::Mesh));

    let mut resumed = None;
    let begun = match origin {
        Some(Point { checkpoint, state, damaged, .. }) => {
            for (name, damage) in damaged {
                log.warn(&format!("not used, {name}: {damage}; the one before is"))?;
                // it must not push a good one out
                remove(&options.out.join(name))?;
            }
            log.say(&format!("resumed from the checkpoint of step {}", checkpoint.step))?;
            let begun = restart(case, &model, state.found.clone(), &state.simulation)?;
            resumed = Some((checkpoint, state));
            begun
        }
        None => {
            let cache = options.preload_cache.as_deref();
            match start(case, &model, cache, stop, observe, &mut |line| log.say(line)) {
                Err(RunError::Preload(error)) => {
                    let summary = without_rolling(case, &model, options.threads, wall, &error);
                    let document = write_summary(&options.out, &summary)?;
                    log.say(&format!("{LOG_END}{:?} before rolling: {error}", summary.status))?;
                    return Ok(document);
                }
                Err(error) => {
                    log.say(&format!("{REFUSED}{error}"))?;
                    return Err(error);
                }
                Ok(begun) => begun,
            }
        }
    };
    let Start { mut simulation, facts } = begun;
    let (stability, steps) = (facts.stability, facts.steps);
    if let (Some(preload), None) = (&facts.preload, &resumed) {
        log.say(&preload.line())?;
    }
    log.say(&format!(
        "step: {:.4e} s, {:.3} of the limit 2/omega_max (omega_max {:.4e} rad/s with contact, \
         {:.4e} without); {steps} steps; kernels: {}",
        simulation.dt(),
        stability.factor,
        stability.omega_max,
        stability.omega_elastic,
        simulation.solid().level().name()
    ))?;
    if let Some(line) = facts.numbers.line() {
        log.say(&line)?;
    }
    if let Some(line) = facts.numbers.expectation() {
        log.warn(&line)?;
    }
    if resumed.is_none() {
        let below = validation::below_the_step(case, simulation.dt());
        below.iter().try_for_each(|line| log.warn(line))?;
    }
    if let (None, Some(line)) =
        (&resumed, Disk::of(case, &model, steps as f64).shortage(&options.out))
    {
        log.warn(&line)?;
    }
    let hertz = hertz(case);
    let created = match &resumed {
        Some((checkpoint, _)) => checkpoint.provenance.created.clone(),
        None => humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
    };
    let basis = Basis {
        folder: &options.out,
        provenance: Provenance {
            creepage_version: env!("CARGO_PKG_VERSION").into(),
            case_hash: case.hash(),
            created,
            attributes: Vec::new(),
        },
        effective_radius: facts.radius.effective,
        hertz_pressure: hertz.p0,
        keeps: resumed.as_ref().map(|(checkpoint, _)| checkpoint.results.clone()),
    };
    // another process may have come during the preload
    held.prove()?;
    if resumed.is_some() {
        // the word of an interruption or a stop holds no longer once the files change
        ["summary.json", POSTMORTEM].iter().try_for_each(|f| remove(&options.out.join(f)))?;
    }
    let mut recorder = Recorder::new(case, &model, &simulation, &basis)?;
    let nodes = model.mesh.nodes.len();
    drop(model); // the time loop has what it needs

    let mut last = Energies::default();
    // wall time before this process: of everything, and of rolling
    let mut before = [Duration::ZERO; 2];
    if let Some((_, state)) = resumed {
        recorder.restore(&state.recorder);
        (last, before) = (state.energies, state.wall);
    }
    let rolling = Instant::now();
    let first = simulation.steps() as u64;
    let mut clock = Clock::new(&case.checkpoint, simulation.dt(), first);
    let mut keeping = Duration::ZERO;
    let (mut found, mut diagnosis) = (None, None);
    let mut status = Status::Completed;
    for n in first..steps {
        let stops = stop.load(Ordering::Relaxed);
        // a state that the guards are about to stop must push no good one out
        if (stops || clock.is_due(n)) && simulation.is_sound() {
            let begun = Instant::now();
            held.prove()?;
            let state = State {
                simulation: simulation.snapshot(),
                recorder: recorder.snapshot()?,
                energies: last,
                found: facts.found(),
                wall: [before[0] + wall.elapsed(), before[1] + rolling.elapsed()],
            };
            let kernels = simulation.solid().level().name();
            recorder.keep(state.into_checkpoint(&basis.provenance, kernels), &options.out)?;
            keeping += begun.elapsed();
        }
        if stops {
            status = Status::Interrupted;
            break;
        }
        recorder.before_step(&simulation)?;
        let read = recorder.reads(n) || n + 1 == steps || n.is_multiple_of(READING);
        let report = simulation.step(read);
        if let Some(failure) = options.law.as_ref().and_then(|law| law.failure()) {
            diagnosis = Some(format!("the friction law failed at step {n}: {failure}"));
            status = Status::Failed;
            break;
        }
        found = simulation.check(&report);
        if let Some(found) = &found {
            diagnosis = Some(format!("{found}; remedy: {}", found.remedy()));
            status = Status::Failed;
            break;
        }
        last = report.energies.unwrap_or(last);
        recorder.after_step(&simulation, &report)?;
        if n % 64 == 0 {
            let per_s = (n - first) as f64 / rolling.elapsed().as_secs_f64();
            observe(&Progress {
                stage: Stage::Roll,
                step: n,
                steps,
                time: report.time,
                end_time: case.duration(),
                normal_force: report.contact.force[0][2],
                tangential_force: report.contact.force[0][0],
                element_steps_per_s: elements as f64 * per_s,
            });
        }
    }
    let rolling_wall = before[1] + rolling.elapsed();
    held.prove()?;
    let (means, output_wall) = recorder.finish(&simulation)?;
    if let Some(d) = &diagnosis {
        log.say(d)?;
    }
    if let Some(d) = &found {
        postmortem::write(&options.out, &mut simulation, d, &basis.provenance)?;
        log.say(&format!("{POSTMORTEM} holds both bodies as they are"))?;
    }

    let ending = Ending {
        status,
        diagnosis,
        postmortem: found.is_some(),
        energies: last,
        means,
        elements,
        nodes,
        threads: options.threads,
        wall: before[0] + wall.elapsed(),
        rolling: rolling_wall,
        output: output_wall,
        keeping,
    };
    for warning in ending.means.mesh_mode.warnings(case) {
        log.warn(&warning)?;
    }
    let mut summary = summary(case, &simulation, &facts, &hertz, &ending);
    let own = options.law.as_deref().filter(|_| case.friction.law == Kind::Python);
    if let Some(points) = own.and_then(friction::sampled) {
        summary.extra.insert(output::SAMPLED_LAW.into(), serde_json::json!(points));
    }
    held.prove()?;
    let document = write_summary(&options.out, &summary)?;
    if status == Status::Completed {
        remove_checkpoints(&options.out)?;
    }
    let (steps, wall) = (summary.steps, summary.wall_s);
    log.say(&format!("{LOG_END}{status:?} after {steps} steps, {wall:.1} s"))?;
    Ok(document)
}

/// Where a run that is to be resumed goes on; none for one that begins.
fn origin(case: &Case, options: &RunOptions) -> Result<Option<Origin>, RunError> {
    if !options.resume {
        return Ok(None);
    }
    match resume::origin(case, &options.out) {
        Ok(origin) => Ok(Some(origin)),
        Err(error) if options.force => Ok(Some(Origin::Beginning(error.to_string()))),
        Err(error) => Err(error.into()),
    }
}

/// A run with nothing left to do.
fn complete(folder: &Path, summary: serde_json::Value) -> serde_json::Value {
    tracing::warn!("the run in {} is complete: nothing to resume", folder.display());
    // It may have been killed just before it took them away itself.
    let _ = remove_checkpoints(folder);
    summary
}

fn remove_checkpoints(folder: &Path) -> Result<(), RunError> {
    CHECKPOINTS.iter().try_for_each(|name| remove(&folder.join(name)))
}

/// Removes a file if it is there.
fn remove(path: &Path) -> Result<(), RunError> {
    match std::fs::remove_file(path) {
        Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => {
            Err(RunError::Text { path: path.to_owned(), cause })
        }
        _ => Ok(()),
    }
}

fn stage(case: &Case, stage: Stage) -> Progress {
    Progress {
        stage,
        step: 0,
        steps: 1,
        time: 0.0,
        end_time: case.duration(),
        normal_force: 0.0,
        tangential_force: 0.0,
        element_steps_per_s: 0.0,
    }
}

/// Under another name first, and brought to the disk: a kill or a power cut leaves the old text or the
/// new one.
fn write_text(path: PathBuf, text: &str) -> Result<(), RunError> {
    let partial = path.with_extension("toml.partial");
    let write = || {
        let mut file = File::create(&partial)?;
        file.write_all(text.as_bytes())?;
        file.sync_all()?;
        std::fs::rename(&partial, &path)
    };
    write().map_err(|cause| RunError::Text { path, cause })
}
