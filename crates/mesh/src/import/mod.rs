//! Meshes of other programs: Gmsh, Abaqus, VTU, arrays.
//!
//! [`Format::read`] makes a [`Foreign`] mesh of a file, [`Foreign::from_arrays`] of arrays. [`bodies()`] checks
//! it and makes the two bodies, disk and bar; [`fit()`] compares them with the shapes of the case. The result
//! has the sets and surfaces of the generated meshes, so that the solver need not know where a mesh comes from.
//! Nodes and elements are renumbered along a space-filling curve: the bits of a run depend neither on the file's
//! format nor on its numbering of nodes.

mod abaqus;
mod bodies;
mod contact_surface;
mod error;
mod file;
mod fit;
mod foreign;
mod gmsh;
mod joined;
mod mirror;
mod nesting;
mod order;
mod own;
mod parts;
mod set_arrays;
mod text;
mod unit;
mod vtu;

pub use abaqus::{read_abaqus, write_abaqus};
pub use bodies::{Imported, SetNames, bodies};
pub use error::{Fault, ImportError, Place, SetRole};
pub use file::Format;
pub use fit::{Shape, fit};
pub use foreign::{Foreign, Labels, Set};
pub use gmsh::{GMSH_MARK, read_gmsh, write_gmsh};
pub use unit::Unit;
pub use vtu::read_vtu;
