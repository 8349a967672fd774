//! `creepage-verify`: runs verification problems, each beside its reference.

mod page;
mod plot;

use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use creepage::chart::FigureError;
use creepage::{FailureResult, VerifyOptions};
use miette::{Diagnostic, MietteHandlerOpts, Report};
use serde::Serialize;
use thiserror::Error;
use verification::{PROBLEMS, Problem, Row, Size, VerifyError};

/// Run verification problems against their references; exit code 1 if one misses its limit
#[derive(Debug, Parser)]
#[command(
    name = "creepage-verify",
    version,
    after_help = "Examples:\n  creepage-verify --list\n  creepage-verify hertz-wheel\n  creepage-verify --quick --json > verify.json"
)]
struct Line {
    #[command(flatten)]
    problems: VerifyOptions,
    /// Print exactly one JSON document on standard output, everything else on standard error
    #[arg(long)]
    json: bool,
    /// Say nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

/// Why the program cannot do what it was asked.
#[derive(Debug, Diagnostic, Error)]
enum Failure {
    #[error("there is no verification problem '{0}'")]
    #[diagnostic(help("`creepage-verify --list` names all problems"))]
    Unknown(String),
    #[error("--plot: {0}")]
    #[diagnostic(help("give a folder that you may write to"))]
    Plot(FigureError),
    #[error("standard output cannot be written: {0}")]
    #[diagnostic(help("make room where it goes, and print again"))]
    Output(#[from] io::Error),
    #[error("{0}")]
    #[diagnostic(help("this is a defect of the program or its build"))]
    Problem(#[from] VerifyError),
}

impl Failure {
    /// Exit code: 2 for bad input, 3 where a solver failed.
    fn exit_code(&self) -> u8 {
        match self {
            Self::Unknown(_) | Self::Plot(_) | Self::Output(_) => 2,
            Self::Problem(_) => 3,
        }
    }
}

fn main() -> ExitCode {
    // set once, before any report is made
    let _ = miette::set_hook(Box::new(|_| {
        Box::new(MietteHandlerOpts::new().wrap_lines(false).context_lines(1).build())
    }));
    let line = Line::parse();
    ExitCode::from(verify(&line).unwrap_or_else(|failure| {
        let code = failure.exit_code();
        if line.json {
            // where standard output takes nothing, its failure is the one that is told
            let _ = print_document(&FailureResult::of(&failure, code));
        }
        eprintln!("{:?}", Report::new(failure));
        code
    }))
}

/// Runs the problems, shows each as it is done, and returns the exit code.
fn verify(line: &Line) -> Result<u8, Failure> {
    let shown = !line.json && !line.quiet;
    let options = &line.problems;
    if options.list {
        if line.json {
            print_document(&Listed { problems: PROBLEMS })?;
        } else if shown {
            print(&page::names(PROBLEMS))?;
        }
        return Ok(0);
    }
    let size = if options.quick { Size::Quick } else { Size::Full };
    let mut rows = Vec::new();
    for problem in chosen(&options.names)? {
        if !line.quiet {
            eprintln!("{}: {}", problem.name, problem.about);
        }
        let clock = Instant::now();
        let found = problem.run(size)?;
        if shown {
            print(&page::rows(problem, &found, clock.elapsed().as_secs_f64()))?;
        }
        rows.extend(found);
    }
    if let Some(folder) = &options.plot {
        draw(&rows, folder)?;
    }
    let pass = rows.iter().all(|row| row.pass);
    if line.json {
        let results = rows.iter().map(VerificationRow::of).collect();
        print_document(&VerificationResult { results, pass })?;
    } else if shown {
        print(&page::count(&rows))?;
    }
    Ok(if pass { 0 } else { 1 })
}

fn chosen(names: &[String]) -> Result<Vec<&'static Problem>, Failure> {
    if names.is_empty() {
        return Ok(PROBLEMS.iter().collect());
    }
    let find =
        |name: &String| verification::find(name).ok_or_else(|| Failure::Unknown(name.clone()));
    names.iter().map(find).collect()
}

fn draw(rows: &[Row], folder: &Path) -> Result<(), Failure> {
    let figures = [
        ("convergence", plot::convergence::figure(rows)),
        ("rupture", plot::rupture::figure(rows)),
    ];
    for (name, figure) in figures {
        if let Some(figure) = figure {
            figure.write(folder, name).map_err(Failure::Plot)?;
        }
    }
    Ok(())
}

/// The document of `--list --json`.
#[derive(Serialize)]
struct Listed {
    problems: &'static [Problem],
}

/// The document of `--json`.
#[derive(Serialize)]
struct VerificationResult<'a> {
    results: Vec<VerificationRow<'a>>,
    pass: bool,
}

/// A row with the signed error on each mesh beside the values, over the reference where that is not zero.
#[derive(Serialize)]
struct VerificationRow<'a> {
    #[serde(flatten)]
    row: &'a Row,
    mesh_errors: Vec<f64>,
}

impl<'a> VerificationRow<'a> {
    fn of(row: &'a Row) -> Self {
        let scale = if row.reference == 0.0 { 1.0 } else { row.reference };
        let error = |value: f64| (value - row.reference) / scale;
        Self { row, mesh_errors: row.meshes.iter().map(|sample| error(sample.value)).collect() }
    }
}

fn print_document(document: &impl Serialize) -> io::Result<()> {
    print(&(serde_json::to_string_pretty(document)? + "\n"))
}

/// Writes on standard output. A reader that closed the pipe wants no more.
fn print(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    let written = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    written.or_else(|error| if error.kind() == ErrorKind::BrokenPipe { Ok(()) } else { Err(error) })
}
