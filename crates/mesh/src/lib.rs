//! Hexahedral meshes of a disk and a bar: generators, import, node sets, surfaces, quality.
//!
//! SI units; `x` is the rolling direction, `y` lateral, `z` up. The apex of the bar's top is
//! `z = 0`; the undeformed disk touches it at the origin with its centre at `(0, 0, R)`. Nodes and elements
//! are counted from 0; corners of hexahedra are in `VTK_HEXAHEDRON` order ([`HEX_CORNERS`]).

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod bar;
mod box_tree;
mod check;
mod disk;
mod error;
pub mod geometry;
mod grading;
mod grid;
mod half;
mod hex;
pub mod import;
mod irregularity;
mod join;
mod layers;
mod mesh;
mod near;
mod outer_faces;
mod padded;
mod patch;
pub mod profile;
mod quality;
mod ring;
mod shells;
mod slice;
mod smooth;
mod transfer;
mod zone;

pub use bar::{Bar, bar};
pub use box_tree::BoxTree;
pub use check::check;
pub use disk::{Disk, disk};
pub use error::{Allowed, MAX_ELEMENTS, MeshError, Parameter};
pub use grading::graded_line;
pub use grid::{block, graded_block};
pub use half::{NotSymmetric, half};
pub use hex::{HEX_CORNERS, HEX_EDGES, HEX_FACES, hex_volume, quad_corner_areas};
pub use irregularity::{
    Along, CLOSED, HIGHEST, HeightError, HeightGrid, HeightTable, Heights, Irregularity,
};
pub use join::join;
pub use layers::layers_below;
pub use mesh::{Body, Face, Mesh, Surface};
pub use outer_faces::outer_faces;
pub use padded::Padded;
pub use patch::seven_hex_patch;
pub use quality::{Quality, quality};
pub use slice::{NoSlice, across};
pub use smooth::SmoothSurface;
pub use transfer::{Chart, Source, sources_ahead};
pub use zone::{FineZone, Grading};
