//! Why a scenario cannot be set up.

use mesh::import::Place;
use std::path::{Path, PathBuf};

use crate::scenario::remedy::{Remedy, key_of_mesh};

/// Why a scenario cannot be set up.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum ScenarioError {
    /// The mesh cannot be built.
    #[error("{}", named(.0))]
    #[diagnostic(help("{}", .0.remedy()))]
    Mesh(#[from] mesh::MeshError),
    /// The mesh file cannot be used.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy))]
    MeshFile(#[from] MeshFileError),
    /// Ctrl-C while meshio read the mesh file.
    #[error("interrupted while meshio read the mesh")]
    #[diagnostic(help("there are no results yet"))]
    Interrupted,
    /// The mesh of a case in plane strain is more than a slice.
    #[error("mesh.plane_strain = true: {0}")]
    #[diagnostic(help(
        "give a mesh one element wide, extruded along y, or mesh.plane_strain = false"
    ))]
    Slice(#[from] mesh::NoSlice),
    /// Heights of a surface that cannot be read.
    #[error("{key}: {problem}")]
    #[diagnostic(help("give a formula, or points in m or rad and m"))]
    Heights {
        /// The key.
        key: &'static str,
        /// What is wrong.
        problem: String,
    },
    /// The mesh of a case without one.
    #[error("model = \"half-space\": the bodies have no mesh")]
    #[diagnostic(help("set model = \"finite-elements\""))]
    NoMesh,
    /// A torque that friction cannot bear.
    #[error(
        "drive.torque over disk.radius is {force:.4e} N, and friction bears less than {bound:.4e} N"
    )]
    #[diagnostic(help("make drive.torque smaller, or give drive.creepage"))]
    Torque {
        /// The force that is asked for (N).
        force: f64,
        /// The coefficient at rest times the load (N).
        bound: f64,
    },
    /// The wheel cannot be pressed on the rail.
    #[error(transparent)]
    #[diagnostic(help(
        "change disk.lateral, disk.yaw or load.normal, the profiles, or mesh.zone.size"
    ))]
    WheelOnRail(#[from] crate::scenario::wheel_on_rail::WheelOnRailError),
    /// Elements that lean too far where the profiles are steep.
    #[error(
        "the profiles are so steep beside the contact, whose angle is {angle:.3} rad, that the least scaled Jacobian of the elements is \
         {least:.2}, below 0.3"
    )]
    #[diagnostic(help(
        "set mesh.grading = \"tensor\", whose elements lean less, or make disk.width and bar.width smaller"
    ))]
    Lean {
        /// The least scaled Jacobian.
        least: f64,
        /// Angle of the plane of contact (rad).
        angle: f64,
    },
    /// A patch of which points would not be recorded.
    #[error("the patch reaches {reach_mm:.2} mm across, beyond the fine zone of {width_mm:.2} mm")]
    #[diagnostic(help("give a mesh.zone.width of more than twice that"))]
    Zone {
        /// How far it reaches from the point of reference (mm).
        reach_mm: f64,
        /// `mesh.zone.width` (mm).
        width_mm: f64,
    },
    /// The half-spaces cannot be set up.
    #[error(transparent)]
    #[diagnostic(help("{}", match .0 {
        halfspace::RollingError::Coarse { .. } => "make mesh.zone.size smaller: the patch must have at least 4",
        halfspace::RollingError::LongStep { .. } => "make time.step shorter, or leave it out",
        halfspace::RollingError::Fast { .. } => "make drive.speed smaller, or the material stiffer",
        halfspace::RollingError::Kernel(_) => "make mesh.zone.size larger, or the patch smaller",
        halfspace::RollingError::State => "begin the run anew with --force",
    }))]
    HalfSpace(#[from] halfspace::RollingError),
    /// The elements cannot be set up.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Solid(#[from] solid::SolidError),
    /// The contact cannot be set up.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Contact(#[from] contact::ContactError),
    /// The case gives no valid friction law.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Friction(#[from] friction::LawError),
    /// The machine has too little memory for the mesh.
    #[error(
        "the run of {elements} elements needs about {} GB of memory, more than the {} GB that are free: \
         enlarge mesh.zone.size or shrink the zone", gigabytes(*needed_gb), gigabytes(*free_gb)
    )]
    #[diagnostic(help(
        "`creepage mesh` tells what a mesh needs; `ulimit -v`, or the limit of a container or batch job, bounds what is free"
    ))]
    Memory {
        /// Elements of both bodies.
        elements: usize,
        /// Estimate of what the run needs (GB).
        needed_gb: f64,
        /// What the system has free (GB).
        free_gb: f64,
    },
    /// Half of a mesh that is not symmetric.
    #[error("mesh.symmetry = \"half\": {0}")]
    #[diagnostic(help(
        "give a mesh with nodes on y = 0 that this plane mirrors, bodies and a fine zone an even number of elements wide, \
         or mesh.symmetry = \"whole\""
    ))]
    Symmetry(#[from] mesh::NotSymmetric),
    /// A fine zone that shall follow the contact, but does not repeat along a body.
    #[error(
        "mesh.window: the columns of elements in the fine zone of the {body} are not alike, so that it cannot move along"
    )]
    #[diagnostic(help(
        "let the bar end two elements or more beyond the zone (bar.start, bar.length), or with it"
    ))]
    Pattern {
        /// Name of the body.
        body: String,
    },
    /// The time step asked for is not stable.
    #[error(
        "time.step = {step:.4e} s is above the stability limit of {limit:.4e} s, which the closed \
         contact springs lower"
    )]
    #[diagnostic(help("lower time.step, or give time.factor, a fraction of the limit"))]
    Step {
        /// The step asked for (s).
        step: f64,
        /// The stability limit (s).
        limit: f64,
    },
    /// The preload was not found.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Preload(#[from] crate::scenario::preload::PreloadError),
    /// The state of a checkpoint is that of another model.
    #[error("the checkpoint cannot be used: {0}")]
    #[diagnostic(help("begin the run anew with --force; its results so far are readable"))]
    Restore(#[from] dynamics::RestoreError),
    /// A file beside the results cannot be written.
    #[error(transparent)]
    #[diagnostic(help("{}", .0.remedy()))]
    Text(#[from] output::NotWritten),
}

impl ScenarioError {
    /// The dotted path of the key of the case that the error is about, where it is about one.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Mesh(error) => key_of_mesh(error),
            Self::Memory { .. } => Some("mesh.zone.size"),
            Self::NoMesh => Some("model"),
            Self::Torque { .. } => Some("drive.torque"),
            Self::Slice(_) => Some("mesh.plane_strain"),
            Self::Symmetry(_) => Some("mesh.symmetry"),
            Self::Pattern { .. } => Some("mesh.window"),
            Self::Step { .. } => Some("time.step"),
            _ => None,
        }
    }

    /// Whether it was asked to stop.
    pub fn is_interruption(&self) -> bool {
        match self {
            Self::Interrupted => true,
            Self::Preload(error) => error.is_interruption(),
            _ => false,
        }
    }

    /// Exit code of the process: 3 where no preload was found or a file cannot be written, 130 when
    /// interrupted, 2 for the rest, which is bad input.
    pub fn exit_code(&self) -> u8 {
        match self {
            _ if self.is_interruption() => 130,
            Self::Preload(_) | Self::Text(_) => 3,
            _ => 2,
        }
    }
}

impl Remedy for ScenarioError {
    fn remedy(&self) -> String {
        miette::Diagnostic::help(self).map_or("change this key".into(), |help| help.to_string())
    }
}

/// What is wrong with a generated mesh, after the key of the case that it is about.
fn named(error: &mesh::MeshError) -> String {
    key_of_mesh(error).map_or(error.to_string(), |key| format!("{key}: {error}"))
}

fn gigabytes(gb: f64) -> String {
    if gb < 0.1 { format!("{gb:.3}") } else { format!("{gb:.1}") }
}

/// A mesh file that cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", at(path, *place))]
pub struct MeshFileError {
    /// The file.
    pub path: PathBuf,
    /// The place in it, where the cause has one.
    pub place: Option<Place>,
    /// What is wrong.
    pub problem: String,
    /// What to do.
    pub remedy: String,
}

fn at(path: &Path, place: Option<Place>) -> String {
    let path = path.display();
    match place {
        None => path.to_string(),
        Some(Place::Line(line)) => format!("{path}:{line}"),
        Some(Place::Byte(byte)) => format!("{path}, byte {byte}"),
    }
}
