//! The keys of a case file.
//!
//! Each key is declared once, on one line of its section: its meaning with SI unit and default, its type,
//! what it may be, what to do where it is refused, and the keys that it depends on or stands for.

pub use crate::case::bodies::{
    Bar, Disk, Ends, Grading, LengthUnit, Material, MaterialOverride, MeshSets, Meshing, Symmetry,
    Zone,
};
use crate::case::form::Form::{Count, Number, OverTime, Points, Text, Words};
use crate::case::form::{none_or_within, within};
pub use crate::case::forms::{Creepage, Crown, ProfileShape, StressField, StressOutput};
use crate::case::key::{FLAG, INTERVAL, OF_A_HUNDRED, OF_SPEED, PENALTY, key, needed, word};
use crate::case::section::{is_default, section, words};
use crate::case::written::Written;
pub use contact::{Normals, Rows, Stiffness};

section! {
    /// A case: a disk pressed on a bar and rolled along it. SI units throughout.
    required Case {
        /// Name of the case; the run goes to `runs/<name>` unless `--out` says otherwise.
        /// Default: the case file's name without its extension.
        #[serde(default)]
        name: String => key(Text, "", "use letters, digits, '-', '_' and '.', as in a folder's name");
        /// One line that says what the case is for. Default: none.
        title: Option<String> => key(Text, "", "give one line of text in quotes");
        /// Another case file, relative to this one, whose keys hold wherever this file is silent.
        /// Tables merge key by key, arrays are replaced whole. Default: none.
        extends: Option<String> => key(Text, "", "give the path of another case file, relative to this one");
        /// Whether the element kernels are those whose bits every processor can give (AVX2's, also where there
        /// is AVX-512 or no AVX2). Default false: the fastest of the machine.
        #[serde(default, skip_serializing_if = "is_default")]
        deterministic: bool => FLAG;
        /// How the bodies are modelled: `"finite-elements"`, a disk and a bar; or `"half-space"`, two elastic
        /// half-spaces of one material, whose profiles near the contact are those of disk and bar. These have no
        /// mesh in depth, no penalty and exact friction; `mesh.zone.size` is the spacing of the points on their surfaces.
        /// Default `"finite-elements"`.
        #[serde(default, skip_serializing_if = "is_default")]
        model: BodyModel => word(BodyModel::WORDS);
        /// How the case was written.
        #[serde(skip)]
        written: Written;
        /// The half-spaces.
        #[serde(default, skip_serializing_if = "is_default")]
        half_space: HalfSpace;
        /// The disk.
        #[serde(default)]
        disk: Disk;
        /// The bar.
        #[serde(default)]
        bar: Bar;
        /// The elastic material of both bodies, unless `disk.material` or `bar.material` differ.
        #[serde(default)]
        material: Material;
        /// The mesh.
        #[serde(default)]
        mesh: Meshing;
        /// The finite element.
        #[serde(default)]
        element: Element;
        /// The load that presses the disk on the bar.
        load: Load;
        /// What makes the disk roll.
        drive: Drive;
        /// The friction law.
        friction: friction::Parameters;
        /// How contact is enforced.
        #[serde(default)]
        contact: Contact;
        /// Damping; everything is off by default.
        #[serde(default)]
        damping: Damping;
        /// How the state before rolling is found.
        #[serde(default)]
        preload: Preload;
        /// Time step and length of the run.
        #[serde(default)]
        time: Time;
        /// The evaluation window.
        #[serde(default)]
        evaluate: Evaluate;
        /// What is written, and how often.
        #[serde(default)]
        output: Output;
        /// How often the state is kept, for `--resume`. No result depends on it.
        #[serde(default)]
        checkpoint: Checkpoint;
        /// What stops the run, beside energy from nowhere, numbers that are none and elements inside out.
        /// No result depends on it.
        #[serde(default)]
        guards: Guards;
    }
}

words! {
    /// How the bodies are modelled.
    BodyModel {
        /// A disk and a bar of finite elements.
        #[default]
        FiniteElements = "finite-elements",
        /// Two elastic half-spaces of one material.
        HalfSpace = "half-space",
    }
}

impl BodyModel {
    /// The model of that word.
    pub(crate) fn named(word: &str) -> Option<Self> {
        [Self::FiniteElements, Self::HalfSpace].into_iter().find(|model| model.word() == word)
    }
}

