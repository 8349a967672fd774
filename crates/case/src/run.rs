//! From a resolved case to a finished run.

use std::fs::File;
use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Instant, SystemTime};

use crate::folder;
use crate::hertz::hertz;
use crate::model::Model;
use crate::progress::{Progress, Stage};
use crate::record::{Basis, Means, Recorder};
use crate::schema::Case;
use crate::start::{Start, start};
use dynamics::{Diagnosis, Energies};
use output::Provenance;
use output::summary::{Contact, Energy, Files, Status, Summary};
use serde_json::json;

/// How to run a case, apart from what the case itself says.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder of the run.
    pub out: PathBuf,
    /// Number of threads, at least one.
    pub threads: usize,
    /// Replace the run that is already in `out`.
    pub force: bool,
    /// The case file, for the log.
    pub source: PathBuf,
}

/// Why a run did not come to its end.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum RunError {
    /// The run folder cannot be used.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Folder(#[from] crate::folder::FolderError),
    /// The mesh cannot be built.
    #[error(transparent)]
    #[diagnostic(help("change the keys of [disk], [bar] or [mesh] that it names"))]
    Mesh(#[from] mesh::MeshError),
    /// The elements cannot be set up.
    #[error(transparent)]
    #[diagnostic(help("change the keys of [material], [disk], [bar] or [mesh] that it names"))]
    Solid(#[from] solid::SolidError),
    /// The contact cannot be set up.
    #[error(transparent)]
    #[diagnostic(help("change the keys of [contact.penalty]"))]
    Contact(#[from] contact::ContactError),
    /// The machine has too little memory for the mesh.
    #[error(
        "the run of {elements} elements needs about {needed_gb:.1} GB of memory, more than the \
         {free_gb:.1} GB that are free: enlarge mesh.zone.size or shrink the zone"
    )]
    #[diagnostic(help("`creepage mesh` tells what a mesh needs"))]
    Memory {
        /// Elements of both bodies.
        elements: usize,
        /// Estimate of what the run needs (GB).
        needed_gb: f64,
        /// What the system has free (GB).
        free_gb: f64,
    },
    /// A surface of the mesh is missing.
    #[error("the mesh has no contact surface in its fine zone")]
    #[diagnostic(help("enlarge mesh.zone"))]
    NoContact,
    /// The preload was not found.
    #[error(transparent)]
    #[diagnostic(help("{}", preload_remedy(.0)))]
    Preload(#[from] dynamics::RelaxationError),
    /// Results cannot be written.
    #[error(transparent)]
    #[diagnostic(help("the run has stopped; what was written before stays readable"))]
    Output(#[from] output::OutputError),
    /// A file beside the results cannot be written.
    #[error("cannot write {}: {cause}", path.display())]
    #[diagnostic(help(
        "the run has stopped; check that its folder is still there and that the disk has room"
    ))]
    Text {
        /// The file.
        path: PathBuf,
        /// What the system said.
        cause: std::io::Error,
    },
    /// A built-in case is wrong.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Case(#[from] crate::error::CaseError),
    /// Threads cannot be started.
    #[error("threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl RunError {
    /// The key of the case that the error is about, where it is about one.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Mesh(mesh::MeshError::OutOfRange { parameter, .. }) => Some(parameter),
            Self::Mesh(mesh::MeshError::TooManyElements { .. }) | Self::Memory { .. } => {
                Some("mesh.zone.size")
            }
            _ => None,
        }
    }

    /// Exit code of the process: 2 for bad input, 3 where the run's own guards stopped it, 130
    /// when interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Folder(_) | Self::Mesh(_) | Self::Solid(_) | Self::Contact(_) => 2,
            Self::NoContact | Self::Case(_) | Self::Threads(_) | Self::Memory { .. } => 2,
            Self::Preload(dynamics::RelaxationError::Interrupted) => 130,
            Self::Preload(_) | Self::Output(_) | Self::Text { .. } => 3,
        }
    }
}

