//! Chores: `cargo xtask validate`, `book`, `book-test`, `kill-loop`, `results`, `soak`, `wheel`.

mod book;
mod book_test;
mod kernels;
mod kill_loop;
mod links;
mod markdown;
mod results;
mod shell;
mod soak;
mod structure;
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
    /// Build the documents as a book, target/book/html, and check its links and its equations
    Book,
    /// Run the commands of the documents in a copy of the checkout, and check the long ones
    BookTest {
        /// Run the long ones, too
        #[arg(long)]
        all: bool,
    },
    /// Build the wheel of the Python package into target/wheel
    Wheel,
    /// Kill runs at random moments, resume them, and compare every bit: `--help` after it for more
    #[command(disable_help_flag = true)]
    KillLoop {
        /// Options of the loop
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        options: Vec<String>,
    },
    /// Tables and pictures of the documents: make them anew from the commands of docs/results/NAME.toml
    Results(results::Options),
    /// Long trials of the whole program: all of them, or one
    Soak {
        #[command(subcommand)]
        part: Option<soak::Part>,
    },
}

fn main() -> ExitCode {
    match Args::parse().chore {
        Chore::Validate => validate::validate(),
        Chore::Book => validate::alone(validate::book),
        Chore::BookTest { all: false } => validate::alone(validate::book_test),
        Chore::BookTest { all: true } => validate::alone(validate::all_of_the_book),
        Chore::Wheel => wheel::wheel(),
        Chore::KillLoop { options } => match kill_loop::kill_loop(&validate::root(), &options) {
            validate::Outcome::Passed => ExitCode::SUCCESS,
            _ => ExitCode::FAILURE,
        },
        Chore::Results(options) => results::results(&options),
        Chore::Soak { part } => soak::soak(part),
    }
}