section! {
    /// The half-spaces of `model = "half-space"`.
    optional HalfSpace {
        /// Whether the half-spaces have inertia (true or false); without it their state is that of equilibrium at each
        /// instant. Default with `model = "half-space"`: true.
        inertia: Option<bool> => FLAG.half_space_only();
    }
}

section! {
    /// The hexahedron.
    optional Element {
        /// Flanagan-Belytschko hourglass stiffness coefficient of the one-point element
        /// (dimensionless). Default 0.05.
        hourglass: f64 = 0.05
            => key(Number(none_or_within(1e-6, 1.0)), "-", "0.05 is usual; 0.01 to 0.1 is the sensible range")
                .finite_elements_only();
        /// Integration of the elements below the fine zone of each contact surface: `"full"` (2x2x2
        /// points, no hourglass modes, two to three times the time of each such element), or
        /// `"one-point"`, as everywhere else: slip that alternates from node to node is then a soft mode
        /// of the mesh, which falling friction feeds. Default `"full"`.
        contact_layers: ContactLayers => word(ContactLayers::WORDS).finite_elements_only();
        /// Layers of elements below each surface that `contact_layers` speaks of (count). Default with
        /// `contact_layers = "full"`: as many as reach a quarter of Hertz's half length of the patch deep, at least 2;
        /// refused with `"one-point"`.
        layers: Option<u64>
            => key(Count(1, 1000), "layers", "give a whole number: 2").only_with("element.contact_layers", &["full"])
                .finite_elements_only();
        /// Volumetric part of the fully integrated elements: `"mean"` (its mean over the element, which
        /// does not lock as Poisson's ratio nears 1/2) or `"full"` (at every point).
        /// Default `"mean"` with `contact_layers = "full"`, refused with `"one-point"`.
        volumetric: Option<Volumetric>
            => word(Volumetric::WORDS).only_with("element.contact_layers", &["full"]).finite_elements_only();
    }
}

words! {
    /// How the elements below the contact surfaces are integrated.
    ContactLayers {
        /// One point and hourglass stiffness.
        OnePoint = "one-point",
        /// 2x2x2 Gauss points.
        #[default]
        Full = "full",
    }
}

words! {
    /// How the volumetric part of a fully integrated element is integrated.
    Volumetric {
        /// By its mean over the element.
        #[default]
        Mean = "mean",
        /// At every Gauss point.
        Full = "full",
    }
}

section! {
    /// The load.
    required Load {
        /// Force pressing the disk down on the bar (N), positive. Required.
        normal: f64
            => needed(Number(within(1e-12, 1e8)), "N",
                "give the force that presses the disk down, positive, in newtons: `normal = 100e3`; a \
         load upwards would lift the disk off the bar");
        /// `"load"`: the force is prescribed while rolling; `"height"`: the hub is held at the
        /// height that the preload found. Default `"load"`.
        #[serde(default)]
        mode: LoadMode => word(LoadMode::WORDS).finite_elements_only();
        /// Extra mass of hub and wheelset carried by the hub (kg). Default 0.
        #[serde(default)]
        hub_mass: f64
            => key(Number(within(0.0, 1e5)), "kg", "give a mass in kg; 0 for the disk alone")
                .finite_elements_only();
    }
}

words! {
    /// What is prescribed vertically at the hub while rolling.
    LoadMode {
        /// The vertical force.
        #[default]
        Load = "load",
        /// The height found by the preload.
        Height = "height",
    }
}

