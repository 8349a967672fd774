//! A mesh that follows the patch: how it moves, and how far it has moved (module `mesh_move` moves it).

use mesh::Source;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The move of the mesh of one body.
#[derive(Clone, Debug)]
pub struct MeshMove {
    /// The nodes of the body.
    pub nodes: Range<usize>,
    /// Where each of them finds its motion.
    pub sources: Vec<Source>,
    /// How far the mesh moves: along the bar (m), or about the axis of the disk (rad).
    pub by: f64,
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
    pub(crate) disk: MeshMove,
    pub(crate) bar: MeshMove,
    /// The successors of the nodes of the disk and of the bar.
    pub(crate) successors: [Vec<Option<u32>>; 2],
}

impl Window {
    /// The moves of disk and bar.
    pub fn new(disk: MeshMove, bar: MeshMove) -> Self {
        let successors = [&disk, &bar].map(MeshMove::successors);
        Self { disk, bar, successors }
    }
}

/// How far the meshes have moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Travel {
    /// The origin of the coordinates along x, from where it was at the start (m).
    pub x: f64,
    /// The mesh of the disk against the disk (rad).
    pub angle: f64,
}
