//! Files of runs damaged at random; the trial itself is built first, since it needs the whole program.

use std::path::Path;

use crate::kill_loop::with_program;
use crate::step::Outcome;

/// Builds program and trial and runs the latter with `options`; gives what it said last, too.
pub fn damage(root: &Path, options: &[String]) -> (Outcome, String) {
    with_program(root, "damage", options)
}

/// A seeded sample for every change: 30 damaged files.
pub fn sample(root: &Path) -> Outcome {
    damage(root, &["--mutations", "15", "--seed", "1"].map(str::to_owned)).0
}