section! {
    /// The drive.
    required Drive {
        /// Rolling speed V in +x (m/s). Required.
        speed: f64
            => needed(Number(within(1e-9, 500.0)), "m/s", "give the rolling speed in +x in m/s: `speed = 38.89`")
                .usually(within(0.0, 120.0), OF_SPEED);
        /// `"creepage"`: the angular velocity is prescribed as (1 + creepage) V/R_eff; `"torque"`: the
        /// torque about the hub is. Default: `"torque"` where `drive.torque` is given, else
        /// `"creepage"`.
        #[serde(default)]
        mode: DriveMode => word(DriveMode::WORDS);
        /// Longitudinal creepage (omega R_eff - V)/V (dimensionless), positive when driving, negative when braking; R_eff is
        /// the effective rolling radius that the preload gives. Either a number, or a table over time: pairs of
        /// time (s of rolling, rising from 0) and creepage, which is linear between them and constant after the last.
        /// Required with `mode = "creepage"`, refused with `"torque"`.
        creepage: Option<Creepage>
            => needed(OverTime(within(-0.5, 0.5)), "-",
                "give the creepage as a plain ratio, not per cent or per mille: `creepage = 2.4e-3` for 2.4 per mille; or \
         over time: `creepage = [[0, 0], [1e-3, 2.4e-3]]`")
                .only_with("drive.mode", &["creepage"]).instead_of("drive.torque")
                .usually(within(-0.1, 0.1), OF_A_HUNDRED);
        /// Lateral velocity of the disk over V (dimensionless), positive in +y; it rises over `ramp`. With finite elements
        /// the hub drifts so, and the rim follows as the disk bends, which takes longer than a roll of 60 mm unless
        /// `disk.hub_radius` leaves a shallow rim. Refused with half a model, plane strain, or a fine zone that follows the
        /// contact. Default 0.
        #[serde(default, skip_serializing_if = "is_default")]
        lateral_creepage: f64
            => key(Number(within(-0.5, 0.5)), "-",
                "give the ratio of the velocities: `lateral_creepage = 1e-3` for 1 per mille")
                .usually(within(-0.1, 0.1), OF_A_HUNDRED);
        /// Angular velocity of the disk about the vertical over V (rad/m), positive about +z; it rises over `ramp`. With
        /// finite elements the hub turns so and follows its heading, on an arc of this curvature; the rim follows as with
        /// `lateral_creepage`, against its inertia. Refused where that is. Default 0.
        #[serde(default, skip_serializing_if = "is_default")]
        spin: f64
            => key(Number(within(-100.0, 100.0)), "rad/m",
                "give the angular velocity over the speed, in rad/m: `spin = 0.1`");
        /// Torque about the hub's axis (N m); positive when driving. Required with
        /// `mode = "torque"`, refused with `"creepage"`.
        torque: Option<f64>
            => needed(Number(within(-1e7, 1e7)), "N m", "give the torque in N m: `torque = 12.9e3`")
                .only_with("drive.mode", &["torque"]).instead_of("drive.creepage");
        /// Time over which creepage, torque, lateral creepage and spin rise by a smoothstep (s). Refused where
        /// `creepage` is a table and neither of the last two is given. Default 0.74e-3.
        ramp: Option<f64> => key(Number(within(0.0, 1.0)), "s", "give a time in seconds: 0.74e-3");
    }
}

impl Drive {
    /// Time over which what drives rises (s).
    pub fn ramp(&self) -> f64 {
        self.ramp.unwrap_or(0.74e-3)
    }

    /// Whether something rises over the ramp: all but a table of creepage.
    pub(crate) fn rises(&self) -> bool {
        let table = matches!(self.creepage, Some(Creepage::Table(_)));
        !table || self.lateral_creepage != 0.0 || self.spin != 0.0
    }
}

words! {
    /// What is prescribed about the hub's axis while rolling.
    DriveMode {
        /// The angular velocity, by the nominal creepage.
        #[default]
        Creepage = "creepage",
        /// The torque.
        Torque = "torque",
    }
}

section! {
    /// Contact enforcement.
    optional Contact {
        /// `"penalty"`: two-pass surface-to-surface penalty with a friction spring (Eqs 10-11), or
        /// `"exact"`: no penetration and no slip in adhesion at the nodes of the finer surface.
        /// Default `"penalty"`.
        enforcement: Enforcement = Enforcement::Penalty => word(Enforcement::WORDS).finite_elements_only();
        /// What the slave nodes of `enforcement = "exact"` meet: `"node_to_face"`, the face under each, or
        /// `"mortar"`, the faces near it in the mean weighted with dual mortar functions, for meshes that do not
        /// match. Default `"node_to_face"` with `"exact"`, refused with `"penalty"`.
        rows: Option<Rows>
            => word(Rows::WORDS).only_with("contact.enforcement", &["exact"])
                .finite_elements_only();
        /// Correct gap and normal with the exact cylinder and crown instead of the facets
        /// (true or false). Default true.
        curvature: bool = true => FLAG.finite_elements_only();
        /// The normal along which a node meets a face: `"averaged"`, interpolated between means over the faces around
        /// each corner, or `"face"`, that of the face alone (Benson and Hallquist 1990), which pushes the disk along
        /// without friction by the order of h/(4R) of the load at faces of size h; without meaning for
        /// `rows = "mortar"`. Default `"averaged"`.
        normals: Normals = Normals::Averaged => word(Normals::WORDS).finite_elements_only();
        /// The penalty springs; without meaning for `enforcement = "exact"`.
        penalty: Penalty;
    }
}

