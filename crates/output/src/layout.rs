//! The layout of a run: every dataset and root attribute, declared once with name, units, shape and meaning.
//!
//! A set of datasets is a struct with a field for each of them, generic in what is held of it: the declaration
//! ([`HISTORY`]) holds their [`FieldSpec`]s, a writer fills in numbers ([`HistoryRow`]) or arrays by their names, and
//! readers ask for datasets by the declaration's names. `docs/files.md` has the same tables, which a test compares.

use crate::field::FieldSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Declares names with their meaning.
macro_rules! names {
    ($(#[$about:meta])* $module:ident { $($NAME:ident = $name:literal, $meaning:literal;)* }) => {
        $(#[$about])*
        pub mod $module {
            $(#[doc = $meaning] pub const $NAME: &str = $name;)*
            /// All with their meaning.
            pub const ALL: [(&str, &str); [$($name),*].len()] = [$(($NAME, $meaning)),*];
        }
    };
}

names! {
    /// Files in the folder of a run.
    file {
        CASE = "case.toml", "the case as resolved";
        FIELDS = "fields.vtkhdf", "both bodies over time";
        CONTACT = "contact.vtkhdf", "both contact surfaces over time";
        HISTORY = "history.h5", "scalars over time";
        PROBES = "probes.h5", "chosen surface nodes at every step";
        POSTMORTEM = "postmortem.vtkhdf", "both bodies as they were when the guards stopped the run";
        SUMMARY = "summary.json", "what `creepage run --json` prints";
        LOG = "run.log", "what the run said";
        REFERENCE = "reference-half-space.json", "steady rolling of half-spaces beside the run";
    }
}

names! {
    /// Root attributes of the HDF5 files.
    attribute {
        VERSION = "creepage_version", "version of the program that wrote the file";
        CASE_HASH = "case_hash", "hash of the resolved case";
        CREATED = "created", "when the run started, ISO 8601 in UTC";
        SLIP_PAIRING = "slip_pairing", "which step's slip stands beside a traction: `before` or `after`";
        ENFORCED_ON = "enforced_on", "the body at whose nodes contact is enforced: `disk` or `bar`";
        CONTACT_ROWS = "contact_rows", "how contact is enforced there: `node_to_face` or `mortar`";
        SYMMETRY = "symmetry", "`half` where y >= 0 alone is modelled: `fields.vtkhdf` and `postmortem.vtkhdf` then hold that half, and counts of elements and nodes are its own; all other numbers are of the whole bodies";
        WINDOW = "window", "`follows` where the fine zone follows the contact: a node is then a place in the mesh, which moves along the material, and displacements count from its place at the start";
        DIAGNOSIS = "diagnosis", "why the guards stopped the run";
    }
}

/// Names of the bodies; the index is the label in the field `body`.
pub const BODY_NAMES: [&str; 2] = ["disk", "bar"];
/// Value of the attribute `contact_rows`: conditions that hold at each node against the face at its
/// closest-point projection.
pub const NODE_TO_FACE: &str = "node_to_face";
/// Value of the attribute `symmetry`.
pub const HALF: &str = "half";
/// Value of the attribute `window`.
pub const FOLLOWS: &str = "follows";
/// Value of the attribute `contact_rows`: conditions that hold in the mean over the faces around each node.
pub const MORTAR: &str = "mortar";

/// Whether a record at t^n holds, beside its tractions, the slip velocity of the step that ends at t^n or
/// of the step that begins there.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, JsonSchema, Serialize, Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Pairing {
    /// p(t^n) with s(t^{n-1/2}).
    #[default]
    Before,
    /// p(t^n) with s(t^{n+1/2}).
    After,
}

impl Pairing {
    /// Its name in options, documents and the attribute `slip_pairing`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Before => "before",
            Self::After => "after",
        }
    }
}

