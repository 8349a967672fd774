//! What a step contributes to the history and to the means of the evaluation window.

use crate::scenario::{BAR, DISK};
use contact::patch;
use dynamics::{Energies, StepReport};
use output::layout::HistoryRow;

use crate::run::means::Means;

/// Resultants of the contact on the disk, and the creepage.
#[derive(Clone, Copy)]
pub(super) struct Resultants {
    /// Forces on the disk (N).
    tangential: f64,
    lateral: f64,
    normal: f64,
    /// omega R_eff / V - 1 (dimensionless).
    creepage: f64,
    /// Resultant on both bodies over the normal force, zero by action and reaction.
    mismatch: f64,
}

impl Resultants {
    /// Those of a step, with the effective rolling radius (m) and the speed (m/s). The lateral forces of the mirror
    /// images of `half` a model cancel.
    pub(super) fn of(report: &StepReport, effective_radius: f64, speed: f64, half: bool) -> Self {
        let [tangential, lateral, normal] = report.contact.force[DISK].into();
        let lateral = if half { 0.0 } else { lateral };
        let sum = report.contact.force[DISK] + report.contact.force[BAR];
        Self {
            tangential,
            lateral,
            normal,
            creepage: report.omega * effective_radius / speed - 1.0,
            mismatch: sum.norm() / report.contact.normal_force.max(f64::MIN_POSITIVE),
        }
    }
}

/// Measures of the patch on the bar at one instant.
pub(crate) struct PatchMeasures {
    /// Half axes along and across (m), peak pressure (Pa), x of the centre relative to the hub (m) and area (m^2), by the
    /// fit of Hertz's distribution; NaN where none fits.
    pub(crate) fit: [f64; 5],
    pub(crate) areas: patch::PatchAreas,
    /// Largest shear traction (Pa).
    pub(crate) peak_shear: f64,
    /// Largest (|shear| - mu p) over the Hertz peak pressure.
    pub(crate) cone_excess: f64,
    /// Rear end of the zone of stick on the centre line, relative to the patch's centre (m).
    pub(crate) stick_border: f64,
}

impl Means {
    /// Adds a step: to the extremes and counts always, to the means where it lies inside the evaluation window, of which so
    /// much has `passed`, from 0 to 1.
    pub(super) fn add_step(
        &mut self,
        report: &StepReport,
        resultants: &Resultants,
        passed: Option<f64>,
    ) {
        let contact = &report.contact;
        if contact.closed > 0 {
            self.worst_mismatch = self.worst_mismatch.max(resultants.mismatch);
        }
        self.most_sweeps = self.most_sweeps.max(contact.sweeps);
        self.add_unconverged(contact.unconverged);
        self.integrated += contact.integrated as u64;
        self.non_unique += contact.non_unique as u64;
        for (most, now) in self.steepness.iter_mut().zip(contact.steepness) {
            *most = most.max(now);
        }
        if let Some(passed) = passed {
            let Resultants { tangential, lateral, normal, .. } = *resultants;
            self.add_normal_force(normal, passed);
            for (mean, f) in self.force.iter_mut().zip([tangential, lateral, normal]) {
                mean.add(f);
            }
            self.traction.add(tangential / normal);
            self.creepage.add(resultants.creepage);
            self.torque.add(report.drive.torque);
            self.penetration.add(contact.max_penetration);
        }
    }

    /// Adds the patch and the energies of a row of the history, at `time` (s).
    pub(super) fn add_row(
        &mut self,
        time: f64,
        patch: &PatchMeasures,
        energies: &Energies,
        inside: bool,
    ) {
        self.worst_cone = self.worst_cone.max(patch.cone_excess);
        if inside {
            let [a, b, p0, _, area] = patch.fit;
            self.half_length.add(a);
            self.half_width.add(b);
            self.peak_pressure.add(p0);
            self.fitted_area.add(area);
            self.peak_shear.add(patch.peak_shear);
            self.area.add(patch.areas.contact);
            self.stick.add(patch.areas.stick_fraction);
            self.slip.add(patch.areas.slip_fraction);
            self.stick_border.add(patch.stick_border);
            self.hourglass_share.add(energies.hourglass / energies.internal);
            let work = [time, energies.friction_dissipated];
            self.friction_work.get_or_insert([work; 2])[1] = work;
        }
    }
}

/// Where the hub is after a step (m), how far the mesh has moved (m), and what the energy ledger says (J).
#[derive(Clone, Copy)]
pub(crate) struct Whereabouts {
    pub(crate) hub_x: f64,
    pub(crate) hub_z: f64,
    pub(crate) window_x: f64,
    pub(crate) window_energy: f64,
    pub(crate) imbalance: f64,
}

/// The row of the history of a step.
pub(super) fn row(
    report: &StepReport,
    resultants: &Resultants,
    patch: &PatchMeasures,
    at: &Whereabouts,
) -> HistoryRow<f64> {
    let e = report.energies.unwrap_or_default();
    let Resultants { tangential, lateral, normal, creepage, mismatch } = *resultants;
    let [a, b, p0, xc, _] = patch.fit;
    let areas = &patch.areas;
    HistoryRow {
        time: report.time,
        step: report.step as f64,
        kinetic: e.kinetic,
        internal: e.internal,
        hourglass: e.hourglass,
        contact_stored: e.contact_stored,
        friction_dissipated: e.friction_dissipated,
        damping_dissipated: e.damping_dissipated,
        external_work: e.external_work,
        imbalance: at.imbalance,
        normal_force: normal,
        tangential_force: tangential,
        lateral_force: lateral,
        traction_coefficient: tangential / normal,
        creepage,
        omega: report.omega,
        torque: report.drive.torque,
        drive_force: report.drive.force_x,
        hub_x: at.hub_x,
        hub_z: at.hub_z,
        patch_half_length: a,
        patch_half_width: b,
        patch_x: xc,
        peak_pressure: p0,
        peak_pressure_raw: areas.peak_pressure,
        peak_shear: patch.peak_shear,
        patch_area: areas.contact,
        stick_fraction: areas.stick_fraction,
        slip_fraction: areas.slip_fraction,
        stick_border: patch.stick_border,
        closed_pairs: report.contact.closed as f64,
        slipping_pairs: report.contact.slipping as f64,
        max_penetration: report.contact.max_penetration,
        cone_excess: patch.cone_excess,
        contact_damping: e.contact_damping,
        sweeps: report.contact.sweeps as f64,
        manifold: report.contact.non_unique as f64,
        resultant_mismatch: mismatch,
        window_x: at.window_x,
        window_energy: at.window_energy,
    }
}