words! {
    /// The enforcement methods.
    Enforcement {
        /// Two-pass penalty.
        #[default]
        Penalty = "penalty",
        /// Lagrange multipliers in one pass.
        Exact = "exact",
    }
}

section! {
    /// The penalty springs.
    optional Penalty {
        /// Normal spring: a number (multiple of K/d per pass, LS-DYNA's scale factor),
        /// `{ stiffness = N/m^3 }` (sum of both passes) or `{ stability = fraction }` of the
        /// stability limit. Default 0.1.
        normal: Stiffness = Stiffness::Factor(0.1) => PENALTY.finite_elements_only();
        /// Tangential spring, in the same three forms. Default 0.1.
        tangential: Stiffness = Stiffness::Factor(0.1) => PENALTY.finite_elements_only();
        /// Normal viscous damping as a fraction of critical (dimensionless). Default 0.1.
        damping: f64 = 0.1
            => key(Number(within(0.0, 1.0)), "-", "give a fraction of critical, not per cent: 0.1")
                .usually(within(0.0, 1.0), OF_A_HUNDRED).finite_elements_only();
    }
}

section! {
    /// Damping.
    optional Damping {
        /// Linear bulk viscosity coefficient (dimensionless). Default 0.
        bulk_linear: f64
            => key(Number(within(0.0, 2.0)), "-", "0.06 is usual; 0 turns it off")
                .finite_elements_only();
        /// Quadratic bulk viscosity coefficient (dimensionless). Default 0.
        bulk_quadratic: f64
            => key(Number(within(0.0, 20.0)), "-", "1.2 is usual; 0 turns it off")
                .finite_elements_only();
        /// Kelvin-Voigt time constant (s). Default with exact contact in explicit steps a twentieth of the time in which a
        /// pressure wave passes an element of the fine zone: without it nodes in steady slip stick and slip in turn. Else 0.
        kelvin_voigt: Option<f64>
            => key(Number(within(0.0, 1e-3)), "s", "give 0.1 to 1 time steps, about 1e-8 s; 0 turns it off")
                .finite_elements_only();
        /// Mass-proportional damping relative to the rigid motion (1/s). Default 0.
        mass: f64
            => key(Number(within(0.0, 1e6)), "1/s", "give a rate in 1/s; 0 turns it off")
                .finite_elements_only();
    }
}

section! {
    /// The preload.
    optional Preload {
        /// `"static"` (Newton's method for the equilibrium under the load), `"relaxation"` (dynamic
        /// relaxation to it) or `"none"` (the load acts suddenly). Default `"static"`.
        method: PreloadMethod => word(PreloadMethod::WORDS).finite_elements_only();
        /// Where the preload has converged (dimensionless): the residual force over the load with
        /// `"static"`, the kinetic over the internal energy with `"relaxation"`. Default 1e-9 with
        /// `"static"`, 1e-8 with `"relaxation"`.
        tolerance: Option<f64>
            => key(Number(within(1e-20, 1e-2)), "-",
                "give the residual over the load (static) or the ratio of kinetic to internal energy: 1e-9")
                .finite_elements_only();
        /// The preload gives up after so many iterations (dimensionless). Default 100 of Newton's with
        /// `"static"`, 40000 with `"relaxation"`.
        max_iterations: Option<u64>
            => key(Count(1, 100_000_000), "-", "give a whole number: 100 (static), 40000 (relaxation)")
                .finite_elements_only();
        /// Disturbance of the preload's displacement (dimensionless): that of every free node is multiplied by
        /// 1 + r disturbance in each direction, r drawn from -1 to 1. In half-spaces it multiplies the pressure of every
        /// point of the material instead. Two runs that differ in it alone show how fast small differences grow; of half a model only those that its plane mirrors. Default: none.
        disturbance: Option<f64>
            => key(Number(within(1e-16, 1e-3)), "-", "give a small part, such as 1e-9")
                .only_with("preload.method", &["static", "relaxation"]);
        /// What the draws of `disturbance` begin with (dimensionless). Default 1 with it, refused without.
        seed: Option<u64>
            => key(Count(0, 1_000_000), "-", "give a whole number").only_with("preload.disturbance", &[]);
    }
}

