//! Tensor-product grids: the bar and the block.

use crate::error::{MAX_ELEMENTS, within};
use crate::{Allowed, Body, Face, HEX_FACES, Mesh, MeshError, Parameter, Surface};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::ops::Range;

/// The numbering of a grid: `x` runs slowest, then `z`, then `y`, so that contiguous ranges of elements are
/// slabs across `x`.
#[derive(Clone, Copy)]
pub(crate) struct Grid {
    /// Cells along `x`, `y`, `z`.
    pub cells: [usize; 3],
}

impl Grid {
    /// Index of the node `i`, `j`, `k` along `x`, `y`, `z`.
    pub fn node(&self, i: usize, j: usize, k: usize) -> u32 {
        let [_, ny, nz] = self.cells;
        ((i * (nz + 1) + k) * (ny + 1) + j) as u32
    }

    /// Index of the cell `i`, `j`, `k` along `x`, `y`, `z`.
    pub fn hex(&self, i: usize, j: usize, k: usize) -> u32 {
        let [_, ny, nz] = self.cells;
        ((i * nz + k) * ny + j) as u32
    }

    /// The mesh of one body with its nodes at the tensor product of the three divisions.
    pub fn mesh(&self, name: &str, xs: &[f64], ys: &[f64], zs: &[f64]) -> Mesh {
        let [nx, ny, nz] = self.cells;
        let mut nodes = Vec::with_capacity(xs.len() * ys.len() * zs.len());
        for &x in xs {
            for &z in zs {
                nodes.extend(ys.iter().map(|&y| Vector3::new(x, y, z)));
            }
        }
        let mut hexes = Vec::with_capacity(nx * ny * nz);
        for i in 0..nx {
            for k in 0..nz {
                for j in 0..ny {
                    let at = |a: usize, b: usize, c: usize| self.node(i + a, j + b, k + c);
                    hexes.push([
                        at(0, 0, 0),
                        at(1, 0, 0),
                        at(1, 1, 0),
                        at(0, 1, 0),
                        at(0, 0, 1),
                        at(1, 0, 1),
                        at(1, 1, 1),
                        at(0, 1, 1),
                    ]);
                }
            }
        }
        let body = Body {
            name: name.to_owned(),
            nodes: 0..nodes.len(),
            hexes: 0..hexes.len(),
            node_sets: BTreeMap::new(),
            surfaces: BTreeMap::new(),
        };
        Mesh { nodes, hexes, bodies: vec![body], symmetric: false }
    }

    /// Faces number `side` (in the order of [`HEX_FACES`]) of a box of cells.
    pub fn faces(&self, mesh: &Mesh, cells: [Range<usize>; 3], side: usize) -> Vec<Face> {
        let [xs, ys, zs] = cells;
        let mut faces = Vec::with_capacity(xs.len() * ys.len() * zs.len());
        for i in xs {
            for k in zs.clone() {
                for j in ys.clone() {
                    let hex = self.hex(i, j, k);
                    let corners = mesh.hexes[hex as usize];
                    faces.push(Face { nodes: HEX_FACES[side].map(|c| corners[c]), hex });
                }
            }
        }
        faces
    }

    /// Faces of one whole side of the grid.
    pub fn side(&self, mesh: &Mesh, side: usize) -> Vec<Face> {
        let mut cells = self.cells.map(|n| 0..n);
        let axis = side / 2;
        let layer = if side.is_multiple_of(2) { 0 } else { self.cells[axis].saturating_sub(1) };
        if self.cells[axis] > 0 {
            cells[axis] = layer..layer + 1;
        }
        self.faces(mesh, cells, side)
    }
}

/// Nodes of a set of faces, sorted and without repetition.
pub(crate) fn nodes_of(faces: &[Face]) -> Vec<u32> {
    let mut nodes: Vec<u32> = faces.iter().flat_map(|f| f.nodes).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// A box of cells between the planes `x = divisions[0][i]`, `y = divisions[1][j]`, `z = divisions[2][k]` (m).
///
/// Body `"block"`; surfaces and node sets `"x-"`, `"x+"`, `"y-"`, `"y+"`, `"z-"`, `"z+"`. Divisions
/// come from [`graded_line`](crate::graded_line) or are any finite, ascending numbers.
///
/// # Errors
/// [`MeshError::OutOfRange`] for a division with fewer than two planes or not ascending, and
/// [`MeshError::TooManyElements`].
pub fn graded_block(divisions: [&[f64]; 3]) -> Result<Mesh, MeshError> {
    for planes in divisions {
        let fault = match planes.windows(2).find(|w| w[0].is_nan() || w[1] <= w[0] || w[1].is_nan())
        {
            Some(w) => Some(w[1]),
            None if planes.len() < 2 => planes.first().copied().or(Some(f64::NAN)),
            None => None,
        };
        if let Some(value) = fault {
            within(false, Parameter::Plane, value, Allowed::Ascending)?;
        }
    }
    let cells = divisions.map(|d| d.len() - 1);
    let estimate = cells.iter().map(|&n| n as f64).product::<f64>();
    if estimate > MAX_ELEMENTS {
        let size = divisions[0][1] - divisions[0][0];
        return Err(MeshError::TooManyElements { body: "block", size, estimate });
    }
    Ok(named_block(cells, divisions))
}

/// A box of `n` equal cells along each axis and edge lengths `size` (m), one corner at the origin.
///
/// Body `"block"`; surfaces and node sets `"x-"`, `"x+"`, `"y-"`, `"y+"`, `"z-"`, `"z+"`. Counts of
/// zero are raised to one; edge lengths must be positive and are not checked.
pub fn block(n: [usize; 3], size: [f64; 3]) -> Mesh {
    let cells = n.map(|n| n.max(1));
    let [xs, ys, zs] = [0, 1, 2]
        .map(|a| (0..=cells[a]).map(|i| size[a] * i as f64 / cells[a] as f64).collect::<Vec<_>>());
    named_block(cells, [&xs, &ys, &zs])
}

fn named_block(cells: [usize; 3], [xs, ys, zs]: [&[f64]; 3]) -> Mesh {
    let grid = Grid { cells };
    let mut mesh = grid.mesh("block", xs, ys, zs);
    for (side, name) in ["x-", "x+", "y-", "y+", "z-", "z+"].into_iter().enumerate() {
        let faces = grid.side(&mesh, side);
        let body = &mut mesh.bodies[0];
        body.node_sets.insert(name.to_owned(), nodes_of(&faces));
        body.surfaces.insert(name.to_owned(), Surface { faces, smooth: None, irregularity: None });
    }
    mesh
}
