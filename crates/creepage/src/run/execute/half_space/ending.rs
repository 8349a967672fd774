//! The summary of a run of half-spaces.

use super::recorder::SolverFacts;
use crate::case::hertz::hertz;
use crate::case::schema::Case;
use crate::run::checkpoint::remove_checkpoints;
use crate::run::error::RunError;
use crate::run::execute::options::RunOptions;
use crate::run::held::FolderLock;
use crate::run::log::Log;
use crate::run::means::Means;
use crate::run::summary::{contact_means, window, write as write_summary};
use crate::scenario::HalfSpaceModel;
use crate::scenario::memory::peak_rss_mb;
use dynamics::Energies;
use output::summary::{Energy, Files, Status, Summary};
use output::{LOG_END, Provenance};
use serde_json::{Value, json};
use std::time::Duration;

/// How a run of half-spaces ended.
pub(super) struct Ended {
    pub(super) status: Status,
    /// Why it failed, and what to do.
    pub(super) diagnosis: Option<String>,
    pub(super) energies: Energies,
    pub(super) means: Means,
    pub(super) facts: SolverFacts,
    /// Wall time of the whole run, of rolling, and of checkpoints on the time loop's side.
    pub(super) wall: Duration,
    /// See `wall`.
    pub(super) rolling: Duration,
    /// See `wall`.
    pub(super) keeping: Duration,
}

/// Writes the summary, and removes the checkpoints of a run that is complete.
pub(super) fn conclude(
    case: &Case,
    options: &RunOptions,
    model: &HalfSpaceModel,
    ended: Ended,
    made: &Provenance,
    held: &FolderLock,
    log: &mut Log,
) -> Result<Value, RunError> {
    ended.means.unconverged_warning().iter().try_for_each(|line| log.warn(line))?;
    if ended.status == Status::Completed {
        ended.means.load_warning(case).iter().try_for_each(|line| log.warn(line))?;
    }
    let mut summary = summary(case, options, model, &ended);
    if let Some(points) = options.law.as_deref().and_then(friction::sampled) {
        summary.extra.insert(output::SAMPLED_LAW.into(), json!(points));
    }
    held.check_owner()?;
    let document = write_summary(&options.out, &summary, made)?;
    if ended.status == Status::Completed {
        remove_checkpoints(&options.out)?;
    }
    let (status, steps, wall) = (ended.status, summary.steps, summary.wall_s);
    log.say(&format!("{LOG_END}{status:?} after {steps} steps, {wall:.1} s"))?;
    Ok(document)
}

fn summary(case: &Case, options: &RunOptions, model: &HalfSpaceModel, ended: &Ended) -> Summary {
    let Ended { energies, means, facts, .. } = ended;
    let rolling = &model.rolling;
    let (steps, seconds) = (rolling.steps() as u64, |d: Duration| d.as_secs_f64());
    let [nx, ny] = rolling.grid();
    let points = (nx * ny) as f64;
    let hertz = hertz(case);
    let half_space = json!({ "half_length": hertz.a, "half_width": hertz.b, "area": hertz.area(),
        "peak_pressure": hertz.p0, "approach": hertz.approach });
    let (memory, faded) = rolling.memory();
    let spectral = json!({ "grid": [nx, ny], "memory_steps": memory, "faded": faded,
        "inertia": case.has_inertia(),
        "megabytes": rolling.bytes() as f64 / 1e6,
        "iterations_per_step": facts.iterations as f64 / steps.max(1) as f64,
        "most_iterations": facts.most, "undelayed_steps": facts.undelayed });
    let exchanged = [energies.internal, energies.friction_dissipated, energies.external_work]
        .into_iter()
        .fold(f64::MIN_POSITIVE, |most: f64, e| most.max(e.abs()));
    let imbalance = energies.internal + energies.friction_dissipated - energies.external_work;
    let mut extra: std::collections::BTreeMap<String, Value> = [
        ("model", json!(case.model)),
        ("symmetry", json!(case.mesh.symmetry)),
        ("half_space", half_space),
        ("spectral", spectral),
        ("numbers", model.numbers.json()),
        ("window", window(case, means, ended.status)),
        (
            "checks",
            json!({ "cone_excess": means.worst_cone,
            "resultant_mismatch": means.worst_mismatch, "contact_damping": 0.0 }),
        ),
    ]
    .map(|(key, value)| (key.to_owned(), value))
    .into();
    if let Some(diagnosis) = &ended.diagnosis {
        extra.insert("diagnosis".into(), json!(diagnosis));
    }
    Summary {
        name: case.name.clone(),
        status: ended.status,
        steps,
        dt: rolling.step_length(),
        t_end: rolling.time(),
        elements: 0,
        nodes: points as u64,
        threads: options.threads as u64,
        wall_s: seconds(ended.wall),
        element_steps_per_s: points * steps as f64 / seconds(ended.rolling),
        peak_rss_mb: peak_rss_mb(),
        energy: Energy {
            internal: energies.internal,
            friction_dissipated: energies.friction_dissipated,
            external_work: energies.external_work,
            balance_error: imbalance.abs() / exchanged,
            ..Energy::default()
        },
        contact: contact_means(means),
        files: Files { fields: String::new(), ..Files::default() },
        stages: [
            ("rolling", seconds(ended.rolling)),
            ("output", seconds(facts.output)),
            ("checkpoints", seconds(ended.keeping)),
        ]
        .map(|(k, v)| (k.to_owned(), v))
        .into(),
        extra,
    }
}