impl Preload {
    /// The preload before it is disturbed.
    pub fn undisturbed(&self) -> Self {
        Self { disturbance: None, seed: None, ..self.clone() }
    }
}

words! {
    /// The preload methods.
    PreloadMethod {
        /// Newton's method.
        #[default]
        Static = "static",
        /// Dynamic relaxation.
        Relaxation = "relaxation",
        /// No preload.
        None = "none",
    }
}

section! {
    /// Time.
    optional Time {
        /// Time step as a fraction of 2/omega_max (dimensionless). Above 1 the run is unstable;
        /// that is accepted with a warning, to show a blow-up. With `model = "half-space"` it is a fraction of the
        /// time in which pressure waves pass `mesh.zone.size`, or without inertia the patch does. Give this or `step`, not both.
        /// Default without `step`: 0.67 with `contact.enforcement = "penalty"`, whose springs stiffen the assembly as
        /// nodes close, 0.95 with `"exact"`, which has none, and 0.5 with `model = "half-space"`, 0.1 without inertia.
        factor: Option<f64>
            => key(Number(within(1e-4, 2.0)), "-",
                "up to 1 is stable, up to 2 is accepted to show a blow-up").instead_of("time.step");
        /// Longest time step (s), whatever the stability limit; refused above that limit with explicit steps. Runs whose
        /// stability limits differ then have the same step. Give this or `factor`, not both.
        /// Default: none.
        step: Option<f64>
            => key(Number(within(1e-15, 1e-3)), "s", "give the step in seconds: 1.5e-7").instead_of("time.factor");
        /// `"explicit"`: central difference, or `"implicit"`: the theta method on velocities, with exact contact and
        /// friction at the end of each step of `time.step`. Default `"explicit"`.
        integrator: Option<Integrator> => word(Integrator::WORDS).finite_elements_only();
        /// The parameter of the implicit integrator (dimensionless): 0.5 keeps the energy of elastic waves and is of second order, 1 damps
        /// those that the step does not resolve most. Default 0.6 with `integrator = "implicit"`, refused without.
        theta: Option<f64>
            => key(Number(within(0.5, 1.0)), "-", "give a number from 0.5 to 1")
                .only_with("time.integrator", &["implicit"]).finite_elements_only();
        /// Rolled distance (m). Give this or `duration`, not both. Default 0.060.
        roll: Option<f64>
            => key(Number(within(1e-9, 10.0)), "m",
                "give the rolled distance in metres: 0.06").instead_of("time.duration");
        /// Duration of rolling (s). Give this or `roll`, not both. Default: `roll / drive.speed`.
        duration: Option<f64>
            => key(Number(within(1e-15, 10.0)), "s", "give the time in seconds: 1.5e-3").instead_of("time.roll");
    }
}

words! {
    /// How finite elements step in time.
    Integrator {
        /// Central difference.
        #[default]
        Explicit = "explicit",
        /// The theta method on velocities.
        Implicit = "implicit",
    }
}

/// How the time step of a case is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// A fraction of the stability limit (dimensionless).
    Fraction(f64),
    /// This step (s), whatever the limit; a run refuses one above it.
    Absolute(f64),
}

impl Step {
    /// The step (s) for a stability limit (s); an absolute step is not compared with it.
    pub fn under(self, limit: f64) -> f64 {
        match self {
            Self::Fraction(factor) => factor * limit,
            Self::Absolute(step) => step,
        }
    }
}

section! {
    /// Evaluation.
    optional Evaluate {
        /// Rolled distance at the end of the run over which means are taken (m). Default 0.020, or
        /// the last third of a run shorter than 0.060 m.
        last: Option<f64>
            => key(Number(within(1e-9, 10.0)), "m",
                "give the rolled distance in metres: 0.02").instead_of("evaluate.transits");
        /// The same distance in contact transits (dimensionless), instead of `last`: a transit is 2a with a Hertz's half axis
        /// along the rolling direction. Where slip fluctuates a mean needs several. Default: none.
        transits: Option<f64>
            => key(Number(within(1e-3, 1e4)), "-", "give contact transits 2a: 4").instead_of("evaluate.last");
    }
}

