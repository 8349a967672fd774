//! The page about a run, a sweep or a folder of runs.

use std::fs;
use std::path::{Path, PathBuf};

use crate::check::{Criteria, Depth, Limits, PostError, Report};
use crate::figures::{Choice, Reference};
use crate::report::ListedRun;
use crate::sweep::SweepResult;
use crate::trends::SweepVerdict;
use output::files::input;
use output::files::made::PAGE;
use output::layout::file;
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::commands::check::{BasisOptions, SpanOptions, basis, inputs};
use crate::commands::outputs::{claim, shown};
use crate::commands::sweep_folder;
use crate::commands::values::maybe_parsed;

/// What to write a page about.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ReportOptions {
    /// Folder of a run, of a sweep, or of several runs, which are listed
    #[cfg_attr(feature = "clap", arg(value_name = "RUN_OR_SWEEP"))]
    pub run: PathBuf,
    /// The page [default: report.html in that folder]
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.html"))]
    pub out: Option<PathBuf>,
    /// Draw the tractions of a run beside steady rolling of half-spaces, as `creepage plot` does
    #[serde(deserialize_with = "maybe_parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "half-space"))]
    pub reference: Option<Reference>,
    /// Over which span of time a run is judged.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub span: SpanOptions,
    /// What the run is measured against.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub basis: BasisOptions,
}

/// A page that was written: the document of `creepage report --json`.
#[derive(Clone, Debug, Serialize)]
pub struct Reported {
    /// The page.
    #[serde(serialize_with = "shown")]
    pub page: PathBuf,
    /// Whether the run holds every limit; none of a sweep, or of a folder of runs.
    pub pass: Option<bool>,
    /// What a sweep says of its parameters.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub verdicts: Option<Vec<SweepVerdict>>,
    /// Names of the runs of a folder.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub runs: Option<Vec<String>>,
}

impl Reported {
    fn of(page: PathBuf) -> Self {
        Self { page, pass: None, verdicts: None, runs: None }
    }
}

/// Writes one self-contained HTML page about a run or a sweep: what happened, patch, checks, figures, details; or about a
/// folder of runs: their list.
///
/// # Errors
/// Results that cannot be read; a page that cannot be written, or would be written over another file.
pub fn report(options: &ReportOptions) -> Result<Reported, Error> {
    let place = |folder: &Path| options.out.clone().unwrap_or_else(|| folder.join("report.html"));
    let window = options.span.span()?;
    let of_a_run =
        [("--reference", options.reference.is_some()), ("--window, --transits", window.is_some())];
    let is_run = options.run.join(file::CONTACT).exists() || !options.run.is_dir();
    if let Some((option, _)) = of_a_run.iter().find(|(_, is_given)| *is_given && !is_run) {
        let problem = format!("{option}: {} is no run", options.run.display());
        return Err(Error::option(problem, "give the folder of a run"));
    }
    let (text, reported) = if let Some(found) = sweep_folder::read(&options.run)? {
        let page = place(&options.run);
        claim("--out", &page, &PAGE, &[options.run.join("sweep.json")])?;
        let verdicts = Some(crate::trends::sweep_verdicts(&options.run, &found));
        (sweep_page(&options.run, &found)?, Reported { verdicts, ..Reported::of(page) })
    } else if let Some(runs) = listed(&options.run) {
        let page = place(&options.run);
        claim("--out", &page, &PAGE, &[])?;
        let names = Some(runs.iter().map(|run| run.name.clone()).collect());
        let text = crate::report::runs_page(&sweep_folder::name(&options.run), &runs);
        (text, Reported { runs: names, ..Reported::of(page) })
    } else {
        let (paths, mut against) = basis(&options.run, &options.basis, Depth::Read)?;
        let page = place(&paths.folder);
        claim("--out", &page, &PAGE, &inputs(&paths))?;
        let wanted = Criteria {
            window,
            limits: Limits::for_enforcement(against.enforcement.as_deref()),
            report: Report::default(),
            map: None,
        };
        let checked = crate::check::check(&paths, &mut against, &wanted)?;
        let choice = Choice { reference: options.reference, ..Choice::default() };
        let figures = crate::figures::figures(&paths, &mut against, window, &choice)?;
        let text = crate::report::run_page(&against, &paths.folder, &checked.result, &figures)?;
        (text, Reported { pass: Some(checked.result.pass), ..Reported::of(page) })
    };
    write("--out ", &reported.page, &text)?;
    Ok(reported)
}

/// The runs below a folder that is no run itself, by name; `None` where there are none.
fn listed(folder: &Path) -> Option<Vec<ListedRun>> {
    if !folder.is_dir() || folder.join(file::CONTACT).exists() {
        return None;
    }
    let mut runs = Vec::new();
    for entry in fs::read_dir(folder).ok()?.flatten() {
        let run = entry.path();
        let Ok(text) = input::text(&run.join(file::SUMMARY), input::DOCUMENT) else {
            continue;
        };
        // a summary that cannot be read shows as unknown
        let summary = serde_json::from_str(&text).unwrap_or_default();
        let name = entry.file_name().to_string_lossy().into_owned();
        runs.push(ListedRun { name, summary, page: run.join("report.html").is_file() });
    }
    runs.sort_by(|a, b| a.name.cmp(&b.name));
    (!runs.is_empty()).then_some(runs)
}

/// Refuses a folder where the page of a sweep would replace what this program did not write.
pub(crate) fn claim_sweep(folder: &Path) -> Result<(), Error> {
    if !folder.is_dir() {
        return Ok(());
    }
    claim("", &folder.join("report.html"), &PAGE, &[])
}

/// Writes the page of a sweep into its folder.
pub(crate) fn write_sweep(folder: &Path, results: &SweepResult) -> Result<PathBuf, Error> {
    let page = folder.join("report.html");
    claim_sweep(folder)?;
    write("", &page, &sweep_page(folder, results)?)?;
    Ok(page)
}

fn sweep_page(folder: &Path, results: &SweepResult) -> Result<String, Error> {
    Ok(crate::report::sweep_page(&sweep_folder::name(folder), &folder.join("sweep.json"), results)?)
}

fn write(option: &str, page: &Path, text: &str) -> Result<(), Error> {
    let failed = |error| {
        PostError::Asked(format!("{option}{}: cannot write the page: {error}", page.display()))
    };
    Ok(fs::write(page, text).map_err(failed)?)
}
