//! Hexahedral meshes of a disk and a bar: generators, node and face sets, surfaces, quality.
//!
//! SI units; `x` is the rolling direction, `y` lateral, `z` up. The apex of the bar's top is
//! `z = 0`; the undeformed disk touches it at the origin with its centre at `(0, 0, R)`.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod bar;
mod check;
mod disk;
mod error;
mod grading;
mod grid;
mod hex;
pub mod import;
mod join;
mod layers;
mod near;
mod padded;
mod patch;
mod quality;
mod ring;
mod slice;
mod smooth;
mod zone;

pub use bar::{Bar, bar};
pub use check::check;
pub use disk::{Disk, disk};
pub use error::{Allowed, MAX_ELEMENTS, MeshError, Parameter};
pub use grading::graded_line;
pub use grid::{block, graded_block};
pub use hex::{HEX_CORNERS, HEX_EDGES, HEX_FACES, hex_volume, quad_corner_areas};
pub use join::join;
pub use layers::layers_below;
pub use padded::Padded;
pub use patch::seven_hex_patch;
pub use quality::{Quality, quality};
pub use slice::{NoSlice, across};
pub use smooth::SmoothSurface;
pub use zone::FineZone;

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