/// What to do where the preload was not found.
fn preload_remedy(error: &dynamics::RelaxationError) -> &'static str {
    match error {
        dynamics::RelaxationError::Slow { .. } => {
            "raise preload.max_iterations, or raise preload.tolerance to a ratio that it reaches"
        }
        dynamics::RelaxationError::BlowUp { .. } => {
            "look at the quality of the mesh with `creepage mesh`; lower contact.penalty.normal, \
             or mesh.growth"
        }
        dynamics::RelaxationError::Interrupted => {
            "the disk had not begun to roll, so there are no results yet"
        }
    }
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
    observe(&stage(case, Stage::Mesh));

    let begun = match start(case, &model, stop, observe) {
        Err(RunError::Preload(error)) => {
            let summary = without_rolling(case, &model, options.threads, wall, &error);
            output::write_json_atomically(options.out.join("summary.json"), &summary)?;
            log.say(&format!("end: {:?} before rolling: {error}", summary.status))?;
            return Ok(json!(summary));
        }
        begun => begun?,
    };
    let Start { mut simulation, stability, radius, preload, steps, preload_wall } = begun;
    if let Some(p) = &preload {
        log.say(&format!(
            "preload: {} iterations, normal force {:.3} N, hub {:.3} um, kinetic/internal {:.1e}",
            p.iterations,
            p.normal_force,
            p.hub * 1e6,
            p.kinetic_ratio
        ))?;
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
    let hertz = hertz(case);
    let basis = Basis {
        folder: &options.out,
        provenance: Provenance {
            creepage_version: env!("CARGO_PKG_VERSION").into(),
            case_hash: case.hash(),
            created: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        },
        effective_radius: radius.effective,
        hertz_pressure: hertz.p0,
    };
    let mut recorder = Recorder::new(case, &model, &simulation, &basis)?;

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
    let rolling_wall = rolling.elapsed().as_secs_f64();
    let (means, output_wall) = recorder.finish(&simulation)?;
    if let Some(d) = &diagnosis {
        log.say(&format!("{d}; remedy: {}", d.remedy()))?;
    }

    let timers = *simulation.timers();
    let seconds = |d: std::time::Duration| d.as_secs_f64();
    let done = simulation.steps() as u64;
    let mut summary = Summary {
        name: case.name.clone(),
        status,
        steps: done,
        dt: simulation.dt(),
        t_end: simulation.time(),
        elements: elements as u64,
        nodes: model.mesh.nodes.len() as u64,
        threads: options.threads as u64,
        wall_s: seconds(wall.elapsed()),
        element_steps_per_s: elements as f64 * done as f64 / rolling_wall,
        peak_rss_mb: peak_rss_mb(),
        energy: Energy {
            kinetic: last.kinetic,
            internal: last.internal,
            hourglass: last.hourglass,
            contact_stored: last.contact_stored,
            friction_dissipated: last.friction_dissipated,
            damping_dissipated: last.damping_dissipated,
            external_work: last.external_work,
            balance_error: simulation.ledger().balance_error(),
        },
        contact: contact_means(&means),
        files: Files::default(),
        stages: [
            ("preload", preload_wall),
            ("rolling", rolling_wall),
            ("internal_force", seconds(timers.internal_force)),
            ("contact", seconds(timers.contact)),
            ("boundary", seconds(timers.boundary)),
            ("nodes", seconds(timers.nodes)),
            ("output", seconds(output_wall)),
        ]
        .map(|(k, v)| (k.to_owned(), v))
        .into(),
        extra: Default::default(),
    };
    let bytes = simulation.bytes() as f64 / elements as f64;
    let sections = [
        ("kernels", json!(simulation.solid().level().name())),
        ("stability", json!(stability)),
        ("rolling_radius", json!(radius)),
        (
            "half_space",
            json!({ "half_length": hertz.a, "half_width": hertz.b, "peak_pressure": hertz.p0,
                    "approach": hertz.approach }),
        ),
        ("window", window(case, &means)),
        (
            "checks",
            json!({ "cone_excess": means.worst_cone,
                           "resultant_mismatch": means.worst_mismatch }),
        ),
        ("time_loop_bytes_per_element", json!(bytes)),
        (
            "preload",
            json!(preload.map(|p| json!({ "iterations": p.iterations,
                "normal_force": p.normal_force, "kinetic_ratio": p.kinetic_ratio,
                "hub_displacement": p.hub }))),
        ),
    ];
    summary.extra = sections.map(|(k, v)| (k.to_owned(), v)).into();
    if let Some(d) = diagnosis {
        let text = format!("{d}; remedy: {}", d.remedy());
        summary.extra.insert("diagnosis".into(), json!(text));
    }
    output::write_json_atomically(options.out.join("summary.json"), &summary)?;
    log.say(&format!("end: {status:?} after {done} steps, {:.1} s", summary.wall_s))?;
    Ok(json!(summary))
}

