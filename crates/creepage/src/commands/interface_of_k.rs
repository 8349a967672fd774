//! The contact of LS-DYNA keyword files, to which their results refer.

use std::path::PathBuf;

use crate::ls_dyna::{Interface, Source, Units, interface};
use serde::Deserialize;

use crate::Error;
use crate::commands::values::parsed;

/// The keyword file, and which of its contacts.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InterfaceOfKOptions {
    /// The keyword file.
    pub file: PathBuf,
    /// Its units.
    #[serde(deserialize_with = "parsed")]
    pub unit: Units,
    /// The number of the wheel's side on the card of the contact.
    #[serde(default)]
    pub wheel: Option<u64>,
    /// The number of the rail's side.
    #[serde(default)]
    pub rail: Option<u64>,
}

/// Reads the contact of a keyword file of any model.
///
/// # Errors
/// A file that cannot be read; a contact that is not there, or is one of several.
pub fn interface_of_k(options: &InterfaceOfKOptions) -> Result<Interface, Error> {
    let source = Source { file: &options.file, include_outside: true };
    Ok(interface(&source, options.unit, [options.wheel, options.rail])?)
}
