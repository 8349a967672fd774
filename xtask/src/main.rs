//! Chores: `cargo xtask validate`, `archive`, `book`, `book-test`, `kill-loop`, `results`, `soak`, `wheel`.

mod archive;
mod book;
mod book_test;
mod chores;
mod kill_loop;
mod links;
mod markdown;
mod results;
mod shell;
mod soak;
mod sources;
mod step;
mod structure;
mod validate;
mod wheel;

use std::process::ExitCode;

use clap::Parser;

use crate::book_test::{Chosen, Long};
use crate::chores::{Args, Chore};

fn main() -> ExitCode {
    match Args::parse().chore {
        Chore::Validate => validate::validate(),
        Chore::Book => step::alone(validate::book),
        Chore::BookTest { all, rest, chapters } => {
            let long = match (all, rest) {
                (true, _) => Long::All,
                (false, true) => Long::Rest,
                (false, false) => Long::None,
            };
            let chosen = Chosen { long, chapters };
            step::alone(|root| validate::commands_of_the_book(root, &chosen))
        }
        Chore::Wheel { portable } => wheel::wheel(portable),
        Chore::Archive => archive::archive(),
        Chore::KillLoop { options } => match kill_loop::kill_loop(&step::root(), &options) {
            step::Outcome::Passed => ExitCode::SUCCESS,
            _ => ExitCode::FAILURE,
        },
        Chore::Results(options) => results::results(&options),
        Chore::Soak { part } => soak::soak(part),
    }
}
