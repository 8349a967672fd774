//! `creepage import-contact`: contact histories of other codes, from CSV.

use std::io::Write as _;
use std::path::PathBuf;

use miette::miette;
use post::{ImportError, ImportFiles, Imported, import_contact};
use serde_json::json;

use crate::args::Args;
use crate::failure::{BAD_INPUT, Failure};
use crate::outputs::claim_grid;

/// Options of `import-contact`.
#[derive(Debug, clap::Args)]
pub struct ImportArgs {
    /// Nodes, one a row: x, y, z (m) and, if wanted, area (m2); the first row is node 0
    #[arg(long, value_name = "NODES.csv")]
    nodes: PathBuf,
    /// Faces, one a row: n0, n1, n2, n3 (counter-clockwise seen from outside) and body (0 disk,
    /// 1 bar)
    #[arg(long, value_name = "FACES.csv")]
    faces: PathBuf,
    /// Values, one row per time and node, times rising: time, node, pressure, shear_x, shear_y,
    /// shear_z, slip_velocity_x, ..., and, if wanted, gap, mu, state, velocity_x, ...,
    /// displacement_x, ...; nodes without a row are open
    #[arg(long, value_name = "VALUES.csv")]
    values: PathBuf,
    /// The file to write
    #[arg(long, value_name = "FILE.vtkhdf", default_value = "contact.vtkhdf")]
    out: PathBuf,
}

/// Runs the command.
pub fn command(args: &Args, options: &ImportArgs) -> Result<u8, Failure> {
    let out = &options.out;
    let files =
        ImportFiles { nodes: &options.nodes, faces: &options.faces, values: &options.values, out };
    let tables = [&options.nodes, &options.faces, &options.values].map(PathBuf::clone);
    claim_grid("--out", out, &tables)?;
    let Imported { nodes, faces, steps, rows } = import_contact(&files)?;
    let out = out.display();
    if args.json {
        args.print_json(&json!({ "file": out.to_string(), "nodes": nodes, "faces": faces,
                                 "steps": steps, "rows": rows }));
    } else if !args.quiet {
        let _ = writeln!(std::io::stdout(), "{out}: {nodes} nodes, {faces} faces, {steps} records");
    }
    Ok(0)
}

impl From<ImportError> for Failure {
    fn from(error: ImportError) -> Self {
        let report = match error {
            ImportError::Input { .. } => miette!(
                help = "`creepage import-contact --help` and docs/checks.md name the columns",
                "{error}"
            ),
            ImportError::Output(_) => miette!("{error}"),
        };
        Self { report, code: BAD_INPUT }
    }
}
