//! The loop of kills, built first: it needs the whole program, this does not.

use std::path::Path;
use std::process::Command;

use crate::step::{Outcome, built, telling};

/// Builds program and loop and runs the latter with `options`.
pub fn kill_loop(root: &Path, options: &[String]) -> Outcome {
    with_program(root, "kill-loop", options).0
}

/// Builds `creepage` and the program `tool` of the tests, and runs the latter with `options`; gives what it said
/// last, too.
pub fn with_program(root: &Path, tool: &str, options: &[String]) -> (Outcome, String) {
    let (Some(program), Some(tool)) = (built(root, "creepage"), built(root, tool)) else {
        return (Outcome::Failed, "it does not build".into());
    };
    telling(Command::new(tool).arg("--program").arg(program).args(options).current_dir(root))
}
