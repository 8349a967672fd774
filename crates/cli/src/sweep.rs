//! `creepage sweep`.

use std::ffi::OsString;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use ::sweep::plan::{self, Existing};
use ::sweep::{Budget, Plan, Sweep, SweepError, collect, schedule};
use figure::Format;
use files::output::PLAN;
use miette::{Report, miette};
use post::PostError;
use serde_json::Value;

use crate::args::{Args, stop_flag};
use crate::embedded::Told;
use crate::failure::{BAD_INPUT, Failure, INTERRUPTED};
use crate::outputs::claim;
use crate::progress::SweepWatch;
use crate::report;
use crate::report_page::{claim_sweep, write_sweep};
use crate::threads::{all_cores, threads};

/// Exit code: a run failed.
const FAILED: u8 = 1;

/// Options of `sweep`.
#[derive(Debug, clap::Args)]
pub struct SweepArgs {
    /// The sweep file
    #[arg(value_name = "SWEEP.toml")]
    sweep: PathBuf,
    /// Folder of the sweep [default: runs/NAME, by the name of the sweep]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Runs at a time [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads)]
    jobs: Option<usize>,
    /// Threads of each run [default: cores over jobs]
    #[arg(long, value_name = "N", value_parser = threads)]
    threads: Option<usize>,
    /// Memory that the runs may take together, in MB [default: nine tenths of what is free]
    #[arg(long, value_name = "MB", value_parser = megabytes, allow_hyphen_values = true)]
    memory: Option<f64>,
    /// Take the kernels whose bits every processor can give in every run; the same as
    /// deterministic = true in [set]
    #[arg(long)]
    deterministic: bool,
    /// Go on with the sweep in the folder: keep the runs that are done, do the others
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Replace the sweep that is in the folder
    #[arg(long)]
    force: bool,
    /// Run nothing: write the runs as shell commands, one a line, for an engine of your own
    #[arg(long, value_name = "FILE", conflicts_with = "collect")]
    plan: Option<PathBuf>,
    /// Run nothing: gather the results of runs from the sweep's folder and these
    #[arg(long, value_name = "DIR", num_args = 0..)]
    collect: Option<Vec<PathBuf>>,
}

/// Reads the sweep file and everything that it names.
pub fn load(options: &SweepArgs) -> Result<Sweep, Failure> {
    let mut sweep = Sweep::load(&options.sweep)?;
    if options.deterministic {
        sweep.sets.push(("deterministic".into(), true.into()));
    }
    Ok(sweep)
}

/// Runs the command.
pub fn command(args: &Args, options: &SweepArgs) -> Result<u8, Failure> {
    let sweep = load(options)?;
    let folder = options.out.clone().unwrap_or_else(|| Path::new("runs").join(&sweep.name));
    if let Some(elsewhere) = &options.collect {
        if let Some(missing) = elsewhere.iter().find(|folder| !folder.is_dir()) {
            let report = miette!("--collect {}: there is no such folder", missing.display());
            return Err(Failure { report, code: BAD_INPUT });
        }
        let plan = plan::open(&sweep, &folder)?;
        return finish(args, &plan, collect(&plan, elsewhere)?);
    }
    if let Some(path) = &options.plan {
        one_line(&folder)?;
        claim("--plan", path, &PLAN, &sweep.inputs())?;
    } else {
        claim_sweep(&folder)?;
    }
    let stop = stop_flag(args);
    let mut say = |line: &str| args.say(&format!("{}: {line}", sweep.name));
    let existing = match (options.force, options.resume, &options.plan) {
        (true, ..) => Existing::Replace,
        // A plan runs nothing, so that writing it once more harms no run.
        (false, false, None) => Existing::Refuse,
        (false, true, _) => Existing::Resume,
        (false, false, Some(_)) if folder.join(plan::PLAN).exists() => Existing::Resume,
        (false, false, Some(_)) => Existing::Refuse,
    };
    let cores = all_cores();
    let plan = plan::prepare(&sweep, &folder, existing, cores, &stop, &mut say)?;
    let jobs = options.jobs.unwrap_or(cores).clamp(1, plan.runs.len());
    let threads = options.threads.unwrap_or((cores / jobs).max(1));
    if let Some(path) = &options.plan {
        let text = plan.commands(options.threads.unwrap_or(1)).join("\n") + "\n";
        fs::write(path, text).map_err(|error| Failure {
            report: miette!("--plan {}: cannot be written: {error}", path.display()),
            code: BAD_INPUT,
        })?;
        if args.json {
            args.print_json(&plan.document);
        } else if !args.quiet {
            let _ = writeln!(std::io::stdout(), "{}", path.display());
        }
        return Ok(0);
    }
    let program = match &args.embedded {
        Some(embedded) => embedded.program.clone(),
        None if args.program.is_empty() => vec![this_program()?],
        None => args.program.clone(),
    };
    let budget = Budget { jobs, threads, memory_mb: options.memory };
    say(&format!(
        "{} runs in {}, {jobs} at a time, {threads} thread{} each",
        plan.runs.len(),
        folder.display(),
        if threads == 1 { "" } else { "s" }
    ));
    // its runs end in order, each in its own time
    args.stop.hears();
    let mut watch = SweepWatch::new(args.quiet, &sweep.name);
    let results = schedule::run(&plan, &program, &budget, &stop, &mut |now| {
        watch.show(now);
        args.tell(|| Told::Sweep(now.clone()));
    });
    watch.finish();
    let code = finish(args, &plan, results?)?;
    if stop.load(Ordering::SeqCst) && code != 0 {
        say("interrupted: --resume goes on");
        return Ok(INTERRUPTED);
    }
    Ok(code)
}

/// A plan has one command a line, in UTF-8: its folder must be written so.
fn one_line(folder: &Path) -> Result<(), Failure> {
    match folder.to_str() {
        Some(text) if !text.chars().any(char::is_control) => Ok(()),
        _ => Err(Failure {
            report: miette!(
                help =
                    "choose a folder without line ends and other control characters with --out DIR",
                "--plan: the folder {folder:?} cannot stand in a line of commands"
            ),
            code: BAD_INPUT,
        }),
    }
}

fn this_program() -> Result<OsString, Failure> {
    let path = std::env::current_exe().map_err(|error| Failure {
        report: miette!("this program cannot find itself to start its runs: {error}"),
        code: BAD_INPUT,
    })?;
    Ok(path.into())
}

/// Shows the results; the exit code is 1 unless every run came to its end.
fn finish(args: &Args, plan: &Plan, results: Value) -> Result<u8, Failure> {
    let figures = plan.folder.join("figures");
    for (stem, figure) in post::sweep_figures(&plan.folder, &results)? {
        for format in [Format::Svg, Format::Png] {
            figure.write_as(&figures, &stem, format).map_err(PostError::from)?;
        }
    }
    let page = write_sweep(&plan.folder, &results)?;
    if args.json {
        args.print_json(&results);
    } else if !args.quiet {
        report::print_sweep(&results, &plan.folder, &page);
    }
    let runs = results["runs"].as_array().map(Vec::as_slice).unwrap_or_default();
    Ok(if runs.iter().all(|run| run["status"] == "completed") { 0 } else { FAILED })
}

fn megabytes(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(mb) if mb.is_finite() && mb > 0.0 => Ok(mb),
        _ => Err("a positive number of megabytes is needed".into()),
    }
}

impl From<SweepError> for Failure {
    fn from(error: SweepError) -> Self {
        let code = error.exit_code();
        Self { report: Report::from(error), code }
    }
}
