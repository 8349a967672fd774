//! The keys of a case file.
//!
//! Each key's doc comment gives its meaning, SI unit and default; the allowed range of every
//! key stands in one table, [`crate::keys::KEYS`], from which both the checks and the ranges in
//! the JSON Schema are taken.

use crate::hertz::hertz;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use crate::bodies::{
    Bar, Disk, Ends, LengthUnit, Material, MaterialOverride, MeshSets, Meshing, Zone,
};
pub use crate::forms::{Crown, Stiffness};

/// A case: a disk pressed on a bar and rolled along it. SI units throughout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// Name of the case; the run goes to `runs/<name>` unless `--out` says otherwise.
    /// Default: the case file's name without its extension.
    #[serde(default)]
    pub name: String,
    /// One line that says what the case is for. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Another case file, relative to this one, whose keys hold wherever this file is silent.
    /// Tables merge key by key, arrays are replaced whole. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extends: Option<String>,
    /// Whether the element kernels are those whose bits every processor can give (AVX2's, also where there
    /// is AVX-512 or no AVX2). Default false: the fastest of the machine.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub deterministic: bool,
    /// The disk.
    #[serde(default)]
    pub disk: Disk,
    /// The bar.
    #[serde(default)]
    pub bar: Bar,
    /// The elastic material of both bodies, unless `disk.material` or `bar.material` differ.
    #[serde(default)]
    pub material: Material,
    /// The mesh.
    #[serde(default)]
    pub mesh: Meshing,
    /// The finite element.
    #[serde(default)]
    pub element: Element,
    /// The load that presses the disk on the bar.
    pub load: Load,
    /// What makes the disk roll.
    pub drive: Drive,
    /// The friction law.
    pub friction: friction::Parameters,
    /// How contact is enforced.
    #[serde(default)]
    pub contact: Contact,
    /// Damping; everything is off by default.
    #[serde(default)]
    pub damping: Damping,
    /// How the state before rolling is found.
    #[serde(default)]
    pub preload: Preload,
    /// Time step and length of the run.
    #[serde(default)]
    pub time: Time,
    /// The evaluation window.
    #[serde(default)]
    pub evaluate: Evaluate,
    /// What is written, and how often.
    #[serde(default)]
    pub output: Output,
    /// How often the state is kept, for `--resume`. No result depends on it.
    #[serde(default)]
    pub checkpoint: Checkpoint,
    /// What stops the run, beside energy from nowhere, numbers that are none and elements inside out.
    /// No result depends on it.
    #[serde(default)]
    pub guards: Guards,
}

/// The hexahedron.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Element {
    /// Flanagan-Belytschko hourglass stiffness coefficient of the one-point element
    /// (dimensionless). Default 0.05.
    pub hourglass: f64,
    /// Integration of the elements below the fine zone of each contact surface: `"full"` (2x2x2
    /// points, no hourglass modes, two to three times the time of each such element), or
    /// `"one-point"`, as everywhere else: slip that alternates from node to node is then a soft mode
    /// of the mesh, which falling friction feeds. Default `"full"`.
    pub contact_layers: ContactLayers,
    /// Layers of elements below each surface that `contact_layers` speaks of (count). Default 2
    /// with `contact_layers = "full"`, refused with `"one-point"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layers: Option<u64>,
    /// Volumetric part of the fully integrated elements: `"mean"` (its mean over the element, which
    /// does not lock as Poisson's ratio nears 1/2) or `"full"` (at every point).
    /// Default `"mean"` with `contact_layers = "full"`, refused with `"one-point"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub volumetric: Option<Volumetric>,
}

impl Default for Element {
    fn default() -> Self {
        Self {
            hourglass: 0.05,
            contact_layers: ContactLayers::default(),
            layers: None,
            volumetric: None,
        }
    }
}

/// How the elements below the contact surfaces are integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ContactLayers {
    /// One point and hourglass stiffness.
    OnePoint,
    /// 2x2x2 Gauss points.
    #[default]
    Full,
}