/// Declares a set of datasets: `name: shape(units, meaning)`, in the order of the file.
macro_rules! datasets {
    ($(#[$about:meta])* $Set:ident, $DECLARED:ident { $(
        $field:ident $(= $name:literal)?: $shape:ident($units:literal, $meaning:literal),
    )* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, Default)]
        pub struct $Set<T> {
            $(#[doc = concat!($meaning, " (", $units, ")")] pub $field: T,)*
        }

        $(#[$about])*
        ///
        /// Name, units, shape and meaning of each dataset.
        pub static $DECLARED: $Set<FieldSpec> = $Set {
            $($field: FieldSpec::$shape(
                datasets!(@name $field $($name)?), $units, $meaning,
            ),)*
        };

        impl<T> $Set<T> {
            /// All in the order of the file.
            pub fn each(&self) -> [&T; [$(stringify!($field)),*].len()] {
                [$(&self.$field),*]
            }
        }
    };
    (@name $field:ident) => { stringify!($field) };
    (@name $field:ident $name:literal) => { $name };
}

datasets! {
    /// A row of `history.h5`, of a full step t^n; forces and positions in the global frame (x rolls, y is
    /// lateral, z is up).
    HistoryRow, HISTORY {
        time: scalar("s", "time since the start of rolling"),
        step: scalar("1", "number of the full step"),
        kinetic: scalar("J", "kinetic energy, 1/2 v(n-1/2) M v(n+1/2)"),
        internal: scalar("J", "strain energy of the elements"),
        hourglass: scalar("J", "hourglass energy of the elements"),
        contact_stored: scalar("J", "energy in the contact springs"),
        friction_dissipated: scalar("J", "dissipated by friction so far"),
        damping_dissipated: scalar("J", "dissipated by damping of every kind so far"),
        external_work: scalar("J", "work of drive, load and constant end reactions so far"),
        imbalance: scalar(
            "J", "sum of energies less external work and window_energy, less the initial sum"
        ),
        normal_force: scalar("N", "force of the bar on the disk, z"),
        tangential_force: scalar("N", "force of the bar on the disk, x"),
        lateral_force: scalar("N", "force of the bar on the disk, y"),
        traction_coefficient: scalar("1", "tangential over normal force"),
        creepage: scalar("1", "(omega R_eff - V)/V"),
        omega: scalar("rad/s", "angular velocity of the hub about y"),
        torque: scalar("N m", "torque that the drive supplies about y"),
        drive_force: scalar("N", "force that the drive supplies in x"),
        hub_x: scalar("m", "displacement of the hub in x"),
        hub_z: scalar("m", "displacement of the hub in z"),
        patch_half_length: scalar(
            "m", "half axis in x of the fit to the pressure on the bar; NaN where none fits"
        ),
        patch_half_width: scalar("m", "half axis in y of the fit, or half the width of a line contact"),
        patch_x: scalar("m", "centre of the fit in x, relative to the hub"),
        peak_pressure: scalar("Pa", "largest pressure of the fit"),
        peak_pressure_raw: scalar("Pa", "largest nodal pressure on the bar"),
        peak_shear: scalar("Pa", "largest nodal shear traction on the bar"),
        patch_area: scalar("m2", "area of the bar's nodes in contact"),
        stick_fraction: scalar("1", "share of that area that sticks"),
        slip_fraction: scalar("1", "share of that area that slips"),
        stick_border: scalar("m", "rear end of the longest stick zone on y = 0 from patch_x; NaN without one"),
        closed_pairs: scalar("1", "pairs in contact, both passes"),
        slipping_pairs: scalar("1", "pairs that slip, both passes"),
        max_penetration: scalar("m", "largest penetration"),
        cone_excess: scalar("1", "largest (|shear| - mu pressure) over the Hertz peak pressure"),
        contact_damping: scalar("J", "the part of damping_dissipated that contact took"),
        sweeps: scalar("1", "sweeps over the contact nodes, exact enforcement"),
        manifold: scalar("1", "nodes at which the law of friction had more than one solution"),
        resultant_mismatch: scalar("1", "|sum of the contact forces on both bodies| over the normal force"),
        window_x: scalar("m", "how far the fine zone that follows the contact has moved; 0 where it stays"),
        window_energy: scalar("J", "brought by its moves so far, less what was taken"),
    }
}

