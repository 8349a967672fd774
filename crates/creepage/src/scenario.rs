//! A scenario: the bodies of a case, what drives them, and their state when they begin to move.
//!
//! A [`Model`] is the discretised bodies; a [`Start`] is the [`dynamics::Simulation`] in the state in which they begin
//! to move, with what a run reports of it. How both are made of a case stands in the folder of the scenario, today
//! `disk_on_bar` alone; [`Model`] and [`numbers`](mod@numbers) name its two bodies as well.

mod disk_on_bar;
mod draw;
pub mod error;
mod half_space;
pub mod memory;
pub mod model;
pub mod numbers;
pub mod preload;
pub mod progress;
pub mod remedy;
mod size;
pub mod start;
#[cfg(test)]
mod tests;
pub mod wheel_on_rail;

// there is one scenario of finite elements; with a second one, these functions choose by the case
pub use disk_on_bar::{model, restart, restart_without_moves, start};
pub use error::{MeshFileError, ScenarioError};
pub use half_space::{HalfSpaceModel, SurfacePoints, drive, half_space, position};
pub use model::{BAR, DISK, Model};
pub use preload::{PreloadError, PreloadReport};
pub use progress::{Cost, Progress, Stage};
pub use remedy::Remedy;
pub use size::{elements, stable_limit};
pub use start::{InitialState, KeptState, RollingRadius, Start};
