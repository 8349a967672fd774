//! What to do about what the crates below find wrong, in the keys of the case file.
//!
//! Those crates say what is wrong in the terms of mechanics and know no key. A text here that names an unknown key or
//! section fails a test.

use crate::scenario::preload::PreloadError;
use contact::ContactError;
use dynamics::{Cause, Diagnosis, RelaxationError, USUAL_HOURGLASS};
use friction::LawError;
use mesh::import::{Fault, SetRole};
use mesh::{Allowed, MeshError, Parameter};
use solid::SolidError;
use statics::StaticsError;

/// What to do about an error.
pub trait Remedy {
    /// What to do, in terms of the keys of the case file.
    fn remedy(&self) -> String;
}

/// The dotted path of the key of a parameter of the mesh generators; none where no key gives it.
pub fn key_of(parameter: Parameter) -> Option<&'static str> {
    Some(match parameter {
        Parameter::DiskRadius => "disk.radius",
        Parameter::HubRadius => "disk.hub_radius",
        Parameter::DiskWidth => "disk.width",
        Parameter::DiskCrown => "disk.crown_radius",
        Parameter::BarLength => "bar.length",
        Parameter::BarWidth => "bar.width",
        Parameter::BarHeight => "bar.height",
        Parameter::BarCrown => "bar.crown_radius",
        Parameter::BarStart => "bar.start",
        Parameter::ZoneSize => "mesh.zone.size",
        Parameter::ZoneLength => "mesh.zone.length",
        Parameter::ZoneWidth => "mesh.zone.width",
        Parameter::ZoneDepth => "mesh.zone.depth",
        Parameter::ZoneStart => "mesh.zone.start",
        Parameter::Growth => "mesh.growth",
        Parameter::Coarsest => "mesh.coarsest",
        Parameter::Line | Parameter::Plane => return None,
    })
}

/// The dotted path of the key that a fault of a generated mesh is about, if it is about one.
pub fn key_of_mesh(error: &MeshError) -> Option<&'static str> {
    match error {
        MeshError::OutOfRange { parameter, .. } => key_of(*parameter),
        MeshError::TooManyElements { .. } => Some("mesh.zone.size"),
        _ => None,
    }
}

/// The key that names a set of a mesh file.
fn key_of_set(role: SetRole) -> &'static str {
    match role {
        SetRole::Disk => "mesh.sets.disk",
        SetRole::Bar => "mesh.sets.bar",
        SetRole::Hub => "mesh.sets.hub",
        SetRole::Tread => "mesh.sets.tread",
        SetRole::Top => "mesh.sets.top",
        SetRole::Clamp => "mesh.sets.clamp",
    }
}

impl Remedy for MeshError {
    fn remedy(&self) -> String {
        let (parameter, allowed) = match self {
            Self::OutOfRange { parameter, allowed, .. } => (*parameter, *allowed),
            Self::TooManyElements { .. } => {
                return "raise mesh.zone.size, or shrink the zone ([mesh.zone])".into();
            }
            _ => return "change the keys of [disk], [bar] or [mesh] that shape it".into(),
        };
        let Some(key) = key_of(parameter) else {
            return "give ascending planes, and a line of positive length".into();
        };
        match (parameter, allowed) {
            (_, Allowed::Positive) => format!("give {key} in metres, above 0"),
            (_, Allowed::Finite) => format!("give {key} in metres"),
            (_, Allowed::Growth) => {
                "set mesh.growth between 1.05 and 3: 1.35 grades gently".into()
            }
            (Parameter::Coarsest, _) => "raise mesh.coarsest, or lower mesh.zone.size".into(),
            (Parameter::HubRadius, _) => "lower disk.hub_radius, or raise disk.radius".into(),
            (Parameter::DiskCrown | Parameter::BarCrown, _) => {
                format!("raise {key}, set it to \"flat\", or narrow the body")
            }
            (Parameter::ZoneSize, _) => {
                "lower mesh.zone.size, or enlarge the zone ([mesh.zone]) or disk.radius".into()
            }
            (Parameter::ZoneStart, _) => {
                "move the zone (mesh.zone.start) nearer to the first contact, x = 0, and onto the bar (bar.start, \
                 bar.length)"
                    .into()
            }
            _ => format!("lower {key}, or enlarge the body"),
        }
    }
}

const ANEW: &str = "mend it in the program that made the mesh";
const FRAME: &str = "x is the rolling direction, z up, the disk touches the bar's top at the origin \
                     with its axis along y";

