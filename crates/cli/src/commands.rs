//! What each command does.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use case::{Case, RunError, RunOptions};
use miette::Diagnostic;
use miette::{Report, miette};
use serde_json::{Value, json};

use crate::args::{Args, BenchArgs, Command, MeshArgs, RunArgs};
use crate::embedded::Told;
use crate::outputs::claim_grid;
use crate::progress::Watch;
use crate::report;
use crate::stop::Stop;

/// Exit code: bad input.
pub const BAD_INPUT: u8 = 2;
/// Exit code: stopped by the run's own guards.
pub const STOPPED_BY_GUARD: u8 = 3;
/// Exit code: interrupted by Ctrl-C or SIGTERM.
pub const INTERRUPTED: u8 = 130;

/// A command that failed.
#[derive(Debug)]
pub struct Failure {
    /// What to say.
    pub report: Report,
    /// The exit code.
    pub code: u8,
}

impl Failure {
    /// The JSON document of the failure: what was wrong, what to do, and what else was wrong.
    pub fn document(&self) -> Value {
        let mut document = failure(&self.report.to_string(), self.code);
        let help = |diagnostic: &dyn Diagnostic| diagnostic.help().map(|help| help.to_string());
        document["help"] = json!(help(&*self.report).unwrap_or_default());
        let others = self.report.related().into_iter().flatten();
        let others: Vec<_> = others
            .map(|other| json!({ "error": other.to_string(), "help": help(other) }))
            .collect();
        document["others"] = json!(others);
        document
    }
}

/// The JSON document of a command that failed: with `--json`, standard output holds one document
/// whatever happens.
pub fn failure(message: &str, code: u8) -> Value {
    json!({ "status": "failed", "exit_code": code, "error": message })
}

impl From<case::CaseError> for Failure {
    fn from(error: case::CaseError) -> Self {
        Self { report: error.into(), code: BAD_INPUT }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        let code = error.exit_code();
        Self { report: error.into(), code }
    }
}

/// Runs the command and returns the exit code.
pub fn dispatch(args: &Args) -> Result<u8, Failure> {
    if args.check_args {
        return check_args(args);
    }
    match &args.command {
        Command::Run(options) => run(args, options),
        Command::Mesh(options) => mesh(args, options),
        Command::Check(options) => crate::check::command(args, options),
        Command::Compare(options) => crate::compare::command(args, options),
        Command::Plot(options) => crate::plot::command(args, options),
        Command::Report(options) => crate::report_page::command(args, options),
        Command::Sweep(options) => crate::sweep::command(args, options),
        Command::ImportContact(options) => crate::import_contact::command(args, options),
        Command::ImportK(options) => crate::import_k::command(args, options),
        Command::Schema => {
            args.print_json(&case::json_schema());
            Ok(0)
        }
        Command::Slider(options) => crate::slider::command(args, options),
        Command::Verify(options) => crate::verify::command(args, options),
        Command::Bench(options) => bench(args, options),
    }
}

/// Reads what a command would compute from, and computes nothing.
fn check_args(args: &Args) -> Result<u8, Failure> {
    match &args.command {
        Command::Run(options) => load(args, &options.case, &options.sets).map(|_| 0),
        Command::Mesh(options) => load(args, &options.case, &options.sets).map(|_| 0),
        Command::Sweep(options) => crate::sweep::load(options).map(|_| 0),
        _ => Ok(0),
    }
}

