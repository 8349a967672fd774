//! A mesh: nodes, elements, and the bodies that they make up with their sets and surfaces.

use crate::SmoothSurface;
use std::collections::BTreeMap;
use std::ops::Range;

/// A mesh of several bodies with contiguous node and element ranges.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Reference coordinates (m).
    pub nodes: Vec<[f64; 3]>,
    /// Node indices of each hexahedron in `VTK_HEXAHEDRON` order.
    pub hexes: Vec<[u32; 8]>,
    /// The bodies; their ranges tile `nodes` and `hexes` in order.
    pub bodies: Vec<Body>,
}

/// One body of a [`Mesh`]: ranges and named sets, all in global indices.
#[derive(Clone, Debug)]
pub struct Body {
    /// `"disk"` or `"bar"` for the generated meshes.
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

/// A set of element faces with, where the geometry is generated, its exact shape.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Faces, in the order of the generator.
    pub faces: Vec<Face>,
    /// The exact undeformed surface on which the face nodes lie.
    pub smooth: Option<SmoothSurface>,
}

/// A quadrilateral element face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Corner nodes, counter-clockwise seen from outside the body.
    pub nodes: [u32; 4],
    /// The element that the face belongs to.
    pub hex: u32,
}
