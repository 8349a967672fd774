//! An elastic disk that rolls on an elastic bar: meshes and sets, masses, the rigid hub that drives the disk,
//! the load, the preload, the quiet ends of the bar, the stable step.

mod bodies;
mod disturbance;
mod guards;
mod mesh_file;
mod preload;
mod start;
mod store;
mod through_meshio;
mod window;

pub use bodies::{elements, model};
pub use start::{restart, restart_without_moves, stable_limit, start};
