//! Errors of generators, and faults of meshes.

use std::fmt;

/// Largest number of elements that a generator accepts.
pub const MAX_ELEMENTS: f64 = 5e7;

/// A parameter of a generator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Rolling radius of the disk (m).
    DiskRadius,
    /// Radius of the disk's rigid hub (m).
    HubRadius,
    /// Width of the disk (m).
    DiskWidth,
    /// Transverse radius of the disk's tread (m).
    DiskCrown,
    /// Length of the bar (m).
    BarLength,
    /// Width of the bar (m).
    BarWidth,
    /// Height of the bar (m).
    BarHeight,
    /// Transverse radius of the bar's top (m).
    BarCrown,
    /// x of the bar's rear end (m).
    BarStart,
    /// Element size of the fine zone (m).
    ZoneSize,
    /// Length of the fine zone (m).
    ZoneLength,
    /// Width of the fine zone (m).
    ZoneWidth,
    /// Depth of the fine zone (m).
    ZoneDepth,
    /// x of the fine zone's rear end (m).
    ZoneStart,
    /// Ratio of successive element sizes outside the fine zone (dimensionless).
    Growth,
    /// Largest element size (m).
    Coarsest,
    /// Length of a line that is divided (m).
    Line,
    /// A plane between the cells of a block (m).
    Plane,
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::DiskRadius => "the radius of the disk",
            Self::HubRadius => "the radius of the hub",
            Self::DiskWidth => "the width of the disk",
            Self::DiskCrown => "the transverse radius of the tread",
            Self::BarLength => "the length of the bar",
            Self::BarWidth => "the width of the bar",
            Self::BarHeight => "the height of the bar",
            Self::BarCrown => "the transverse radius of the bar's top",
            Self::BarStart => "x of the bar's rear end",
            Self::ZoneSize => "the element size of the fine zone",
            Self::ZoneLength => "the length of the fine zone",
            Self::ZoneWidth => "the width of the fine zone",
            Self::ZoneDepth => "the depth of the fine zone",
            Self::ZoneStart => "x of the fine zone's rear end",
            Self::Growth => "the growth ratio of element sizes outside the fine zone",
            Self::Coarsest => "the largest element size",
            Self::Line => "the length of the line",
            Self::Plane => "a plane between cells",
        })
    }
}

/// What a parameter of a generator may be; lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowed {
    /// Positive and finite.
    Positive,
    /// Finite.
    Finite,
    /// A ratio of successive sizes: above 1 and at most 3.
    Growth,
    /// At least this value, the size of the second.
    AtLeast(f64, &'static str),
    /// At most this value, the size of the second.
    AtMost(f64, &'static str),
    /// Below this value, the size of the second.
    Below(f64, &'static str),
    /// From the first value to the second; the third is the reason.
    Between(f64, f64, &'static str),
    /// A radius of a crown whose sagitta at half the width, `fall`, is at most `most`.
    Falls {
        /// Its sagitta (m).
        fall: f64,
        /// The largest sagitta allowed (m).
        most: f64,
    },
    /// Above the plane before it.
    Ascending,
}

/// A computed number rounded to six digits, for messages.
pub(crate) fn digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Positive => f.write_str("a positive, finite number"),
            Self::Finite => f.write_str("a finite number"),
            Self::Growth => f.write_str("above 1 and at most 3"),
            Self::AtLeast(least, what) => write!(f, "at least {}, {what}", digits(*least)),
            Self::AtMost(most, what) => write!(f, "at most {}, {what}", digits(*most)),
            Self::Below(end, what) => write!(f, "below {end}, {what}"),
            Self::Between(low, high, why) => {
                write!(f, "from {} to {}, {why}", digits(*low), digits(*high))
            }
            Self::Falls { fall, most } => {
                let (fall, most) = (digits(*fall), digits(*most));
                write!(
                    f,
                    "large enough that the surface falls by less than {most} m over the width; it falls by {fall} m"
                )
            }
            Self::Ascending => f.write_str("above the plane before it"),
        }
    }
}

