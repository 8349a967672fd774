//! What a case has where its file is silent, and what follows from its keys.

use crate::case::hertz::hertz;
use crate::case::schema::{
    BodyModel, Case, ContactLayers, Drive, Enforcement, Evaluate, Integrator, Material,
    PreloadMethod, Step,
};

/// `damping.kelvin_voigt` of exact contact over the time in which a pressure wave passes an element (dimensionless).
const KELVIN_VOIGT: f64 = 0.05;

/// `time.theta` where it is not given (dimensionless).
const THETA: f64 = 0.6;

/// `time.factor` of half-spaces with and without inertia where neither it nor `time.step` is given (dimensionless). Without
/// inertia tractions at 1 mm then differ by a thousandth from those of shorter steps.
const HALF_SPACE_FACTORS: [f64; 2] = [0.5, 0.1];

/// How deep the layers of elements below the contact surfaces reach, over Hertz's half length of the patch: the field below
/// the patch varies over that length, and where less of it lies in sound elements slip fluctuates (docs/performance.md).
const LAYERS_DEPTH: f64 = 0.25;

/// And how many there are at least.
const LEAST_LAYERS: u64 = 2;

impl Enforcement {
    /// `time.factor` of finite elements where neither it nor `time.step` is given (dimensionless).
    ///
    /// The springs that close after the preload raise the largest frequency; a third of the step is left to them. Exact
    /// contact has no springs: what is left is for the frequencies that rise as elements are compressed, by half their
    /// strain.
    fn default_factor(self) -> f64 {
        match self {
            Self::Penalty => 0.67,
            Self::Exact => 0.95,
        }
    }
}

impl Case {
    /// Writes every default out.
    pub(super) fn write_defaults(&mut self) {
        if self.is_half_space() {
            self.half_space.inertia.get_or_insert(true);
        }
        if self.drive.rises() {
            self.drive.ramp = Some(self.drive.ramp());
        }
        let exact = self.contact.enforcement == Enforcement::Exact || self.is_half_space();
        self.friction.write_defaults(exact);
        if self.contact.enforcement == Enforcement::Exact {
            self.contact.rows.get_or_insert_default();
        }
        if self.element.contact_layers == ContactLayers::Full {
            self.element.layers = Some(self.contact_layers());
            self.element.volumetric.get_or_insert_default();
        }
        if !self.is_half_space() {
            self.damping.kelvin_voigt = Some(self.kelvin_voigt());
        }
        if self.time.step.is_none() {
            self.time.factor = Some(self.factor());
        }
        if self.time.duration.is_none() {
            self.time.roll = Some(self.rolled());
        }
        if self.mesh.file.is_some() {
            self.mesh.unit.get_or_insert_default();
            let sets = &mut self.mesh.sets;
            for (set, name) in [
                (&mut sets.disk, "disk"),
                (&mut sets.bar, "bar"),
                (&mut sets.hub, "hub"),
                (&mut sets.tread, "tread"),
                (&mut sets.top, "top"),
                (&mut sets.clamp, "clamp"),
            ] {
                set.get_or_insert_with(|| name.to_owned());
            }
        } else {
            self.mesh.grading = Some(self.mesh.grading());
        }
        self.preload.tolerance = Some(self.preload_tolerance());
        self.preload.max_iterations = Some(self.preload_iterations());
        self.guards.parted = self.longest_parted();
        self.guards.friction = self.largest_friction();
        if self.evaluate.transits.is_none() {
            self.evaluate.last = Some(self.evaluate_last());
        }
        self.output.fields_interval = Some(self.fields_interval());
    }

    /// The disk's material: `[material]` with the keys of `[disk.material]` over it.
    pub fn disk_material(&self) -> Material {
        self.disk.material.over(self.material)
    }

    /// The bar's material: `[material]` with the keys of `[bar.material]` over it.
    pub fn bar_material(&self) -> Material {
        self.bar.material.over(self.material)
    }

    /// How the time step is chosen.
    pub fn step(&self) -> Step {
        match self.time.step {
            Some(step) => Step::Absolute(step),
            None => Step::Fraction(self.factor()),
        }
    }

    /// The parameter of implicit steps (dimensionless); none of explicit ones.
    pub fn theta(&self) -> Option<f64> {
        let implicit = self.time.integrator == Some(Integrator::Implicit);
        implicit.then(|| self.time.theta.unwrap_or(THETA))
    }

    /// The Kelvin–Voigt time constant (s).
    pub fn kelvin_voigt(&self) -> f64 {
        let undamped = self.contact.enforcement == Enforcement::Penalty || self.theta().is_some();
        let default = if undamped { 0.0 } else { KELVIN_VOIGT * self.wave_time() };
        self.damping.kelvin_voigt.unwrap_or(default)
    }

    /// Longest stable explicit step (s) with the largest frequency `omega_max` (rad/s) without damping: Kelvin–Voigt
    /// stiffens that mode, dt <= 2/omega (sqrt(1 + xi^2) - xi) with xi = eta omega/2.
    pub fn stable_limit(&self, omega_max: f64) -> f64 {
        let xi = 0.5 * self.kelvin_voigt() * omega_max;
        2.0 / omega_max * ((1.0 + xi * xi).sqrt() - xi)
    }

    /// How many layers of elements below each surface `element.contact_layers` speaks of.
    pub fn contact_layers(&self) -> u64 {
        let deep = || (LAYERS_DEPTH * hertz(self).a / self.mesh.zone.size - 1e-9).ceil() as u64;
        self.element.layers.unwrap_or_else(|| LEAST_LAYERS.max(deep()))
    }

