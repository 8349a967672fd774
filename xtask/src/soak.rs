//! `cargo xtask soak`: long trials of whole runs, which are programs of the tests, and the samples of `validate`.

use std::path::Path;
use std::process::Command;

use crate::step::{Ended, built, done, output, skipped};

/// What is tried.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum Trial {
    /// Damage the files of runs at random, and see what is made of them
    Damage,
    /// Kill a short run at every system call that changes its folder
    Kills,
    /// Kill runs at random moments, resume them, and compare every bit
    KillLoop,
}

/// Builds the program and the trial, and runs the latter with `options`.
pub fn soak(root: &Path, trial: Trial, options: &[impl AsRef<str>]) -> Ended {
    let tool = match trial {
        Trial::Damage => "damage",
        Trial::Kills => "kill-points",
        Trial::KillLoop => "kill-loop",
    };
    let mut trial = Command::new(built(root, tool)?);
    trial.arg("--program").arg(built(root, "creepage")?);
    done(trial.args(options.iter().map(AsRef::as_ref)).current_dir(root))
}

/// The same eight kills of each kind of run in every `validate`.
pub fn sample_of_kills(root: &Path) -> Ended {
    if output(Command::new("strace").args(["-f", "-o", "/dev/null", "true"])).is_err() {
        return skipped("there is no strace that may trace; the trial of kills at system calls");
    }
    soak(root, Trial::Kills, &["--points", "8"])
}
