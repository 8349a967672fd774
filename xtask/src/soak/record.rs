//! What the long trials found last: `docs/soak.json`, and its table in `docs/soak.md`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use serde::{Deserialize, Serialize};

use crate::step::Outcome;

const FILE: &str = "docs/soak.json";
const PAGE: &str = "docs/soak.md";
const BEGIN: &str = "<!-- soak -->";
const END: &str = "<!-- end of soak -->";

/// A trial as it went.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Trial {
    /// The command that repeats it.
    pub command: String,
    /// The day, in UTC.
    pub date: String,
    /// The commit that was tried, and whether files were changed since.
    pub commit: String,
    pub changed: bool,
    pub minutes: f64,
    pub passed: bool,
    /// What it said last.
    pub said: String,
}

impl Trial {
    /// A trial that ended now, after `time`; none where it was skipped.
    pub fn ended(
        root: &Path,
        command: String,
        (outcome, said): (Outcome, String),
        time: Duration,
    ) -> Option<Self> {
        let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
        let git = |words: &[&str]| {
            let output = std::process::Command::new("git").args(words).current_dir(root).output();
            output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
        };
        (outcome != Outcome::Skipped).then(|| Self {
            command,
            date: now.split('T').next().unwrap_or_default().to_owned(),
            commit: git(&["rev-parse", "--short", "HEAD"]).unwrap_or_default(),
            changed: git(&["status", "--porcelain", "--", "crates", "tests"])
                .is_ok_and(|changed| !changed.is_empty()),
            minutes: (time.as_secs_f64() / 6.0).round() / 10.0,
            passed: outcome == Outcome::Passed,
            said,
        })
    }
}

/// The trials by their names.
type Trials = BTreeMap<String, Trial>;

/// Keeps a trial in place of the one before it of the same name, and prints the table anew.
pub fn keep(root: &Path, name: &str, trial: Trial) -> Result<(), String> {
    let mut trials = read(root)?;
    trials.insert(name.to_owned(), trial);
    let text = serde_json::to_string_pretty(&trials).map_err(|error| error.to_string())?;
    write(&root.join(FILE), &(text + "\n"))?;
    let page = text_of(&root.join(PAGE))?;
    write(&root.join(PAGE), &with_table(&page, &table(&trials))?)
}

fn read(root: &Path) -> Result<Trials, String> {
    let file = root.join(FILE);
    if !file.exists() {
        return Ok(Trials::new());
    }
    serde_json::from_str(&text_of(&file)?).map_err(|error| format!("{FILE}: {error}"))
}

fn text_of(file: &Path) -> Result<String, String> {
    fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))
}

fn write(file: &Path, text: &str) -> Result<(), String> {
    fs::write(file, text).map_err(|error| format!("{}: {error}", file.display()))
}

fn table(trials: &Trials) -> String {
    let mut text = "| trial | command | when, of which commit | minutes | what it said last |\n\
                    |---|---|---|---|---|\n"
        .to_owned();
    for (name, trial) in trials {
        let Trial { command, date, commit, minutes, said, .. } = trial;
        let changed = if trial.changed { ", changed" } else { "" };
        let failed = if trial.passed { "" } else { "**failed:** " };
        let said = said.replace('|', "\\|");
        text.push_str(&format!(
            "| {name} | `{command}` | {date}, {commit}{changed} | {minutes} | {failed}{said} |\n"
        ));
    }
    text
}

/// The page with this table between its markers.
fn with_table(page: &str, table: &str) -> Result<String, String> {
    let lacks = || format!("{PAGE} has no `{BEGIN}` and `{END}`");
    let (before, rest) = page.split_once(BEGIN).ok_or_else(lacks)?;
    let (_, after) = rest.split_once(END).ok_or_else(lacks)?;
    Ok(format!("{before}{BEGIN}\n{table}{END}{after}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn the_page_says_what_the_trials_said() {
        let root = crate::step::root();
        let page = text_of(&root.join(PAGE)).unwrap();
        let trials = read(&root).unwrap();
        assert!(!trials.is_empty());
        assert_eq!(with_table(&page, &table(&trials)).unwrap(), page);
    }

    #[test]
    fn a_trial_that_failed_stands_out_and_replaces_what_stood_there() {
        let trial = Trial {
            command: "cargo xtask soak kills".into(),
            date: "2026-01-02".into(),
            commit: "abc".into(),
            changed: true,
            minutes: 1.5,
            passed: false,
            said: "1 | fault".into(),
        };
        let table = table(&Trials::from([("kills".to_owned(), trial)]));
        let page = with_table("a\n<!-- soak -->\nold\n<!-- end of soak -->\nb\n", &table).unwrap();
        assert!(page.contains("2026-01-02, abc, changed | 1.5 | **failed:** 1 \\| fault |"));
        assert!(page.starts_with("a\n") && page.ends_with("\nb\n") && !page.contains("old"));
        assert!(with_table("no markers", &table).is_err());
    }
}
