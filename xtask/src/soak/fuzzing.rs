//! Every reader under libFuzzer, for a while each.

use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::available_parallelism;

use crate::step::Outcome;

/// How long, and what.
#[derive(Debug, clap::Args)]
pub struct Options {
    /// Targets [default: all]
    targets: Vec<String>,
    /// Minutes of each
    #[arg(long, default_value_t = 10)]
    minutes: u32,
}

impl Options {
    /// All targets, `minutes` each.
    pub fn all(minutes: u32) -> Self {
        Self { targets: Vec::new(), minutes }
    }

    /// As they are typed.
    pub fn shown(&self) -> String {
        let targets: String = self.targets.iter().map(|target| format!(" {target}")).collect();
        format!("cargo xtask soak fuzzing{targets} --minutes {}", self.minutes)
    }
}

/// Targets that read HDF5: small lists of changes to a seed go farther than files.
const LISTS: [&str; 3] = ["grid", "history", "checkpoint"];
/// Words that make up a text, by target.
const WORDS: [(&str, &str); 3] =
    [("case", "case"), ("formula", "formula"), ("keywords", "keywords")];

/// Runs the targets one after the other; what is found lies in `fuzz/artifacts`.
pub fn fuzzing(root: &Path, options: &Options) -> (Outcome, String) {
    let mut there = Command::new("cargo");
    there.args(["+nightly", "fuzz", "--version"]).stdout(Stdio::null()).stderr(Stdio::null());
    if !there.status().is_ok_and(|status| status.success()) {
        eprintln!("warning: `cargo +nightly fuzz` is not there (fuzz/README.md); no fuzzing");
        return (Outcome::Skipped, String::new());
    }
    let targets = match targets(root, &options.targets) {
        Ok(targets) => targets,
        Err(problem) => {
            eprintln!("error: {problem}");
            return (Outcome::Failed, problem);
        }
    };
    let jobs = available_parallelism().map_or(1, usize::from);
    let mut found = Vec::new();
    for target in &targets {
        let mut fuzz = Command::new("cargo");
        fuzz.args(["+nightly", "fuzz", "run", "-s", "none", "-j", &jobs.to_string(), target, "--"]);
        let longest = if LISTS.contains(&target.as_str()) { 400 } else { 4096 };
        fuzz.args(["-timeout=5", "-rss_limit_mb=512", &format!("-max_len={longest}")]);
        fuzz.arg(format!("-max_total_time={}", 60 * options.minutes));
        if let Some((_, words)) = WORDS.iter().find(|(name, _)| name == target) {
            fuzz.arg(format!("-dict=fuzz/{words}.dict"));
        }
        if !fuzz.current_dir(root).status().is_ok_and(|status| status.success()) {
            found.push(target.clone());
        }
    }
    let all = format!("{} min of {} each", options.minutes, targets.join(", "));
    if found.is_empty() {
        return (Outcome::Passed, format!("{all}: nothing found"));
    }
    (Outcome::Failed, format!("{all}: found something in {}", found.join(", ")))
}

/// The targets asked for, all if none.
fn targets(root: &Path, asked: &[String]) -> Result<Vec<String>, String> {
    let folder = root.join("fuzz/fuzz_targets");
    let entries = std::fs::read_dir(&folder).map_err(|error| error.to_string())?;
    let names = entries.flatten().map(|entry| entry.path());
    let mut all: Vec<String> =
        names.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect();
    all.sort();
    match asked.iter().find(|target| !all.contains(target)) {
        Some(unknown) => Err(format!("there is no target {unknown}: {}", all.join(", "))),
        None if asked.is_empty() => Ok(all),
        None => Ok(asked.to_vec()),
    }
}
