//! Checks of the sources that no test makes: spelling, licences of the dependencies, other machines.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::step::{Outcome, cargo, execute, files, missing, output, python};

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
    if output(Command::new("cargo-deny").arg("--version")).is_err() {
        eprintln!("warning: there is no cargo-deny; the licences of the dependencies were skipped");
        return Outcome::Skipped;
    }
    cargo(root, &["deny", "--workspace", "check", "licenses", "bans", "sources"], &[])
}

/// The program compiles for other machines, as far as their standard libraries are installed here.
pub fn other_machines(root: &Path) -> Outcome {
    let list = ["target", "list", "--installed"];
    let installed = output(Command::new("rustup").args(list)).unwrap_or_default();
    let mut outcome = Outcome::Skipped;
    for target in TARGETS {
        if !installed.lines().any(|line| line == target) {
            eprintln!("warning: {target} was skipped: `rustup target add {target}`");
            continue;
        }
        // where the operating system is the same, the crates with instructions of a processor
        let packages = match target.contains("linux") {
            true => with_instructions(root),
            false => vec!["--package=creepage".to_owned()],
        };
        let mut check = vec!["check", "--release", "--quiet", "--target", target];
        check.extend(packages.iter().map(String::as_str));
        outcome = cargo(root, &check, &[("RUSTFLAGS", "-D warnings")]);
        if outcome == Outcome::Failed {
            break;
        }
    }
    outcome
}

/// The crates whose sources depend on the processor, as options of Cargo.
fn with_instructions(root: &Path) -> Vec<String> {
    let folders = fs::read_dir(root.join("crates")).into_iter().flatten().flatten();
    let depends =
        |file: PathBuf| fs::read_to_string(file).is_ok_and(|text| text.contains("target_arch"));
    let depend = folders.filter(|folder| files(&folder.path().join("src")).any(depends));
    depend.map(|folder| format!("--package=creepage-{}", folder.file_name().display())).collect()
}
