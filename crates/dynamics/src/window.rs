//! A mesh that follows the patch: how it moves, and how far it has moved (module `mesh_move` moves it).

use mesh::{Padded, Source};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The move of the mesh of one body.
#[derive(Clone, Debug)]
pub struct MeshMove {
    /// The nodes of the body.
    pub nodes: Range<usize>,
    /// Where each of them finds its motion.
    pub sources: Vec<Source>,
    /// How far the mesh moves: along the lower body (m), or about the axis of the upper body (rad).
    pub by: f64,
    /// What the sources miss of the displacements.
    pub missed: Missed,
}

/// What the sources of a mesh that moves miss of the displacements that its body has at rest under the forces that roll over
/// it.
///
/// At rest the displacements are those of the mesh: with the force at the same place of the body, they are a little
/// different for the mesh before and after its move, and what is interpolated differs more. Without this part,
/// the difference would run through the body as a wave after every move. All by their components along the coordinates of
/// the body (module `mesh::transfer`), one entry for each of its nodes.
#[derive(Clone, Debug)]
pub struct Missed {
    /// Under contact's force along the surface (m/N).
    pub along: Vec<Padded>,
    /// Under contact's force outward from the surface (m/N).
    pub outward: Vec<Padded>,
    /// Under the centrifugal force of the body's turning, over the square of its angular velocity (m s^2).
    pub centrifugal: Vec<Padded>,
}

impl Missed {
    /// The displacements (m) that are missed of each node under the `loads`: both forces of contact (N), and the square of
    /// the angular velocity (1/s^2).
    pub(crate) fn under(&self, loads: [f64; 3]) -> impl Iterator<Item = Padded> {
        let Self { along, outward, centrifugal } = self;
        along.iter().zip(outward).zip(centrifugal).map(move |((a, o), c)| {
            Padded::from(loads[0] * a.vector() + loads[1] * o.vector() + loads[2] * c.vector())
        })
    }
}

impl MeshMove {
    /// The node that takes over the material of each node of the body, if any does.
    fn successors(&self) -> Vec<Option<u32>> {
        let mut successors = vec![None; self.nodes.len()];
        for (node, source) in (self.nodes.start as u32..).zip(&self.sources) {
            if let Source::Node(from) = source {
                // the first, where several are moved back to the end of the body
                successors[*from as usize - self.nodes.start].get_or_insert(node);
            }
        }
        successors
    }
}

/// The moves of a mesh that follows the patch.
#[derive(Clone, Debug)]
pub struct Window {
    pub(crate) upper: MeshMove,
    pub(crate) lower: MeshMove,
    /// The successors of the nodes of both bodies.
    pub(crate) successors: [Vec<Option<u32>>; 2],
}

impl Window {
    /// The moves of both bodies.
    pub fn new(upper: MeshMove, lower: MeshMove) -> Self {
        let successors = [&upper, &lower].map(MeshMove::successors);
        Self { upper, lower, successors }
    }
}

/// How far the meshes have moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Travel {
    /// The origin of the coordinates along x, from where it was at the start (m).
    pub x: f64,
    /// The mesh of the upper body against the body (rad).
    pub angle: f64,
}