impl Remedy for Fault {
    fn remedy(&self) -> String {
        match self {
            Self::Syntax { .. } | Self::Unknown { .. } => {
                "write the file anew with the program that it comes from".into()
            }
            Self::Unsupported { remedy, .. } => (*remedy).into(),
            Self::Cell { .. } | Self::NoHexes => {
                "mesh both bodies with linear hexahedra; in Gmsh: recombine and extrude with \
                 layers, order 1"
                    .into()
            }
            Self::Repeated { .. } => "number nodes and elements without repetition".into(),
            Self::NotFinite { .. } => {
                "give the node three finite coordinates in the program that made the mesh".into()
            }
            Self::Collapsed { .. } | Self::Inverted { .. } | Self::Mesh(_) => ANEW.into(),
            Self::Coincident { .. } | Self::FaceShared { .. } | Self::Hanging { .. } => {
                "merge coincident nodes within each body (Gmsh: Coherence Mesh, meshio: \
                 merge duplicates), and make its elements match"
                    .into()
            }
            Self::SharedNode { .. } => {
                "mesh the two bodies apart, also where they touch, and do not merge their nodes"
                    .into()
            }
            Self::NoBody { .. } => {
                "put every hexahedron into one of the two sets; mesh.sets.disk and mesh.sets.bar name them"
                    .into()
            }
            Self::MissingSet { role, .. } => {
                let key = key_of_set(*role);
                format!(
                    "name the set so in the file, or give its name in the case: {key} = \"...\""
                )
            }
            Self::NoSets { .. } => {
                "write the sets too: meshio keeps cell_sets and point_sets in .vtu and .inp, and in \
                 .msh only gmsh:physical with its names, field_data"
                    .into()
            }
            Self::EmptySet { role, .. }
            | Self::BothBodies { role, .. }
            | Self::NotOutside { role, .. } => {
                let key = key_of_set(*role);
                format!("choose the nodes or faces of the set anew, or name another as {key}")
            }
            Self::SetsMeet { .. } => "end one of the sets before the other begins".into(),
            Self::Loose { .. } => {
                "merge the nodes where the parts touch, or leave the part out".into()
            }
            Self::Hole { .. } | Self::Open { .. } | Self::Pieces { .. } | Self::Fold { .. } => {
                "put all faces of the running surface into the set and no others".into()
            }
            Self::Axis { axis, .. } => {
                format!("turn the mesh so that its {axis} becomes y: {FRAME}")
            }
            // no disk of a case that was meant is ten times as large or as small
            Self::Size { parameter: Parameter::DiskRadius, found, expected }
                if !(0.1..=10.0).contains(&(found / expected)) =>
            {
                "give the unit of the file as mesh.unit, or mesh the body in its size".into()
            }
            Self::Size { parameter, found, .. } => match key_of(*parameter) {
                Some(key) => format!("set {key} = {found}, or mesh the body in its size"),
                None => "mesh the body in its size".into(),
            },
            Self::Unit { unit, .. } => {
                let unit = unit.symbol();
                format!("set mesh.unit = \"{unit}\"")
            }
            Self::Place { .. } => format!("move the mesh: {FRAME}"),
            Self::OffSurface { role, .. } => {
                let radii = match role {
                    SetRole::Tread => "disk.radius and disk.crown_radius",
                    _ => "bar.crown_radius",
                };
                format!(
                    "give the radii of the mesh as {radii}, or contact.curvature = false for a \
                     surface of another shape"
                )
            }
            Self::Uncovered { .. } => {
                "move or shorten the zone ([mesh.zone]), or extend the set: contact passes over the zone"
                    .into()
            }
            Self::ZoneSize { disk, bar, .. } => {
                let size = disk.min(*bar);
                format!("set mesh.zone.size = {size:.2e}, or refine the mesh")
            }
            Self::HalfOfBodies => {
                "set mesh.symmetry = \"half\", or give the mesh of the whole bodies".into()
            }
            Self::NoEnd { .. } => "make the ends plane, or set bar.ends = \"free\"".into(),
        }
    }
}

impl Remedy for SolidError {
    fn remedy(&self) -> String {
        match self {
            Self::Material { .. } => {
                "correct the keys of [material], [disk.material] or [bar.material]".into()
            }
            Self::Inverted { .. } | Self::Folded { .. } => {
                "change the keys of [disk], [bar] or [mesh] that shape the element".into()
            }
            Self::Level(_) => "take a machine that has them, or another build".into(),
            Self::Count { .. } => "give every body its material".into(),
        }
    }
}

