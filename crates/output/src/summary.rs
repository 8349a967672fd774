//! The summary of a run: what `creepage run --json` prints and `summary.json` holds.
//!
//! Each number is declared once, with its unit and what it is; the sections `units` and `names` of the file and the
//! columns of sweeps take both from here.

use crate::integrity::{FileSum, checksum_of, sums_of_files};
use crate::json::{keyed, known, write_json_atomically};
use crate::layout::file;
use crate::{OutputError, Provenance};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It reached the end time of its case.
    Completed,
    /// A signal interrupted it; the results so far are readable.
    Interrupted,
    /// Its guards stopped it.
    Failed,
}

impl Status {
    /// Its word in files.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::Interrupted => "interrupted",
            Self::Failed => "failed",
        }
    }
}

/// A key of the summary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// The key in its section.
    pub key: &'static str,
    /// Its SI unit, `1` where it has none; empty of what is no number.
    pub units: &'static str,
    /// What it is.
    pub name: &'static str,
}

/// Declares a section of the summary: `key: Type = name [unit]`, without a unit what is no number.
macro_rules! section {
    ($(#[$about:meta])* $Section:ident {
        $($(#[$attribute:meta])* $key:ident: $Type:ty = $name:literal $([$units:literal])?,)*
    }) => {
        $(#[$about])*
        #[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
        #[serde(default)]
        pub struct $Section {
            $($(#[$attribute])* #[doc = concat!($name $(, " (", $units, ")")?)] pub $key: $Type,)*
        }

        impl $Section {
            /// Its keys, in the order of the file.
            pub const KEYS: &[Quantity] =
                &[$(Quantity { key: stringify!($key), units: concat!($($units)?), name: $name },)*];
        }
    };
}

section! {
    /// The energy balance of both bodies at the end of the run, and its error.
    #[derive(Copy)]
    Energy {
        #[serde(deserialize_with = "null_is_nan")]
        kinetic: f64 = "kinetic energy" ["J"],
        #[serde(deserialize_with = "null_is_nan")]
        internal: f64 = "strain energy of the elements" ["J"],
        #[serde(deserialize_with = "null_is_nan")]
        hourglass: f64 = "energy of the hourglass stiffness" ["J"],
        #[serde(deserialize_with = "null_is_nan")]
        contact_stored: f64 = "energy in the contact springs" ["J"],
        #[serde(deserialize_with = "null_is_nan")]
        friction_dissipated: f64 = "work of friction turned into heat so far" ["J"],
        #[serde(deserialize_with = "null_is_nan")]
        damping_dissipated: f64 = "work of all dampers turned into heat so far" ["J"],
        #[serde(deserialize_with = "null_is_nan")]
        external_work: f64 = "work of prescribed motion and load so far" ["J"],
        #[serde(deserialize_with = "null_is_nan")]
        balance_error: f64 = "error of the energy balance, |sum of energies - external work - initial sum|, over the largest energy exchanged" ["1"],
    }
}

section! {
    /// Means over the evaluation window; forces are those of the bar on the disk in the global frame (x rolls, y is
    /// lateral, z is up). `None` (null) where there is no value, such as where Hertz's distribution fits no pressure.
    #[derive(Copy)]
    Contact {
        normal_force: Option<f64> = "force of the bar on the disk, z, mean over the evaluation window" ["N"],
        tangential_force: Option<f64> = "force of the bar on the disk, x, mean over the evaluation window" ["N"],
        lateral_force: Option<f64> = "force of the bar on the disk, y, mean over the evaluation window" ["N"],
        traction_coefficient: Option<f64> = "tangential over normal force" ["1"],
        creepage: Option<f64> = "(omega R_eff - V)/V" ["1"],
        nominal_creepage: Option<f64> = "(omega R - V)/V, with R the radius of the undeformed disk" ["1"],
        patch_half_length: Option<f64> = "half axis of the patch in x" ["m"],
        patch_half_width: Option<f64> = "half axis of the patch in y, or half the width of a line contact" ["m"],
        patch_area: Option<f64> = "area of the bar's nodes in contact" ["m2"],
        patch_area_fitted: Option<f64> = "area of the fitted ellipse, or of a line contact's rectangle" ["m2"],
        peak_pressure: Option<f64> = "largest pressure of the fit of Hertz's distribution" ["Pa"],
        stick_fraction: Option<f64> = "share of the patch that sticks" ["1"],
        slip_fraction: Option<f64> = "share of the patch that slips" ["1"],
    }
}

/// Declares [`Mean`]: the means that are fields of [`Contact`], then those of [`Window`].
macro_rules! means {
    (contact { $($Contact:ident $contact:ident)* } window { $($Window:ident $window:ident)* }) => {
        /// A mean over the evaluation window.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, JsonSchema, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Mean {
            $(#[doc = concat!("[`Contact::", stringify!($contact), "`]")] $Contact,)*
            $(#[doc = concat!("[`Window::", stringify!($window), "`]")] $Window,)*
        }

        impl Mean {
            /// Its section and its key there.
            pub fn key(self) -> (&'static str, &'static str) {
                match self {
                    $(Self::$Contact => ("contact", stringify!($contact)),)*
                    $(Self::$Window => ("window", stringify!($window)),)*
                }
            }
        }

        impl Summary {
            /// A mean over the evaluation window, where it has a value.
            pub fn mean(&self, mean: Mean) -> Option<f64> {
                match mean {
                    $(Mean::$Contact => self.contact.$contact,)*
                    $(Mean::$Window => self.window.as_ref()?.$window,)*
                }
            }
        }

        /// All of them.
        pub const MEANS: &[Mean] = &[$(Mean::$Contact,)* $(Mean::$Window,)*];
    };
}

means! {
    contact {
        NormalForce normal_force
        TangentialForce tangential_force
        LateralForce lateral_force
        TractionCoefficient traction_coefficient
        Creepage creepage
        PatchHalfLength patch_half_length
        PatchHalfWidth patch_half_width
        PatchArea patch_area
        PatchAreaFitted patch_area_fitted
        PeakPressure peak_pressure
        StickFraction stick_fraction
        SlipFraction slip_fraction
    }
    window {
        StickBorder stick_border
        PeakShear peak_shear
        Torque torque
        MaxPenetration max_penetration
        HourglassShare hourglass_share
        FrictionPower friction_power
    }
}

section! {
    /// The evaluation window, means over it that [`Contact`] does not hold, and standard deviations.
    Window {
        from: Option<f64> = "start of the evaluation window" ["s"],
        to: Option<f64> = "end of the evaluation window" ["s"],
        #[serde(deserialize_with = "known")]
        #[schemars(schema_with = "keyed::<Mean, String>")]
        reasons: BTreeMap<Mean, String> = "why a mean has no value, or how many rows of the history it leaves out",
        stick_border: Option<f64> = "rear end of the longest stick zone on y = 0 from the centre of the patch" ["m"],
        peak_shear: Option<f64> = "largest nodal shear traction on the bar" ["Pa"],
        torque: Option<f64> = "torque that the drive supplies about y" ["N m"],
        max_penetration: Option<f64> = "largest penetration" ["m"],
        hourglass_share: Option<f64> = "hourglass over strain energy" ["1"],
        friction_power: Option<f64> = "mean power of friction; T creepage V in steady rolling" ["W"],
        warnings: Vec<String> = "what is wrong with the means",
        #[serde(deserialize_with = "known")]
        #[schemars(schema_with = "keyed::<Mean, Option<f64>>")]
        deviation: BTreeMap<Mean, Option<f64>> = "standard deviations of the means",
    }
}

section! {
    /// Hertz's contact of the case.
    #[derive(Copy)]
    HalfSpace {
        half_length: Option<f64> = "a, half axis of Hertz's patch in x" ["m"],
        half_width: Option<f64> = "b, half axis of Hertz's patch in y" ["m"],
        area: Option<f64> = "area of Hertz's patch" ["m2"],
        peak_pressure: Option<f64> = "p_0, Hertz's peak pressure" ["Pa"],
        approach: Option<f64> = "delta, Hertz's approach of the bodies; zero of a line contact, which has none" ["m"],
    }
}

section! {
    /// Whether slip and the elements below the contact show a mode of the mesh.
    MeshMode {
        alternating_slip: Option<f64> = "slip that alternates from node to node over all slip" ["1"],
        #[serde(deserialize_with = "null_is_nan")]
        alternating_slip_limit: f64 = "beyond this it is a mode of the mesh, or not resolved" ["1"],
        hourglass_energy_in_layers: Option<f64> = "hourglass over strain energy of the elements below the contact" ["1"],
        #[serde(deserialize_with = "null_is_nan")]
        hourglass_energy_limit: f64 = "beyond this they deform by modes of the mesh" ["1"],
        warnings: Vec<String> = "what is wrong with them",
    }
}

section! {
    /// Errors of the solution that every run watches.
    #[derive(Copy)]
    Checks {
        cone_excess: Option<f64> = "largest (|shear| - mu pressure) over Hertz's peak pressure" ["1"],
        resultant_mismatch: Option<f64> = "|sum of the contact forces on both bodies| over the normal force" ["1"],
        contact_damping: Option<f64> = "the part of damping_dissipated that contact took" ["J"],
    }
}

section! {
    /// What exact enforcement took.
    ExactContact {
        rows: Option<String> = "`node_to_face` or `mortar`",
        #[serde(deserialize_with = "null_is_nan")]
        kelvin_voigt: f64 = "Kelvin-Voigt time constant" ["s"],
        most_sweeps: u64 = "most sweeps of a step" ["1"],
        unconverged_steps: u64 = "steps whose sweeps did not converge" ["1"],
        unconverged_change: Option<f64> = "largest last change of a force over the largest force" ["1"],
        manifold_node_steps: u64 = "nodes times steps at which friction had several solutions" ["1"],
        mortar_integrals: u64 = "integrals of mortar rows" ["1"],
        steepness_node: Option<f64> = "largest steepness of friction of a node in an implicit step" ["1"],
        steepness_patch: Option<f64> = "the same of all nodes together" ["1"],
        warnings: Vec<String> = "what did not converge",
    }
}

section! {
    /// What implicit steps took.
    #[derive(Copy)]
    Implicit {
        #[serde(deserialize_with = "null_is_nan")]
        theta: f64 = "parameter of the theta method" ["1"],
        solved: u64 = "implicit steps solved" ["1"],
        cut: u64 = "implicit steps cut" ["1"],
        iterations: u64 = "iterations of all implicit steps" ["1"],
        products: u64 = "products with the stiffness of all implicit steps" ["1"],
    }
}

section! {
    /// The frequencies that limit the time step.
    #[derive(Copy)]
    Stability {
        #[serde(deserialize_with = "null_is_nan")]
        omega_elastic: f64 = "largest frequency of the bodies without contact, with margin" ["rad/s"],
        #[serde(deserialize_with = "null_is_nan")]
        omega_max: f64 = "largest frequency with the springs of contact closed after the preload, with margin" ["rad/s"],
        #[serde(deserialize_with = "null_is_nan")]
        omega_bound: f64 = "rigorous upper bound of omega_max, by the bounds of the elements and of the contact springs" ["rad/s"],
        #[serde(deserialize_with = "null_is_nan")]
        dt_limit: f64 = "longest stable time step: 2/omega_max, less with Kelvin-Voigt damping" ["s"],
        #[serde(deserialize_with = "null_is_nan")]
        factor: f64 = "time step over that limit" ["1"],
    }
}

section! {
    /// Rolling radii of the disk.
    #[derive(Copy)]
    RollingRadius {
        #[serde(deserialize_with = "null_is_nan")]
        nominal: f64 = "radius of the undeformed disk" ["m"],
        #[serde(deserialize_with = "null_is_nan")]
        effective: f64 = "R_eff, V over the omega at which the slip averaged over the preloaded patch is zero" ["m"],
        free: Option<f64> = "V over the omega of free rolling, where drive.torque = 0" ["m"],
    }
}

section! {
    /// How the preload was found.
    Preload {
        method: String = "`static` or `relaxation`",
        iterations: u64 = "iterations of Newton's method, or of the relaxation" ["1"],
        cg_iterations: Option<u64> = "iterations of conjugate gradients, of a static preload" ["1"],
        #[serde(deserialize_with = "null_is_nan")]
        normal_force: f64 = "sum of the contact's normal forces" ["N"],
        closed_pairs: Option<u64> = "contact points that are closed, of a static preload" ["1"],
        residual: Option<f64> = "residual force over the load at the end, of a static preload" ["1"],
        facet_residual: Option<f64> = "the same once normals that had to be held follow the facets again" ["1"],
        kinetic_ratio: Option<f64> = "fictitious kinetic over internal energy at the end, of relaxation" ["1"],
        #[serde(deserialize_with = "null_is_nan")]
        hub_displacement: f64 = "displacement of the hub in z" ["m"],
    }
}

section! {
    /// The dimensionless numbers of contact and friction; docs/theory.md defines them.
    Numbers {
        pressure: Option<f64> = "p, the pressure at which the numbers hold: Hertz's peak pressure" ["Pa"],
        impedance: Option<f64> = "rho c_s of both bodies in series" ["Pa s/m"],
        r: Option<f64> = "R, steepness of falling friction: above 1 it has several solutions without memory" ["1"],
        n1: Option<f64> = "N_1 = dt^2 k_t/m*, stiffness of the friction springs in a time step" ["1"],
        n2: Option<f64> = "N_2, steepness of falling friction in a time step" ["1"],
        f_min: Option<f64> = "least coefficient of friction that the falling law reaches" ["1"],
        s_m: Option<f64> = "slip velocity at that coefficient" ["m/s"],
        s_jump: Option<f64> = "slip velocity to which a node jumps from rest" ["m/s"],
        slip_length: Option<f64> = "l_slip, length of the zone of slip by Carter's theory" ["m"],
        nucleation_length: Option<f64> = "h_n, nucleation length of friction with memory" ["m"],
        gamma: Option<f64> = "Gamma = l_slip/h_n" ["1"],
        stable_memory: Option<f64> = "memory of friction from which steady rolling is stable" ["m"],
        expect: Option<String> = "what to expect of the run, where there is reason for a warning",
    }
}

section! {
    /// What half-spaces took.
    #[derive(Copy)]
    Spectral {
        grid: [usize; 2] = "points along x and y",
        memory_steps: u64 = "steps of the past that are felt" ["1"],
        #[serde(deserialize_with = "null_is_nan")]
        faded: f64 = "share of the static compliance that is felt at its static value from then on" ["1"],
        inertia: bool = "whether the half-spaces have inertia",
        #[serde(deserialize_with = "null_is_nan")]
        megabytes: f64 = "memory of the half-spaces" ["MB"],
        #[serde(deserialize_with = "null_is_nan")]
        iterations_per_step: f64 = "mean iterations of a step" ["1"],
        most_iterations: u64 = "most iterations of a step" ["1"],
        undelayed_steps: u64 = "steps in which a point that stuck began to slip although adhesion was a solution" ["1"],
    }
}

section! {
    /// A fine zone that follows the contact.
    #[derive(Copy)]
    MeshWindow {
        #[serde(deserialize_with = "null_is_nan")]
        travel: f64 = "how far the fine zone has moved" ["m"],
        #[serde(deserialize_with = "null_is_nan")]
        energy: f64 = "brought by its moves, less what was taken" ["J"],
    }
}

section! {
    /// Where a wheel with profiles touches the rail, and what it slips by its position.
    #[derive(Copy)]
    Position {
        #[serde(deserialize_with = "null_is_nan")]
        wheel_y: f64 = "y of the first point of contact on the profile of the wheel" ["m"],
        #[serde(deserialize_with = "null_is_nan")]
        rail_y: f64 = "y of the first point of contact on the profile of the rail" ["m"],
        #[serde(deserialize_with = "null_is_nan")]
        rolling_radius: f64 = "distance of the first point of contact from the axle" ["m"],
        #[serde(deserialize_with = "null_is_nan")]
        plane_angle: f64 = "slope of the plane of contact, positive where it rises in +y" ["rad"],
        #[serde(deserialize_with = "null_is_nan")]
        longitudinal: f64 = "longitudinal creepage by the position" ["1"],
        #[serde(deserialize_with = "null_is_nan")]
        lateral: f64 = "lateral creepage by the position" ["1"],
        #[serde(deserialize_with = "null_is_nan")]
        spin: f64 = "spin by the position" ["1/m"],
    }
}

section! {
    /// The summary of a run at its end; numbers in SI units unless a field says otherwise.
    Summary {
        name: String = "name of the case",
        #[serde(skip_serializing_if = "Option::is_none")]
        status: Option<Status> = "how the run ended",
        steps: u64 = "time steps taken" ["1"],
        #[serde(deserialize_with = "null_is_nan")]
        dt: f64 = "time step" ["s"],
        #[serde(deserialize_with = "null_is_nan")]
        t_end: f64 = "simulated time reached" ["s"],
        elements: u64 = "elements of both bodies" ["1"],
        nodes: u64 = "nodes of both bodies" ["1"],
        threads: u64 = "threads used" ["1"],
        #[serde(deserialize_with = "null_is_nan")]
        wall_s: f64 = "wall-clock time of the run" ["s"],
        #[serde(deserialize_with = "null_is_nan")]
        element_steps_per_s: f64 = "elements times steps over the wall-clock time of the time loop" ["1/s"],
        #[serde(deserialize_with = "null_is_nan")]
        peak_rss_mb: f64 = "largest resident memory of the process" ["MB"],
        energy: Energy = "energies at the end of the run",
        contact: Contact = "means over the evaluation window",
        files: Files = "files of the run, relative to its folder",
        stages: BTreeMap<String, f64> = "wall-clock time of each stage of the run (s)",
        #[serde(skip_serializing_if = "Option::is_none")]
        diagnosis: Option<String> = "why its own guards stopped it, and what to do",
        #[serde(skip_serializing_if = "Option::is_none")]
        model: Option<String> = "`half-space`, of half-spaces",
        #[serde(skip_serializing_if = "Option::is_none")]
        symmetry: Option<String> = "whether half of the bodies is modelled",
        #[serde(skip_serializing_if = "Option::is_none")]
        kernels: Option<String> = "the instructions that the kernels used",
        time_loop_bytes_per_element: Option<f64> = "memory of the time loop over the elements" ["B"],
        #[serde(skip_serializing_if = "Option::is_none")]
        stability: Option<Stability> = "frequencies that limit the time step",
        #[serde(skip_serializing_if = "Option::is_none")]
        rolling_radius: Option<RollingRadius> = "rolling radii of the disk",
        #[serde(skip_serializing_if = "Option::is_none")]
        half_space: Option<HalfSpace> = "Hertz's contact",
        #[serde(skip_serializing_if = "Option::is_none")]
        window: Option<Window> = "the evaluation window",
        #[serde(skip_serializing_if = "Option::is_none")]
        mesh_mode: Option<MeshMode> = "modes of the mesh",
        #[serde(skip_serializing_if = "Option::is_none")]
        checks: Option<Checks> = "errors of the solution",
        exact_contact: Option<ExactContact> = "exact enforcement; null without it",
        implicit: Option<Implicit> = "implicit steps; null of explicit ones",
        preload: Option<Preload> = "the preload; null without one",
        #[serde(skip_serializing_if = "Option::is_none")]
        numbers: Option<Numbers> = "dimensionless numbers",
        #[serde(skip_serializing_if = "Option::is_none")]
        spectral: Option<Spectral> = "half-spaces",
        #[serde(skip_serializing_if = "Option::is_none")]
        mesh_window: Option<MeshWindow> = "a fine zone that follows the contact",
        #[serde(skip_serializing_if = "Option::is_none")]
        position: Option<Position> = "the position of a wheel with profiles",
        /// Samples of a friction law that the user supplied as a function:
        #[serde(skip_serializing_if = "Option::is_none")]
        friction_law: Option<Vec<[f64; 2]>> = "pairs of slip speed (m/s) and coefficient of friction",
        #[serde(skip_serializing_if = "Option::is_none")]
        creepage_version: Option<String> = "version of the program that wrote the file",
        #[serde(skip_serializing_if = "Option::is_none")]
        case_hash: Option<String> = "hash of the resolved case",
        #[serde(skip_serializing_if = "Option::is_none")]
        created: Option<String> = "when the run started, ISO 8601 in UTC",
        #[serde(skip_serializing_if = "BTreeMap::is_empty")]
        units: BTreeMap<String, String> = "unit of each number, by its dotted key",
        #[serde(skip_serializing_if = "BTreeMap::is_empty")]
        names: BTreeMap<String, String> = "what each number is, by its dotted key",
        #[serde(skip_serializing_if = "Option::is_none")]
        checksums: Option<BTreeMap<String, FileSum>> = "lengths and checksums of the files",
        #[serde(skip_serializing_if = "Option::is_none")]
        sha256: Option<String> = "checksum of the summary without this key",
    }
}

/// Files of a run, relative to its folder.
#[derive(Clone, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct Files {
    /// Fields of both bodies; empty where the run has no such file.
    pub fields: String,
    /// Both contact surfaces.
    pub contact: String,
    /// Scalars over time.
    pub history: String,
    /// The state in which the guards stopped the run, if they did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub postmortem: Option<String>,
}

impl Default for Files {
    fn default() -> Self {
        Self {
            fields: file::FIELDS.into(),
            contact: file::CONTACT.into(),
            history: file::HISTORY.into(),
            postmortem: None,
        }
    }
}

impl Files {
    /// Those of a run that ended before it had any.
    pub fn none() -> Self {
        let none = String::new;
        Self { fields: none(), contact: none(), history: none(), postmortem: None }
    }

    /// Those of a run that does not record its bodies.
    pub fn without_fields() -> Self {
        Self { fields: String::new(), ..Self::default() }
    }
}

/// A number that is null in JSON where it was not finite; checkpoints, which are binary, hold it as it is.
fn null_is_nan<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    if !from.is_human_readable() {
        return f64::deserialize(from);
    }
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

/// A section of the summary: its key, empty for the keys outside sections; its keys; whether a summary has it.
type Section = (&'static str, &'static [Quantity], fn(&Summary) -> bool);

const SECTIONS: [Section; 16] = [
    ("", Summary::KEYS, |_| true),
    ("energy", Energy::KEYS, |_| true),
    ("contact", Contact::KEYS, |_| true),
    ("window", Window::KEYS, |summary| summary.window.is_some()),
    ("checks", Checks::KEYS, |summary| summary.checks.is_some()),
    ("mesh_mode", MeshMode::KEYS, |summary| summary.mesh_mode.is_some()),
    ("half_space", HalfSpace::KEYS, |summary| summary.half_space.is_some()),
    ("stability", Stability::KEYS, |summary| summary.stability.is_some()),
    ("rolling_radius", RollingRadius::KEYS, |summary| summary.rolling_radius.is_some()),
    ("preload", Preload::KEYS, |summary| summary.preload.is_some()),
    ("numbers", Numbers::KEYS, |summary| summary.numbers.is_some()),
    ("exact_contact", ExactContact::KEYS, |summary| summary.exact_contact.is_some()),
    ("implicit", Implicit::KEYS, |summary| summary.implicit.is_some()),
    ("spectral", Spectral::KEYS, |summary| summary.spectral.is_some()),
    ("mesh_window", MeshWindow::KEYS, |summary| summary.mesh_window.is_some()),
    ("position", Position::KEYS, |summary| summary.position.is_some()),
];

/// The number at `key` of a section, empty for those outside sections; `None` for `stages` and for what is no number.
pub fn quantity(section: &str, key: &str) -> Option<Quantity> {
    let (_, keys, _) = SECTIONS.iter().find(|(name, ..)| *name == section)?;
    keys.iter().find(|quantity| quantity.key == key && quantity.is_number()).copied()
}

/// All dotted keys, in the order of the file: those of a section follow its own.
pub fn dotted_keys() -> Vec<(String, Quantity)> {
    let mut all = Vec::new();
    for own in Summary::KEYS {
        all.push((own.key.to_owned(), *own));
        let of_section = SECTIONS.iter().filter(|(name, ..)| *name == own.key);
        let keys = of_section.flat_map(|(_, keys, _)| *keys);
        all.extend(keys.map(|key| (format!("{}.{}", own.key, key.key), *key)));
    }
    all
}

impl Quantity {
    fn is_number(&self) -> bool {
        !self.units.is_empty()
    }
}

impl Mean {
    /// Its unit and what it is.
    pub fn quantity(self) -> Option<Quantity> {
        let (section, key) = self.key();
        quantity(section, key)
    }
}

impl Summary {
    /// Fills the sections `units` and `names`. Deviations have the units of their means.
    fn describe(&mut self) {
        let dotted = |section: &str, key: &str| match section {
            "" => key.to_owned(),
            _ => format!("{section}.{key}"),
        };
        let (mut units, mut names) = (BTreeMap::new(), BTreeMap::new());
        for (section, keys, _) in SECTIONS.iter().filter(|(.., has)| has(self)) {
            for quantity in keys.iter().filter(|quantity| quantity.is_number()) {
                let key = dotted(section, quantity.key);
                units.insert(key.clone(), quantity.units.to_owned());
                names.insert(key, quantity.name.to_owned());
            }
        }
        for stage in self.stages.keys() {
            units.insert(dotted("stages", stage), "s".into());
        }
        for mean in self.window.iter().flat_map(|window| window.deviation.keys()) {
            let unit = mean.quantity().map_or("1", |quantity| quantity.units);
            units.insert(dotted("window.deviation", mean.key().1), unit.into());
        }
        (self.units, self.names) = (units, names);
    }

    /// Writes the summary of a run whose files are closed into its folder, with what it was made by and when, the units
    /// of its numbers, and the checksums of the files; returns what was written.
    ///
    /// # Errors
    /// Files that cannot be read, a summary that cannot be written.
    pub fn write(mut self, folder: &Path, made: &Provenance) -> Result<Self, OutputError> {
        self.creepage_version = Some(made.creepage_version.clone());
        self.case_hash = Some(made.case_hash.clone());
        self.created = Some(made.created.clone());
        self.describe();
        self.checksums = Some(sums_of_files(folder, &SUMMED)?);
        self.sha256 = Some(checksum_of(&self)?);
        write_json_atomically(folder.join(file::SUMMARY), &self)?;
        Ok(self)
    }
}

/// The files whose lengths and checksums a summary holds.
const SUMMED: [&str; 6] =
    [file::CASE, file::FIELDS, file::CONTACT, file::HISTORY, file::PROBES, file::POSTMORTEM];

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// A summary as the version before wrote it.
    const WRITTEN: &str = r#"{
        "name": "quick", "status": "completed", "steps": 6989, "dt": 2.2e-7, "t_end": 1.54e-3, "elements": 41320,
        "nodes": 46641, "threads": 2, "wall_s": 10.5, "element_steps_per_s": 4.5e7, "peak_rss_mb": 52.1,
        "kernels": "avx2", "symmetry": "none", "energy": { "kinetic": 3.4e5, "internal": null },
        "contact": { "normal_force": 1.0038e5, "creepage": null }, "exact_contact": null, "implicit": null,
        "window": { "from": 1e-3, "to": 1.5e-3, "deviation": { "torque": 75.0, "creepage": null },
                    "reasons": { "stick_border": "none of 3 rows" }, "warnings": [] },
        "preload": { "method": "relaxation", "iterations": 7, "normal_force": 1e5, "kinetic_ratio": 1e-9,
                     "hub_displacement": -1e-4 },
        "mesh_window": { "travel": 0.1, "energy": null }, "stability": { "omega_max": null, "factor": 0.67 },
        "stages": { "rolling": 6.0 }, "files": { "fields": "", "contact": "contact.vtkhdf", "history": "history.h5" }
    }"#;

    #[test]
    fn a_summary_that_was_written_before_reads_back_and_numbers_that_were_not_finite_are_nan() {
        let summary: Summary = serde_json::from_str(WRITTEN).unwrap();
        assert_eq!(summary.status, Some(Status::Completed));
        assert!(summary.energy.kinetic == 3.4e5 && summary.energy.internal.is_nan());
        assert_eq!(summary.mean(Mean::NormalForce), Some(1.0038e5));
        assert_eq!(summary.mean(Mean::Creepage), None);
        let window = summary.window.as_ref().unwrap();
        assert_eq!(window.deviation[&Mean::Torque], Some(75.0));
        assert_eq!(window.reasons[&Mean::StickBorder], "none of 3 rows");
        assert_eq!(summary.preload.as_ref().unwrap().kinetic_ratio, Some(1e-9));
        assert!(summary.mesh_window.unwrap().energy.is_nan());
        assert!(summary.stability.unwrap().omega_max.is_nan());
    }

    #[test]
    fn a_section_in_a_checkpoint_comes_back_with_its_bits() {
        let section = Stability { omega_max: f64::NAN, factor: 0.67, ..Stability::default() };
        let bytes = postcard::to_allocvec(&section).unwrap();
        let again: Stability = postcard::from_bytes(&bytes).unwrap();
        assert_eq!(again.omega_max.to_bits(), section.omega_max.to_bits());
        assert_eq!(again.factor, 0.67);
    }

    #[test]
    fn a_mean_that_this_version_does_not_know_is_left_out() {
        let later =
            WRITTEN.replace("\"torque\": 75.0", "\"torque\": 75.0, \"heat\": { \"W\": 1.0 }");
        let summary: Summary = serde_json::from_str(&later).unwrap();
        assert_eq!(summary.window, serde_json::from_str::<Summary>(WRITTEN).unwrap().window);
    }

    #[test]
    fn every_key_that_was_written_is_written_again_with_its_value() {
        fn same(written: &serde_json::Value, again: &serde_json::Value, at: &str) {
            match (written.as_object(), again.as_object()) {
                (Some(written), Some(again)) => written.iter().for_each(|(key, value)| {
                    let found = again.get(key).unwrap_or_else(|| panic!("{at}.{key} is gone"));
                    same(value, found, &format!("{at}.{key}"));
                }),
                _ => assert_eq!(written, again, "{at}"),
            }
        }
        let summary: Summary = serde_json::from_str(WRITTEN).unwrap();
        let [written, again] = [serde_json::from_str(WRITTEN), serde_json::to_value(&summary)];
        same(&written.unwrap(), &again.unwrap(), "");
    }

    #[test]
    fn units_and_names_stand_at_the_dotted_keys_of_the_numbers_that_there_are() {
        let mut summary: Summary = serde_json::from_str(WRITTEN).unwrap();
        summary.describe();
        for (key, unit) in [
            ("dt", "s"),
            ("energy.internal", "J"),
            ("contact.creepage", "1"),
            ("window.deviation.torque", "N m"),
            ("stages.rolling", "s"),
            ("preload.hub_displacement", "m"),
        ] {
            assert_eq!(summary.units.get(key).map(String::as_str), Some(unit), "{key}");
        }
        for none in ["energy", "window.warnings", "numbers.r", "name", "implicit.solved"] {
            assert!(!summary.units.contains_key(none), "{none}");
        }
        assert_eq!(summary.names["dt"], "time step");
    }
}
