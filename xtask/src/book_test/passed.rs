//! Which long blocks of commands passed, and when: `docs/book-test.json`. They take many hours together, so that they
//! are run a few at a time.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::{Kind, Script, arguments};
use crate::results;
use crate::shell::commands;
use crate::soak::record::Trial;
use crate::step::Outcome;

const FILE: &str = "docs/book-test.json";

/// When a block passed.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Pass {
    /// Where it stood, `file:line`.
    place: String,
    /// The day, in UTC.
    date: String,
    /// The commit that was tried, and whether files were changed since.
    commit: String,
    changed: bool,
    minutes: f64,
}

/// Blocks by their commands, and the commands that made tables.
#[derive(Debug, Default)]
pub struct Passed {
    blocks: BTreeMap<String, Pass>,
    tables: BTreeSet<Vec<String>>,
}

impl Passed {
    /// What is kept in the checkout at `root` of the blocks that the book still has.
    pub fn read(root: &Path, scripts: &[Script]) -> Result<Self, String> {
        let file = root.join(FILE);
        let told = |error: &dyn std::fmt::Display| format!("{FILE}: {error}");
        let mut blocks: BTreeMap<String, Pass> = if file.exists() {
            let text = fs::read_to_string(&file).map_err(|error| told(&error))?;
            serde_json::from_str(&text).map_err(|error| told(&error))?
        } else {
            BTreeMap::new()
        };
        blocks.retain(|text, _| scripts.iter().any(|script| script.text == *text));
        let steps = results::made_commands(root);
        Ok(Self { blocks, tables: of_tables(&steps) })
    }

    /// Keeps that a block passed now.
    pub fn keep(&mut self, root: &Path, script: &Script, seconds: f64) -> Result<(), String> {
        let (text, place) = (script.text.clone(), script.at.clone());
        let passed = (Outcome::Passed, String::new());
        let trial = Trial::ended(root, text.clone(), passed, Duration::from_secs_f64(seconds));
        self.blocks.extend(trial.map(|Trial { date, commit, changed, minutes, .. }| {
            (text, Pass { place, date, commit, changed, minutes })
        }));
        let text = serde_json::to_string_pretty(&self.blocks).map_err(|error| error.to_string())?;
        fs::write(root.join(FILE), text + "\n").map_err(|error| format!("{FILE}: {error}"))
    }

    /// How many of the long blocks passed as they stand, and how many made tables.
    pub fn told(&self, scripts: &[Script]) -> String {
        let long = scripts.iter().filter(|script| matches!(script.kind, Kind::Long { .. }));
        let (passed, others): (Vec<&Script>, Vec<&Script>) =
            long.partition(|script| self.blocks.contains_key(&script.text));
        let tables = others.iter().filter(|script| self.made_tables(script)).count();
        format!(
            "of {} long blocks {} have passed as they stand ({FILE}), {tables} have made tables",
            passed.len() + others.len(),
            passed.len()
        )
    }

    /// Whether a block passed as it stands, or made a table.
    pub fn has(&self, script: &Script) -> bool {
        self.blocks.contains_key(&script.text) || self.made_tables(script)
    }

    fn made_tables(&self, script: &Script) -> bool {
        commands(&script.text).iter().all(|words| self.tables.contains(&what_runs(words)))
    }
}

/// What the commands of tables run. Long ones go on with a sweep that was interrupted (`--resume`), which ends with the
/// results of the whole sweep.
fn of_tables(steps: &[impl AsRef<str>]) -> BTreeSet<Vec<String>> {
    let whole = |mut words: Vec<String>| {
        words.retain(|word| word != "--resume");
        what_runs(&words)
    };
    steps.iter().flat_map(|step| commands(step.as_ref())).map(whole).collect()
}

/// A command without what only says where its results and its pictures go and in which form.
fn what_runs(words: &[String]) -> Vec<String> {
    let mut kept = Vec::new();
    let mut words = arguments(words).unwrap_or(words).iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--out" | "--format" => drop(words.next()),
            // that it draws matters
            "--plot" => {
                words.next();
                kept.push(word.clone());
            }
            "--force" | "--json" | "--quiet" => {}
            // the runs of the tables lie beside those that a reader makes
            _ => kept.push(word.replace("runs/docs/", "runs/")),
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::super::scripts;
    use super::*;

    fn script(kind: Kind, text: &str) -> Script {
        Script { at: "docs/a.md:1".into(), kind, text: text.into() }
    }

    fn passed(blocks: &[&str], tables: &[&str]) -> Passed {
        let pass = Pass {
            place: "docs/a.md:1".into(),
            date: "2026-01-02".into(),
            commit: "abc".into(),
            changed: false,
            minutes: 1.0,
        };
        let blocks = blocks.iter().map(|text| ((*text).to_owned(), pass.clone())).collect();
        Passed { blocks, tables: of_tables(tables) }
    }

    #[test]
    fn a_block_that_passed_as_it_stands_or_made_a_table_is_known() {
        let long = Kind::Long { exit: 0 };
        let scripts = [
            script(long, "creepage sweep a.toml"),
            script(long, "creepage sweep a.toml --resume"),
            script(long, "creepage sweep a.toml\ncreepage plot runs/a --with runs/b"),
            script(long, "creepage verify lamb"),
            script(long, "creepage verify --plot pictures"),
            script(long, "creepage verify rupture"),
            script(long, "creepage verify rupture --plot pictures"),
            script(Kind::Run { exit: 0 }, "creepage run c.toml"),
        ];
        let steps = [
            "creepage sweep a.toml --out runs/docs/a --resume",
            "creepage plot runs/docs/a --with runs/docs/b --format png",
            "creepage verify --json --plot runs/docs/verify",
            "creepage verify rupture --json",
        ];
        let passed = passed(&["creepage verify lamb"], &steps);
        let has = scripts.each_ref().map(|script| passed.has(script));
        assert_eq!(has, [true, false, true, true, true, true, false, false]);
        assert_eq!(
            passed.told(&scripts),
            "of 7 long blocks 1 have passed as they stand (docs/book-test.json), 4 have made tables"
        );
    }

    #[test]
    fn what_the_project_keeps_of_its_blocks_is_read() {
        let root = crate::step::root();
        let mut scripts = scripts(&root, &mut Vec::new()).unwrap();
        let kept = |scripts: &[Script]| Passed::read(&root, scripts).unwrap().blocks;
        let blocks = kept(&scripts);
        assert!(!blocks.is_empty());
        // of a block that has changed it is not said that it passed
        scripts.iter_mut().for_each(|script| script.text.push('#'));
        assert!(kept(&scripts).is_empty());
    }
}