/// The summary of a run that ended in its preload: nothing rolled, so there are no results.
fn without_rolling(
    case: &Case,
    model: &Model,
    threads: usize,
    wall: Instant,
    error: &dynamics::RelaxationError,
) -> Summary {
    let wall_s = wall.elapsed().as_secs_f64();
    let none = String::new;
    Summary {
        name: case.name.clone(),
        status: match error {
            dynamics::RelaxationError::Interrupted => Status::Interrupted,
            _ => Status::Failed,
        },
        steps: 0,
        dt: 0.0,
        t_end: 0.0,
        elements: model.mesh.hexes.len() as u64,
        nodes: model.mesh.nodes.len() as u64,
        threads: threads as u64,
        wall_s,
        element_steps_per_s: 0.0,
        peak_rss_mb: peak_rss_mb(),
        energy: Energy::default(),
        contact: Contact::default(),
        files: Files { fields: none(), contact: none(), history: none() },
        stages: [("preload".to_owned(), wall_s)].into(),
        extra: [("diagnosis".to_owned(), json!(format!("{error}: {}", preload_remedy(error))))]
            .into(),
    }
}

fn contact_means(means: &Means) -> Contact {
    let [tangential, lateral, normal] = means.force;
    Contact {
        normal_force: normal.mean(),
        tangential_force: tangential.mean(),
        lateral_force: lateral.mean(),
        traction_coefficient: means.traction.mean(),
        creepage: means.creepage.mean(),
        patch_half_length: means.half_length.mean(),
        patch_half_width: means.half_width.mean(),
        patch_area: means.area.mean(),
        peak_pressure: means.peak_pressure.mean(),
        stick_fraction: means.stick.mean(),
        slip_fraction: means.slip.mean(),
    }
}

/// The evaluation window: what it spans, means that the contract's `contact` does not name, and
/// standard deviations.
fn window(case: &Case, means: &Means) -> serde_json::Value {
    json!({
        "from": case.evaluate_from(),
        "to": case.duration(),
        "stick_border": means.stick_border.mean(),
        "peak_shear": means.peak_shear.mean(),
        "torque": means.torque.mean(),
        "max_penetration": means.penetration.mean(),
        "hourglass_share": means.hourglass_share.mean(),
        "deviation": {
            "normal_force": means.force[2].deviation(),
            "tangential_force": means.force[0].deviation(),
            "traction_coefficient": means.traction.deviation(),
            "patch_half_length": means.half_length.deviation(),
            "patch_half_width": means.half_width.deviation(),
            "peak_pressure": means.peak_pressure.deviation(),
            "stick_border": means.stick_border.deviation(),
        },
    })
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

/// `run.log`: what the run said, line by line.
struct Log {
    path: PathBuf,
    file: File,
}

impl Log {
    fn new(path: PathBuf) -> Result<Self, RunError> {
        match File::create(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(cause) => Err(RunError::Text { path, cause }),
        }
    }

    fn say(&mut self, line: &str) -> Result<(), RunError> {
        tracing::info!("{line}");
        writeln!(self.file, "{line}")
            .map_err(|cause| RunError::Text { path: self.path.clone(), cause })
    }
}

/// Bytes per element of a whole run, output included.
pub(crate) const BYTES_PER_ELEMENT: f64 = 500.0;

/// Refuses a mesh that would bring the machine to its knees, where the system tells what is free.
fn enough_memory(elements: usize) -> Result<(), RunError> {
    let table = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = table.lines().find_map(|l| l.strip_prefix("MemAvailable:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    let free_gb = kib.map_or(f64::INFINITY, |k| k * 1024.0 / 1e9);
    let needed_gb = elements as f64 * BYTES_PER_ELEMENT / 1e9;
    if needed_gb > free_gb {
        return Err(RunError::Memory { elements, needed_gb, free_gb });
    }
    Ok(())
}

/// Largest resident memory of this process so far (MB); zero where the system does not tell.
pub(crate) fn peak_rss_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    kib.map_or(0.0, |k| k * 1024.0 / 1e6)
}
