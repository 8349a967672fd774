//! What a case file says.
//!
//! A case is a TOML file ([`schema`]). [`Case::load`] lays the files of `extends` and the `--set` options
//! over one another ([`layers`]), checks every key against the table of keys ([`keys`]), then the keys
//! against one another ([`validation`]), and writes every default out. The case keeps the [`places`] where its keys were
//! written, for what is found later.
//!
//! SI units. x is the rolling direction, y the direction across, z up; the disk touches the bar's top at the
//! origin.

mod bodies;
mod check;
mod column;
mod defaults;
pub mod error;
mod file;
pub mod form;
mod forms;
pub mod friction_law;
pub mod hertz;
pub mod irregularity;
mod json_schema;
pub mod key;
pub mod keys;
pub mod layers;
mod left_out;
mod load;
pub mod mesh_file;
pub mod name;
pub mod places;
mod profile_file;
mod quantity;
pub mod reference;
pub mod schema;
mod section;
pub mod table;
#[cfg(test)]
mod tests;
mod units;
pub mod validation;
pub mod value;
mod wheel_on_rail;
mod window;
mod written;

pub use error::{CaseError, Excerpt, KeyError};
pub use file::CaseFile;
pub use json_schema::json_schema;
pub use load::CaseSource;
pub(crate) use profile_file::profile_at;
pub use schema::Case;
pub use written::Written;
