//! `creepage plot`.

use std::io::Write as _;
use std::path::PathBuf;

use figure::Format;
use post::{Depth, PostError};
use serde_json::json;

use crate::args::Args;
use crate::check::{BasisArgs, WindowArgs, basis};
use crate::failure::Failure;
use crate::sweep_folder as sweep;

/// Options of `plot`.
#[derive(Debug, clap::Args)]
pub struct PlotArgs {
    /// Folder of a run or of a sweep, or a file of the layout of contact.vtkhdf
    #[arg(value_name = "RUN_OR_SWEEP")]
    run: PathBuf,
    /// Folder of the figures [default: figures in that folder]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Kinds of files, with a comma between
    #[arg(long, value_name = "svg,png", value_delimiter = ',', default_values = ["svg", "png"],
          value_parser = format)]
    format: Vec<Format>,
    // lines and maps are those at its end
    #[command(flatten)]
    window: WindowArgs,
    #[command(flatten)]
    basis: BasisArgs,
}

/// Runs the command.
pub fn command(args: &Args, options: &PlotArgs) -> Result<u8, Failure> {
    let (name, folder, figures) = if let Some(sweep) = sweep::read(&options.run)? {
        let figures = post::sweep_figures(&options.run, &sweep)?;
        let figures = figures.into_iter().map(|(stem, figure)| (stem, String::new(), figure));
        (sweep::name(&options.run), options.run.clone(), figures.collect::<Vec<_>>())
    } else {
        let (paths, mut against) = basis(&options.run, &options.basis, Depth::Read)?;
        let figures = post::figures(&paths, &mut against, options.window.span())?;
        let figures =
            figures.into_iter().map(|n| (n.stem.to_owned(), n.about.to_owned(), n.figure));
        (against.name, paths.folder, figures.collect())
    };
    let folder = options.out.clone().unwrap_or_else(|| folder.join("figures"));
    let mut written = Vec::new();
    for (stem, about, figure) in &figures {
        let mut files = Vec::new();
        for format in &options.format {
            let path = figure.write_as(&folder, stem, *format);
            files.push(path.map_err(PostError::from)?.display().to_string());
        }
        if !args.json && !args.quiet {
            let line = format!("{}  {about}", files.join(", "));
            let _ = writeln!(std::io::stdout(), "{}", line.trim_end());
        }
        written.push(json!({ "name": stem, "about": about, "files": files }));
    }
    if args.json {
        args.print_json(&json!({ "name": name, "figures": written }));
    }
    Ok(0)
}

fn format(text: &str) -> Result<Format, String> {
    let known = [Format::Svg, Format::Png].into_iter().find(|f| f.extension() == text);
    known.ok_or_else(|| "svg, png, or both with a comma between are needed".into())
}
