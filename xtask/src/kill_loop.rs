//! The loop of kills, built first: it needs the whole program, this does not.

use std::path::Path;
use std::process::{Command, ExitCode};

/// Builds program and loop and runs the latter with `options`.
pub fn kill_loop(options: &[String]) -> ExitCode {
    with_program("kill-loop", options)
}

/// Builds `creepage` and the program `tool` of the tests, and runs the latter with `options`.
pub fn with_program(tool: &str, options: &[String]) -> ExitCode {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let built = Command::new(&cargo).args(["build", "--release", "-p", "creepage"]).status();
    if !built.is_ok_and(|status| status.success()) {
        return ExitCode::FAILURE;
    }
    let target = std::env::var_os("CARGO_TARGET_DIR");
    let target = target.map_or_else(|| "target".into(), |dir| Path::new(&dir).to_path_buf());
    let program = target.join("release").join(format!("creepage{}", std::env::consts::EXE_SUFFIX));
    let done = Command::new(cargo)
        .args(["run", "--release", "-p", "creepage-tests", "--bin", tool, "--", "--program"])
        .arg(program)
        .args(options)
        .status();
    if done.is_ok_and(|status| status.success()) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
