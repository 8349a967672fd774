//! The stiffness of supported bodies as a sparse matrix, and its Cholesky factor.

use crate::reference::dissection::{Graph, nested_dissection};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatMut, MatRef, Par, Side, Spec};
use mesh::Mesh;
use nalgebra::Vector3;
use solid::Material;
use statics::{Axis, Supports};
use thiserror::Error;

/// Stiffness of one hexahedron with given corners (m) and material, about the undeformed state
/// (N/m); row `3 node + axis`, and columns alike. For example [`solid::element_stiffness`] with an element's options.
pub type ElementStiffness<'a> =
    dyn Fn(&[Vector3<f64>; 8], &Material) -> [[f64; 24]; 24] + Sync + 'a;

/// No unknown: the node is held in that direction.
pub(crate) const NONE: u32 = u32::MAX;

/// Unknowns of tied groups with more neighbours than this (a hub, not a pair of nodes) are
/// eliminated late, just before the surface: eliminated earlier, they would couple all their neighbours.
const MANY_NEIGHBOURS: usize = 200;

/// A pivot below this fraction of its unknown's diagonal stiffness is round-off. In a supported body elimination
/// reduces a pivot only by about the number of elements up to the support.
const LOST: f64 = 1e-12;

/// All arithmetic of a factorisation runs on one thread, for the same bits on any machine load. Callers factor
/// several bodies in parallel instead.
const SERIAL: Par = Par::Seq;

/// Why a stiffness cannot be assembled or factored.
#[derive(Debug, Error)]
pub enum SparseError {
    /// The numbers of materials and of bodies differ.
    #[error("{bodies} bodies need as many materials, not {materials}")]
    Materials {
        /// Bodies in the mesh.
        bodies: usize,
        /// Materials given.
        materials: usize,
    },
    /// A support, or the list of nodes to eliminate last, has a node that does not exist.
    #[error("a support names node {node}, the mesh has {nodes}")]
    Node {
        /// The node named.
        node: u32,
        /// Nodes of the mesh.
        nodes: usize,
    },
    /// A node is in two supports.
    #[error("node {node} belongs to two supports")]
    Twice {
        /// The node.
        node: u32,
    },
    /// The matrix is not positive definite.
    #[error(
        "the stiffness is not positive definite at node {node}, axis {axis}: the body can move \
         freely, or an element around this node is inverted"
    )]
    NotPositive {
        /// A node of the unknown whose pivot failed (mesh index).
        node: usize,
        /// 0, 1, 2 for x, y, z.
        axis: usize,
    },
    /// Everything is held.
    #[error("no node is free to move")]
    NothingFree,
    /// The factor does not fit into memory.
    #[error("no memory for the factor of {unknowns} unknowns")]
    Memory {
        /// Number of unknowns.
        unknowns: usize,
    },
}

/// The numbering of the unknown displacements of supported bodies, in elimination order.
///
/// Held directions have no unknown; a tied group has one for each loaded axis.
pub struct Unknowns {
    /// Unknown of each node and axis, or [`NONE`].
    of: Vec<[u32; 3]>,
    count: usize,
    /// Number of unknowns of the nodes that are eliminated last.
    last: usize,
    /// Free nodes and tied groups as vertices; those of one element are neighbours.
    graph: Graph,
    /// Unknown of each vertex and axis, or [`NONE`].
    dofs: Vec<[u32; 3]>,
}

