//! From a resolved case to a finished run.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Instant, SystemTime};

use crate::folder;
use crate::hertz::hertz;
use crate::log::Log;
use crate::memory::enough_memory;
use crate::model::Model;
use crate::progress::{Progress, Stage};
use crate::record::{Basis, Recorder};
use crate::run_error::RunError;
use crate::schema::Case;
use crate::start::{Start, start};
use crate::summary::{Ending, summary, without_rolling};
use dynamics::{Diagnosis, Energies};
use output::Provenance;
use output::summary::Status;
use serde_json::json;

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
    /// Folder in which preloads are kept for other runs with the same, and taken from.
    pub preload_cache: Option<PathBuf>,
    /// The case file, for the log.
    pub source: PathBuf,
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
    pool.install(|| run_in_pool(case, options, stop, observe))
}

fn run_in_pool(
    case: &Case,
    options: &RunOptions,
    stop: &AtomicBool,
    observe: &mut (dyn FnMut(&Progress) + Send),
) -> Result<serde_json::Value, RunError> {
    let wall = Instant::now();
    // A mesh that is refused must cost no earlier run its results.
    folder::check(&options.out, options.force)?;
    let model = Model::build(case)?;
    enough_memory(model.mesh.hexes.len())?;
    folder::prepare(&options.out, options.force)?;
    write_text(options.out.join("case.toml"), &case.to_toml())?;
    let mut log = Log::new(options.out.join("run.log"))?;
    log.say(&format!(
        "creepage {}: {} from {}",
        env!("CARGO_PKG_VERSION"),
        case.name,
        options.source.display()
    ))?;
    case.warnings().iter().try_for_each(|w| log.say(&format!("warning: {w}")))?;
    let elements = model.mesh.hexes.len();
    log.say(&format!("mesh: {elements} elements, {} nodes", model.mesh.nodes.len()))?;
    if model.fully_integrated() > 0 {
        log.say(&format!("fully integrated: {} elements", model.fully_integrated()))?;
    }
    observe(&stage(case, Stage::Mesh));

    let begun =
        match start(case, &model, options.preload_cache.as_deref(), stop, observe, &mut |line| {
            log.say(line)
        }) {
            Err(RunError::Preload(error)) => {
                let summary = without_rolling(case, &model, options.threads, wall, &error);
                output::write_json_atomically(options.out.join("summary.json"), &summary)?;
                log.say(&format!("end: {:?} before rolling: {error}", summary.status))?;
                return Ok(json!(summary));
            }
            Err(error) => {
                log.say(&format!("{REFUSED}{error}"))?;
                return Err(error);
            }
            Ok(begun) => begun,
        };
    let Start { mut simulation, facts } = begun;
    let (stability, steps) = (facts.stability, facts.steps);
    if let Some(preload) = &facts.preload {
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
    let hertz = hertz(case);
    let basis = Basis {
        folder: &options.out,
        provenance: Provenance {
            creepage_version: env!("CARGO_PKG_VERSION").into(),
            case_hash: case.hash(),
            created: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
            attributes: Vec::new(),
        },
        effective_radius: facts.radius.effective,
        hertz_pressure: hertz.p0,
    };
    let mut recorder = Recorder::new(case, &model, &simulation, &basis)?;
    let nodes = model.mesh.nodes.len();
    drop(model); // the time loop has what it needs

    let rolling = Instant::now();
    let mut last = Energies::default();
    let mut diagnosis: Option<Diagnosis> = None;
    let mut status = Status::Completed;
    for n in 0..steps {
        if stop.load(Ordering::Relaxed) {
            status = Status::Interrupted;
            break;
        }
        recorder.before_step(&simulation)?;
        let read = recorder.reads(n) || n + 1 == steps;
        let report = simulation.step(read);
        if let Some(energies) = report.energies {
            diagnosis = simulation.guard(&energies);
            if diagnosis.is_some() {
                status = Status::Failed;
                break;
            }
            last = energies;
        }
        recorder.after_step(&simulation, &report)?;
        if n % 64 == 0 {
            observe(&Progress {
                stage: Stage::Roll,
                step: n,
                steps,
                time: report.time,
                end_time: case.duration(),
                normal_force: report.contact.force[0][2],
                tangential_force: report.contact.force[0][0],
                element_steps_per_s: elements as f64 * n as f64 / rolling.elapsed().as_secs_f64(),
            });
        }
    }
    let rolling_wall = rolling.elapsed();
    let (means, output_wall) = recorder.finish(&simulation)?;
    if let Some(d) = &diagnosis {
        log.say(&format!("{d}; remedy: {}", d.remedy()))?;
    }

    let ending = Ending {
        status,
        diagnosis,
        energies: last,
        means,
        elements,
        nodes,
        threads: options.threads,
        wall: wall.elapsed(),
        rolling: rolling_wall,
        output: output_wall,
    };
    let summary = summary(case, &simulation, &facts, &hertz, &ending);
    output::write_json_atomically(options.out.join("summary.json"), &summary)?;
    log.say(&format!("end: {status:?} after {} steps, {:.1} s", summary.steps, summary.wall_s))?;
    Ok(json!(summary))
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

fn write_text(path: PathBuf, text: &str) -> Result<(), RunError> {
    std::fs::write(&path, text).map_err(|cause| RunError::Text { path, cause })
}