/// How the volumetric part of a fully integrated element is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Volumetric {
    /// By its mean over the element.
    #[default]
    Mean,
    /// At every Gauss point.
    Full,
}

/// The load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Force pressing the disk down on the bar (N), positive. Required.
    pub normal: f64,
    /// `"load"`: the force is prescribed while rolling; `"height"`: the hub is held at the
    /// height that the preload found. Default `"load"`.
    #[serde(default)]
    pub mode: LoadMode,
    /// Extra mass of hub and wheelset carried by the hub (kg). Default 0.
    #[serde(default)]
    pub hub_mass: f64,
}

/// What is prescribed vertically at the hub while rolling.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum LoadMode {
    /// The vertical force.
    #[default]
    Load,
    /// The height found by the preload.
    Height,
}

/// The drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// Rolling speed V in +x (m/s). Required.
    pub speed: f64,
    /// `"creepage"`: the angular velocity is prescribed as (1 + creepage) V/R_eff; `"torque"`: the
    /// torque about the hub is. Default: `"torque"` where `drive.torque` is given, else
    /// `"creepage"`.
    #[serde(default)]
    pub mode: DriveMode,
    /// Longitudinal creepage (omega R_eff - V)/V (dimensionless), positive when driving; R_eff is
    /// the effective rolling radius that the preload gives.
    /// Required with `mode = "creepage"`, refused with `"torque"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub creepage: Option<f64>,
    /// Torque about the hub's axis (N m); positive when driving. Required with
    /// `mode = "torque"`, refused with `"creepage"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<f64>,
    /// Time over which creepage or torque rises by a smoothstep (s). Default 0.74e-3.
    #[serde(default = "Drive::default_ramp")]
    pub ramp: f64,
}

impl Drive {
    fn default_ramp() -> f64 {
        0.74e-3
    }
}

/// What is prescribed about the hub's axis while rolling.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DriveMode {
    /// The angular velocity, by the nominal creepage.
    #[default]
    Creepage,
    /// The torque.
    Torque,
}

/// Contact enforcement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Contact {
    /// `"penalty"`: two-pass surface-to-surface penalty with a friction spring (Eqs 10-11), or
    /// `"exact"`: no penetration and no slip in adhesion at the nodes of the finer surface.
    /// Default `"penalty"`.
    pub enforcement: Enforcement,
    /// What the slave nodes of `enforcement = "exact"` meet: `"node_to_face"`, the face under each, or
    /// `"mortar"`, the faces near it in the mean weighted with dual mortar functions, for meshes that do not
    /// match. Default `"node_to_face"` with `"exact"`, refused with `"penalty"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rows: Option<Rows>,
    /// Correct gap and normal with the exact cylinder and crown instead of the facets
    /// (true or false). Default true.
    pub curvature: bool,
    /// The penalty springs; without meaning for `enforcement = "exact"`.
    pub penalty: Penalty,
}

impl Default for Contact {
    fn default() -> Self {
        Self {
            enforcement: Enforcement::Penalty,
            rows: None,
            curvature: true,
            penalty: Penalty::default(),
        }
    }
}

/// The enforcement methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Enforcement {
    /// Two-pass penalty.
    #[default]
    Penalty,
    /// Lagrange multipliers in one pass.
    Exact,
}

/// The rows of exact enforcement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Rows {
    /// A slave node and the face under it.
    #[default]
    NodeToFace,
    /// A slave node and the mean over the faces near it, by dual mortar functions.
    Mortar,
}

/// The penalty springs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Penalty {
    /// Normal spring: a number (multiple of K/d per pass, LS-DYNA's scale factor),
    /// `{ stiffness = N/m^3 }` (sum of both passes) or `{ stability = fraction }` of the
    /// stability limit. Default 0.1.
    pub normal: Stiffness,
    /// Tangential spring, in the same three forms. Default 0.1.
    pub tangential: Stiffness,
    /// Normal viscous damping as a fraction of critical (dimensionless). Default 0.1.
    pub damping: f64,
}

impl Default for Penalty {
    fn default() -> Self {
        Self { normal: Stiffness::Factor(0.1), tangential: Stiffness::Factor(0.1), damping: 0.1 }
    }
}

