//! The summary of a run.

use std::time::{Duration, Instant};

use crate::case::hertz::Hertz;
use crate::case::schema::{Case, DriveMode, Enforcement};
use crate::run::means::Means;
use crate::scenario::memory::peak_rss_mb;
use crate::scenario::remedy::Remedy;
use crate::scenario::wheel_on_rail::PositionReport;
use crate::scenario::{InitialState, Model, PreloadError, RollingRadius};
use contact::Rows;
use dynamics::{Energies, Simulation};
use output::layout::file;
use output::summary::{
    self, Checks, Contact, Energy, ExactContact, Files, HalfSpace, Implicit, Mean, Status, Summary,
    Window,
};
use std::collections::BTreeMap;

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
    /// Where a wheel with profiles touches the rail.
    pub(crate) position: Option<PositionReport>,
    pub(crate) threads: usize,
    /// Wall time of the whole run, of rolling, and of output on the time loop's side.
    pub(crate) wall: Duration,
    pub(crate) rolling: Duration,
    pub(crate) output: Duration,
    /// Wall time of checkpoints on the time loop's side, since the run was last resumed.
    pub(crate) keeping: Duration,
}

/// What implicit steps took; none of explicit ones.
fn implicit(case: &Case, simulation: &Simulation) -> Option<Implicit> {
    let (theta, effort) = case.theta().zip(simulation.effort())?;
    Some(Implicit {
        theta,
        solved: effort.solved as u64,
        cut: effort.cut as u64,
        iterations: effort.iterations as u64,
        products: effort.products as u64,
    })
}

/// What exact enforcement took; none of penalty springs.
fn exact_contact(case: &Case, means: &Means) -> Option<ExactContact> {
    let (steps, change) = means.unconverged;
    (case.contact.enforcement == Enforcement::Exact).then(|| ExactContact {
        rows: case.contact.rows.map(|rows| Rows::WORDS[rows as usize].to_owned()),
        kelvin_voigt: case.kelvin_voigt(),
        most_sweeps: means.most_sweeps as u64,
        unconverged_steps: steps,
        unconverged_change: Some(change),
        manifold_node_steps: means.non_unique,
        mortar_integrals: means.integrated,
        steepness_node: Some(means.steepness[0]),
        steepness_patch: Some(means.steepness[1]),
        warnings: means.unconverged_warning().into_iter().collect(),
    })
}

/// The rolling radii; that of free rolling is known where no torque acts.
fn rolling_radius(case: &Case, facts: &InitialState, means: &Means) -> summary::RollingRadius {
    let RollingRadius { nominal, effective } = facts.radius;
    let rolls_freely = case.drive.mode == DriveMode::Torque && case.drive.torque == Some(0.0);
    let free = means.creepage.mean().filter(|_| rolls_freely).map(|xi| effective / (1.0 + xi));
    summary::RollingRadius { nominal, effective, free }
}

/// Hertz's contact.
pub(crate) fn half_space(hertz: &Hertz) -> HalfSpace {
    HalfSpace {
        half_length: Some(hertz.a),
        half_width: Some(hertz.b),
        area: Some(hertz.area()),
        peak_pressure: Some(hertz.p0),
        approach: Some(hertz.approach),
    }
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
    Summary {
        name: case.name.clone(),
        status: Some(ending.status),
        steps,
        dt: simulation.dt(),
        t_end: simulation.time(),
        elements: ending.elements as u64,
        nodes: ending.nodes as u64,
        position: ending.position.as_ref().map(PositionReport::result),
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
        contact: contact_means(means, &facts.radius),
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
            ("exchange", seconds(timers.exchange)),
            ("output", seconds(ending.output)),
            ("checkpoints", seconds(ending.keeping)),
        ]
        .map(|(k, v)| (k.to_owned(), v))
        .into(),
        diagnosis: ending.diagnosis.clone(),
        symmetry: Some(case.mesh.symmetry.word().into()),
        kernels: Some(simulation.solid().level().name().into()),
        time_loop_bytes_per_element: Some(simulation.bytes() as f64 / elements),
        stability: Some(facts.stability),
        rolling_radius: Some(rolling_radius(case, facts, means)),
        half_space: Some(half_space(hertz)),
        window: Some(window(case, means, ending.status)),
        mesh_mode: Some(means.mesh_mode.result(case)),
        checks: Some(Checks {
            cone_excess: Some(means.worst_cone),
            resultant_mismatch: Some(means.worst_mismatch),
            contact_damping: Some(last.contact_damping),
        }),
        exact_contact: exact_contact(case, means),
        implicit: implicit(case, simulation),
        preload: facts.preload.map(|preload| preload.result()),
        numbers: Some(facts.numbers.result()),
        ..Summary::default()
    }
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
    let status = if error.is_interruption() { Status::Interrupted } else { Status::Failed };
    Summary {
        name: case.name.clone(),
        status: Some(status),
        elements: model.mesh.hexes.len() as u64,
        nodes: model.mesh.nodes.len() as u64,
        threads: threads as u64,
        wall_s,
        peak_rss_mb: peak_rss_mb(),
        files: Files::none(),
        stages: [("preload".to_owned(), wall_s)].into(),
        diagnosis: Some(format!("{error}: {}", error.remedy())),
        symmetry: Some(case.mesh.symmetry.word().into()),
        ..Summary::default()
    }
}

