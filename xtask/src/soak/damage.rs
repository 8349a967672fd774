//! Files of runs damaged at random; the trial itself is built first, since it needs the whole program.

use std::path::Path;

use crate::validate::{Outcome, cargo, program};

/// Builds program and trial and runs the latter with `options`.
pub fn damage(root: &Path, options: &[String]) -> Outcome {
    if cargo(root, &["build", "--release", "-p", "creepage"], &[]) == Outcome::Failed {
        return Outcome::Failed;
    }
    let program = program(root).display().to_string();
    let trial = ["run", "--release", "-p", "creepage-tests", "--bin", "damage", "--", "--program"];
    let options = options.iter().map(String::as_str);
    let words: Vec<&str> = trial.into_iter().chain([program.as_str()]).chain(options).collect();
    cargo(root, &words, &[])
}

/// A seeded sample for every change: 30 damaged files.
pub fn sample(root: &Path) -> Outcome {
    damage(root, &["--mutations", "15", "--seed", "1"].map(str::to_owned))
}
