//! `cargo xtask soak damage`: damages files of runs at random and judges what the program makes of them.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use runs::damage::Trial;
use runs::project;

/// Damage one random file of a run at a time: cut it short, empty it, flip a bit, change a byte, zero a
/// page, swap or double a block, delete it. `creepage check` of a complete run must then give the same
/// numbers or end with 2 and the file's name; an interrupted run must be resumed to the same bits, or the
/// resuming end with 2 and the file's name, and with --force succeed.
#[derive(Debug, Parser)]
struct Args {
    /// Mutations of the complete run, and as many of the interrupted one
    #[arg(long, default_value_t = 500)]
    mutations: usize,
    /// Where the random choices come from
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The case
    #[arg(long, value_name = "CASE.toml")]
    case: Option<PathBuf>,
    /// The program
    #[arg(long, value_name = "FILE")]
    program: PathBuf,
}

fn main() -> ExitCode {
    let args = Args::parse();
    println!("{} mutations of each kind of run, seed {}", args.mutations, args.seed);
    let trial = Trial {
        program: args.program,
        case: args.case.unwrap_or_else(|| project("tests/small.toml")),
        mutations: args.mutations,
        seed: args.seed,
    };
    let outcome = tempfile::tempdir()
        .map_err(|error| error.to_string())
        .and_then(|folder| trial.run(folder.path(), &mut |line| println!("{line}")));
    match outcome {
        Ok(outcome) => {
            println!("{outcome}");
            if outcome.faults.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(problem) => {
            println!("{problem}");
            ExitCode::FAILURE
        }
    }
}
