//! Meshes of other programs: Gmsh, Abaqus, VTU, arrays.
//!
//! [`Foreign::from_arrays`] takes arrays; [`bodies()`] checks it and makes the two bodies of it; [`fit()`] sets them against the shapes that the case
//! gives. The result has the sets and surfaces of the generated meshes, so that the solver does not
//! know where a mesh comes from. Nodes and elements are numbered anew along a curve through space:
//! the bits of a run depend neither on the file's format nor on its numbering of nodes.

mod bodies;
mod contact_surface;
mod error;
mod fit;
mod foreign;
mod order;
mod parts;
mod unit;

pub use bodies::{Imported, SetNames, bodies};
pub use error::{Fault, ImportError};
pub use fit::{Shape, fit};
pub use foreign::{Foreign, Labels, Set};
pub use unit::Unit;
