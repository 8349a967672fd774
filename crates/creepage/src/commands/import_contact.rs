//! Contact histories of other codes, from CSV.

use std::path::PathBuf;

use crate::check::{ImportContactOptions, Imported};
use serde::Serialize;

use crate::Error;
use crate::commands::outputs::{claim_grid, shown};

/// A contact history that was written: the document of `creepage import-contact --json`.
#[derive(Clone, Debug, Serialize)]
pub struct ImportedContact {
    /// The file.
    #[serde(serialize_with = "shown")]
    pub file: PathBuf,
    /// Its size.
    #[serde(flatten)]
    pub size: Imported,
}

/// Brings a contact history of another code into the layout that [`check`](crate::check()) reads.
///
/// # Errors
/// Tables that cannot be read; a file that cannot be written, or is not to be written over.
pub fn import_contact(options: &ImportContactOptions) -> Result<ImportedContact, Error> {
    let ImportContactOptions { nodes, faces, values, out } = options;
    claim_grid("--out", out, &[nodes, faces, values].map(PathBuf::clone))?;
    let size = crate::check::import_contact(options)?;
    Ok(ImportedContact { file: out.clone(), size })
}
