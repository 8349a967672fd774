//! What a case file says.
//!
//! A case is a TOML file ([`schema`]). [`Case::load`] lays the files of `extends` and the `--set` options
//! over one another ([`layers`]), checks every key against the table of keys ([`check`], [`keys`]), then the keys
//! against one another ([`validation`]), and writes every default out.
//!
//! SI units. x is the rolling direction, y the direction across, z up; the disk touches the bar's top at the
//! origin.

mod bodies;
pub mod check;
mod column;
mod contact_layers;
mod creepage;
pub mod error;
mod excerpt;
pub mod forms;
pub mod friction_law;
pub mod hertz;
pub mod json_schema;
pub mod key;
pub mod keys;
pub mod layers;
mod left_out;
pub mod load;
pub mod mesh_file;
mod model;
pub mod name;
mod naming;
mod quantity;
pub mod schema;
mod section;
mod source;
pub mod table;
#[cfg(test)]
mod tests;
mod units;
pub mod validation;
mod window;
mod words;

pub use error::{CaseError, KeyError};
pub use excerpt::Excerpt;
pub use json_schema::json_schema;
pub use load::{error_at_key, inputs};
pub use schema::Case;
pub use source::CaseSource;
