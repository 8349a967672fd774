//! From a resolved case to a finished run.

mod begin;
mod half_space;
mod observer;
mod opening;
mod rolling;

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::{Instant, SystemTime};

use crate::case::hertz::hertz;
use crate::case::schema::{Case, Symmetry};
use crate::case::validation;
use crate::run::checkpoint::remove_checkpoints;
use crate::run::cost::cost;
use crate::run::disk::Disk;
use crate::run::error::RunError;
use crate::run::held::FolderLock;
use crate::run::log::Log;
use crate::run::options::RunOptions;
use crate::run::postmortem;
use crate::run::processes::Leader;
use crate::run::progress_lines;
use crate::run::record::{RecordBasis, Recorder};
use crate::run::resume::ResumePoint;
use crate::run::summary::{Ending, summary};
use crate::run::text_file::remove;
use crate::scenario::progress::{Progress, Stage};
use crate::scenario::{InitialState, Start};
use begin::{Preloaded, begin};
use dynamics::Simulation;
use friction::Kind;
use opening::{OpenRun, Opening, log_model, model, open};
use output::NotWritten;
use output::layout::{FOLLOWS, HALF, attribute, file};
use output::summary::{MeshWindow, Status, Summary};
use output::{LOG_END, Provenance};
use rolling::{FinishedRun, Stopped, TimeLoop};

/// Runs a case to its end, to a stop request or to a guard, and returns its summary (`summary.json`).
///
/// A run that a guard stopped, or that found no preload, has the status `failed` and a `diagnosis`; one that was
/// interrupted has the status `interrupted`. In all cases the results so far are readable. `stop` is read at every
/// step; `observe` is called now and then.
///
/// # Errors
/// A folder that cannot be used, a run that cannot be resumed, a mesh, contact or friction law that cannot be set up,
/// files that cannot be written, a folder that another process took.
pub fn run(
    case: &Case,
    options: &RunOptions,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
) -> Result<Summary, RunError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(options.threads()).build()?;
    // The whole run inside the pool: entering it costs microseconds, a step of a small case few more.
    let mut result = pool.install(|| run_in_pool(case, options, stop, observe));
    if let Err(RunError::Output(error)) = &result
        && (options.resume && options.force)
        && error.damaged().is_some()
        && !options.leader.as_ref().is_some_and(|leader| leader.has_shared())
    {
        // found only when the files were opened to be extended
        tracing::warn!("{error}; the run begins at its start");
        let anew = RunOptions { resume: false, ..options.clone() };
        result = pool.install(|| run_in_pool(case, &anew, stop, observe));
    }
    if let Err(error @ (RunError::Output(_) | RunError::Text(_) | RunError::Process { .. })) =
        &result
    {
        // as far as that is possible where files could not be written
        let _ = Log::append(options.folder(case).join(file::LOG))
            .and_then(|mut log| log.say(&format!("{LOG_END}Failed, {error}")));
    }
    result
}

fn run_in_pool(
    case: &Case,
    options: &RunOptions,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
) -> Result<Summary, RunError> {
    let wall = Instant::now();
    let law = case.friction.law;
    match (law == Kind::Python, options.law.is_some()) {
        (true, false) => return Err(RunError::NoLaw),
        (false, true) => return Err(RunError::UnusedLaw { law: law.declaration().word }),
        _ => {}
    }
    let leader = options.leader.as_deref();
    if leader.is_some() {
        Leader::check(case)?;
    }
    if case.is_half_space() {
        return half_space::run(case, options, wall, stop, observe);
    }
    let make = |point: Option<&_>| model(case, options, point);
    let mut opened = match open(case, options, make, |model, log| log_model(case, model, log))? {
        Opening::Complete(summary) => return Ok(complete(&options.folder(case), *summary)),
        Opening::Run(opened) => *opened,
    };
    let observe = &mut opened.log.progress(progress_lines::INTERVAL)?.beside(observe);
    observe(&stage(case, Stage::Mesh));
    let basis = basis(case, options, opened.point.as_ref());
    let (start, files, resumed) =
        match begin(case, options, &mut opened, &basis, wall, stop, observe)? {
            Preloaded::NotPreloaded(summary) => return Ok(*summary),
            Preloaded::Rolling(start, files, resumed) => {
                (*start, files.map(|files| *files), resumed)
            }
        };
    let OpenRun { held, mut log, model, .. } = opened;
    let Start { mut simulation, facts } = start;
    log_facts(&simulation, &facts, &mut log)?;
    if resumed.is_none() {
        let below = validation::below_the_step(case, simulation.dt());
        below.iter().try_for_each(|line| log.warn(line))?;
        let disk = Disk::of(case, &model, facts.steps as f64);
        disk.shortage(&options.folder(case)).iter().try_for_each(|line| log.warn(line))?;
        let cost = cost(case, &model, &facts, &simulation)?;
        observe(&Progress { cost, steps: facts.steps, ..stage(case, Stage::Roll) });
    }
    // another process may have taken the folder during the preload
    held.check_owner()?;
    if resumed.is_some() {
        // what these say of an interruption or a stop is no longer true once the files change
        [file::SUMMARY, file::POSTMORTEM]
            .iter()
            .try_for_each(|f| remove(&options.folder(case).join(f)))?;
    }
    let recorder = Recorder::new(case, &model, &simulation, facts.radius.effective, files, &basis)?;
    let (elements, nodes) = (model.mesh.hexes.len(), model.mesh.nodes.len());
    let position = model.position;
    if let Some(leader) = leader {
        leader.share(case, options, &model, &facts, &mut simulation, &mut log)?;
    }
    drop(model); // the time loop has what it needs

    let mut rolling = TimeLoop::new(case, &facts, &held, simulation, recorder, wall);
    if let Some(state) = resumed {
        rolling.resume(*state);
    }
    let Stopped { status, diagnosis, guard } = rolling.roll(options, &basis, stop, observe)?;
    let mut rolled = rolling.end()?;
    if let Some(line) = &diagnosis {
        log.say(line)?;
    }
    if let Some(guard) = &guard {
        postmortem::write(&options.folder(case), &mut rolled.simulation, guard, &basis.provenance)?;
        log.say(&format!(
            "{} holds both bodies as they were when the run stopped",
            file::POSTMORTEM
        ))?;
    }
    let FinishedRun { simulation, energies, means, before, rolling, output, keeping } = rolled;
    let ending = Ending {
        status,
        diagnosis,
        postmortem: guard.is_some(),
        energies,
        means,
        elements,
        nodes,
        position,
        threads: options.threads(),
        wall: before + wall.elapsed(),
        rolling,
        output,
        keeping,
    };
    conclude(case, options, &simulation, &facts, &ending, &basis, &held, &mut log)
}