impl Unknowns {
    /// Numbers the unknowns of `mesh` under `supports` by nested dissection; those of the nodes
    /// in `last` (mesh indices) are eliminated last, in their order.
    ///
    /// # Errors
    /// [`SparseError::Node`], [`SparseError::Twice`], [`SparseError::NothingFree`].
    pub fn new(mesh: &Mesh, supports: &Supports, last: &[u32]) -> Result<Self, SparseError> {
        let nodes = mesh.nodes.len();
        let named = supports.held.iter().chain(supports.tied.iter().flat_map(|t| &t.nodes));
        if let Some(&node) =
            named.chain(&supports.sliding).chain(last).find(|&&n| n as usize >= nodes)
        {
            return Err(SparseError::Node { node, nodes });
        }
        // Vertices of the graph: free nodes and tied groups, each with up to three unknowns.
        const FREE: u32 = u32::MAX - 1;
        let mut vertex = vec![FREE; nodes];
        let mut claim = |node: u32, as_vertex: u32| {
            let slot = &mut vertex[node as usize];
            if *slot != FREE {
                return Err(SparseError::Twice { node });
            }
            *slot = as_vertex;
            Ok(())
        };
        for &node in &supports.held {
            claim(node, NONE)?;
        }
        let mut axes = Vec::new();
        let mut at = Vec::new();
        for group in &supports.tied {
            let loaded = group.axes.map(|a| matches!(a, Axis::Loaded(_)));
            let id = if loaded == [false; 3] { NONE } else { axes.len() as u32 };
            for &node in &group.nodes {
                claim(node, id)?;
            }
            if let (Some(&first), true) = (group.nodes.first(), id != NONE) {
                axes.push(loaded);
                at.push(mesh.nodes[first as usize]);
            }
        }
        let mut slides = vec![false; nodes];
        supports.sliding.iter().for_each(|&n| slides[n as usize] = true);
        for ((slot, x), slides) in vertex.iter_mut().zip(&mesh.nodes).zip(slides) {
            if *slot == FREE {
                *slot = axes.len() as u32;
                axes.push([true, !slides, true]);
                at.push(*x);
            }
        }
        let cliques = mesh.hexes.iter().map(|hex| hex.map(|n| vertex[n as usize]));
        let graph = Graph::of_cliques(axes.len(), cliques);

        let mut late = vec![false; axes.len()];
        let mut end = Vec::new();
        for &node in last {
            let v = vertex[node as usize];
            if v != NONE && !std::mem::replace(&mut late[v as usize], true) {
                end.push(v);
            }
        }
        let (joining, inner): (Vec<u32>, Vec<u32>) = (0..axes.len() as u32)
            .filter(|&v| !late[v as usize])
            .partition(|&v| graph.neighbours(v).len() > MANY_NEIGHBOURS);
        let mut order = nested_dissection(&graph, &at, inner);
        order.extend(joining);
        let before = order.len();
        order.extend(end);

        let mut dofs = vec![[NONE; 3]; axes.len()];
        let (mut count, mut first_last) = (0, 0);
        for (i, &v) in order.iter().enumerate() {
            if i == before {
                first_last = count;
            }
            for axis in 0..3 {
                if axes[v as usize][axis] {
                    dofs[v as usize][axis] = count;
                    count += 1;
                }
            }
        }
        if before == order.len() {
            first_last = count;
        }
        if count == 0 {
            return Err(SparseError::NothingFree);
        }
        let of =
            vertex.iter().map(|&v| if v == NONE { [NONE; 3] } else { dofs[v as usize] }).collect();
        let (count, last) = (count as usize, (count - first_last) as usize);
        Ok(Self { of, count, last, graph, dofs })
    }

    /// Number of unknowns.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Number of unknowns of the nodes that are eliminated last.
    pub fn last(&self) -> usize {
        self.last
    }

    /// Unknown of a node (mesh index) along an axis (0, 1, 2 for x, y, z); `None` where it is held.
    ///
    /// # Panics
    /// If the node or the axis does not exist.
    pub fn of(&self, node: usize, axis: usize) -> Option<usize> {
        let dof = self.of[node][axis];
        (dof != NONE).then_some(dof as usize)
    }

    fn not_positive(&self, dof: usize) -> SparseError {
        let (node, axis) = self.owner(dof);
        SparseError::NotPositive { node, axis }
    }

    /// The node and axis of an unknown.
    fn owner(&self, dof: usize) -> (usize, usize) {
        let find = |(node, of): (usize, &[u32; 3])| {
            of.iter().position(|&d| d as usize == dof).map(|axis| (node, axis))
        };
        self.of.iter().enumerate().find_map(find).unwrap_or((0, 0))
    }
}

