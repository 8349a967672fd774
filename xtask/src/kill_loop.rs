//! The loop of kills, built first: it needs the whole program, this does not.

use std::path::Path;
use std::process::Command;

use crate::validate::{Outcome, built, execute};

/// Builds program and loop and runs the latter with `options`.
pub fn kill_loop(root: &Path, options: &[String]) -> Outcome {
    with_program(root, "kill-loop", options)
}

/// Builds `creepage` and the program `tool` of the tests, and runs the latter with `options`.
pub fn with_program(root: &Path, tool: &str, options: &[String]) -> Outcome {
    let (Some(program), Some(tool)) = (built(root, "creepage"), built(root, tool)) else {
        return Outcome::Failed;
    };
    execute(Command::new(tool).arg("--program").arg(program).args(options).current_dir(root))
}
