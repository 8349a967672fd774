//! Checks of the sources that no test makes: spelling, other machines.

use std::path::Path;
use std::process::Command;

use crate::step::{Ended, Outcome, cargo, done, missing, output, part, python};

/// The machines that the sources must compile for, besides the one at hand.
const TARGETS: [&str; 3] =
    ["aarch64-apple-darwin", "aarch64-unknown-linux-gnu", "x86_64-pc-windows-gnu"];

/// The crates whose sources depend on the processor.
const WITH_INSTRUCTIONS: [&str; 3] =
    ["--package=creepage-dynamics", "--package=creepage-halfspace", "--package=creepage-solid"];

/// No known misspelling in sources, documents and cases, but for the words of `_typos.toml`.
pub fn spelling(root: &Path) -> Ended {
    match python(root) {
        Ok(python) => done(Command::new(python.with_file_name("typos")).current_dir(root)),
        Err(problem) => missing(problem, "the spelling"),
    }
}

/// The program compiles for other machines, as far as their standard libraries are installed here; the continuous
/// integration takes one of them in turn.
pub fn other_machines(root: &Path) -> Ended {
    let list = ["target", "list", "--installed"];
    let installed = output(Command::new("rustup").args(list)).unwrap_or_default();
    let (here, elsewhere): (Vec<_>, Vec<_>) =
        TARGETS.into_iter().partition(|target| installed.lines().any(|line| line == *target));
    for target in elsewhere {
        eprintln!("warning: {target} was skipped: `rustup target add {target}`");
    }
    let mut outcome = Outcome::Skipped;
    let chosen = part(root).map(|part| part.div_ceil(2) % here.len().max(1));
    for (_, target) in here.into_iter().enumerate().filter(|(n, _)| chosen.is_none_or(|c| c == *n))
    {
        // where the operating system is the same, the crates with instructions of a processor
        let packages = match target.contains("linux") {
            true => &WITH_INSTRUCTIONS[..],
            // with the features of the whole workspace, so that macros are compiled once
            false => &["--workspace", "--bin=creepage"],
        };
        let check = [&["check", "--release", "--quiet", "--target", target], packages].concat();
        outcome = cargo(root, &check, &[("RUSTFLAGS", "-D warnings")])?;
    }
    Ok(outcome)
}
