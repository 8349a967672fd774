//! What is wrong with the input of contact.

/// Input from which no contact can be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// A surface has no faces.
    #[error("contact surface {side} has no faces")]
    EmptySurface {
        /// Side of the contact, 0 or 1.
        side: usize,
    },
    /// A face refers to a node or an element that the mesh does not have.
    #[error("face {face} of contact surface {side} refers to a node or element outside the mesh")]
    OutsideMesh {
        /// Side of the contact, 0 or 1.
        side: usize,
        /// Index of the face in its surface.
        face: usize,
    },
    /// A face without area, an element without volume, or coordinates that are not finite.
    #[error("face {face} of contact surface {side} has no positive area and element volume")]
    Degenerate {
        /// Side of the contact, 0 or 1.
        side: usize,
        /// Index of the face in its surface.
        face: usize,
    },
    /// More than two faces at one edge, or neighbours of opposite orientation.
    #[error("the edge of nodes {a} and {b} of contact surface {side} does not join two faces")]
    Edge {
        /// Side of the contact, 0 or 1.
        side: usize,
        /// First node of the edge.
        a: u32,
        /// Second node of the edge.
        b: u32,
    },
    /// A node belongs to both surfaces.
    #[error("node {node} belongs to both contact surfaces")]
    SharedNode {
        /// The node.
        node: u32,
    },
    /// A setting or a material constant is outside its range.
    #[error("{name} = {value} must be {range}")]
    Value {
        /// What the number is.
        name: &'static str,
        /// The number given.
        value: f64,
        /// The admissible range in words.
        range: &'static str,
    },
    /// [`Stiffness::Stability`](crate::Stiffness::Stability) without the scale that it is a fraction of.
    #[error(
        "a stiffness as a fraction of the stability limit needs the elastic frequency and the \
         time step"
    )]
    NoStabilityScale,
}