/// The upper triangle of a stiffness matrix (N/m) in compressed columns.
pub struct StiffnessMatrix {
    columns: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl StiffnessMatrix {
    /// Assembles the elements of all bodies, one material per body, in the order of the mesh. `unknowns` are those of
    /// the same mesh.
    ///
    /// # Errors
    /// [`SparseError::Materials`].
    pub fn assemble(
        mesh: &Mesh,
        materials: &[Material],
        element: &ElementStiffness<'_>,
        unknowns: &Unknowns,
    ) -> Result<Self, SparseError> {
        if mesh.bodies.len() != materials.len() {
            let (bodies, materials) = (mesh.bodies.len(), materials.len());
            return Err(SparseError::Materials { bodies, materials });
        }
        let mut matrix = Self::pattern(unknowns);
        for (body, material) in mesh.bodies.iter().zip(materials) {
            for hex in &mesh.hexes[body.hexes.clone()] {
                let k = element(&hex.map(|n| mesh.at(n)), material);
                let dof = hex.map(|n| unknowns.of[n as usize]);
                for (column, entries) in k.iter().enumerate() {
                    let j = dof[column / 3][column % 3];
                    if j == NONE {
                        continue;
                    }
                    let range = matrix.columns[j as usize]..matrix.columns[j as usize + 1];
                    let rows = &matrix.rows[range.clone()];
                    let values = &mut matrix.values[range];
                    for (row, k) in entries.iter().enumerate() {
                        let i = dof[row / 3][row % 3];
                        if i != NONE && i <= j {
                            // The pattern holds every pair of an element's unknowns.
                            values[rows.partition_point(|&r| r < i as usize)] += k;
                        }
                    }
                }
            }
        }
        Ok(matrix)
    }

    /// The matrix with an entry for every pair of unknowns that are neighbours in the graph, all zero.
    fn pattern(unknowns: &Unknowns) -> Self {
        let mut vertex_of = vec![0; unknowns.count];
        for (v, dofs) in unknowns.dofs.iter().enumerate() {
            dofs.iter().filter(|&&d| d != NONE).for_each(|&d| vertex_of[d as usize] = v as u32);
        }
        let mut columns = Vec::with_capacity(unknowns.count + 1);
        columns.push(0);
        let mut rows = Vec::new();
        for (j, &v) in vertex_of.iter().enumerate() {
            let begin = rows.len();
            for &n in unknowns.graph.neighbours(v).iter().chain([&v]) {
                let above = |&d: &u32| d != NONE && d as usize <= j;
                rows.extend(
                    unknowns.dofs[n as usize].into_iter().filter(above).map(|d| d as usize),
                );
            }
            rows[begin..].sort_unstable();
            columns.push(rows.len());
        }
        let values = vec![0.0; rows.len()];
        Self { columns, rows, values }
    }

    fn view(&self) -> SparseColMatRef<'_, usize, f64> {
        let n = self.columns.len() - 1;
        let symbolic = SymbolicSparseColMatRef::new_checked(n, n, &self.columns, None, &self.rows);
        SparseColMatRef::new(symbolic, &self.values)
    }
}

/// The structure of a Cholesky factor, for any matrix with the same unknowns.
pub struct Symbolic {
    symbolic: SymbolicCholesky<usize>,
}

impl Symbolic {
    /// Analyses the pattern of `matrix`; the unknowns are eliminated in the order of their numbers.
    ///
    /// # Errors
    /// [`SparseError::Memory`].
    pub fn new(matrix: &StiffnessMatrix) -> Result<Self, SparseError> {
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let pattern = matrix.view().symbolic();
        factorize_symbolic_cholesky(pattern, Side::Upper, SymmetricOrdering::Identity, params)
            .map(|symbolic| Self { symbolic })
            .map_err(|_| SparseError::Memory { unknowns: pattern.nrows() })
    }

    /// Number of stored entries of the factor.
    pub fn entries(&self) -> usize {
        self.symbolic.len_val()
    }

    /// The factor L of `matrix` = L L^T. `matrix` and `unknowns` are those of which the structure was made, or have
    /// the same pattern.
    ///
    /// # Errors
    /// [`SparseError::NotPositive`], [`SparseError::Memory`].
    pub fn factor<'a>(
        &'a self,
        matrix: &StiffnessMatrix,
        unknowns: &Unknowns,
    ) -> Result<Factor<'a>, SparseError> {
        let memory = SparseError::Memory { unknowns: unknowns.count };
        let scratch = self.symbolic.factorize_numeric_llt_scratch::<f64>(SERIAL, Spec::default());
        let Ok(mut buffer) = MemBuffer::try_new(scratch) else { return Err(memory) };
        let mut values = Vec::new();
        if values.try_reserve_exact(self.entries()).is_err() {
            return Err(memory);
        }
        values.resize(self.entries(), 0.0);
        let result = self.symbolic.factorize_numeric_llt(
            &mut values,
            matrix.view(),
            Side::Upper,
            LltRegularization::default(),
            SERIAL,
            MemStack::new(&mut buffer),
            Spec::default(),
        );
        match result {
            Ok(_) => {
                let factor = Factor { symbolic: &self.symbolic, values };
                match factor.lost_pivot(matrix) {
                    None => Ok(factor),
                    Some(dof) => Err(unknowns.not_positive(dof)),
                }
            }
            Err(LltError::NonPositivePivot { index }) => Err(unknowns.not_positive(index)),
        }
    }
}

