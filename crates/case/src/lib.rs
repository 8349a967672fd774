//! A case file becomes a run.
//!
//! A case is a TOML file ([`schema`]); it is read with its `extends` and `--set` layers
//! ([`load`]), checked against the table of keys ([`keys`]) and against itself, and resolved so
//! that every default is written out. [`mod@run`] then takes the resolved case to its results.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod bench;
mod bodies;
pub mod check;
mod checkpoint;
pub mod derived;
mod disk;
mod disturbance;
pub mod error;
mod excerpt;
pub mod folder;
pub mod forms;
mod friction_law;
mod guards;
mod held;
pub mod hertz;
pub mod json_schema;
pub mod key;
pub mod keys;
pub mod layers;
pub mod load;
mod log;
mod means;
mod memory;
mod mesh_file;
mod mesh_mode;
pub mod mesh_report;
mod model;
pub mod name;
mod numbers;
mod postmortem;
pub mod preload;
mod probes;
pub mod progress;
mod record;
pub mod remedy;
pub mod resume;
pub mod run;
mod run_error;
pub mod schema;
mod section;
mod start;
mod summary;
mod table;
#[cfg(test)]
mod tests;
mod text_file;
mod validation;

pub use bench::{BlockElement, bench, bench_block};
pub use error::{CaseError, KeyError};
pub use excerpt::Excerpt;
pub use json_schema::json_schema;
pub use load::{error_at_key, inputs};
pub use log::REFUSED;
pub use memory::{BYTES_PER_ELEMENT, free_mb};
pub use mesh_file::MeshFileError;
pub use mesh_report::mesh_report;
pub use model::elements;
pub use progress::{Progress, Stage};
pub use remedy::Remedy;
pub use run::{RunOptions, run};
pub use run_error::RunError;
pub use schema::Case;
pub use solid::Level;
pub use start::stable_limit;
