//! `creepage verify`.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Instant;

use miette::miette;
use serde_json::{Value, json};
use verify::{PROBLEMS, Problem, Row, Size, VerifyError};

use crate::args::Args;
use crate::failure::{BAD_INPUT, Failure, INTERRUPTED, STOPPED_BY_GUARD};
use crate::{convergence_plot, rupture_plot};

/// Exit code: a row beyond its limit.
const FAILED: u8 = 1;

/// Options of `verify`.
#[derive(Debug, clap::Args)]
pub struct VerifyArgs {
    /// Problems to run [default: all]
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Name all problems and run none
    #[arg(long, conflicts_with_all = ["names", "quick", "plot"])]
    list: bool,
    /// Coarse meshes, for continuous integration
    #[arg(long)]
    quick: bool,
    /// Draw error over mesh size (convergence.svg, .png) and rupture times (rupture.svg, .png) in this folder
    #[arg(long, value_name = "FOLDER")]
    plot: Option<PathBuf>,
}

/// Runs the command.
pub fn command(args: &Args, options: &VerifyArgs) -> Result<u8, Failure> {
    if options.list {
        list(args);
        return Ok(0);
    }
    let problems = chosen(options)?;
    let size = if options.quick { Size::Quick } else { Size::Full };
    let mut rows = Vec::new();
    for problem in problems {
        if args.embedded.as_ref().is_some_and(|by| by.stop.load(Ordering::Relaxed)) {
            return Ok(INTERRUPTED);
        }
        args.say(&format!("{}: {}", problem.name, problem.about));
        let clock = Instant::now();
        let found = problem.run(size)?;
        if !args.json && !args.quiet {
            let seconds = clock.elapsed().as_secs_f64();
            let _ = write!(std::io::stdout(), "{}", page(problem, &found, seconds));
        }
        rows.extend(found);
    }
    if let Some(folder) = &options.plot {
        let failed = |error| Failure {
            report: miette!(help = "give a folder that you may write to", "--plot: {error}"),
            code: BAD_INPUT,
        };
        let figures = [
            ("convergence", convergence_plot::figure(&rows)),
            ("rupture", rupture_plot::figure(&rows)),
        ];
        for (name, figure) in figures {
            if let Some(figure) = figure {
                figure.write(folder, name).map_err(failed)?;
            }
        }
    }
    let pass = rows.iter().all(|row| row.pass);
    if args.json {
        let rows: Vec<Value> = rows.iter().map(document).collect();
        args.print_json(&json!({ "results": rows, "pass": pass }));
    } else if !args.quiet {
        let failed = rows.iter().filter(|row| !row.pass).count();
        let _ = writeln!(
            std::io::stdout(),
            "{} of {} quantities within their limits",
            rows.len() - failed,
            rows.len()
        );
    }
    Ok(if pass { 0 } else { FAILED })
}

/// A row with the signed error on each mesh beside the values, over the reference where that is not zero.
fn document(row: &Row) -> Value {
    let mut document = json!(row);
    let scale = if row.reference == 0.0 { 1.0 } else { row.reference };
    let errors: Vec<f64> =
        row.meshes.iter().map(|sample| (sample.value - row.reference) / scale).collect();
    document["mesh_errors"] = json!(errors);
    document
}

fn chosen(options: &VerifyArgs) -> Result<Vec<&'static Problem>, Failure> {
    if options.names.is_empty() {
        return Ok(PROBLEMS.iter().collect());
    }
    let unknown = |name: &String| Failure {
        report: miette!(
            help = "`creepage verify --list` names all problems",
            "there is no verification problem '{name}'"
        ),
        code: BAD_INPUT,
    };
    options.names.iter().map(|name| verify::find(name).ok_or_else(|| unknown(name))).collect()
}

fn list(args: &Args) {
    if args.json {
        let problems =
            PROBLEMS.iter().map(|problem| json!({ "name": problem.name, "about": problem.about }));
        args.print_json(&json!({ "problems": problems.collect::<Vec<_>>() }));
        return;
    }
    for problem in PROBLEMS {
        let _ = writeln!(std::io::stdout(), "{:<22}{}", problem.name, problem.about);
    }
}

/// The rows of a problem, one line each, and below what they rest on.
fn page(problem: &Problem, rows: &[Row], seconds: f64) -> String {
    let mut page = format!("{} ({seconds:.1} s)\n", problem.name);
    let width = rows.iter().map(|row| row.quantity.chars().count()).max().unwrap_or(0).max(8);
    let _ = writeln!(
        page,
        "  {:<width$}  {:>12} {:>12} {:>9} {:>9}  ",
        "quantity", "reference", "computed", "error", "limit"
    );
    for row in rows {
        let _ = writeln!(
            page,
            "  {:<width$}  {:>12} {:>12} {:>9.1e} {:>9.1e}  {}",
            row.quantity,
            number(row.reference),
            number(row.computed),
            row.error,
            row.limit,
            if row.pass { "pass" } else { "FAIL" }
        );
        for sample in &row.meshes {
            let _ = writeln!(
                page,
                "  {:<width$}  {:>12} {:>12}",
                format!("    h = {}", length(sample.size)),
                "",
                number(sample.value)
            );
        }
    }
    let mut said = Vec::new();
    for row in rows {
        let line = format!("reference: {}; limit: {}", row.source, row.limit_from);
        if !said.contains(&line) {
            let _ = writeln!(page, "  {line}");
            said.push(line);
        }
    }
    page.push('\n');
    page
}

/// A mesh size (m).
fn length(size: f64) -> String {
    if size < 1.0 { format!("{:.4} mm", 1e3 * size) } else { format!("{size} m") }
}

fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        format!("{value:.6}")
    } else {
        format!("{value:.5e}")
    }
}

impl From<VerifyError> for Failure {
    fn from(error: VerifyError) -> Self {
        let report = miette!(help = "this is a defect of the program or its build", "{error}");
        Self { report, code: STOPPED_BY_GUARD }
    }
}
