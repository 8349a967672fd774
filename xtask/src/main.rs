//! Chores: `cargo xtask validate`.

mod kernels;
mod links;
mod validate;

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
    /// the case files, the kernels' instructions, a smoke run with the checks of its files
    Validate,
}

fn main() -> ExitCode {
    match Args::parse().chore {
        Chore::Validate => validate::validate(),
    }
}
