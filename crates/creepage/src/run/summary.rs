//! The summary of a run.

use std::time::{Duration, Instant};

use crate::case::hertz::Hertz;
use crate::case::schema::{Case, DriveMode, Enforcement};
use crate::run::error::RunError;
use crate::run::means::Means;
use crate::scenario::memory::peak_rss_mb;
use crate::scenario::remedy::Remedy;
use crate::scenario::{InitialState, Model, PreloadError, RollingRadius};
use dynamics::{Energies, Simulation};
use output::layout::{attribute, file};
use output::summary::{Contact, Energy, Files, Status, Summary};
use output::{Provenance, quantities};
use serde_json::{Value, json};
use std::path::Path;

/// How a run ended.
pub(crate) struct Ending {
    pub(crate) status: Status,
    /// Why it failed, and what to do.
    pub(crate) diagnosis: Option<String>,
    /// Whether a guard stopped it and wrote the post-mortem file.
    pub(crate) postmortem: bool,
    /// The last energies read.
    pub(crate) energies: Energies,
    pub(crate) means: Means,
    pub(crate) elements: usize,
    pub(crate) nodes: usize,
    pub(crate) threads: usize,
    /// Wall time of the whole run, of rolling, and of output on the time loop's side.
    pub(crate) wall: Duration,
    pub(crate) rolling: Duration,
    pub(crate) output: Duration,
    /// Wall time of checkpoints on the time loop's side, since the run was last resumed.
    pub(crate) keeping: Duration,
}

/// What implicit steps took; null of explicit ones.
fn implicit(case: &Case, simulation: &Simulation) -> serde_json::Value {
    let took = case.theta().zip(simulation.effort());
    json!(took.map(|(theta, effort)| {
        json!({ "theta": theta, "solved": effort.solved, "cut": effort.cut,
            "iterations": effort.iterations, "products": effort.products })
    }))
}

/// The rolling radii (m); that of free rolling is known where no torque acts, and null elsewhere.
fn rolling_radius(case: &Case, facts: &InitialState, means: &Means) -> serde_json::Value {
    let RollingRadius { nominal, effective } = facts.radius;
    let rolls_freely = case.drive.mode == DriveMode::Torque && case.drive.torque == Some(0.0);
    let free = means.creepage.mean().filter(|_| rolls_freely).map(|xi| effective / (1.0 + xi));
    json!({ "nominal": nominal, "effective": effective, "free": free })
}

/// The summary of a run that rolled.
pub(crate) fn summary(
    case: &Case,
    simulation: &Simulation,
    facts: &InitialState,
    hertz: &Hertz,
    ending: &Ending,
) -> Summary {
    let timers = simulation.timers();
    let seconds = |d: Duration| d.as_secs_f64();
    let steps = simulation.steps() as u64;
    let elements = ending.elements as f64;
    let (last, means) = (&ending.energies, &ending.means);
    let mut summary = Summary {
        name: case.name.clone(),
        status: ending.status,
        steps,
        dt: simulation.dt(),
        t_end: simulation.time(),
        elements: ending.elements as u64,
        nodes: ending.nodes as u64,
        threads: ending.threads as u64,
        wall_s: seconds(ending.wall),
        element_steps_per_s: elements * steps as f64 / seconds(ending.rolling),
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
        contact: contact_means(means),
        files: Files {
            postmortem: ending.postmortem.then(|| file::POSTMORTEM.to_owned()),
            ..Files::default()
        },
        stages: [
            ("preload", facts.preload_wall),
            ("rolling", seconds(ending.rolling)),
            ("internal_force", seconds(timers.internal_force)),
            ("contact", seconds(timers.contact)),
            ("boundary", seconds(timers.boundary)),
            ("nodes", seconds(timers.nodes)),
            ("output", seconds(ending.output)),
            ("checkpoints", seconds(ending.keeping)),
        ]
        .map(|(k, v)| (k.to_owned(), v))
        .into(),
        extra: Default::default(),
    };
    let half_space = json!({ "half_length": hertz.a, "half_width": hertz.b,
        "area": hertz.area(),
        "peak_pressure": hertz.p0, "approach": hertz.approach });
    let checks = json!({ "cone_excess": means.worst_cone, "resultant_mismatch": means.worst_mismatch,
        "contact_damping": last.contact_damping });
    let exact = (case.contact.enforcement == Enforcement::Exact).then(|| {
        let (steps, change) = means.unconverged;
        json!({ "rows": case.contact.rows, "kelvin_voigt": case.kelvin_voigt(),
            "most_sweeps": means.most_sweeps, "unconverged_steps": steps,
            "unconverged_change": change, "manifold_node_steps": means.non_unique,
            "mortar_integrals": means.integrated,
            "steepness_node": means.steepness[0], "steepness_patch": means.steepness[1],
            "warnings": means.unconverged_warning().as_slice() })
    });
    let preload = facts.preload.map(|p| p.json());
    let sections = [
        ("symmetry", json!(case.mesh.symmetry)),
        ("kernels", json!(simulation.solid().level().name())),
        ("stability", json!(facts.stability)),
        ("rolling_radius", rolling_radius(case, facts, means)),
        ("half_space", half_space),
        ("window", window(case, means, ending.status)),
        ("mesh_mode", means.mesh_mode.json(case)),
        ("checks", checks),
        ("exact_contact", json!(exact)),
        ("implicit", implicit(case, simulation)),
        ("time_loop_bytes_per_element", json!(simulation.bytes() as f64 / elements)),
        ("preload", json!(preload)),
        ("numbers", facts.numbers.json()),
    ];
    summary.extra = sections.map(|(k, v)| (k.to_owned(), v)).into();
    if let Some(d) = &ending.diagnosis {
        summary.extra.insert("diagnosis".into(), json!(d));
    }
    summary
}