fn run(args: &Args, options: &RunArgs) -> Result<u8, Failure> {
    let sets = options.sets();
    let case = load(args, &options.case, &sets)?;
    let out = options.out.clone().unwrap_or_else(|| case::folder::default_folder(&case));
    let run_options = RunOptions {
        out: out.clone(),
        threads: options.threads.unwrap_or_else(all_cores),
        force: options.force,
        resume: options.resume,
        preload_cache: options.preload_cache.clone(),
        source: options.case.clone(),
        law: args.embedded.as_ref().and_then(|embedded| embedded.law.clone()),
    };
    let stop = stop_flag(args);
    args.tell(|| Told::Folder(out.clone()));
    let mut watch = Watch::new(args.quiet, options.leash);
    if options.leash {
        hold_leash(args.stop.clone())?;
    }
    let result = case::run(&case, &run_options, &stop, &mut |progress| {
        if progress.stage == case::Stage::Roll {
            args.stop.hears();
        }
        watch.show(progress);
        args.tell(|| Told::Run(*progress));
    });
    watch.finish();
    let summary = result.map_err(|error| placed(error, args, &options.case, &sets))?;
    if args.json {
        args.print_json(&summary);
    } else if !args.quiet {
        report::print_run(&summary, &out);
    }
    let status = summary.get("status").and_then(Value::as_str);
    let diagnosis = summary.get("diagnosis").and_then(Value::as_str);
    if let Some(diagnosis) = diagnosis.filter(|_| args.embedded.is_none()) {
        let _ = writeln!(std::io::stderr(), "stopped: {diagnosis}");
    }
    if status == Some("interrupted") && !args.quiet {
        let _ = writeln!(std::io::stderr(), "interrupted: --resume goes on");
    }
    Ok(match status {
        Some("interrupted") => INTERRUPTED,
        Some("failed") => STOPPED_BY_GUARD,
        _ => 0,
    })
}

fn mesh(args: &Args, options: &MeshArgs) -> Result<u8, Failure> {
    let case = load(args, &options.case, &options.sets)?;
    if let Some(out) = &options.out {
        claim_grid("--out", out, &case::inputs(&case, &options.case))?;
    }
    let found = case::mesh_report(&case, options.out.as_deref())
        .map_err(|error| placed(error, args, &options.case, &options.sets))?;
    if args.json {
        args.print_json(&found);
    } else if !args.quiet {
        report::print_mesh(&found);
    }
    Ok(0)
}

fn bench(args: &Args, options: &BenchArgs) -> Result<u8, Failure> {
    let threads = options.threads.unwrap_or_else(all_cores);
    let found = match options.block {
        Some(n) => case::bench_block(n, options.element, threads, options.kernels)?,
        None => case::bench(threads, options.kernels, &options.sets)
            .map_err(|error| placed(error, args, Path::new("reference.toml"), &options.sets))?,
    };
    if args.json {
        args.print_json(&found);
    } else if !args.quiet {
        report::print_bench(&found);
    }
    Ok(0)
}

/// An error about a key of the case, with the line where the key was written.
fn placed(error: RunError, args: &Args, case: &Path, sets: &[String]) -> Failure {
    let text = text(args);
    match error.key() {
        Some(key) => {
            case::error_at_key(case, text, sets, key, &error.to_string(), &error.remedy()).into()
        }
        None => error.into(),
    }
}

fn load(args: &Args, path: &Path, sets: &[String]) -> Result<Case, Failure> {
    let case = match text(args) {
        Some(text) => Case::from_text(text, path, sets)?,
        None => Case::load(path, sets)?,
    };
    case.warnings().iter().for_each(|warning| args.say(&format!("warning: {warning}")));
    Ok(case)
}

/// The case where it is not in a file.
fn text(args: &Args) -> Option<&str> {
    args.embedded.as_ref()?.case.as_deref()
}

pub fn all_cores() -> usize {
    std::thread::available_parallelism().map_or(1, |n| n.get())
}

/// Ends the run with the process at the other end of standard input: in order where that asks for
/// it, at once where it is gone.
fn hold_leash(stop: Stop) -> Result<(), Failure> {
    let held = std::thread::Builder::new().spawn(move || {
        for line in std::io::stdin().lines().map_while(Result::ok) {
            if line == case::sweep::schedule::STOP {
                stop.ask();
            }
        }
        std::process::exit(INTERRUPTED.into());
    });
    held.map(|_| ()).map_err(|error| Failure {
        report: miette!("the thread that minds the sweep cannot be started: {error}"),
        code: STOPPED_BY_GUARD,
    })
}

/// The flag that ends a command in order: at the first Ctrl-C or SIGTERM, or by the program that holds
/// it.
pub fn stop_flag(args: &Args) -> Arc<AtomicBool> {
    match &args.embedded {
        Some(embedded) => Arc::clone(&embedded.stop),
        None => args.stop.in_order(),
    }
}