/// Damping.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Damping {
    /// Linear bulk viscosity coefficient (dimensionless). Default 0.
    pub bulk_linear: f64,
    /// Quadratic bulk viscosity coefficient (dimensionless). Default 0.
    pub bulk_quadratic: f64,
    /// Kelvin-Voigt time constant (s). Default 0.
    pub kelvin_voigt: f64,
    /// Mass-proportional damping relative to the rigid motion (1/s). Default 0.
    pub mass: f64,
}

/// The preload.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Preload {
    /// `"static"` (Newton's method for the equilibrium under the load), `"relaxation"` (dynamic
    /// relaxation to it) or `"none"` (the load acts suddenly). Default `"static"`.
    pub method: PreloadMethod,
    /// Where the preload has converged (dimensionless): the residual force over the load with
    /// `"static"`, the kinetic over the internal energy with `"relaxation"`. Default 1e-9 with
    /// `"static"`, 1e-8 with `"relaxation"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// The preload gives up after so many iterations (dimensionless). Default 100 of Newton's with
    /// `"static"`, 40000 with `"relaxation"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_iterations: Option<u64>,
    /// Disturbance of the preload's displacement (dimensionless): that of every free node is multiplied by
    /// 1 + r disturbance in each direction, r drawn from -1 to 1. Two runs that differ in it alone show how
    /// fast small differences grow. Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub disturbance: Option<f64>,
    /// What the draws of `disturbance` begin with (dimensionless). Default 1 with it, refused without.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
}

impl Preload {
    /// The preload before it is disturbed.
    pub(crate) fn undisturbed(&self) -> Self {
        Self { disturbance: None, seed: None, ..self.clone() }
    }
}

/// The preload methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PreloadMethod {
    /// Newton's method.
    #[default]
    Static,
    /// Dynamic relaxation.
    Relaxation,
    /// No preload.
    None,
}

/// Time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Time {
    /// Time step as a fraction of 2/omega_max (dimensionless). Above 1 the run is unstable;
    /// that is accepted with a warning, to show a blow-up. Give this or `step`, not both.
    /// Default 0.67 without `step`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("default" = Time::FACTOR))]
    pub factor: Option<f64>,
    /// Longest time step (s), whatever the stability limit; refused above that limit. Runs whose
    /// stability limits differ then have the same step. Give this or `factor`, not both.
    /// Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub step: Option<f64>,
    /// Rolled distance (m). Give this or `duration`, not both. Default 0.060.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll: Option<f64>,
    /// Duration of rolling (s). Give this or `roll`, not both. Default: `roll / drive.speed`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub duration: Option<f64>,
}

impl Time {
    /// `factor` where neither it nor `step` is given.
    pub const FACTOR: f64 = 0.67;
}

/// What the time step is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A fraction of the stability limit (dimensionless).
    Fraction(f64),
    /// This step (s), which must not exceed the limit.
    Absolute(f64),
}

impl Step {
    /// The step (s) for a stability limit (s).
    pub fn under(self, limit: f64) -> f64 {
        match self {
            Self::Fraction(factor) => factor * limit,
            Self::Absolute(step) => step,
        }
    }
}

/// Evaluation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evaluate {
    /// Rolled distance at the end of the run over which means are taken (m). Default 0.020, or
    /// the last third of a run shorter than 0.060 m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub last: Option<f64>,
    /// The same distance in contact transits (dimensionless), instead of `last`: a transit is 2a with a Hertz's half axis
    /// along the rolling direction. Where slip fluctuates a mean needs several. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transits: Option<f64>,
}

/// Output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Interval of `fields.vtkhdf` (s). Default: a fortieth of the run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fields_interval: Option<f64>,
    /// Write the stress of every element to `fields.vtkhdf` (true or false). Default true.
    pub stress: bool,
    /// Interval of `contact.vtkhdf` outside windows (s). Default 5.7e-6, the paper's.
    pub contact_interval: f64,
    /// Interval of `history.h5` (steps). Default 10.
    pub history_interval: u64,
    /// Surface nodes recorded at every step.
    pub probes: Probes,
    /// Spans of time in which the contact surfaces are recorded more often. Default: none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub window: Vec<Window>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            fields_interval: None,
            stress: true,
            contact_interval: 5.7e-6,
            history_interval: 10,
            probes: Probes::default(),
            window: Vec::new(),
        }
    }
}