/// The summary of a run that ended in its preload: nothing rolled, so there are no results.
pub(crate) fn without_rolling(
    case: &Case,
    model: &Model,
    threads: usize,
    wall: Instant,
    error: &PreloadError,
) -> Summary {
    let wall_s = wall.elapsed().as_secs_f64();
    let none = String::new;
    Summary {
        name: case.name.clone(),
        status: if error.is_interruption() { Status::Interrupted } else { Status::Failed },
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
        files: Files { fields: none(), contact: none(), history: none(), postmortem: None },
        stages: [("preload".to_owned(), wall_s)].into(),
        extra: [
            ("symmetry".to_owned(), json!(case.mesh.symmetry)),
            ("diagnosis".to_owned(), json!(format!("{error}: {}", error.remedy()))),
        ]
        .into(),
    }
}

/// The files whose lengths and checksums a summary holds.
const SUMMED: [&str; 6] =
    [file::CASE, file::FIELDS, file::CONTACT, file::HISTORY, file::PROBES, file::POSTMORTEM];

/// Writes the summary of a run whose files are closed into its folder, with what it was made by and when, the units of
/// its quantities, and the checksums of the files; returns it.
pub(crate) fn write(
    folder: &Path,
    summary: &Summary,
    made: &Provenance,
) -> Result<Value, RunError> {
    let mut document = json!(summary);
    let [units, names] = quantities::described(&document);
    if let Value::Object(entries) = &mut document {
        entries.insert(attribute::VERSION.into(), json!(made.creepage_version));
        entries.insert(attribute::CASE_HASH.into(), json!(made.case_hash));
        entries.insert(attribute::CREATED.into(), json!(made.created));
        entries.insert("units".into(), units);
        entries.insert("names".into(), names);
        output::seal(entries, &output::sums_of_files(folder, &SUMMED)?);
    }
    output::write_json_atomically(folder.join(file::SUMMARY), &document)?;
    Ok(document)
}

pub(crate) fn contact_means(means: &Means) -> Contact {
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
        patch_area_fitted: means.fitted_area.mean(),
        peak_pressure: means.peak_pressure.mean(),
        stick_fraction: means.stick.mean(),
        slip_fraction: means.slip.mean(),
    }
}

/// The section `window`: the span of the evaluation window (s), means that the section `contact` does not hold, and
/// standard deviations.
pub(crate) fn window(case: &Case, means: &Means, status: Status) -> serde_json::Value {
    let [from, to] = case.evaluation_window();
    let misses = Some(means).filter(|_| status == Status::Completed);
    let misses = misses.and_then(|means| means.load_warning(case));
    json!({
        "from": from,
        "to": to,
        "reasons": reasons(means),
        "stick_border": means.stick_border.mean(),
        "peak_shear": means.peak_shear.mean(),
        "torque": means.torque.mean(),
        "max_penetration": means.penetration.mean(),
        "hourglass_share": means.hourglass_share.mean(),
        "friction_power": means.friction_power(),
        "warnings": misses.as_slice(),
        "deviation": {
            "normal_force": means.force[2].deviation(),
            "tangential_force": means.force[0].deviation(),
            "lateral_force": means.force[1].deviation(),
            "traction_coefficient": means.traction.deviation(),
            "creepage": means.creepage.deviation(),
            "patch_half_length": means.half_length.deviation(),
            "patch_half_width": means.half_width.deviation(),
            "patch_area": means.area.deviation(),
            "patch_area_fitted": means.fitted_area.deviation(),
            "peak_pressure": means.peak_pressure.deviation(),
            "peak_shear": means.peak_shear.deviation(),
            "stick_fraction": means.stick.deviation(),
            "slip_fraction": means.slip.deviation(),
            "stick_border": means.stick_border.deviation(),
            "torque": means.torque.deviation(),
            "max_penetration": means.penetration.deviation(),
        },
    })
}

/// Why means of the patch have no value, or how many rows of the history they leave out.
fn reasons(means: &Means) -> serde_json::Map<String, serde_json::Value> {
    let rows = means.area.count();
    let fit = "Hertz's distribution fits the pressure of";
    let stick = "something sticks on y = 0, and a fit has a centre, in";
    let all = [
        ("patch_half_length", &means.half_length, fit),
        ("patch_half_width", &means.half_width, fit),
        ("patch_area_fitted", &means.fitted_area, fit),
        ("peak_pressure", &means.peak_pressure, fit),
        ("stick_border", &means.stick_border, stick),
    ];
    let entry = |(key, mean, what): (&str, &crate::run::means::Mean, &str)| {
        let text = match mean.count() {
            _ if rows == 0 => "the evaluation window holds no row of the history".to_owned(),
            0 => format!("{what} none of {rows} rows of the history"),
            some if some < rows => format!("{what} {some} of {rows} rows of the history"),
            _ => return None,
        };
        Some((key.to_owned(), json!(text)))
    };
    all.into_iter().filter_map(entry).collect()
}
