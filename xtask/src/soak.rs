//! `cargo xtask soak`: long trials of the whole program, each a part by itself.

mod damage;
mod kills;

use std::process::ExitCode;

use crate::validate::{self, Outcome};

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
}

/// Runs one part, or all with their default options.
pub fn soak(part: Option<Part>) -> ExitCode {
    let root = validate::root();
    let outcomes = match part {
        Some(Part::Damage { options }) => vec![damage::damage(&root, &options)],
        Some(Part::Kills { options }) => vec![kills::kills(&root, &options)],
        None => vec![damage::damage(&root, &[]), kills::kills(&root, &[])],
    };
    if outcomes.iter().all(|outcome| *outcome == Outcome::Passed) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
