//! What holds the bodies and what presses them.

/// How a group of nodes moves along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// By a given displacement (m); zero holds it.
    Moved(f64),
    /// Under a given force on the whole group (N), all nodes of the group together.
    Loaded(f64),
}

/// Nodes that move together as a rigid body that does not turn: the hub.
#[derive(Clone, Debug, PartialEq)]
pub struct Tied {
    /// The nodes (mesh indices).
    pub nodes: Vec<u32>,
    /// Motion along x, y, z.
    pub axes: [Axis; 3],
}

/// Boundary conditions of a static problem.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Supports {
    /// Nodes that do not move (mesh indices).
    pub held: Vec<u32>,
    /// Groups of nodes that move together.
    pub tied: Vec<Tied>,
    /// Nodes that do not move along y but slide in x and z: those on a plane of symmetry, or all of a slice in plane
    /// strain. The reaction is left out of the forces.
    pub sliding: Vec<u32>,
}