/// Writes into the log what is known before the disk rolls.
fn log_facts(
    simulation: &Simulation,
    facts: &InitialState,
    log: &mut Log,
) -> Result<(), NotWritten> {
    let stability = &facts.stability;
    log.say(&format!(
        "step: {:.4e} s, {:.3} of the stability limit (omega_max {:.4e} rad/s with contact, \
         {:.4e} without); {} steps; kernels: {}",
        simulation.dt(),
        stability.factor,
        stability.omega_max,
        stability.omega_elastic,
        facts.steps,
        simulation.solid().level().name()
    ))?;
    facts.numbers.line().iter().try_for_each(|line| log.say(line))?;
    facts.numbers.expectation().iter().try_for_each(|line| log.warn(line))
}

/// What the files of the run are made from besides the case.
fn basis<S>(case: &Case, options: &RunOptions, point: Option<&ResumePoint<S>>) -> RecordBasis {
    RecordBasis {
        folder: options.folder(case),
        provenance: Provenance {
            creepage_version: env!("CARGO_PKG_VERSION").into(),
            case_hash: case.hash(),
            created: match point {
                Some(point) => point.checkpoint.provenance.created.clone(),
                None => humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            },
            attributes: kinds(case),
        },
        hertz_pressure: hertz(case).p0,
        keeps: point.map(|point| point.checkpoint.results.clone()),
    }
}

/// The attributes of every file of a run that say what of the bodies is modelled, and where.
pub(crate) fn kinds(case: &Case) -> Vec<(String, String)> {
    let half = case.mesh.symmetry == Symmetry::Half;
    let follows = case.mesh.window.is_some();
    [(half, attribute::SYMMETRY, HALF), (follows, attribute::WINDOW, FOLLOWS)]
        .into_iter()
        .filter(|(holds, ..)| *holds)
        .map(|(_, name, value)| (name.to_owned(), value.to_owned()))
        .collect()
}

/// Says what to know of the means, and writes the summary.
fn conclude(
    case: &Case,
    options: &RunOptions,
    simulation: &Simulation,
    facts: &InitialState,
    ending: &Ending,
    basis: &RecordBasis,
    held: &FolderLock,
    log: &mut Log,
) -> Result<Summary, RunError> {
    ending.means.unconverged_warning().iter().try_for_each(|line| log.warn(line))?;
    if ending.status == Status::Completed {
        ending.means.load_warning(case).iter().try_for_each(|line| log.warn(line))?;
    }
    ending.means.mesh_mode.warnings(case).iter().try_for_each(|line| log.warn(line))?;
    let mut summary = summary(case, simulation, facts, &hertz(case), ending);
    summary.friction_law = options.law.as_deref().and_then(friction::sampled);
    if case.mesh.window.is_some() {
        let (travel, energy) = (simulation.travel().x, simulation.ledger().moved);
        summary.mesh_window = Some(MeshWindow { travel, energy });
    }
    close(basis, summary, ending.status, held, log)
}

/// Writes the summary of a run that ended with `status`, and removes the checkpoints of one that is complete.
fn close(
    basis: &RecordBasis,
    summary: Summary,
    status: Status,
    held: &FolderLock,
    log: &mut Log,
) -> Result<Summary, RunError> {
    held.check_owner()?;
    let summary = summary.write(&basis.folder, &basis.provenance)?;
    if status == Status::Completed {
        remove_checkpoints(&basis.folder)?;
    }
    let (steps, wall) = (summary.steps, summary.wall_s);
    log.say(&format!("{LOG_END}{status:?} after {steps} steps, {wall:.1} s"))?;
    Ok(summary)
}

/// A run with nothing left to do.
fn complete(folder: &Path, summary: Summary) -> Summary {
    tracing::warn!("the run in {} is complete: nothing to resume", folder.display());
    // It may have been killed just before it removed them itself.
    let _ = remove_checkpoints(folder);
    summary
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
        cost: None,
    }
}
