//! The mesh of a case.

use std::path::PathBuf;

use crate::run::MeshReport;
use serde::Deserialize;

use crate::commands::outputs::claim_grid;
use crate::commands::values::MESH;
use crate::rule::RANKS;
use crate::{CaseSource, Error, Listener};

/// Whose mesh, and where to write it.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct MeshOptions {
    /// Write the mesh and its sets here; mesh.file reads it again
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.vtu|FILE.vtkhdf|FILE.msh",
        value_parser = |file: &str| MESH.read(file)))]
    pub out: Option<PathBuf>,
    /// Report also how so many processes would share a run
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = |n: &str| RANKS.read(n)))]
    pub ranks: Option<usize>,
    /// The case.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub case: CaseSource,
}

/// Builds the mesh of a case. The listener hears the case's warnings.
///
/// # Errors
/// A case or a mesh that cannot be used; a file that cannot be written, or is not to be written over.
pub fn mesh(options: &MeshOptions, listener: &mut dyn Listener) -> Result<MeshReport, Error> {
    MESH.check("--out", options.out.as_ref())?;
    RANKS.check("--ranks", options.ranks.as_ref())?;
    let case = options.case.load(listener)?;
    if let Some(out) = &options.out {
        claim_grid("--out", out, &case.inputs())?;
    }
    let found = crate::run::mesh_report(&case, options.out.as_deref(), options.ranks);
    found.map_err(|error| case.placed(error))
}
