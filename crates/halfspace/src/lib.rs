//! Rolling contact of two equal elastic half-spaces with inertia: no mesh in the depth, no penalty, exact friction.
//!
//! The shear traction `tau` (Pa) that the lower body exerts on the upper one moves the upper surface against the lower
//! one by `u` (m). For each wavenumber of the plane of contact [`HalfSpaces::compliance`] gives `u` as a function of the
//! complex frequency; [`Quadrature`] turns that into weights `w_m` of the time step, and [`Kernel`] cuts them to the
//! patch, so that
//!
//! ```text
//! u_n = sum over m of  w_m * tau_(n-m)                       (* convolution in the plane)
//! s_n = rigid slip + (3/2 u_n - 2 u_(n-1) + 1/2 u_(n-2))/dt
//! ```
//!
//! with the slip velocity `s` of the upper body against the lower one, and friction between `tau` and `s` of the same
//! instant at every point of the patch ([`Rolling`]).
//!
//! Equal materials: shear does not move the normal problem, and the pressure is Hertz's, or that of [`press`] for
//! another gap.
//!
//! # Frame
//! Both materials stand, and the patch travels in +x over them. The grid is periodic and belongs to the material: the
//! patch rolls around it. Nothing is felt across the seam, since the weights are zero beyond half of the grid: outside the
//! patch the traction is zero, so that only points no farther apart than the patch is long must feel each other. So no
//! image of the patch is felt, which a periodic kernel has (Cochard and Rice 1997 cut theirs for the same
//! reason).
//!
//! SI units.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod compliance;
mod ellipse;
mod fault;
mod history;
mod kalker;
mod kernel;
mod normal;
mod patch;
mod plane;
mod quadrature;
mod return_mapping;
mod rolling;
mod stability;
mod steady;
mod subsurface;
mod tangential;

pub use compliance::{Compliance, HalfSpaces};
pub use ellipse::Ellipse;
pub use fault::{Fault, FaultSetup};
pub use kalker::{ClosedForms, c11};
pub use kernel::{Extent, Kernel, KernelError};
pub use normal::{Gap, PressError, Pressed, press};
pub use patch::{Patch, PressureField};
pub use quadrature::Quadrature;
pub use rolling::{
    Along, Inertia, PatchPoint, PressureFactor, Rigid, Rolling, RollingError, RollingState, Setup,
    StepSums,
};
pub use stability::{Fading, LineRolling};
pub use steady::{SteadyError, SteadyRolling, steady};
pub use subsurface::{LoadedCell, plane_stress_below, stress_below};
