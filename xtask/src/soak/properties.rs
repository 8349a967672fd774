//! The property tests with many samples, drawn anew.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

use crate::step::{Outcome, execute};

/// How many samples, and which.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Samples of each property
    #[arg(long, default_value_t = 4000)]
    samples: u32,
    /// Seed of the samples [default: from the time]
    #[arg(long)]
    seed: Option<u64>,
}

impl Options {
    /// This many samples.
    pub fn new(samples: u32) -> Self {
        Self { samples, seed: None }
    }

    /// As they are typed.
    pub fn shown(&self) -> String {
        let seed = self.seed.map(|seed| format!(" --seed {seed}")).unwrap_or_default();
        format!("cargo xtask soak properties --samples {}{seed}", self.samples)
    }
}

/// Runs the tests of every crate that draws samples.
pub fn properties(root: &Path, options: &Options) -> (Outcome, String) {
    let crates = match crates(root) {
        Ok(crates) => crates,
        Err(problem) => {
            eprintln!("error: {problem}");
            return (Outcome::Failed, problem);
        }
    };
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let seed = options.seed.unwrap_or(now);
    let mut test = Command::new("cargo");
    test.args(["test", "--release", "--no-fail-fast"]).current_dir(root);
    test.env("PROPTEST_CASES", options.samples.to_string());
    test.env("PROPTEST_RNG_SEED", seed.to_string());
    for name in &crates {
        test.args(["--package", &format!("creepage-{name}")]);
    }
    let outcome = execute(&mut test);
    let end = if outcome == Outcome::Passed { "all hold" } else { "a property fails" };
    let samples = options.samples;
    (outcome, format!("{samples} samples (seed {seed}) of {}: {end}", crates.join(", ")))
}

/// Folders of the crates that draw samples.
fn crates(root: &Path) -> Result<Vec<String>, String> {
    let entries = fs::read_dir(root.join("crates")).map_err(|error| error.to_string())?;
    let mut names = Vec::new();
    for folder in entries.flatten().map(|entry| entry.path()) {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        if manifest.lines().any(|line| line.starts_with("proptest")) {
            names.extend(folder.file_name().and_then(|name| name.to_str()).map(str::to_owned));
        }
    }
    names.sort();
    Ok(names)
}
