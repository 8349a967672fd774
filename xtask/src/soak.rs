//! `cargo xtask soak`: long trials of the whole program, each a part by itself. What each found last stands in
//! `docs/soak.md`.

mod damage;
mod fuzzing;
mod kills;
mod properties;
pub mod record;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use self::record::Trial;
use crate::results;
use crate::step::{self, Outcome};

pub use damage::sample as sample_of_damage;
pub use kills::sample as sample_of_kills;

/// What to try.
#[derive(Debug, clap::Subcommand)]
pub enum Part {
    /// Damage the files of complete and interrupted runs at random, and see what is made of them:
    /// `--help` after it for more
    #[command(disable_help_flag = true)]
    Damage {
        /// Options of the trial
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        options: Vec<String>,
    },
    /// Kill a short run at every system call that changes its folder: `--help` after it for more
    #[command(disable_help_flag = true)]
    Kills {
        /// Options of the kills
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        options: Vec<String>,
    },
    /// Run every fuzz target for a while
    Fuzzing(fuzzing::Options),
    /// Run the property tests with many new samples
    Properties(properties::Options),
    /// Make the long tables of the documents again, and compare
    Tables,
}

/// Mutations of each run that damage is tried with.
const MUTATIONS: &str = "500";
/// Samples of each property.
const SAMPLES: u32 = 4000;
/// Minutes of each fuzz target.
const MINUTES: u32 = 10;

/// Runs one part, or all in full.
pub fn soak(part: Option<Part>) -> ExitCode {
    let root = step::root();
    let parts = part.map_or_else(all, |part| vec![part]);
    let outcomes: Vec<Outcome> = parts.iter().map(|part| run(&root, part)).collect();
    if outcomes.contains(&Outcome::Failed) { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn all() -> Vec<Part> {
    let damage = Part::Damage { options: vec!["--mutations".into(), MUTATIONS.into()] };
    let fuzzing = Part::Fuzzing(fuzzing::Options::all(MINUTES));
    let properties = Part::Properties(properties::Options::new(SAMPLES));
    vec![damage, Part::Kills { options: Vec::new() }, fuzzing, properties, Part::Tables]
}

/// Runs a part and keeps what it said.
fn run(root: &Path, part: &Part) -> Outcome {
    let typed = |name: &str, options: &[String]| {
        let options: String = options.iter().map(|option| format!(" {option}")).collect();
        format!("cargo xtask soak {name}{options}")
    };
    let start = Instant::now();
    let (name, command, found) = match part {
        Part::Damage { options } => {
            ("damage", typed("damage", options), damage::damage(root, options))
        }
        Part::Kills { options } => ("kills", typed("kills", options), kills::kills(root, options)),
        Part::Fuzzing(options) => ("fuzzing", options.shown(), fuzzing::fuzzing(root, options)),
        Part::Properties(options) => {
            ("properties", options.shown(), properties::properties(root, options))
        }
        Part::Tables => ("tables", typed("tables", &[]), results::compare_long(root)),
    };
    let outcome = found.0;
    let kept = Trial::ended(root, command, found, start.elapsed())
        .map_or(Ok(()), |trial| record::keep(root, name, trial));
    match kept {
        Ok(()) => outcome,
        Err(problem) => {
            eprintln!("error: {problem}");
            Outcome::Failed
        }
    }
}