datasets! {
    /// What a row of `probes.h5` holds of each probe, a node of a contact surface; vectors in the global frame,
    /// tractions on the node's own surface.
    ProbeRow, PROBE {
        pressure: scalar("Pa", "contact pressure"),
        shear_x: scalar("Pa", "shear traction on this surface, x"),
        shear_y: scalar("Pa", "shear traction on this surface, y"),
        shear_z: scalar("Pa", "shear traction on this surface, z"),
        slip_velocity_x: scalar("m/s", "velocity relative to the other surface, x"),
        slip_velocity_y: scalar("m/s", "velocity relative to the other surface, y"),
        slip_velocity_z: scalar("m/s", "velocity relative to the other surface, z"),
        slip_x: scalar("m", "relative motion since contact began, x"),
        mu: scalar("1", "coefficient of friction used"),
        state: scalar("1", "0 open, 1 stick, 2 slip"),
        gap: scalar("m", "gap"),
    }
}

datasets! {
    /// Fields of `fields.vtkhdf` in the global frame; the stresses are those that the case asks for, tension
    /// positive.
    BodyFields, BODIES {
        displacement: vector("m", "displacement from the undeformed state"),
        deformation: vector(
            "m", "displacement less the body's rigid motion (the hub's for the disk, none for the bar)"
        ),
        velocity: vector("m/s", "velocity over the last step"),
        stress: cell_tensor("Pa", "Cauchy stress, xx yy zz xy yz xz"),
        von_mises: cell_scalar("Pa", "von Mises stress"),
        max_shear: cell_scalar("Pa", "largest shear stress, half of largest less smallest principal stress"),
        hydrostatic: cell_scalar("Pa", "hydrostatic stress, a third of the trace"),
        principal: cell_vector("Pa", "principal stresses, the largest first"),
    }
}

datasets! {
    /// Fields of `contact.vtkhdf` in the global frame; `pass_pressure` where two passes of penalty contact
    /// share the pressure.
    ContactFields, CONTACT {
        pressure: scalar("Pa", "contact pressure, positive in compression"),
        shear: vector("Pa", "shear traction on this surface"),
        slip_velocity: vector("m/s", "velocity of this surface relative to the other"),
        slip: vector("m", "relative tangential motion since contact began"),
        mu: scalar("1", "coefficient of friction that the algorithm used"),
        state: label("1", "0 open, 1 stick, 2 slip"),
        gap: scalar("m", "gap, negative when penetrating"),
        velocity: vector("m/s", "velocity"),
        displacement: vector("m", "displacement"),
        pass_pressure: scalar("Pa", "the part of the pressure that the node's own pass carries"),
    }
}

datasets! {
    /// Fields of `postmortem.vtkhdf` in the global frame.
    PostmortemFields, POSTMORTEM {
        displacement: vector("m", "displacement from the undeformed state"),
        velocity: vector("m/s", "velocity over the last step"),
        force: vector("N", "force of the elements on the node, without viscous parts"),
        suspect_node = "suspect": label("1", "0 no, 1 suspect, 2 named in the diagnosis"),
        volume_ratio: cell_scalar("1", "volume over that of the undeformed element"),
        corner_ratio: cell_scalar("1", "smallest det F at a corner, negative where inside out"),
        strain_energy: cell_scalar("J", "strain energy of the element"),
        hourglass_energy: cell_scalar("J", "hourglass energy of the element"),
        suspect_element = "suspect": cell_label("1", "0 no, 1 suspect, 2 named in the diagnosis"),
    }
}

datasets! {
    /// Fields of the grids that do not change in time; `area` only of contact surfaces.
    ConstantFields, CONSTANT {
        body: cell_label("1", "0 disk, 1 bar"),
        area: scalar("m2", "tributary area of the node"),
    }
}

datasets! {
    /// The sets of nodes in a mesh that `creepage mesh` writes; its elements are told apart by `body`.
    MeshSets, MESH_SETS {
        hub: label("1", "1 at the nodes of the rigid hub, else 0"),
        tread: label("1", "1 at the nodes of the running surface of the disk, else 0"),
        top: label("1", "1 at the nodes of the running surface of the bar, else 0"),
        clamp: label("1", "1 at the nodes by which the bar is clamped, else 0"),
    }
}

