//! `creepage report`.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use post::{CheckOptions, Depth, Limits, PostError, Report};
use serde_json::{Value, json};

use crate::args::Args;
use crate::check::{BasisArgs, basis};
use crate::commands::Failure;
use crate::sweep_folder as sweep;

/// Options of `report`.
#[derive(Debug, clap::Args)]
pub struct ReportArgs {
    /// Folder of a run or of a sweep
    #[arg(value_name = "RUN_OR_SWEEP")]
    run: PathBuf,
    /// The page [default: report.html in that folder]
    #[arg(long, value_name = "FILE.html")]
    out: Option<PathBuf>,
    #[command(flatten)]
    basis: BasisArgs,
}

/// Runs the command.
pub fn command(args: &Args, options: &ReportArgs) -> Result<u8, Failure> {
    let (page, folder, pass) = if let Some(found) = sweep::read(&options.run)? {
        (sweep_page(&options.run, &found)?, options.run.clone(), None)
    } else {
        let (paths, mut against) = basis(&options.run, &options.basis, Depth::Read)?;
        let wanted = CheckOptions {
            window: None,
            limits: Limits::for_enforcement(against.enforcement.as_deref()),
            report: Report::default(),
            map: None,
        };
        let checked = post::check(&paths, &mut against, &wanted)?;
        let figures = post::figures(&paths, &mut against, None)?;
        let page = post::run_page(&against, &paths.folder, &checked.document, &figures)?;
        (page, paths.folder, Some(checked.pass))
    };
    let out = options.out.clone().unwrap_or_else(|| folder.join("report.html"));
    fs::write(&out, page).map_err(|error| {
        PostError::Asked(format!("--out {}: cannot write the page: {error}", out.display()))
    })?;
    if args.json {
        args.print_json(&json!({ "page": out.display().to_string(), "pass": pass }));
    } else if !args.quiet {
        let _ = writeln!(std::io::stdout(), "{}", out.display());
    }
    Ok(0)
}

/// Writes the page of a sweep into its folder.
pub fn write_sweep(folder: &Path, results: &Value) -> Result<PathBuf, Failure> {
    let out = folder.join("report.html");
    fs::write(&out, sweep_page(folder, results)?).map_err(|error| {
        PostError::Asked(format!("{}: cannot write the page: {error}", out.display()))
    })?;
    Ok(out)
}

fn sweep_page(folder: &Path, results: &Value) -> Result<String, Failure> {
    Ok(post::sweep_page(&sweep::name(folder), &folder.join("sweep.json"), results)?)
}
