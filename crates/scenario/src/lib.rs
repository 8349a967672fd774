//! A scenario: the bodies of a case, what drives them, and their state when they begin to move.
//!
//! Everything that knows the shapes and roles of the bodies stands in the folder of its scenario, today
//! `disk_on_bar` alone. A scenario yields a [`dynamics::Simulation`] and what a run records of it.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod disk_on_bar;
pub mod error;
pub mod memory;
pub mod model;
pub mod numbers;
pub mod preload;
pub mod progress;
pub mod remedy;
pub mod start;
#[cfg(test)]
mod tests;

// there is one scenario; with a second one, these choose by the case
pub use disk_on_bar::{elements, model, restart, stable_limit, start};
pub use error::{MeshFileError, ScenarioError};
pub use model::{BAR, DISK, Model};
pub use preload::{PreloadError, PreloadReport};
pub use progress::{Progress, Stage};
pub use remedy::Remedy;
pub use start::{Facts, Found, Start};
