//! The compliance of a body as its contact surface feels it.

use crate::sparse::{ElementStiffness, NONE, SparseError, StiffnessMatrix, Symbolic, Unknowns};
use faer::Mat;
use mesh::Mesh;
use solid::Material;
use statics::Supports;

/// Displacements of some nodes of supported bodies per force on them: the block of K^-1 (m/N).
pub struct SurfaceCompliance {
    nodes: Vec<u32>,
    /// Row of each node and axis in `matrix`, or [`NONE`] where the node is held.
    row: Vec<[u32; 3]>,
    matrix: Mat<f64>,
    size: FactorSize,
}

/// What a factorisation cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactorSize {
    /// Unknown displacements.
    pub unknowns: usize,
    /// Entries of the factor.
    pub entries: usize,
}

impl SurfaceCompliance {
    /// Condenses the bodies of `mesh` to `nodes` by a Cholesky factorisation in which the unknowns
    /// of those nodes come last.
    ///
    /// Everything is linear about the undeformed state. Supports must hold the bodies by
    /// themselves: a group that is only loaded moves freely, and the stiffness is singular.
    ///
    /// # Errors
    /// [`SparseError`].
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

    /// The nodes (mesh indices).
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// What the factorisation cost.
    pub fn size(&self) -> FactorSize {
        self.size
    }

    /// Displacement of node `i` (an index into [`nodes`](Self::nodes)) along the axes per unit
    /// force on node `j` along the axes (m/N), `[axis of i][axis of j]`; zero where held.
    pub fn block(&self, i: usize, j: usize) -> [[f64; 3]; 3] {
        self.row[i].map(|r| {
            self.row[j].map(|c| {
                if r == NONE || c == NONE { 0.0 } else { self.matrix[(r as usize, c as usize)] }
            })
        })
    }
}
