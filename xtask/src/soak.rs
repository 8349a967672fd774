//! `cargo xtask soak`: long trials of the whole program, each a part by itself.

mod damage;

use std::process::ExitCode;

use crate::validate::{self, Outcome};

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
}

/// Runs one part, or all with their default options.
pub fn soak(part: Option<Part>) -> ExitCode {
    let root = validate::root();
    let outcome = match part {
        Some(Part::Damage { options }) => damage::damage(&root, &options),
        None => damage::damage(&root, &[]),
    };
    if outcome == Outcome::Passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The short form of every part.
pub fn sample(root: &std::path::Path) -> Outcome {
    damage::sample(root)
}