/// Means of the contact of a disk with the radii `radius`.
pub(crate) fn contact_means(means: &Means, radius: &RollingRadius) -> Contact {
    let [tangential, lateral, normal] = means.force;
    let larger = radius.nominal / radius.effective;
    Contact {
        normal_force: normal.mean(),
        tangential_force: tangential.mean(),
        lateral_force: lateral.mean(),
        traction_coefficient: means.traction.mean(),
        creepage: means.creepage.mean(),
        nominal_creepage: means.creepage.mean().map(|xi| (1.0 + xi) * larger - 1.0),
        patch_half_length: means.half_length.mean(),
        patch_half_width: means.half_width.mean(),
        patch_area: means.area.mean(),
        patch_area_fitted: means.fitted_area.mean(),
        peak_pressure: means.peak_pressure.mean(),
        stick_fraction: means.stick.mean(),
        slip_fraction: means.slip.mean(),
    }
}

/// The evaluation window, means over it that [`Contact`] does not hold, and standard deviations.
pub(crate) fn window(case: &Case, means: &Means, status: Status) -> Window {
    let [from, to] = case.evaluation_window();
    let misses = Some(means).filter(|_| status == Status::Completed);
    let deviation = [
        (Mean::NormalForce, &means.force[2]),
        (Mean::TangentialForce, &means.force[0]),
        (Mean::LateralForce, &means.force[1]),
        (Mean::TractionCoefficient, &means.traction),
        (Mean::Creepage, &means.creepage),
        (Mean::PatchHalfLength, &means.half_length),
        (Mean::PatchHalfWidth, &means.half_width),
        (Mean::PatchArea, &means.area),
        (Mean::PatchAreaFitted, &means.fitted_area),
        (Mean::PeakPressure, &means.peak_pressure),
        (Mean::PeakShear, &means.peak_shear),
        (Mean::StickFraction, &means.stick),
        (Mean::SlipFraction, &means.slip),
        (Mean::StickBorder, &means.stick_border),
        (Mean::Torque, &means.torque),
        (Mean::MaxPenetration, &means.penetration),
    ];
    Window {
        from: Some(from),
        to: Some(to),
        reasons: reasons(means),
        stick_border: means.stick_border.mean(),
        peak_shear: means.peak_shear.mean(),
        torque: means.torque.mean(),
        max_penetration: means.penetration.mean(),
        hourglass_share: means.hourglass_share.mean(),
        friction_power: means.friction_power(),
        warnings: misses.and_then(|means| means.load_warning(case)).into_iter().collect(),
        deviation: deviation.map(|(mean, of)| (mean, of.deviation())).into(),
    }
}

/// Why means of the patch have no value, or how many rows of the history they leave out.
fn reasons(means: &Means) -> BTreeMap<Mean, String> {
    let rows = means.area.count();
    let fit = "Hertz's distribution fits the pressure of";
    let stick = "something sticks on y = 0, and a fit has a centre, in";
    let all = [
        (Mean::PatchHalfLength, &means.half_length, fit),
        (Mean::PatchHalfWidth, &means.half_width, fit),
        (Mean::PatchAreaFitted, &means.fitted_area, fit),
        (Mean::PeakPressure, &means.peak_pressure, fit),
        (Mean::StickBorder, &means.stick_border, stick),
    ];
    let entry = |(key, mean, what): (Mean, &crate::run::means::Mean, &str)| {
        let text = match mean.count() {
            _ if rows == 0 => "the evaluation window holds no row of the history".to_owned(),
            0 => format!("{what} none of {rows} rows of the history"),
            some if some < rows => format!("{what} {some} of {rows} rows of the history"),
            _ => return None,
        };
        Some((key, text))
    };
    all.into_iter().filter_map(entry).collect()
}