/// How often a run writes a checkpoint, from which `--resume` goes on with the same bits. Whichever
/// interval ends first counts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Checkpoint {
    /// Interval in time steps (steps). Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    /// Interval in simulated time (s). Default: none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Interval in wall-clock time (min); 0 for none. Default 5.
    pub wall_minutes: f64,
}

impl Default for Checkpoint {
    fn default() -> Self {
        Self { steps: None, time: None, wall_minutes: 5.0 }
    }
}

/// What no sound run does. A run that does it stops, with its cause, place and remedy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Guards {
    /// Hourglass energy over strain energy (dimensionless), reckoned with the usual coefficient 0.05
    /// where `element.hourglass` is smaller. Default 0.5.
    pub hourglass: f64,
    /// Largest penetration in element sizes `mesh.zone.size` (dimensionless). Default 0.5: the search for
    /// contact looks half a face deep.
    pub penetration: f64,
    /// Longest time without contact once there was contact (s). Default 1e-4 after a preload; none with
    /// `preload.method = "none"`, where the disk may bounce.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parted: Option<f64>,
    /// Largest coefficient of friction that the law may give (dimensionless). Default 5; none with
    /// `friction.law = "prakash_clifton"`, whose friction lags behind a pressure that may go to zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
}

impl Default for Guards {
    fn default() -> Self {
        Self { hourglass: 0.5, penetration: 0.5, parted: None, friction: None }
    }
}

/// A span of time in which contact is recorded every `every` steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// Start of the window (s of rolling). Required.
    pub from: f64,
    /// End of the window (s of rolling). Required.
    pub to: f64,
    /// Interval inside the window (steps). Default 1.
    #[serde(default = "Window::every_step")]
    pub every: u64,
}

impl Window {
    fn every_step() -> u64 {
        1
    }
}

/// Points whose nearest surface node is recorded at every step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Probes {
    /// Points [x, y] on the bar's top (m). Default: none.
    pub bar: Vec<[f64; 2]>,
    /// Points [s, y] on the disk's tread (m), s the arc length from the first point of contact,
    /// positive towards +x. Default: none.
    pub disk: Vec<[f64; 2]>,
}

impl Case {
    /// The disk's material: `[material]` with the keys of `[disk.material]` over it.
    pub fn disk_material(&self) -> Material {
        self.disk.material.over(self.material)
    }

    /// The bar's material: `[material]` with the keys of `[bar.material]` over it.
    pub fn bar_material(&self) -> Material {
        self.bar.material.over(self.material)
    }

    /// What the time step is taken from.
    pub fn step(&self) -> Step {
        match self.time.step {
            Some(step) => Step::Absolute(step),
            None => Step::Fraction(self.time.factor.unwrap_or(Time::FACTOR)),
        }
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

    /// Where the preload has converged (dimensionless), by its method.
    pub fn preload_tolerance(&self) -> f64 {
        self.preload.tolerance.unwrap_or(match self.preload.method {
            PreloadMethod::Static => 1e-9,
            PreloadMethod::Relaxation | PreloadMethod::None => 1e-8,
        })
    }

    /// Iterations after which the preload gives up, by its method.
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

    /// Intervals between field snapshots of a case that gives none.
    pub(crate) const SNAPSHOTS: f64 = 40.0;

    /// Interval between field snapshots (s).
    pub fn fields_interval(&self) -> f64 {
        self.output.fields_interval.unwrap_or_else(|| self.duration() / Self::SNAPSHOTS)
    }
}

impl Default for Evaluate {
    /// The window that [`Case::evaluate_last`] derives from the rolled distance.
    fn default() -> Self {
        Self { last: None, transits: None }
    }
}
