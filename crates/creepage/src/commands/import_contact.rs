//! Contact histories of other codes, from CSV.

use std::path::PathBuf;

use crate::check::{ImportFiles, Imported};
use serde::Serialize;

use crate::Error;
use crate::commands::outputs::{claim_grid, shown};

/// The tables to read, and the file to write.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ImportContactOptions {
    /// Nodes, one a row: x, y, z (m) and, if wanted, area (m2); the first row is node 0
    #[cfg_attr(feature = "clap", arg(long, value_name = "NODES.csv"))]
    pub nodes: PathBuf,
    /// Faces, one a row: n0, n1, n2, n3 (counter-clockwise seen from outside) and body (0 disk,
    /// 1 bar)
    #[cfg_attr(feature = "clap", arg(long, value_name = "FACES.csv"))]
    pub faces: PathBuf,
    /// Values, one row per time and node, times rising: time, node, pressure, shear_x, shear_y,
    /// shear_z, slip_velocity_x, ..., and, if wanted, gap, mu, state, velocity_x, ...,
    /// displacement_x, ...; nodes without a row are open
    #[cfg_attr(feature = "clap", arg(long, value_name = "VALUES.csv"))]
    pub values: PathBuf,
    /// The file to write
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "FILE.vtkhdf", default_value = "contact.vtkhdf")
    )]
    pub out: PathBuf,
}

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
    let size = crate::check::import_contact(&ImportFiles { nodes, faces, values, out })?;
    Ok(ImportedContact { file: out.clone(), size })
}
