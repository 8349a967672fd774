//! Chores: `cargo xtask validate`.

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
    /// Run every check, cheapest first: format, lints, docs, tests, a smoke run with its checks
    Validate,
}

fn main() -> ExitCode {
    match Args::parse().chore {
        Chore::Validate => validate::validate(),
    }
}
