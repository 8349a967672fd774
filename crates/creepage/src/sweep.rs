//! A sweep file becomes many runs.
//!
//! [`Sweep::load`] reads and checks the file, [`Sweep::points`] resolves the case of every
//! run, [`plan::prepare`] lays the sweep's folder out, [`pool::run`] runs what is not yet done,
//! and [`collect::collect`] gathers the results.

pub mod collect;
mod ensemble;
pub mod file;
pub mod plan;
pub mod points;
pub mod pool;
pub mod result;
mod table;
#[cfg(test)]
mod tests;

pub use collect::collect;
pub use file::Sweep;
pub use plan::{Plan, SweepError};
pub use points::Point;
pub use pool::{Budget, Watched};
pub use result::{SweepPlan, SweepResult, SweepRun};
pub use table::{Cell, Column, Table};
