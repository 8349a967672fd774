//! `creepage mesh`.

use std::path::PathBuf;

use crate::args::Args;
use crate::case_file::{load, placed};
use crate::failure::Failure;
use crate::outputs::claim_grid;
use crate::report;

/// Options of `mesh`.
#[derive(Debug, clap::Args)]
pub struct MeshArgs {
    /// The case file
    #[arg(value_name = "CASE.toml")]
    pub case: PathBuf,
    /// Write the mesh here
    #[arg(long, value_name = "FILE.vtu|FILE.vtkhdf", value_parser = mesh_file)]
    pub out: Option<PathBuf>,
    /// Set a key of the case, for example mesh.zone.size=2e-3; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

fn mesh_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("vtu" | "vtkhdf") => Ok(path),
        _ => Err("the file's name must end in .vtu or .vtkhdf".into()),
    }
}

/// Builds the mesh of a case and says what it is like.
pub fn command(args: &Args, options: &MeshArgs) -> Result<u8, Failure> {
    let case = load(args, &options.case, &options.sets)?;
    if let Some(out) = &options.out {
        claim_grid("--out", out, &case::inputs(&case, &options.case))?;
    }
    let found = ::run::mesh_report(&case, options.out.as_deref())
        .map_err(|error| placed(error, args, &options.case, &options.sets))?;
    if args.json {
        args.print_json(&found);
    } else if !args.quiet {
        report::print_mesh(&found);
    }
    Ok(0)
}
