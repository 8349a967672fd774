//! The summary of a run of half-spaces.

use super::recorder::SolverFacts;
use crate::case::hertz::hertz;
use crate::case::schema::Case;
use crate::run::error::RunError;
use crate::run::execute::close;
use crate::run::held::FolderLock;
use crate::run::log::Log;
use crate::run::means::Means;
use crate::run::options::RunOptions;
use crate::run::record::RecordBasis;
use crate::run::summary::{contact_means, half_space, window};
use crate::scenario::memory::peak_rss_mb;
use crate::scenario::wheel_on_rail::PositionReport;
use crate::scenario::{HalfSpaceModel, RollingRadius};
use dynamics::Energies;
use output::summary::{Checks, Energy, Files, Spectral, Status, Summary};
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

/// Says what to know of the means, and writes the summary.
pub(super) fn conclude(
    case: &Case,
    options: &RunOptions,
    model: &HalfSpaceModel,
    ended: Ended,
    basis: &RecordBasis,
    held: &FolderLock,
    log: &mut Log,
) -> Result<Summary, RunError> {
    ended.means.unconverged_warning().iter().try_for_each(|line| log.warn(line))?;
    if ended.status == Status::Completed {
        ended.means.load_warning(case).iter().try_for_each(|line| log.warn(line))?;
    }
    let mut summary = summary(case, options, model, &ended);
    summary.friction_law = options.law.as_deref().and_then(friction::sampled);
    close(basis, summary, ended.status, held, log)
}

fn summary(case: &Case, options: &RunOptions, model: &HalfSpaceModel, ended: &Ended) -> Summary {
    let Ended { energies, means, facts, .. } = ended;
    let rolling = &model.rolling;
    let (steps, seconds) = (rolling.steps() as u64, |d: Duration| d.as_secs_f64());
    let [nx, ny] = rolling.grid();
    let points = (nx * ny) as f64;
    let (memory_steps, faded) = rolling.memory();
    let spectral = Spectral {
        grid: [nx, ny],
        memory_steps: memory_steps as u64,
        faded,
        inertia: case.has_inertia(),
        megabytes: rolling.bytes() as f64 / 1e6,
        iterations_per_step: facts.iterations as f64 / steps.max(1) as f64,
        most_iterations: facts.most,
        undelayed_steps: facts.undelayed,
    };
    let exchanged = [energies.internal, energies.friction_dissipated, energies.external_work]
        .into_iter()
        .fold(f64::MIN_POSITIVE, |most: f64, e| most.max(e.abs()));
    let imbalance = energies.internal + energies.friction_dissipated - energies.external_work;
    let radius = RollingRadius { nominal: case.disk.radius, effective: case.disk.radius };
    Summary {
        name: case.name.clone(),
        status: Some(ended.status),
        steps,
        dt: rolling.step_length(),
        t_end: rolling.time(),
        elements: 0,
        nodes: points as u64,
        threads: options.threads() as u64,
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
        contact: contact_means(means, &radius),
        files: Files::without_fields(),
        stages: [
            ("rolling", seconds(ended.rolling)),
            ("output", seconds(facts.output)),
            ("checkpoints", seconds(ended.keeping)),
        ]
        .map(|(k, v)| (k.to_owned(), v))
        .into(),
        diagnosis: ended.diagnosis.clone(),
        model: Some(case.model.word().into()),
        symmetry: Some(case.mesh.symmetry.word().into()),
        half_space: Some(half_space(&hertz(case))),
        spectral: Some(spectral),
        numbers: Some(model.numbers.result()),
        position: model.position.as_ref().map(PositionReport::result),
        window: Some(window(case, means, ended.status)),
        checks: Some(Checks {
            cone_excess: Some(means.worst_cone),
            resultant_mismatch: Some(means.worst_mismatch),
            contact_damping: Some(0.0),
        }),
        ..Summary::default()
    }
}
