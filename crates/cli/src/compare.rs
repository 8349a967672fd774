//! `creepage compare`.

use std::path::{Path, PathBuf};

use figure::Format;
use miette::miette;
use post::{Compared, Depth, PostError};
use serde_json::json;

use crate::args::Args;
use crate::check::{BasisArgs, WindowArgs, basis};
use crate::failure::{BAD_INPUT, Failure};
use crate::report;

/// Options of `compare`.
#[derive(Debug, clap::Args)]
pub struct CompareArgs {
    /// Folders of two runs or more; each is compared with the one before it
    #[arg(value_name = "RUN", num_args = 2.., required = true)]
    runs: Vec<PathBuf>,
    #[command(flatten)]
    window: WindowArgs,
    /// Draw the slip along the centre line: mean in time and one standard deviation
    #[arg(long, value_name = "FILE.svg|FILE.png", value_parser = figure_file)]
    plot: Option<PathBuf>,
    #[command(flatten)]
    basis: BasisArgs,
}

/// Runs the command.
pub fn command(args: &Args, options: &CompareArgs) -> Result<u8, Failure> {
    let mut runs = Vec::new();
    for run in &options.runs {
        let (paths, basis) = basis(run, &options.basis, Depth::Read)?;
        runs.push(Compared { paths, basis });
    }
    let found = post::compare(&mut runs, options.window.span())?;
    let mut document = found.document;
    if let Some(plot) = &options.plot {
        let (folder, stem, format) = parts(plot)
            .ok_or_else(|| Failure { report: miette!("--plot: no file"), code: BAD_INPUT })?;
        let path = found.figure.write_as(folder, stem, format).map_err(PostError::from)?;
        document["figure"] = json!(path);
    }
    if args.json {
        args.print_json(&document);
    } else if !args.quiet {
        report::print_compare(&document);
    }
    Ok(0)
}

fn figure_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let refused = "the file's name must end in .svg or .png";
    parts(&path).map(|_| path.clone()).ok_or_else(|| refused.to_owned())
}

/// Folder, name without its ending, and kind of a figure's file.
fn parts(path: &Path) -> Option<(&Path, &str, Format)> {
    let ending = path.extension()?.to_str()?;
    let format = [Format::Svg, Format::Png].into_iter().find(|f| f.extension() == ending)?;
    Some((path.parent()?, path.file_stem()?.to_str()?, format))
}
