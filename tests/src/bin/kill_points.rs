//! `cargo xtask soak kills`: kills a short run at every system call that changes its folder.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use runs::kill_points::{KillPoints, SHORT, can_trace};
use runs::project;

/// Kill a short run (one that begins, one that replaces another, one that is resumed) after every system call
/// that changes its folder, and see that it then goes on, or begins anew, to the same bits. Needs strace.
#[derive(Debug, Parser)]
struct Args {
    /// States of each kind of run, drawn at random [default: all]
    #[arg(long)]
    points: Option<usize>,
    /// Where the random draw comes from
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// One kind of run alone: begun, replaced or resumed [default: all]
    #[arg(long, value_parser = ["begun", "replaced", "resumed"])]
    kind: Option<String>,
    /// The case
    #[arg(long, value_name = "CASE.toml")]
    case: Option<PathBuf>,
    /// Set a key of the case; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// The program
    #[arg(long, value_name = "FILE")]
    program: PathBuf,
}

fn main() -> ExitCode {
    let args = Args::parse();
    if !can_trace() {
        println!("there is no strace that may trace: nothing was killed");
        return ExitCode::from(2);
    }
    let kill_points = KillPoints {
        program: args.program,
        case: args.case.unwrap_or_else(|| project("tests/small.toml")),
        sets: SHORT.iter().map(|set| (*set).to_owned()).chain(args.sets).collect(),
        sample: args.points,
        seed: args.seed,
        kind: args.kind,
    };
    let outcome = tempfile::tempdir().map_err(|error| error.to_string()).and_then(|folder| {
        kill_points.run(folder.path(), &mut |line| println!("{line}")).inspect_err(|_| {
            println!("the folder is kept in {}", folder.keep().display());
        })
    });
    match outcome {
        Ok(outcome) => println!("all the same bits: {outcome:?}"),
        Err(problem) => {
            println!("{problem}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
