//! What a case file says.
//!
//! A case is a TOML file ([`schema`]); it is read with its `extends` and `--set` layers
//! ([`load`]), checked against the table of keys ([`keys`]) and against itself, and resolved so
//! that every default is written out.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod bodies;
pub mod check;
pub mod error;
mod excerpt;
pub mod forms;
pub mod friction_law;
pub mod hertz;
pub mod json_schema;
pub mod key;
pub mod keys;
pub mod layers;
pub mod load;
pub mod mesh_file;
pub mod name;
mod naming;
pub mod schema;
mod section;
mod table;
#[cfg(test)]
mod tests;
pub mod validation;

pub use error::{CaseError, KeyError};
pub use excerpt::Excerpt;
pub use json_schema::json_schema;
pub use load::{error_at_key, inputs};
pub use schema::Case;