/// A Cholesky factor.
pub struct Factor<'a> {
    symbolic: &'a SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl Factor<'_> {
    /// Solves K X = B in place. `right` holds `columns` right-hand sides (N) one after the other, each by unknown, and
    /// is overwritten with the displacements (m).
    ///
    /// # Errors
    /// [`SparseError::Memory`].
    ///
    /// # Panics
    /// If the length of `right` is not the number of unknowns times `columns`.
    pub fn solve(&self, right: &mut [f64], columns: usize) -> Result<(), SparseError> {
        let n = self.symbolic.nrows();
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(columns, SERIAL);
        let Ok(mut buffer) = MemBuffer::try_new(scratch) else {
            return Err(SparseError::Memory { unknowns: n });
        };
        LltRef::new(self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(right, n, columns),
            SERIAL,
            MemStack::new(&mut buffer),
        );
        Ok(())
    }

    /// An unknown whose pivot is only the round-off of its stiffness. Where a body is free to move, the last pivot is
    /// such a number, and may be positive by chance.
    fn lost_pivot(&self, matrix: &StiffnessMatrix) -> Option<usize> {
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else { return None };
        let factor = SupernodalLltRef::new(symbolic, &self.values);
        (0..symbolic.n_supernodes()).find_map(|s| {
            let node = factor.supernode(s);
            (0..node.val().ncols()).find_map(|c| {
                let dof = node.start() + c;
                // The diagonal ends its column of the upper triangle.
                let stiffness = matrix.values[matrix.columns[dof + 1] - 1];
                (node.val()[(c, c)].powi(2) < LOST * stiffness).then_some(dof)
            })
        })
    }

    /// The inverse of the stiffness condensed to the last `count` unknowns: the block of K^-1
    /// that belongs to them (m/N).
    ///
    /// With those unknowns eliminated last, L L^T restricted to them is their Schur complement
    /// S = K_ss - K_si K_ii^-1 K_is, and (K^-1)_ss = S^-1: no right-hand side has to be solved.
    pub(crate) fn inverse_of_last(&self, count: usize) -> Mat<f64> {
        let first = self.symbolic.nrows() - count;
        let mut lower = Mat::<f64>::zeros(count, count);
        if let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() {
            let factor = SupernodalLltRef::new(symbolic, &self.values);
            for s in 0..symbolic.n_supernodes() {
                let node = factor.supernode(s);
                copy_last(&mut lower, first, node.start(), node.pattern(), node.val());
            }
        }
        let mut inverse = Mat::<f64>::zeros(count, count);
        faer::linalg::triangular_inverse::invert_lower_triangular(
            inverse.as_mut(),
            lower.as_ref(),
            SERIAL,
        );
        let mut product = lower;
        use faer::linalg::matmul::triangular::{BlockStructure, matmul};
        matmul(
            product.as_mut(),
            BlockStructure::TriangularLower,
            faer::Accum::Replace,
            inverse.transpose(),
            BlockStructure::TriangularUpper,
            inverse.as_ref(),
            BlockStructure::TriangularLower,
            1.0,
            SERIAL,
        );
        for j in 0..count {
            for i in 0..j {
                product[(i, j)] = product[(j, i)];
            }
        }
        product
    }
}

/// Copies the part of a supernode that lies in the last rows and columns.
fn copy_last(
    lower: &mut Mat<f64>,
    first: usize,
    start: usize,
    pattern: &[usize],
    val: MatRef<'_, f64>,
) {
    let columns = val.ncols();
    for c in first.saturating_sub(start)..columns {
        let column = start + c - first;
        for r in c..columns {
            lower[(start + r - first, column)] = val[(r, c)];
        }
        for (r, &row) in pattern.iter().enumerate() {
            lower[(row - first, column)] = val[(columns + r, c)];
        }
    }
}
