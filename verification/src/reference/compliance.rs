//! The compliance of bodies condensed to the nodes of their contact surface.

use crate::reference::sparse::{
    ElementStiffness, NONE, SparseError, StiffnessMatrix, Symbolic, Unknowns,
};
use faer::Mat;
use mesh::Mesh;
use solid::Material;
use statics::Supports;

/// Displacements of some nodes of supported bodies per force on these nodes: their block of K^-1 (m/N), in the global
/// frame.
pub struct SurfaceCompliance {
    nodes: Vec<u32>,
    /// Row of each node and axis in `matrix`, or [`NONE`] where the node is held.
    row: Vec<[u32; 3]>,
    matrix: Mat<f64>,
    size: FactorSize,
}

/// Size of a factorisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactorSize {
    /// Number of unknown displacements.
    pub unknowns: usize,
    /// Number of stored entries of the factor.
    pub entries: usize,
}

impl SurfaceCompliance {
    /// Condenses the bodies of `mesh` to `nodes` (mesh indices) by a Cholesky factorisation in which the unknowns
    /// of those nodes come last. `materials` has one entry per body.
    ///
    /// Everything is linear about the undeformed state. Of `supports` only the kind counts, held, tied or loaded, and
    /// not the given displacements and forces. Supports must hold the bodies by themselves: a body whose only support
    /// is a loaded group moves freely, and its stiffness is singular.
    ///
    /// # Errors
    /// [`SparseError`], in all its variants.
    pub fn new(
        mesh: &Mesh,
        materials: &[Material],
        element: &ElementStiffness<'_>,
        supports: &Supports,
        nodes: &[u32],
    ) -> Result<Self, SparseError> {
        let unknowns = Unknowns::new(mesh, supports, nodes)?;
        let stiffness = StiffnessMatrix::assemble(mesh, materials, element, &unknowns)?;
        let symbolic = Symbolic::new(&stiffness)?;
        let size = FactorSize { unknowns: unknowns.count(), entries: symbolic.entries() };
        let matrix = symbolic.factor(&stiffness, &unknowns)?.inverse_of_last(unknowns.last());
        let first = unknowns.count() - unknowns.last();
        let row = nodes
            .iter()
            .map(|&n| {
                [0, 1, 2].map(|axis| {
                    unknowns.of(n as usize, axis).map_or(NONE, |dof| (dof - first) as u32)
                })
            })
            .collect();
        Ok(Self { nodes: nodes.to_vec(), row, matrix, size })
    }

    /// The nodes (mesh indices), in the order in which they were given.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Size of the factorisation.
    pub fn size(&self) -> FactorSize {
        self.size
    }

    /// Displacement of node `i` per force on node `j` (m/N), `[axis of i][axis of j]` with the global axes; zero where
    /// held. `i` and `j` are indices into [`nodes`](Self::nodes).
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn block(&self, i: usize, j: usize) -> [[f64; 3]; 3] {
        self.row[i].map(|r| {
            self.row[j].map(|c| {
                if r == NONE || c == NONE { 0.0 } else { self.matrix[(r as usize, c as usize)] }
            })
        })
    }
}