impl Remedy for ContactError {
    fn remedy(&self) -> String {
        match self {
            Self::Value { .. } | Self::NoStabilityScale => {
                "change the keys of [contact.penalty]".into()
            }
            Self::EmptySurface { .. }
            | Self::OutsideMesh { .. }
            | Self::Degenerate { .. }
            | Self::Edge { .. }
            | Self::SharedNode { .. } => {
                "look at the mesh with `creepage mesh`, and mend it or change [mesh]".into()
            }
        }
    }
}

impl Remedy for LawError {
    fn remedy(&self) -> String {
        match self {
            Self::Expression(_) => "correct friction.expression".into(),
            Self::Table(_) => "correct friction.table".into(),
        }
    }
}

impl Remedy for PreloadError {
    fn remedy(&self) -> String {
        match self {
            Self::Static(error) => error.remedy(),
            Self::Relaxation(error) => error.remedy(),
        }
    }
}

/// What to do where a preload diverges for no known reason.
fn soften() -> String {
    "look at the quality of the mesh with `creepage mesh`; lower contact.penalty.normal, or \
         mesh.growth"
        .into()
}

const INTERRUPTED: &str = "the disk had not begun to roll, so there are no results yet";

impl Remedy for RelaxationError {
    fn remedy(&self) -> String {
        match self {
            Self::Slow { .. } => {
                "raise preload.max_iterations, or raise preload.tolerance to a ratio that it reaches"
                    .into()
            }
            Self::BlowUp { .. } => soften(),
            Self::Interrupted => INTERRUPTED.into(),
        }
    }
}

impl Remedy for StaticsError {
    fn remedy(&self) -> String {
        match self {
            Self::Slow { .. } | Self::Linear { .. } => {
                "raise preload.max_iterations, or, with penalty contact, try preload.method = \"relaxation\"".into()
            }
            Self::Inverted { .. } | Self::Flat { .. } => {
                "lower load.normal; `creepage mesh` tells what Hertz's contact expects of it"
                    .into()
            }
            Self::Open { .. } => {
                "give a load.normal that presses the disk on the bar, or, with penalty contact, stiffen the springs \
                 (contact.penalty.normal)"
                    .into()
            }
            Self::Interrupted => INTERRUPTED.into(),
            _ => soften(),
        }
    }
}

impl Remedy for Diagnosis {
    fn remedy(&self) -> String {
        self.cause.remedy()
    }
}

impl Remedy for Cause {
    fn remedy(&self) -> String {
        match self {
            Self::UnstableStep { .. } => "leave time.factor out, or set it below 1".into(),
            Self::StiffContact { .. } => {
                "lower the contact stiffness (contact.penalty.normal, contact.penalty.tangential) or time.factor; \
                 with preload.method = \"static\" the step respects the springs"
                    .into()
            }
            Self::Unsolved(_) => {
                "shorten time.step, raise time.theta towards 1, or give the friction law a memory (friction.memory): \
                 without one, steep falling friction may leave no single solution"
                    .into()
            }
            Self::EnergyGrowth => "lower time.factor or the contact stiffness (contact.penalty.normal, \
                 contact.penalty.tangential)".into(),
            Self::NotFinite => "lower time.factor and look at the last readable results".into(),
            Self::Friction { .. } => {
                "correct the law ([friction]), or raise guards.friction where it is meant so".into()
            }
            Self::Inverted { .. } => format!(
                "check load.normal, drive.torque, drive.speed and the units of [material]; raise \
                 element.hourglass to {USUAL_HOURGLASS} if it is lower"
            ),
            Self::Hourglass { coefficient, .. } if *coefficient < USUAL_HOURGLASS => {
                format!("raise element.hourglass to {USUAL_HOURGLASS}")
            }
            Self::Hourglass { .. } => {
                "lower mesh.zone.size, or set element.contact_layers = \"full\"".into()
            }
            Self::Penetration { .. } => {
                "stiffen the springs (contact.penalty.normal; 0.1 to 1 is usual), lower the load or the torque, or \
                 raise guards.penetration where it is meant so"
                    .into()
            }
            Self::ContactLost { .. } => {
                "check load.normal, disk.lift and load.hub_mass, or raise guards.parted where the disk is meant to \
                 jump"
                    .into()
            }
            Self::MeshMoves { .. } => {
                "lengthen mesh.window, or lower mesh.zone.size; without mesh.window the zone stays"
                    .into()
            }
            Self::EndOfTrack { .. } => {
                "roll less (time.roll), or lengthen the bar (bar.length)".into()
            }
        }
    }
}
