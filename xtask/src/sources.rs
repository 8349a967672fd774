//! Checks of the sources that no test makes: spelling, licences of the dependencies, other machines.

use std::path::Path;
use std::process::Command;

use crate::step::{Outcome, cargo, execute, missing, python};

/// The machines that the sources must compile for, besides the one at hand, and what is checked there: the program, or
/// where the operating system is the same, the crates with instructions of a processor.
const TARGETS: [(&str, &[&str]); 3] = [
    ("aarch64-apple-darwin", &["creepage"]),
    ("aarch64-unknown-linux-gnu", &["creepage-solid", "creepage-dynamics", "creepage-halfspace"]),
    ("x86_64-pc-windows-gnu", &["creepage"]),
];

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
    for (target, packages) in TARGETS {
        if !installed.lines().any(|line| line == target) {
            eprintln!("warning: {target} was skipped: `rustup target add {target}`");
            continue;
        }
        let packages = packages.iter().flat_map(|package| ["--package", package]);
        let check: Vec<&str> = ["check", "--release", "--quiet", "--target", target]
            .into_iter()
            .chain(packages)
            .collect();
        outcome = cargo(root, &check, &[("RUSTFLAGS", "-D warnings")]);
        if outcome == Outcome::Failed {
            break;
        }
    }
    outcome
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::collections::BTreeSet;
    use std::fs;

    use super::*;

    /// Whether a file below `folder` says `word`.
    fn says(folder: &Path, word: &str) -> bool {
        fs::read_dir(folder).unwrap().any(|entry| {
            let path = entry.unwrap().path();
            if path.is_dir() {
                says(&path, word)
            } else {
                fs::read_to_string(&path).is_ok_and(|text| text.contains(word))
            }
        })
    }

    #[test]
    fn every_crate_with_instructions_of_a_processor_is_checked_for_another_one() {
        let crates = fs::read_dir(crate::step::root().join("crates")).unwrap();
        let folders = crates.map(|entry| entry.unwrap().path());
        let found: BTreeSet<String> = folders
            .filter(|folder| says(&folder.join("src"), "target_arch"))
            .map(|folder| format!("creepage-{}", folder.file_name().unwrap().display()))
            .collect();
        let checked: BTreeSet<String> = TARGETS[1].1.iter().map(|name| (*name).into()).collect();
        assert_eq!(found, checked);
    }
}
