//! What can be wrong with a foreign mesh.

use super::unit::Unit;
use crate::Parameter;
use std::fmt;

/// What a set of a mesh file stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetRole {
    /// The elements of the disk.
    Disk,
    /// The elements of the bar.
    Bar,
    /// The disk's rigid hub.
    Hub,
    /// The disk's running surface.
    Tread,
    /// The bar's running surface.
    Top,
    /// The nodes by which the bar is clamped.
    Clamp,
}

impl fmt::Display for SetRole {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Disk => "the disk",
            Self::Bar => "the bar",
            Self::Hub => "the disk's hub",
            Self::Tread => "the disk's running surface",
            Self::Top => "the bar's running surface",
            Self::Clamp => "the bar's clamp",
        })
    }
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of a text, counted from 1.
    Line(usize),
    /// A byte of a binary file, counted from 0.
    Byte(usize),
}

impl From<usize> for Place {
    fn from(line: usize) -> Self {
        Self::Line(line)
    }
}

/// Why a foreign mesh is refused, and where in the file the cause stands.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{fault}")]
pub struct ImportError {
    /// Where; `None` for arrays, and for faults that belong to no place.
    pub place: Option<Place>,
    /// What is wrong.
    pub fault: Fault,
}

/// What is wrong with a foreign mesh. Nodes and elements are named by their numbers in the file; in a VTU file
/// and in arrays these are their indices, counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// The file does not follow its format.
    #[error("{what}")]
    Syntax {
        /// What was expected, and mostly what was found.
        what: String,
    },
    /// A part of the format that is not read.
    #[error("{what} is not read")]
    Unsupported {
        /// What it is.
        what: String,
        /// What to do instead.
        remedy: &'static str,
    },
    /// A cell that is no hexahedron with eight nodes.
    #[error("element {element} is {kind}; only hexahedra with 8 nodes are computed with")]
    Cell {
        /// The element.
        element: u64,
        /// What it is.
        kind: String,
    },
    /// The mesh has no hexahedra.
    #[error("there are no hexahedra with 8 nodes in the mesh")]
    NoHexes,
    /// A number is used twice.
    #[error("{what} {id} is there twice")]
    Repeated {
        /// `"node"`, `"element"` or the like.
        what: &'static str,
        /// Its number.
        id: u64,
    },
    /// A node, element or set that is named does not exist.
    #[error("{from} names {what}, which is not there")]
    Unknown {
        /// What names it.
        from: String,
        /// What does not exist.
        what: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("node {node} has a coordinate that is not finite: {point:?}")]
    NotFinite {
        /// The node.
        node: u64,
        /// Its coordinates, in the unit of the file.
        point: [f64; 3],
    },
    /// A hexahedron names a node twice.
    #[error("element {element} names node {node} twice: a hexahedron has 8 different corners")]
    Collapsed {
        /// The element.
        element: u64,
        /// The node.
        node: u64,
    },
    /// A hexahedron without a positive Jacobian at each corner, whichever way it is numbered.
    #[error(
        "element {element} is inverted or flat at its corner {corner}: scaled Jacobian {value:.3e}, \
         and numbering it the other way round does not mend it"
    )]
    Inverted {
        /// The element.
        element: u64,
        /// Corner, counted from 1 in the order of the file.
        corner: usize,
        /// Scaled Jacobian there (dimensionless).
        value: f64,
    },
    /// Two nodes of one body coincide.
    #[error(
        "nodes {first} and {second} of the {body} coincide at {point:?} m: they are not merged"
    )]
    Coincident {
        /// One node.
        first: u64,
        /// The other node.
        second: u64,
        /// The body.
        body: &'static str,
        /// Where (m).
        point: [f64; 3],
    },
    /// A face belongs to more than two elements, or to two on the same side.
    #[error(
        "a face of element {element} is shared by more than two elements, or by two on the same \
         side of it"
    )]
    FaceShared {
        /// The element.
        element: u64,
    },
    /// A node on a face or edge of an element that it is no corner of.
    #[error("node {node} hangs on a face of element {element}, which it is no corner of")]
    Hanging {
        /// The node.
        node: u64,
        /// The element.
        element: u64,
    },
    /// The disk and the bar have a node in common.
    #[error("node {node} belongs to elements of the disk and of the bar: they share no nodes")]
    SharedNode {
        /// The node.
        node: u64,
    },
    /// An element is in no body, or in both.
    #[error("element {element} is in {of} of the sets `{disk}` (disk) and `{bar}` (bar)")]
    NoBody {
        /// The element.
        element: u64,
        /// `"neither"` or `"both"`.
        of: &'static str,
        /// Name of the disk's set.
        disk: String,
        /// Name of the bar's set.
        bar: String,
    },
    /// A set is not in the file.
    #[error("there is no set `{name}` for {role}; the file has {there}")]
    MissingSet {
        /// What the set stands for.
        role: SetRole,
        /// The name looked for.
        name: String,
        /// The names of the sets in the file.
        there: String,
    },
    /// The file has no sets at all.
    #[error("there is no set `{name}` for {role}: the file has no sets")]
    NoSets {
        /// What the set stands for.
        role: SetRole,
        /// The name looked for.
        name: String,
    },
    /// A set holds nothing of the kind that is needed.
    #[error("set `{name}` of {role} holds no {what}")]
    EmptySet {
        /// What the set stands for.
        role: SetRole,
        /// Its name.
        name: String,
        /// What it should hold, in the plural.
        what: &'static str,
    },
    /// A set names nodes or faces of the wrong body.
    #[error(
        "set `{name}` of {role} names both bodies: node {node} is of the {other}, not of the {body}"
    )]
    BothBodies {
        /// What the set stands for.
        role: SetRole,
        /// Its name.
        name: String,
        /// A node of the other body.
        node: u64,
        /// The body that the set must lie on.
        body: &'static str,
        /// The other body.
        other: &'static str,
    },
    /// A face of a set is not on the outside of its body.
    #[error(
        "set `{name}` of {role}: the face with the nodes {nodes:?} is none of the {body}'s outside"
    )]
    NotOutside {
        /// What the set stands for.
        role: SetRole,
        /// Its name.
        name: String,
        /// Corner nodes.
        nodes: [u64; 4],
        /// The body.
        body: &'static str,
    },
    /// Two sets that must be disjoint have a node in common.
    #[error("sets `{first}` and `{second}` share node {node}")]
    SetsMeet {
        /// One set.
        first: String,
        /// The other set.
        second: String,
        /// The node.
        node: u64,
    },
    /// The elements of a body are not all connected.
    #[error("element {element} does not hang together with the rest of the {body}")]
    Loose {
        /// The body.
        body: &'static str,
        /// An element that is not connected with the largest part.
        element: u64,
    },
    /// A contact surface has a hole.
    #[error(
        "set `{name}` of {role} has a hole, bounded by {edges} edges, at {at:?} m: a face of element \
         {element} is left out of it"
    )]
    Hole {
        /// What the set stands for.
        role: SetRole,
        /// Its name.
        name: String,
        /// Number of edges around the hole.
        edges: usize,
        /// Coordinates of a node on its border (m).
        at: [f64; 3],
        /// Element of the face beyond the border.
        element: u64,
    },
    /// The tread does not go round the disk.
    #[error(
        "set `{name}` of {role} does not go round the disk: it ends at a face of element {element}"
    )]
    Open {
        /// What the set stands for.
        role: SetRole,
        /// Its name.
        name: String,
        /// Element of a face beyond the end.
        element: u64,
    },
    /// The tread goes round another axis than the disk's.
    #[error(
        "set `{name}` of {role} goes round an axis along {axis}: the axis of the disk must be along y"
    )]
    Axis {
        /// What the set stands for.
        role: SetRole,
        /// Its name.
        name: String,
        /// The axis that it goes round.
        axis: char,
    },
    /// A contact surface is in several pieces.
    #[error("set `{name}` of {role} is in several pieces: a face of element {element} is apart")]
    Pieces {
        /// What the set stands for.
        role: SetRole,
        /// Its name.
        name: String,
        /// Element of a face of a smaller piece.
        element: u64,
    },
    /// More than two faces of a contact surface meet in one edge.
    #[error(
        "set `{name}` of {role}: more than two of its faces meet in the edge of nodes {edge:?}"
    )]
    Fold {
        /// What the set stands for.
        role: SetRole,
        /// Its name.
        name: String,
        /// Nodes at the ends of the edge.
        edge: [u64; 2],
    },
    /// A size of the mesh differs from that of the case.
    #[error("{parameter} is {found} m in the mesh, not {expected} m")]
    Size {
        /// What was measured.
        parameter: Parameter,
        /// Its value (m).
        found: f64,
        /// What it must be (m).
        expected: f64,
    },
    /// The radius of the disk differs from that of the case by the ratio of two units of length.
    #[error(
        "the disk of the mesh has a radius of {found} m, not {expected} m: its coordinates are in {}",
        unit.symbol()
    )]
    Unit {
        /// Radius found (m).
        found: f64,
        /// What it must be (m).
        expected: f64,
        /// The unit in which the file must have been written.
        unit: Unit,
    },
    /// The mesh does not lie in the frame of the case.
    #[error("the {what} of the mesh lies at {found} m, not at {expected} m")]
    Place {
        /// What was measured.
        what: &'static str,
        /// Where it is (m).
        found: f64,
        /// Where it must be (m).
        expected: f64,
    },
    /// A node of a contact surface is off the cylinder or crown that the case gives.
    #[error(
        "node {node} of set `{name}` lies {distance:.2e} m off the surface that the radii of the case give \
         for {role}, more than {limit:.2e} m"
    )]
    OffSurface {
        /// The node.
        node: u64,
        /// Name of the set.
        name: String,
        /// Distance (m).
        distance: f64,
        /// What the set stands for.
        role: SetRole,
        /// Largest distance allowed (m).
        limit: f64,
    },
    /// Too few faces, or none, lie in the fine zone.
    #[error(
        "set `{name}` of {role} covers {covered:.0} % of the fine zone: {faces} faces lie there"
    )]
    Uncovered {
        /// What the set stands for.
        role: SetRole,
        /// Its name.
        name: String,
        /// Area of the faces over that of the zone (%).
        covered: f64,
        /// Faces in the zone.
        faces: usize,
    },
    /// The faces in the fine zone differ in size from the case.
    #[error(
        "in the zone the faces of the mesh have edges of {disk:.3e} m (disk) and {bar:.3e} m (bar), \
         not {size} m"
    )]
    ZoneSize {
        /// Mean edge on the disk (m).
        disk: f64,
        /// Mean edge on the bar (m).
        bar: f64,
        /// What they must be near (m).
        size: f64,
    },
    /// The mesh is the half y >= 0 of the bodies where the whole is wanted.
    #[error("the mesh is half a model: it has no part y < 0, and is half as wide as the case says")]
    HalfOfBodies,
    /// An end of the bar is not plane.
    #[error("the bar has no plane {which} end x = {at} m, on which a quiet boundary could act")]
    NoEnd {
        /// `"rear"` or `"front"`.
        which: &'static str,
        /// Where it was looked for (m).
        at: f64,
    },
    /// A fault that [`check`](crate::check()) finds and none of the others describes.
    #[error(transparent)]
    Mesh(#[from] crate::MeshError),
}

impl Fault {
    /// The fault at no place.
    pub(crate) fn nowhere(self) -> ImportError {
        ImportError { place: None, fault: self }
    }

    /// The fault at a place: a line, counted from 1, or a byte.
    pub(crate) fn at(self, place: impl Into<Place>) -> ImportError {
        ImportError { place: Some(place.into()), fault: self }
    }
}
