//! The chores by their names and options on the command line.

use clap::{Parser, Subcommand};

use crate::{results, soak};

/// The project's chores.
#[derive(Debug, Parser)]
#[command(name = "xtask")]
pub struct Args {
    /// Which one.
    #[command(subcommand)]
    pub chore: Chore,
}

#[derive(Debug, Subcommand)]
pub enum Chore {
    /// Run every check, cheapest first, up to the first that fails
    Validate,
    /// Build the documents as a book, target/book/html, and check its links and its equations
    Book,
    /// Run the commands of the documents in a copy of the checkout, and check the long ones
    BookTest {
        /// Run the long ones, too, and keep which passed in docs/book-test.json; this takes many hours
        #[arg(long)]
        all: bool,
        /// Of the long ones, run those that have not passed as they stand and made no table
        #[arg(long, conflicts_with = "all")]
        rest: bool,
        /// Documents whose commands are run, `verdict.md`, or blocks of them, `verdict.md:190`, with those that they need
        /// [default: all]
        chapters: Vec<String>,
    },
    /// Build the wheel of the Python package into target/wheel
    Wheel {
        /// For every Linux with glibc 2.17 or newer, linked by zig, which pip installs
        #[arg(long)]
        portable: bool,
    },
    /// Build the static program with completions and manual pages, target/archive/creepage-....tar.gz
    Archive,
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
