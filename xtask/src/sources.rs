//! Checks of the sources that no test makes: spelling, licences of the dependencies, other machines.

use std::path::Path;
use std::process::Command;

use crate::step::{Outcome, cargo, execute, missing, python};

/// The machines that the sources must compile for, besides the one at hand.
const TARGETS: [&str; 3] =
    ["aarch64-apple-darwin", "aarch64-unknown-linux-gnu", "x86_64-pc-windows-gnu"];

/// No known misspelling in sources, documents and cases, but for the words of `_typos.toml`.
pub fn spelling(root: &Path) -> Outcome {
    match python(root) {
        Ok(python) => execute(Command::new(python.with_file_name("typos")).current_dir(root)),
        Err(problem) => missing(&problem, "the spelling"),
    }
}

/// Every dependency comes from the registry, under a licence that `deny.toml` allows. Machines without
/// cargo-deny skip this.
pub fn licences(root: &Path) -> Outcome {
    if !Command::new("cargo-deny").arg("--version").output().is_ok_and(|told| told.status.success())
    {
        eprintln!("warning: there is no cargo-deny; the licences of the dependencies were skipped");
        return Outcome::Skipped;
    }
    cargo(root, &["deny", "--workspace", "check", "licenses", "bans", "sources"], &[])
}

/// The program compiles for other machines, as far as their standard libraries are installed here.
pub fn other_machines(root: &Path) -> Outcome {
    let installed = Command::new("rustup").args(["target", "list", "--installed"]).output();
    let installed = match installed {
        Ok(told) if told.status.success() => String::from_utf8_lossy(&told.stdout).into_owned(),
        _ => String::new(),
    };
    let mut outcome = Outcome::Skipped;
    for target in TARGETS {
        if !installed.lines().any(|line| line == target) {
            eprintln!("warning: {target} was skipped: `rustup target add {target}`");
            continue;
        }
        let check = ["check", "--package", "creepage", "--quiet", "--target", target];
        outcome = cargo(root, &check, &[("RUSTFLAGS", "-D warnings")]);
        if outcome == Outcome::Failed {
            break;
        }
    }
    outcome
}
