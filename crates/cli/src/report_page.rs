//! `creepage report`.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use files::output::PAGE;
use post::{CheckOptions, Depth, Limits, PostError, Report, SweepVerdict};
use serde_json::{Value, json};

use crate::args::Args;
use crate::check::{BasisArgs, basis, inputs};
use crate::failure::Failure;
use crate::outputs::claim;
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
    let place = |folder: &Path| options.out.clone().unwrap_or_else(|| folder.join("report.html"));
    let (page, out, more) = if let Some(found) = sweep::read(&options.run)? {
        let out = place(&options.run);
        claim("--out", &out, &PAGE, &[options.run.join("sweep.json")])?;
        let verdicts = post::sweep_verdicts(&options.run, &found)?;
        let verdicts: Vec<Value> = verdicts.iter().map(SweepVerdict::document).collect();
        (sweep_page(&options.run, &found)?, out, json!({ "pass": null, "verdicts": verdicts }))
    } else {
        let (paths, mut against) = basis(&options.run, &options.basis, Depth::Read)?;
        let out = place(&paths.folder);
        claim("--out", &out, &PAGE, &inputs(&paths))?;
        let wanted = CheckOptions {
            window: None,
            limits: Limits::for_enforcement(against.enforcement.as_deref()),
            report: Report::default(),
            map: None,
        };
        let checked = post::check(&paths, &mut against, &wanted)?;
        let figures = post::figures(&paths, &mut against, None)?;
        let page = post::run_page(&against, &paths.folder, &checked.document, &figures)?;
        (page, out, json!({ "pass": checked.pass }))
    };
    fs::write(&out, page).map_err(|error| {
        PostError::Asked(format!("--out {}: cannot write the page: {error}", out.display()))
    })?;
    if args.json {
        let mut document = json!({ "page": out.display().to_string() });
        if let (Value::Object(document), Value::Object(more)) = (&mut document, more) {
            document.extend(more);
        }
        args.print_json(&document);
    } else if !args.quiet {
        let _ = writeln!(std::io::stdout(), "{}", out.display());
    }
    Ok(0)
}

/// Refuses a folder where the page of a sweep would replace what this program did not write.
pub fn claim_sweep(folder: &Path) -> Result<(), Failure> {
    if !folder.is_dir() {
        return Ok(());
    }
    claim("", &folder.join("report.html"), &PAGE, &[])
}

/// Writes the page of a sweep into its folder.
pub fn write_sweep(folder: &Path, results: &Value) -> Result<PathBuf, Failure> {
    let out = folder.join("report.html");
    claim_sweep(folder)?;
    fs::write(&out, sweep_page(folder, results)?).map_err(|error| {
        PostError::Asked(format!("{}: cannot write the page: {error}", out.display()))
    })?;
    Ok(out)
}

fn sweep_page(folder: &Path, results: &Value) -> Result<String, Failure> {
    Ok(post::sweep_page(&sweep::name(folder), &folder.join("sweep.json"), results)?)
}
