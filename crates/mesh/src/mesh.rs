//! A mesh: nodes, elements, and bodies with their node sets and surfaces.

use crate::{Irregularity, SmoothSurface};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::ops::Range;

/// A mesh of several bodies with contiguous node and element ranges.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Reference coordinates (m).
    pub nodes: Vec<Vector3<f64>>,
    /// Node indices of each hexahedron in `VTK_HEXAHEDRON` order.
    pub hexes: Vec<[u32; 8]>,
    /// The bodies; their ranges cover `nodes` and `hexes` in order, without gaps or overlaps.
    pub bodies: Vec<Body>,
    /// Whether this is the [half](crate::half) y >= 0 of bodies that y = 0 is a plane of symmetry of.
    pub symmetric: bool,
}

impl Mesh {
    /// Where a node is in the reference configuration (m).
    #[inline]
    pub fn at(&self, node: u32) -> Vector3<f64> {
        self.nodes[node as usize]
    }
}

/// One body of a [`Mesh`]: ranges and named sets, all in indices of the whole mesh.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name: `"disk"` or `"bar"` for the bodies of a case.
    pub name: String,
    /// Nodes of this body in [`Mesh::nodes`].
    pub nodes: Range<usize>,
    /// Elements of this body in [`Mesh::hexes`].
    pub hexes: Range<usize>,
    /// Named node sets, sorted and without repetition.
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// Named surfaces.
    pub surfaces: BTreeMap<String, Surface>,
}

/// A set of element faces, with its exact shape where that is known.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Faces, in the order of the generator; of an imported mesh, in that of the elements.
    pub faces: Vec<Face>,
    /// The exact undeformed surface on which the nodes of the faces lie; `None` where there is only the mesh.
    pub smooth: Option<SmoothSurface>,
    /// What it has beyond that shape; the mesh does not have it.
    pub irregularity: Option<Irregularity>,
}

/// A quadrilateral element face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Corner nodes, counter-clockwise seen from outside the body.
    pub nodes: [u32; 4],
    /// The element that the face belongs to, as an index in [`Mesh::hexes`].
    pub hex: u32,
}
