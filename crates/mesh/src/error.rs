//! What can be wrong with a mesh or with the shape asked for.

/// Largest number of elements that a generator accepts.
pub const MAX_ELEMENTS: f64 = 5e7;

/// A refused shape, or a fault found by [`check`](crate::check()).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A parameter of a generator lies outside its range.
    #[error("`{parameter}` = {value} is out of range: it must be {allowed}; {remedy}")]
    OutOfRange {
        /// Key of the parameter, as in `mesh.zone.length`.
        parameter: &'static str,
        /// The value given (SI units).
        value: f64,
        /// The range allowed, in words and numbers.
        allowed: String,
        /// What to do about it.
        remedy: String,
    },
    /// The shape would need more than [`MAX_ELEMENTS`] elements.
    #[error(
        "`mesh.zone.size` = {size} asks for about {estimate:.2e} elements of the {body}, more \
         than the {MAX_ELEMENTS:.0e} allowed; raise the size or shrink the zone"
    )]
    TooManyElements {
        /// Body that is too large.
        body: &'static str,
        /// Element size asked for (m).
        size: f64,
        /// Estimated number of elements.
        estimate: f64,
    },
    /// The ranges of the bodies do not tile the nodes or elements.
    #[error("the ranges of body `{body}` do not continue those before it or exceed the mesh")]
    BodyRange {
        /// Name of the body.
        body: String,
    },
    /// A node index points outside its body.
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
    /// An element is inverted or flat at a corner.
    #[error(
        "element {element} is inverted or flat at its corner {corner}: scaled Jacobian {value:.3e}"
    )]
    NegativeJacobian {
        /// The element.
        element: usize,
        /// Corner in `VTK_HEXAHEDRON` order.
        corner: usize,
        /// Scaled Jacobian there.
        value: f64,
    },
    /// Two nodes of one body coincide.
    #[error("nodes {first} and {second} coincide at {point:?}; merge them")]
    DuplicateNodes {
        /// One node.
        first: usize,
        /// The other node.
        second: usize,
        /// Where (m).
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
    /// A surface names a face that its element does not have.
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

impl MeshError {
    pub(crate) fn range(
        parameter: &'static str,
        value: f64,
        allowed: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::OutOfRange { parameter, value, allowed: allowed.into(), remedy: remedy.into() }
    }
}

/// Refuses a value that is not a positive, finite number.
pub(crate) fn positive(parameter: &'static str, value: f64) -> Result<(), MeshError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(MeshError::range(parameter, value, "a positive, finite number", "give a length in metres"))
}
