//! Why there is no equilibrium, and where.

use crate::problem::Iteration;
use nalgebra::Vector3;

/// Why no equilibrium was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StaticsError {
    /// A support names a node that the mesh does not have.
    #[error("a support names node {node}, which the mesh does not have")]
    NoSuchNode {
        /// The node.
        node: u32,
    },
    /// A node is tied twice, or tied and held.
    #[error("node {node} is tied to a group and supported otherwise as well")]
    TwiceSupported {
        /// The node.
        node: u32,
    },
    /// A group without nodes.
    #[error("a group of tied nodes is empty")]
    EmptyGroup,
    /// A load, a displacement or a start value is not a number.
    #[error("a load or a displacement is {value}: no finite number")]
    NotANumber {
        /// The value.
        value: f64,
    },
    /// A body, or a part of it, that nothing holds: it could turn and slide freely.
    #[error(
        "body '{body}' floats: no support holds the part of it around node {node}, and contact \
         without friction cannot"
    )]
    Floating {
        /// Name of the body.
        body: String,
        /// A node of the part.
        node: usize,
    },
    /// A load that no contact takes up.
    #[error(
        "contact is open: a force of {force:e} N along {axis} acts on body '{body}', which \
         neither a support nor contact holds in that direction; the load must press the bodies \
         together"
    )]
    Open {
        /// Name of the body.
        body: String,
        /// `x`, `y` or `z`.
        axis: char,
        /// Force on the body (N).
        force: f64,
    },
    /// The tangent has no stiffness in some direction.
    #[error(
        "the bodies move without resistance, most of all node {node} of body '{body}' at \
         {}: a support is missing, or the load is absurd",
        millimetres(position)
    )]
    Flat {
        /// The node that moves most.
        node: usize,
        /// Name of its body.
        body: String,
        /// Its reference position (m).
        position: Vector3<f64>,
    },
    /// An element turned inside out.
    #[error(
        "element {element} of body '{body}' at {} is turned inside out (det F = {jacobian:.3}) \
         under the load: the load is absurd, or the contact starts too deep",
        millimetres(centre)
    )]
    Inverted {
        /// Index in the mesh.
        element: usize,
        /// Name of its body.
        body: String,
        /// Its centre in the reference configuration (m).
        centre: Vector3<f64>,
        /// det F.
        jacobian: f64,
    },
    /// Linear iterations ran out.
    #[error(
        "conjugate gradients did not converge in {iterations} iterations in Newton iteration \
         {}, residual {:.1e} of the load", at.iteration, at.residual
    )]
    Linear {
        /// Iterations used.
        iterations: usize,
        /// Newton's state.
        at: Iteration,
    },
    /// Newton iterations ran out.
    #[error(
        "no equilibrium in {} Newton iterations: residual {:.1e} of the load (tolerance \
         {tolerance:.1e}), {} contact pairs; the residual is largest at node {node} of body \
         '{body}' at {}", at.iteration, at.residual, at.closed, millimetres(position)
    )]
    Slow {
        /// State when it gave up.
        at: Iteration,
        /// What was asked for.
        tolerance: f64,
        /// The node with the largest residual.
        node: usize,
        /// Name of its body.
        body: String,
        /// Its reference position (m).
        position: Vector3<f64>,
    },
    /// Exact contact of a slave that a support holds too.
    #[error("node {node} is a slave of exact contact, but a support holds it")]
    HeldSlave {
        /// The node.
        node: usize,
    },
    /// The observer asked to stop.
    #[error("interrupted while seeking the equilibrium")]
    Interrupted,
}

/// A position (m) as people read it.
fn millimetres(position: &Vector3<f64>) -> String {
    let at = 1e3 * position;
    format!("({:.3}, {:.3}, {:.3}) mm", at.x, at.y, at.z)
}
