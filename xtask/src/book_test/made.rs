//! Runs that the tables of the documents made a moment ago, for commands that would make them again.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::arguments;
use crate::book::copy;
use crate::results;
use crate::shell::commands;

/// Runs and sweeps of the short tables that are younger than the program.
#[derive(Debug, Default)]
pub struct Made(Vec<(Vec<String>, PathBuf)>);

impl Made {
    /// Those of the checkout at `root`, made by `program`.
    pub fn of(root: &Path, program: &Path) -> Self {
        let built = modified(program);
        let steps = results::short_commands(root);
        let made = steps.iter().filter_map(|step| run(&commands(step).pop()?));
        let fresh = made.filter(|(_, folder)| {
            let ends = ["summary.json", "sweep.json"].map(|file| root.join(folder).join(file));
            built.is_some() && ends.iter().any(|file| modified(file) > built)
        });
        Self(fresh.map(|(command, folder)| (command, root.join(folder))).collect())
    }

    /// Puts the results of a script into `scratch` where all of its commands are runs that were made, and says
    /// whether they were.
    pub fn take(&self, script: &str, scratch: &Path) -> io::Result<bool> {
        let wanted: Option<Vec<_>> = commands(script).iter().map(|words| run(words)).collect();
        let found = wanted.unwrap_or_default().into_iter().map(|(command, to)| {
            let made = self.0.iter().find(|(made, _)| *made == command);
            made.map(|(_, from)| (from, scratch.join(to)))
        });
        let Some(copies) = found.collect::<Option<Vec<_>>>() else { return Ok(false) };
        copies.iter().try_for_each(|(from, to)| copy(from, to))?;
        Ok(!copies.is_empty())
    }
}

/// A command that makes a run or a sweep: its words without those of the folder, and the folder.
fn run(words: &[String]) -> Option<(Vec<String>, PathBuf)> {
    let command = arguments(words)?;
    if !["run", "sweep"].contains(&command.first()?.as_str()) {
        return None;
    }
    // by their name, which is that of the file
    let mut folder = Path::new("runs").join(Path::new(command.get(1)?).file_stem()?);
    let mut kept = Vec::new();
    let mut words = command.iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--out" => folder = words.next()?.into(),
            "--force" => {}
            _ => kept.push(word.clone()),
        }
    }
    Some((kept, folder))
}

/// The folders that a script makes, in order, and whether what lies there may stay or be replaced.
pub fn folders_made(script: &str) -> Vec<(PathBuf, bool)> {
    let again = ["--force", "--resume", "--plan", "--collect"];
    let made = commands(script).into_iter().filter_map(|words| {
        let may_be_there = words.iter().any(|word| again.contains(&word.as_str()));
        Some((run(&words)?.1, may_be_there))
    });
    made.collect()
}

/// The folders below `runs` that a script makes, and those that it names besides.
pub fn folders(script: &str) -> (BTreeSet<PathBuf>, BTreeSet<PathBuf>) {
    let made: BTreeSet<PathBuf> =
        folders_made(script).into_iter().map(|(folder, _)| folder).collect();
    let words = commands(script).into_iter().flatten().map(PathBuf::from);
    let named = words.filter(|word| word.starts_with("runs") && !made.contains(word)).collect();
    (made, named)
}

fn modified(file: &Path) -> Option<SystemTime> {
    fs::metadata(file).and_then(|metadata| metadata.modified()).ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn of(line: &str) -> Option<(String, PathBuf)> {
        run(&commands(line)[0]).map(|(words, folder)| (words.join(" "), folder))
    }

    #[test]
    fn a_run_is_the_same_whatever_its_folder_is_called() {
        let wanted = "run cases/quick.toml --set a=1";
        for (line, folder) in [
            ("creepage run cases/quick.toml --set a=1 --force", "runs/quick"),
            ("creepage run cases/quick.toml --out runs/docs/q --force --set a=1", "runs/docs/q"),
            ("cargo run --release -- run cases/quick.toml --set a=1", "runs/quick"),
            (
                "cargo run --release --no-default-features -- run cases/quick.toml --set a=1",
                "runs/quick",
            ),
            ("target/release/creepage run cases/quick.toml --set a=1", "runs/quick"),
        ] {
            assert_eq!(of(line), Some((wanted.to_owned(), folder.into())), "{line}");
        }
        assert_eq!(of("creepage check runs/quick"), None);
        for other in ["git status", "git run a", "cargo run --release -p creepage-mesh", "cargo"] {
            assert_eq!(of(other), None, "{other}");
        }
    }

    #[test]
    fn a_script_is_taken_only_where_all_of_it_was_made() {
        let folder = std::env::temp_dir().join(format!("creepage-made-{}", std::process::id()));
        let (made, scratch) = (folder.join("made"), folder.join("scratch"));
        fs::create_dir_all(&made).unwrap();
        fs::write(made.join("summary.json"), "{}").unwrap();
        let made = Made(vec![(vec!["run".into(), "a.toml".into()], made)]);
        assert!(made.take("creepage run a.toml --force", &scratch).unwrap());
        assert!(scratch.join("runs/a/summary.json").exists());
        for script in ["creepage run b.toml", "creepage run a.toml\ncreepage check runs/a", ""] {
            assert!(!made.take(script, &scratch).unwrap(), "{script}");
        }
        fs::remove_dir_all(&folder).unwrap();
    }
}
