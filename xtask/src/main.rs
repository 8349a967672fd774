//! Chores: `cargo xtask validate`, `cargo xtask kill-loop`, `cargo xtask wheel`.

mod kernels;
mod kill_loop;
mod links;
mod validate;
mod wheel;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// The project's chores.
#[derive(Debug, Parser)]
#[command(name = "xtask")]
struct Args {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Debug, Subcommand)]
enum Chore {
    /// Run every check, cheapest first: format, links, lints, documentation, tests, the schema of
    /// the case files, the kernels' instructions, a smoke run with the checks of its files, the Python package
    Validate,
    /// Build the wheel of the Python package into target/wheel
    Wheel,
    /// Kill runs at random moments, resume them, and compare every bit: `--help` after it for more
    #[command(disable_help_flag = true)]
    KillLoop {
        /// Options of the loop
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        options: Vec<String>,
    },
}

fn main() -> ExitCode {
    match Args::parse().chore {
        Chore::Validate => validate::validate(),
        Chore::Wheel => wheel::wheel(),
        Chore::KillLoop { options } => kill_loop::kill_loop(&options),
    }
}