datasets! {
    /// The mesh of a grid, in the group `VTKHDF`.
    MeshDatasets, MESH {
        points = "Points": vector("m", "reference coordinates"),
        connectivity = "Connectivity": scalar("1", "point indices of the cells, one cell after the other"),
        offsets = "Offsets": scalar("1", "where each cell starts in Connectivity, and its end"),
        types = "Types": scalar("1", "VTK cell type"),
        point_count = "NumberOfPoints": scalar("1", "points of the only part"),
        cell_count = "NumberOfCells": scalar("1", "cells of the only part"),
        connectivity_count = "NumberOfConnectivityIds": scalar("1", "length of Connectivity"),
    }
}

datasets! {
    /// The records of a grid, in the group `VTKHDF/Steps`.
    StepDatasets, STEPS {
        times = "Values": scalar("s", "simulated time of each step"),
        parts = "NumberOfParts": scalar("1", "parts of each step"),
        part_offsets = "PartOffsets": scalar("1", "first part of each step"),
        point_offsets = "PointOffsets": scalar("1", "the mesh is the same for all steps"),
        cell_offsets = "CellOffsets": scalar("1", "the mesh is the same for all steps"),
        connectivity_offsets = "ConnectivityIdOffsets": scalar("1", "the mesh is the same for all steps"),
    }
}

impl ContactFields<FieldSpec> {
    /// The fields of a run with this pairing. With [`Pairing::After`] (exact enforcement) there are no two
    /// passes, so `pass_pressure` is left out.
    pub fn of_run(&self, pairing: Pairing) -> Vec<FieldSpec> {
        let step = match pairing {
            Pairing::Before => "over the last step",
            Pairing::After => "over the next step",
        };
        let mut fields = self.clone();
        let Self { slip_velocity, velocity, .. } = &mut fields;
        slip_velocity.description = format!("{}, {step}", slip_velocity.description).into();
        velocity.description = format!("{} {step}", velocity.description).into();
        let passes = pairing == Pairing::Before;
        let there = |field: &&FieldSpec| passes || **field != self.pass_pressure;
        fields.each().into_iter().filter(there).cloned().collect()
    }
}

/// The column of probe number `k` (from 0) in `probes.h5`: `column` of [`PROBE`] under the name
/// `probe{k}_{name}`.
pub fn of_probe(k: usize, column: &FieldSpec) -> FieldSpec {
    FieldSpec { name: format!("probe{k}_{}", column.name).into(), ..column.clone() }
}

/// Every HDF5 file of a run with the datasets that hold its results, in their order; of the probes those of
/// probe 0. The mesh ([`MESH`]) and the steps ([`STEPS`]) of the grids are left out.
pub fn files() -> [(&'static str, Vec<FieldSpec>); 5] {
    let owned = |fields: &[&FieldSpec]| fields.iter().copied().cloned().collect::<Vec<_>>();
    let probe = PROBE.each().map(|column| of_probe(0, column));
    [
        (file::FIELDS, owned(&[&BODIES.each()[..], &[&CONSTANT.body]].concat())),
        (file::CONTACT, owned(&[&CONTACT.each()[..], &CONSTANT.each()].concat())),
        (file::HISTORY, owned(&HISTORY.each())),
        (file::PROBES, [&owned(&[&HISTORY.time])[..], &probe].concat()),
        (file::POSTMORTEM, owned(&[&POSTMORTEM.each()[..], &[&CONSTANT.body]].concat())),
    ]
}

/// Group of the datasets of the steps.
pub(crate) const STEPS_GROUP: [&str; 2] = ["VTKHDF", "Steps"];
/// Attribute of that group: the number of complete steps.
pub(crate) const STEP_COUNT: &str = "NSteps";

/// Path of a dataset of [`MESH`] in the file.
pub(crate) fn mesh_path(spec: &FieldSpec) -> String {
    format!("VTKHDF/{}", spec.name)
}

/// Path of a dataset of [`STEPS`] in the file.
pub(crate) fn step_path(spec: &FieldSpec) -> String {
    format!("{}/{}", STEPS_GROUP.join("/"), spec.name)
}

/// Path of a field of points or cells.
pub(crate) fn data_path(name: &str, on_cells: bool) -> String {
    let group = if on_cells { "CellData" } else { "PointData" };
    format!("VTKHDF/{group}/{name}")
}

/// Root attribute of a history: the number of complete rows.
pub(crate) const ROW_COUNT: &str = "rows";
