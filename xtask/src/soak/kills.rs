//! Kills at every system call, by the program `kill-points` of the tests.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::kill_loop::with_program;
use crate::step::Outcome;

/// Builds program and kills and runs the latter with `options`; gives what it said last, too.
pub fn kills(root: &Path, options: &[String]) -> (Outcome, String) {
    with_program(root, "kill-points", options)
}

/// Points of each kind of run that are tried on every change.
const SAMPLE: &str = "8";

/// A sample, always the same.
pub fn sample(root: &Path) -> Outcome {
    let mut strace = Command::new("strace");
    strace.args(["-f", "-o", "/dev/null", "true"]).stdout(Stdio::null()).stderr(Stdio::null());
    if !strace.status().is_ok_and(|status| status.success()) {
        eprintln!(
            "warning: there is no strace that may trace; the kills at system calls were skipped"
        );
        return Outcome::Skipped;
    }
    kills(root, &["--points".into(), SAMPLE.into()]).0
}