/// A shape that a generator refuses, or a fault found by [`check`](crate::check()). Nodes and elements are
/// named by their indices in the mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A parameter of a generator lies outside its range.
    #[error("{parameter}, {value}, must be {allowed}")]
    OutOfRange {
        /// The parameter.
        parameter: Parameter,
        /// The value given (m, or dimensionless).
        value: f64,
        /// The values allowed.
        allowed: Allowed,
    },
    /// The shape would need more than [`MAX_ELEMENTS`] elements.
    #[error(
        "elements of {size} m in the fine zone: the {body} would have about {estimate:.2e}, more than the \
         {MAX_ELEMENTS:.0e} allowed"
    )]
    TooManyElements {
        /// Name of the body.
        body: &'static str,
        /// Element size in the fine zone (m).
        size: f64,
        /// Number of elements, or an estimate of it.
        estimate: f64,
    },
    /// The ranges of the bodies do not follow one another, or do not cover all nodes and elements.
    #[error("the ranges of body `{body}` do not continue those before it or exceed the mesh")]
    BodyRange {
        /// Name of the body.
        body: String,
    },
    /// A node or element index lies outside its body.
    #[error("{what} of body `{body}` names node or element {index}, outside the body")]
    BadIndex {
        /// Element, set or surface that holds the index.
        what: String,
        /// Name of the body.
        body: String,
        /// The index.
        index: usize,
    },
    /// A node set is not sorted or repeats a node.
    #[error("node set `{set}` of body `{body}` is not sorted without repetition")]
    UnsortedSet {
        /// Name of the set.
        set: String,
        /// Name of the body.
        body: String,
    },
    /// A coordinate is NaN or infinite.
    #[error("node {node} has a coordinate that is not finite: {point:?}")]
    NotFinite {
        /// The node.
        node: usize,
        /// Its coordinates (m).
        point: [f64; 3],
    },
    /// An element is inverted or flat at a corner, or has an edge without length.
    #[error(
        "element {element} is inverted or flat at its corner {corner}: scaled Jacobian {value:.3e}"
    )]
    NegativeJacobian {
        /// The element.
        element: usize,
        /// Corner, 0 to 7 in `VTK_HEXAHEDRON` order.
        corner: usize,
        /// Scaled Jacobian there (dimensionless); NaN for an edge without length.
        value: f64,
    },
    /// Two nodes of one body coincide.
    #[error("nodes {first} and {second} coincide at {point:?}; merge them")]
    DuplicateNodes {
        /// One node.
        first: usize,
        /// The other node.
        second: usize,
        /// Their coordinates (m).
        point: [f64; 3],
    },
    /// A face belongs to more than two elements, or to two on the same side.
    #[error("the face {nodes:?} of element {element} is shared by elements on the same side of it")]
    FaceShared {
        /// Corner nodes.
        nodes: [u32; 4],
        /// One of the elements.
        element: usize,
    },
    /// A node lies inside a face or on an edge of an element that it is not a corner of.
    #[error("node {node} hangs on the face {face:?} of element {element}")]
    HangingNode {
        /// The node.
        node: usize,
        /// Corner nodes of the face.
        face: [u32; 4],
        /// Element of the face.
        element: usize,
    },
    /// A surface names a face that its element does not have, or from the inside.
    #[error("surface `{surface}` of body `{body}`: {nodes:?} is no outward face of element {hex}")]
    NotAFace {
        /// Name of the surface.
        surface: String,
        /// Name of the body.
        body: String,
        /// Corner nodes given.
        nodes: [u32; 4],
        /// Element given.
        hex: u32,
    },
    /// A node belongs to no element: it would have no mass.
    #[error("node {node} belongs to no element")]
    LooseNode {
        /// The node.
        node: usize,
    },
}

/// Refuses `value` unless the condition `holds`.
pub(crate) fn within(
    holds: bool,
    parameter: Parameter,
    value: f64,
    allowed: Allowed,
) -> Result<(), MeshError> {
    if holds { Ok(()) } else { Err(MeshError::OutOfRange { parameter, value, allowed }) }
}

/// Refuses a value that is not a positive, finite number.
pub(crate) fn positive(parameter: Parameter, value: f64) -> Result<(), MeshError> {
    within(value.is_finite() && value > 0.0, parameter, value, Allowed::Positive)
}

/// Refuses a value that is not a finite number.
pub(crate) fn finite(parameter: Parameter, value: f64) -> Result<(), MeshError> {
    within(value.is_finite(), parameter, value, Allowed::Finite)
}

/// Refuses a growth outside (1, 3], and a largest size below the `size` of the zone's elements.
pub(crate) fn graded(size: f64, growth: f64, coarsest: f64) -> Result<(), MeshError> {
    within(growth > 1.0 && growth <= 3.0, Parameter::Growth, growth, Allowed::Growth)?;
    let allowed = Allowed::AtLeast(size, "the element size of the fine zone");
    within(coarsest >= size, Parameter::Coarsest, coarsest, allowed)
}
