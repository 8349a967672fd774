//! `cargo xtask soak kill-loop`: kills runs at random moments, resumes them, and compares every bit.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use runs::kill::{BUSY, EXACT_WITH_MEMORY, KillLoop, python};
use runs::project;

/// Kill runs with SIGKILL at random moments, resume them, and compare every bit with a run that was
/// not killed: half of the kills with penalty contact, half with exact contact and friction with memory.
/// Where $CREEPAGE_PYTHON, or python3, has h5py, that opens and compares the files too.
#[derive(Debug, Parser)]
struct Args {
    /// Kills in all
    #[arg(long, default_value_t = 20)]
    kills: usize,
    /// The case
    #[arg(long, value_name = "CASE.toml")]
    case: Option<PathBuf>,
    /// Set a key of the case; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Where the random moments come from
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The program
    #[arg(long, value_name = "FILE")]
    program: PathBuf,
}

fn main() -> ExitCode {
    let args = Args::parse();
    let python = python();
    println!("files are opened by creepage{}", if python.is_some() { " and h5py" } else { "" });
    let methods = [("penalty", &[][..]), ("exact, with memory", &EXACT_WITH_MEMORY)];
    for (k, (name, method)) in methods.into_iter().enumerate() {
        let sets = BUSY.iter().chain(method).map(|set| (*set).to_owned());
        let kill_loop = KillLoop {
            program: args.program.clone(),
            case: args.case.clone().unwrap_or_else(|| project("tests/small.toml")),
            sets: sets.chain(args.sets.iter().cloned()).collect(),
            kills: (args.kills + 1 - k) / 2,
            seed: args.seed + k as u64,
            python: python.clone(),
        };
        let outcome = tempfile::tempdir().map_err(|error| error.to_string()).and_then(|folder| {
            kill_loop.run(folder.path(), &mut |line| println!("{name}: {line}")).inspect_err(|_| {
                println!("{name}: its files are kept in {}", folder.keep().display())
            })
        });
        match outcome {
            Ok(outcome) => println!("{name}: {outcome:?}"),
            Err(problem) => {
                println!("{name}: {problem}");
                return ExitCode::FAILURE;
            }
        }
    }
    ExitCode::SUCCESS
}
