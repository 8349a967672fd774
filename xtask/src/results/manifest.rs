//! What a table of the documents is made of: `docs/results/NAME.toml`.

use std::collections::BTreeSet;

use serde::Deserialize;

use super::extract::split;
use super::steps::sum_of;
use super::template::paths;

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

impl Manifest {
    /// Reads a manifest.
    pub fn read(text: &str) -> Result<Self, String> {
        let manifest: Self = toml::from_str(text).map_err(|error| error.to_string())?;
        if manifest.depends.is_empty() {
            return Err("`depends` names nothing, so that the table would never grow old".into());
        }
        let mut names = BTreeSet::new();
        for Step { name, .. } in &manifest.steps {
            if !names.insert(name) {
                return Err(format!("two steps have the name `{name}`"));
            }
        }
        for part in &manifest.parts {
            let in_text = paths(&part.text)?;
            let of_steps = part.each.as_deref().map_or(in_text, |each| vec![each]);
            if let Some(path) = of_steps.into_iter().find(|path| manifest.step_of(path).is_none()) {
                return Err(format!("{{{path}}}: there is no step `{}`", split(path).0));
            }
        }
        Ok(manifest)
    }

    /// The step that a path begins with.
    pub fn step_of(&self, path: &str) -> Option<&Step> {
        self.steps.iter().find(|step| step.name == split(path).0)
    }

    /// SHA-256 of the commands and of what is read of each: results of other ones are no longer the table's.
    pub fn steps_sum(&self) -> String {
        let line = |Step { name, command, read, exit, .. }: &Step| {
            format!("{name}\n{command}\n{}\n{exit}\n", read.as_deref().unwrap_or_default())
        };
        let lines: String = self.steps.iter().map(line).collect();
        sum_of(lines)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_manifest_that_contradicts_itself_is_refused() {
        let head = "title = \"A\"\ndepends = [\"a\"]\ntolerance = { relative = 0.0, absolute = 0.0 }\n\
             [[step]]\nname = \"a\"\ncommand = \"true\"\n";
        let read = |more: &str| Manifest::read(&format!("{head}{more}"));
        assert!(!read("[[part]]\ntext = \"{a > x :.2}\"\n").unwrap().long);
        for (more, problem) in [
            ("[[part]]\ntext = \"{b > x :.2}\"\n", "no step `b`"),
            ("[[part]]\neach = \"c > rows\"\ntext = \"{x :.2}\"\n", "no step `c`"),
            ("[[step]]\nname = \"a\"\ncommand = \"\"\n", "two steps"),
            ("[[peace]]\n", "peace"),
        ] {
            assert!(read(more).unwrap_err().contains(problem), "{more}");
        }
        let young = head.replace("[\"a\"]", "[]");
        assert!(Manifest::read(&young).unwrap_err().contains("never grow old"));
    }
}