    /// The time step as a fraction of the stability limit (dimensionless), where `time.step` does not give it.
    pub fn factor(&self) -> f64 {
        self.time.factor.unwrap_or(self.default_factor())
    }

    /// `time.factor` where neither it nor `time.step` is given (dimensionless).
    pub fn default_factor(&self) -> f64 {
        match self.model {
            BodyModel::FiniteElements => self.contact.enforcement.default_factor(),
            BodyModel::HalfSpace if self.has_inertia() => HALF_SPACE_FACTORS[0],
            BodyModel::HalfSpace => HALF_SPACE_FACTORS[1],
        }
    }

    /// The time (s) in which the faster pressure waves pass an element of the fine zone, or go from point to point
    /// of half-spaces, of which their `time.factor` is a fraction; without inertia, the time in which the patch does.
    pub fn wave_time(&self) -> f64 {
        if self.is_half_space() && !self.has_inertia() {
            return self.mesh.zone.size / self.drive.speed;
        }
        let speeds = [self.disk_material(), self.bar_material()].map(|m| m.pressure_wave());
        self.mesh.zone.size / speeds[0].max(speeds[1])
    }

    /// Whether the bodies are half-spaces.
    pub fn is_half_space(&self) -> bool {
        self.model == BodyModel::HalfSpace
    }

    /// Whether half-spaces have inertia.
    pub fn has_inertia(&self) -> bool {
        self.half_space.inertia.unwrap_or(true)
    }

    /// Duration of rolling (s).
    pub fn duration(&self) -> f64 {
        self.time.duration.unwrap_or_else(|| self.rolled() / self.drive.speed)
    }

    /// Rolled distance (m).
    pub fn rolled(&self) -> f64 {
        match (self.time.roll, self.time.duration) {
            (Some(roll), _) => roll,
            (None, Some(duration)) => duration * self.drive.speed,
            (None, None) => 0.060,
        }
    }

    /// How far the disk drifts sideways at most (m), by lateral creepage and by the arc of its spin.
    pub fn drift(&self) -> f64 {
        let (rolled, Drive { lateral_creepage, spin, .. }) = (self.rolled(), &self.drive);
        rolled * lateral_creepage.abs() + 0.5 * spin.abs() * rolled * rolled
    }

    /// How far the patch lies behind the middle of a disk that drifts, over the drift (dimensionless): it stays where both
    /// surfaces are parallel across, which is on the crest of a bar under a disk that is flat across. 0 where both are.
    pub fn patch_behind(&self) -> f64 {
        let [disk, bar] =
            [self.disk.crown_radius, self.bar.crown_radius].map(|crown| crown.curvature());
        if bar > 0.0 { bar / (disk + bar) } else { 0.0 }
    }

    /// The evaluation window, over which means are taken: from and to (s of rolling).
    pub fn evaluation_window(&self) -> [f64; 2] {
        let to = self.duration();
        [(to - self.evaluate_last() / self.drive.speed).max(0.0), to]
    }

    /// Rolled distance at the end over which means are taken (m).
    pub fn evaluate_last(&self) -> f64 {
        let Evaluate { last, transits } = self.evaluate;
        let of_transits = || transits.map(|transits| transits * 2.0 * hertz(self).a);
        last.or_else(of_transits).unwrap_or_else(|| (self.rolled() / 3.0).min(0.020))
    }

    /// The preload's tolerance (dimensionless); the default is that of its method.
    pub fn preload_tolerance(&self) -> f64 {
        self.preload.tolerance.unwrap_or(match self.preload.method {
            PreloadMethod::Static => 1e-9,
            PreloadMethod::Relaxation | PreloadMethod::None => 1e-8,
        })
    }

    /// Iterations after which the preload fails; the default is that of its method.
    pub fn preload_iterations(&self) -> u64 {
        self.preload.max_iterations.unwrap_or(match self.preload.method {
            PreloadMethod::Static => 100,
            PreloadMethod::Relaxation | PreloadMethod::None => 40_000,
        })
    }

    /// Longest time without contact (s), if there is a limit.
    pub fn longest_parted(&self) -> Option<f64> {
        let preloaded = self.preload.method != PreloadMethod::None;
        self.guards.parted.or(preloaded.then_some(1e-4))
    }

    /// Largest coefficient of friction (dimensionless), if there is a limit.
    pub fn largest_friction(&self) -> Option<f64> {
        let lags = self.friction.law == friction::Kind::PrakashClifton;
        self.guards.friction.or((!lags).then_some(5.0))
    }

    /// Intervals between the field snapshots of a run whose case gives no `output.fields_interval`.
    pub(crate) const SNAPSHOTS: f64 = 40.0;

    /// Interval between field snapshots (s).
    pub fn fields_interval(&self) -> f64 {
        self.output.fields_interval.unwrap_or_else(|| self.duration() / Self::SNAPSHOTS)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::path::Path;

    #[test]
    fn layers_reach_a_quarter_of_the_patch_deep_and_are_two_at_least() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/zhao-li/a-coulomb.toml");
        let layers = |sets: &[&str]| {
            let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
            Case::load(&file, &sets).unwrap().contact_layers()
        };
        // the half length is 7.16 mm
        assert_eq!(layers(&["mesh.zone.size=2e-3"]), 2);
        assert_eq!(layers(&[]), 2);
        assert_eq!(layers(&["mesh.zone.size=0.5e-3"]), 4);
        assert_eq!(layers(&["mesh.zone.size=0.25e-3"]), 8);
        assert_eq!(layers(&["mesh.zone.size=0.25e-3", "element.layers=3"]), 3);
    }
}
