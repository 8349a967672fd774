//! Linear-elastic hexahedra under finite rotation.
//!
//! The element is the uniform-gradient hexahedron of Flanagan and Belytschko (1981) in a total Lagrangian
//! formulation with the law of St. Venant and Kirchhoff: it is exactly objective, and integrates no stress rates,
//! so that stresses do not drift. Chosen elements may be fully integrated instead. The internal force is computed in
//! batches of eight elements; the vector instructions are chosen at run time.
//!
//! SI units; global axes x, y, z; positions and gradients refer to the undeformed (reference) configuration, that
//! of the mesh. Nodal arrays hold one [`mesh::Padded`] per node of the mesh. Corners of elements are in
//! `VTK_HEXAHEDRON` order.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod blocks;
mod centrifugal;
mod device;
mod formulation;
mod full;
mod full_stiffness;
mod gauss;
mod geometry;
pub mod invariants;
mod kernel;
mod lanes;
pub mod linear;
mod mass;
mod material;
mod peak;
mod record;
mod solid;
mod stable;
mod stiffness;
mod stress;
mod tensor;

pub use blocks::FULL_COST;
pub use centrifugal::Centrifugal;
pub use device::{DeviceElements, DeviceKind};
pub use formulation::{Element, Elements, Formulation, Volumetric};
pub use geometry::{displacement_gradient, mean_gradient, nodal_gradients, surface_derivatives};
pub use lanes::Level;
pub use mass::lumped_mass;
pub use material::{Material, MaterialError};
pub use peak::multiply_additions;
pub use solid::{ElementState, ForceSums, Solid, SolidError, Viscosity};
pub use stable::{element_frequency_bound, largest_frequency, nodal_stiffness_bounds};
pub use stiffness::element_stiffness;
