//! Chores: `cargo xtask validate`, `archive`, `book`, `book-test`, `results`, `soak`, `wheel`.

mod archive;
mod book;
mod book_test;
mod markdown;
mod results;
mod soak;
mod sources;
mod step;
mod structure;
mod validate;
mod wheel;

use std::process::ExitCode;

use clap::builder::PossibleValuesParser;
use clap::{Parser, Subcommand};

/// The project's chores.
#[derive(Debug, Parser)]
#[command(name = "xtask")]
struct Args {
    /// Only read the command line
    #[arg(long, hide = true)]
    check_args: bool,
    /// Which one
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Debug, Subcommand)]
enum Chore {
    /// Run every check, cheapest first, up to the first that fails
    Validate {
        /// Run these alone [default: all]
        #[arg(value_parser = PossibleValuesParser::new(validate::STEPS.map(|(name, _)| name)))]
        steps: Vec<String>,
    },
    /// Check the links of the documents and build them as a book, target/book/html
    Book,
    /// Run the short commands of the documents in a copy of the checkout, and read the others
    BookTest(book_test::Options),
    /// Build the wheel of the Python package into target/wheel
    Wheel {
        /// For every Linux with glibc 2.17 or newer, linked by zig, which pip installs
        #[arg(long)]
        portable: bool,
    },
    /// Build the static program with completions and manual pages, target/archive/creepage-....tar.gz
    Archive,
    /// Tables and pictures of the documents: make them anew from the commands of docs/results/NAME.toml
    Results(results::Options),
    /// Long trials of whole runs
    Soak {
        /// Which one
        trial: soak::Trial,
        /// Its options: `-- --help` shows them
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        options: Vec<String>,
    },
}

fn main() -> ExitCode {
    let args = Args::parse();
    if args.check_args {
        return ExitCode::SUCCESS;
    }
    match args.chore {
        Chore::Validate { steps } => validate::validate(&steps),
        Chore::Book => step::alone(book::step),
        Chore::BookTest(options) => step::alone(|root| book_test::test(root, &options)),
        Chore::Wheel { portable } => step::made(|root| wheel::wheel(root, portable)),
        Chore::Archive => step::made(archive::archive),
        Chore::Results(options) => step::alone(|root| results::results(root, &options)),
        Chore::Soak { trial, options } => step::alone(|root| soak::soak(root, trial, &options)),
    }
}
