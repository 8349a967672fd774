//! What a table of the documents is made of: `docs/results/NAME.toml`.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use serde::Deserialize;
use sha2::{Digest, Sha256};

use super::template::{Placeholder, placeholders};

/// Where manifests and results lie, below the root.
pub const FOLDER: &str = "docs/results";

/// Commands, and how what they found is printed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// What the table shows.
    pub title: String,
    /// Whether it takes too long for every `validate`.
    #[serde(default)]
    pub long: bool,
    /// Paths of the repository, as git takes them, on which the numbers depend.
    pub depends: Vec<String>,
    /// By how much a rerun may differ.
    pub tolerance: Tolerance,
    /// Commands in their order.
    #[serde(rename = "step")]
    pub steps: Vec<Step>,
    /// What stands between the markers, from top to bottom.
    #[serde(rename = "part", default)]
    pub parts: Vec<Part>,
    /// Pictures that the commands draw.
    #[serde(rename = "picture", default)]
    pub pictures: Vec<Picture>,
}

/// A value may differ by `relative` times its size and by `absolute` besides.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    pub relative: f64,
    pub absolute: f64,
}

/// A command, run from the root of the project.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// The first word of placeholders.
    pub name: String,
    pub command: String,
    /// The file to read (`.json`, `.csv`); standard output where none is named.
    pub read: Option<String>,
    /// The exit code to expect.
    #[serde(default)]
    pub exit: i32,
    /// Whether its numbers repeat on machines with the same kernels alone.
    #[serde(default)]
    pub chaotic: bool,
}

/// Some lines with placeholders; with `each`, once for every value found there.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    pub text: String,
    pub each: Option<String>,
}

/// A picture is copied from where a command draws it into the documents.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Picture {
    pub from: String,
    pub to: String,
}

impl Part {
    /// The part's placeholders; they were read before, when the manifest was checked.
    pub fn placeholders(&self) -> Vec<Placeholder> {
        placeholders(&self.text).unwrap_or_default()
    }
}

impl Manifest {
    /// SHA-256 of the commands and of what is read of each: results of other ones are no longer the table's.
    pub fn steps_sum(&self) -> String {
        let mut sum = Sha256::new();
        for Step { name, command, read, exit, .. } in &self.steps {
            let read = read.as_deref().unwrap_or_default();
            sum.update(format!("{name}\n{command}\n{read}\n{exit}\n"));
        }
        sum.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Reads a manifest.
    pub fn read(text: &str) -> Result<Self, String> {
        let manifest: Self = toml::from_str(text).map_err(|error| error.to_string())?;
        manifest.check()?;
        Ok(manifest)
    }

    /// What the types alone do not say.
    fn check(&self) -> Result<(), String> {
        if self.depends.is_empty() {
            return Err("`depends` names nothing, so that the table would never grow old".into());
        }
        let mut names = BTreeSet::new();
        for step in &self.steps {
            if !names.insert(step.name.as_str()) {
                return Err(format!("two steps have the name `{}`", step.name));
            }
        }
        for part in &self.parts {
            let found = placeholders(&part.text)?;
            let paths = match &part.each {
                Some(each) => vec![each.clone()],
                None => found.into_iter().map(|placeholder| placeholder.path).collect(),
            };
            for path in paths {
                let step = super::extract::step_of(&path);
                if !names.contains(step) {
                    return Err(format!("{{{path}}}: there is no step `{step}`"));
                }
            }
        }
        Ok(())
    }

    /// The step that a path begins with.
    pub fn step_of(&self, path: &str) -> Option<&Step> {
        let name = super::extract::step_of(path);
        self.steps.iter().find(|step| step.name == name)
    }
}

/// All manifests below `root` by name; what cannot be read is told in `faults`.
pub fn all(root: &Path, faults: &mut Vec<String>) -> BTreeMap<String, Manifest> {
    let mut found = BTreeMap::new();
    for name in names(root, "toml") {
        let file = format!("{FOLDER}/{name}.toml");
        let read = fs::read_to_string(root.join(&file)).map_err(|error| error.to_string());
        match read.and_then(|text| Manifest::read(&text)) {
            Ok(manifest) => drop(found.insert(name, manifest)),
            Err(problem) => faults.push(format!("{file}: {problem}")),
        }
    }
    found
}

/// Names of the files of a kind among manifests and results, in order.
pub fn names(root: &Path, extension: &str) -> Vec<String> {
    let entries = fs::read_dir(root.join(FOLDER)).into_iter().flatten().flatten();
    let mut names: Vec<String> = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|found| found == extension))
        .filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    names
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const HEAD: &str = "title = \"A\"\ndepends = [\"crates\"]\ntolerance = { relative = 0.0, absolute = 0.0 }\n\
                        [[step]]\nname = \"a\"\ncommand = \"true\"\n";

    fn refused(text: &str) -> String {
        Manifest::read(text).unwrap_err()
    }

    #[test]
    fn a_manifest_that_asks_for_what_no_step_gives_is_refused() {
        let manifest = Manifest::read(&format!("{HEAD}[[part]]\ntext = \"{{a > x :.2}}\"\n"));
        assert!(!manifest.unwrap().long);
        let part = format!("{HEAD}[[part]]\ntext = \"{{b > x :.2}}\"\n");
        assert!(refused(&part).contains("no step `b`"), "{part}");
        let each = format!("{HEAD}[[part]]\neach = \"c > rows\"\ntext = \"{{x :.2}}\"\n");
        assert!(refused(&each).contains("no step `c`"), "{each}");
    }

    #[test]
    fn unknown_keys_and_names_given_twice_are_refused() {
        assert!(refused(&format!("tittle = \"A\"\n{HEAD}")).contains("tittle"));
        assert!(
            refused(&format!("{HEAD}[[step]]\nname = \"a\"\ncommand = \"\"\n"))
                .contains("two steps")
        );
        assert!(refused(&HEAD.replace("[\"crates\"]", "[]")).contains("depends"));
    }
}