section! {
    /// Output.
    optional Output {
        /// Interval of `fields.vtkhdf` (s). Default: a fortieth of the run.
        fields_interval: Option<f64> => INTERVAL.finite_elements_only();
        /// Which stresses of every element `fields.vtkhdf` holds, tension positive: true for `tensor` and
        /// `von_mises`, false for none, or a list: `"tensor"` (xx yy zz xy yz xz), `"von_mises"`, `"max_shear"` (half of
        /// largest less smallest principal stress), `"hydrostatic"` (a third of the trace), `"principal"` (the largest
        /// first). Default true.
        stress: StressOutput = StressOutput::Usual(true)
            => key(Words(StressField::WORDS), "", "give a list of names: [\"von_mises\", \"max_shear\"]")
                .finite_elements_only();
        /// Interval of `contact.vtkhdf` outside windows (s). Default 5.7e-6, the paper's.
        contact_interval: f64 = 5.7e-6 => INTERVAL;
        /// Interval of `history.h5` (steps). Default 10.
        history_interval: u64 = 10 => key(Count(1, 1_000_000), "steps", "give a whole number: 10");
        /// Surface nodes recorded at every step.
        probes: Probes;
        /// Spans of time in which the contact surfaces are recorded more often. Default: none.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        window: Vec<Window>;
    }
}

section! {
    /// How often a run writes a checkpoint, from which `--resume` goes on with the same bits. Whichever
    /// interval ends first counts.
    optional Checkpoint {
        /// Interval in time steps (steps). Default: none.
        steps: Option<u64> => key(Count(1, 1_000_000_000), "steps", "give a whole number: 100000");
        /// Interval in simulated time (s). Default: none.
        time: Option<f64> => INTERVAL;
        /// Interval in wall-clock time (min); 0 for none. Default 5.
        wall_minutes: f64 = 5.0 => key(Number(none_or_within(1e-5, 1e5)), "min", "give minutes, 0 for none: 5");
    }
}

section! {
    /// What no sound run does. A run that does it stops, with its cause, place and remedy.
    optional Guards {
        /// Hourglass energy over strain energy (dimensionless), reckoned with the usual coefficient 0.05
        /// where `element.hourglass` is smaller. Default 0.5.
        hourglass: f64 = 0.5
            => key(Number(within(1e-6, 1e6)), "-", "give a share of the strain energy: 0.5")
                .finite_elements_only();
        /// Largest penetration in element sizes `mesh.zone.size` (dimensionless). Default 0.5: the search for
        /// contact looks half a face deep.
        penetration: f64 = 0.5
            => key(Number(within(1e-6, 1e6)), "-", "give element sizes: 0.5 for half a one")
                .finite_elements_only();
        /// Longest time without contact once there was contact (s). Default 1e-4 after a preload; none with
        /// `preload.method = "none"`, where the disk may bounce.
        parted: Option<f64>
            => key(Number(within(1e-9, 10.0)), "s", "give a time in seconds: 1e-4")
                .finite_elements_only();
        /// Largest coefficient of friction that the law may give (dimensionless). Default 5; none with
        /// `friction.law = "prakash_clifton"`, whose friction lags behind a pressure that may go to zero.
        friction: Option<f64> => key(Number(within(1e-3, 1e12)), "-", "give a coefficient of friction: 5");
    }
}

section! {
    /// A span of time in which contact is recorded every `every` steps.
    required Window {
        /// Start of the window (s of rolling). Required.
        from: f64 => needed(Number(within(0.0, 10.0)), "s", "give the start in seconds");
        /// End of the window (s of rolling). Required.
        to: f64 => needed(Number(within(1e-15, 10.0)), "s", "give the end in seconds");
        /// Interval inside the window (steps). Default 1.
        #[serde(default = "Window::every_step")]
        every: u64 => key(Count(1, 1_000_000), "steps", "give a whole number: 1");
    }
}

impl Window {
    fn every_step() -> u64 {
        1
    }
}

section! {
    /// Points whose nearest surface node is recorded at every step.
    optional Probes {
        /// Points [x, y] on the bar's top (m). Default: none.
        bar: Vec<[f64; 2]>
            => key(Points(within(-10.0, 10.0)), "m", "give pairs: [[0.02, 0.0], [0.03, 0.0]]")
                .finite_elements_only();
        /// Points [s, y] on the disk's tread (m), s the arc length from the first point of contact,
        /// positive towards +x. Default: none.
        disk: Vec<[f64; 2]>
            => key(Points(within(-10.0, 10.0)), "m", "give pairs: [[0.02, 0.0], [0.03, 0.0]]")
                .finite_elements_only();
    }
}
