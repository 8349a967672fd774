//! `creepage run`.

use std::io::Write;
use std::path::PathBuf;

use ::run::RunOptions;
use miette::miette;
use serde_json::Value;

use crate::args::{Args, stop_flag};
use crate::case_file::{load, placed};
use crate::embedded::Told;
use crate::failure::{Failure, INTERRUPTED, STOPPED_BY_GUARD};
use crate::progress::Watch;
use crate::report;
use crate::stop::Stop;
use crate::threads::{all_cores, threads};

/// Options of `run`.
#[derive(Debug, clap::Args)]
pub struct RunArgs {
    /// The case file
    #[arg(value_name = "CASE.toml")]
    pub case: PathBuf,
    /// Folder of the run [default: runs/NAME, by the name of the case]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Set a key of the case, for example mesh.zone.size=2e-3; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Take the kernels whose bits every processor can give, at some cost in speed; the same as
    /// --set deterministic=true
    #[arg(long)]
    pub deterministic: bool,
    /// Go on with the run in the folder from its last checkpoint, to the same bits; with --force,
    /// begin anew where there is none of this case
    #[arg(long)]
    pub resume: bool,
    /// Replace the run that is already in the folder
    #[arg(long)]
    pub force: bool,
    /// Keep the preload in this folder, and take it from there if a run with the same has been
    #[arg(long, value_name = "DIR")]
    pub preload_cache: Option<PathBuf>,
    /// Live as long as standard input is open, and print progress: how a sweep holds its runs
    #[arg(long, hide = true)]
    pub leash: bool,
}

impl RunArgs {
    /// What is laid over the case file.
    pub fn sets(&self) -> Vec<String> {
        let pinned = self.deterministic.then(|| "deterministic=true".to_owned());
        self.sets.iter().cloned().chain(pinned).collect()
    }
}

/// Runs a case.
pub fn command(args: &Args, options: &RunArgs) -> Result<u8, Failure> {
    let sets = options.sets();
    let case = load(args, &options.case, &sets)?;
    let out = options.out.clone().unwrap_or_else(|| ::run::folder::default_folder(&case));
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
    let result = ::run::run(&case, &run_options, &stop, &mut |progress| {
        if progress.stage == scenario::Stage::Roll {
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

/// Ends the run with the process at the other end of standard input: in order where that asks for
/// it, at once where it is gone.
fn hold_leash(stop: Stop) -> Result<(), Failure> {
    let held = std::thread::Builder::new().spawn(move || {
        for line in std::io::stdin().lines().map_while(Result::ok) {
            if line == ::sweep::schedule::STOP {
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
