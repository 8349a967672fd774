//! What the commands of a table found: `docs/results/NAME.json`. A table is printed from it alone.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::extract::{at, in_step, one};
use super::manifest::{FOLDER, Manifest, Tolerance};
use super::template::fill;

/// Values by their paths.
pub type Values = BTreeMap<String, Value>;

/// Results with what they were made by.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// When, in UTC.
    pub date: String,
    /// SHA-256 of the commands and of what was read of each.
    pub steps: String,
    /// The last commit that changed what the table depends on, when its commands began.
    pub commit: String,
    /// What of it was changed and not committed.
    pub uncommitted: Vec<String>,
    /// The program's version, and the SHA-256 of its file.
    pub version: String,
    pub program: String,
    /// Instruction set of the element kernels.
    pub kernels: String,
    /// Threads of the machine.
    pub threads: usize,
    /// SHA-256 of the resolved case of each run, by its file.
    pub cases: BTreeMap<String, String>,
    pub found: Found,
    /// SHA-256 of each picture.
    pub pictures: BTreeMap<String, String>,
}

/// The numbers and texts of a table.
#[derive(Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Found {
    pub values: Values,
    /// Rows of the parts with `each`.
    pub rows: BTreeMap<String, Vec<Values>>,
}

impl Record {
    /// Where the results of a table lie.
    pub fn file(root: &Path, name: &str) -> PathBuf {
        root.join(FOLDER).join(format!("{name}.json"))
    }

    /// The results of a table, if there are any.
    pub fn read(root: &Path, name: &str) -> Result<Option<Self>, String> {
        let file = Self::file(root, name);
        if !file.exists() {
            return Ok(None);
        }
        let text = fs::read_to_string(&file).map_err(|error| error.to_string())?;
        serde_json::from_str(&text).map(Some).map_err(|error| error.to_string())
    }

    /// Keeps them.
    pub fn write(&self, root: &Path, name: &str) -> Result<(), String> {
        let text = serde_json::to_string_pretty(self).map_err(|error| error.to_string())?;
        let file = Self::file(root, name);
        fs::write(&file, text + "\n").map_err(|error| format!("{}: {error}", file.display()))
    }
}

impl Found {
    /// Takes what a manifest asks for from what its steps gave.
    pub fn take(manifest: &Manifest, documents: &BTreeMap<String, Value>) -> Result<Self, String> {
        let mut found = Self::default();
        let of = |path: &str| documents.get(super::extract::step_of(path)).unwrap_or(&Value::Null);
        for part in &manifest.parts {
            let placeholders = part.placeholders();
            let Some(each) = &part.each else {
                for placeholder in placeholders {
                    let path = placeholder.path;
                    let value = one(&in_step(of(&path), &path), &path)?.clone();
                    found.values.insert(path, value);
                }
                continue;
            };
            let items = match &in_step(of(each), each)[..] {
                [Value::Array(items)] => items.iter().collect(),
                items => items.to_vec(),
            };
            if items.is_empty() {
                return Err(format!("{{{each}}} fits nothing"));
            }
            let mut rows = Vec::new();
            for item in items {
                let mut row = Values::new();
                for placeholder in &placeholders {
                    let path: Vec<&str> = placeholder.path.split(" > ").map(str::trim).collect();
                    let value = one(&at(item, &path), &placeholder.path)?.clone();
                    row.insert(placeholder.path.clone(), value);
                }
                rows.push(row);
            }
            found.rows.insert(each.clone(), rows);
        }
        Ok(found)
    }

    /// What stands between the markers.
    pub fn print(&self, manifest: &Manifest) -> Result<String, String> {
        let mut text = String::new();
        for part in &manifest.parts {
            let placeholders = part.placeholders();
            let lacks = |path: &str| format!("the results lack {{{path}}}: make them anew");
            let get = |values: &'_ Values, path: &str| values.get(path).cloned().ok_or(lacks(path));
            let rows = match &part.each {
                None => std::slice::from_ref(&self.values),
                Some(each) => self.rows.get(each).ok_or(lacks(each))?.as_slice(),
            };
            for row in rows {
                let line = fill(&part.text, &placeholders, |path| get(row, path))?;
                text.push_str(line.trim_end_matches('\n'));
                text.push('\n');
            }
        }
        Ok(text)
    }

    /// Where a rerun differs from these results by more than the manifest allows. Chaotic runs and texts are
    /// compared where kernels are the `same` alone.
    pub fn differences(&self, rerun: &Self, manifest: &Manifest, same: bool) -> Vec<String> {
        let compare = |step: &str, path: &str, old: &Value, new: Option<&Value>| {
            let chaotic = manifest.step_of(step).is_some_and(|step| step.chaotic);
            let compared = same || (!chaotic && !old.is_string());
            compared.then(|| difference(path, old, new, manifest.tolerance)).flatten()
        };
        let mut faults = Vec::new();
        for (path, old) in &self.values {
            faults.extend(compare(path, path, old, rerun.values.get(path)));
        }
        for (each, rows) in &self.rows {
            let anew = rerun.rows.get(each).map(Vec::as_slice).unwrap_or_default();
            for (number, row) in rows.iter().enumerate() {
                for (key, old) in row {
                    let new = anew.get(number).and_then(|row| row.get(key));
                    faults.extend(compare(each, &format!("{each} > {number} > {key}"), old, new));
                }
            }
            if anew.len() > rows.len() {
                faults.push(format!("{{{each}}}: {} rows instead of {}", anew.len(), rows.len()));
            }
        }
        faults
    }
}

fn difference(path: &str, old: &Value, new: Option<&Value>, allowed: Tolerance) -> Option<String> {
    let near = match (old.as_f64(), new.and_then(Value::as_f64)) {
        (Some(old), Some(new)) => {
            (new - old).abs() <= allowed.relative * old.abs() + allowed.absolute
        }
        _ => match (old.as_array(), new.and_then(Value::as_array)) {
            (Some(old), Some(new)) if old.len() == new.len() => old
                .iter()
                .zip(new)
                .all(|(old, new)| difference(path, old, Some(new), allowed).is_none()),
            _ => new == Some(old),
        },
    };
    let now = new.map_or("nothing".to_owned(), Value::to_string);
    (!near).then(|| format!("{{{path}}} is {now} now, the document has {old}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use serde_json::json;

    use super::*;

    fn manifest() -> Manifest {
        let text = r#"
            title = "A"
            depends = ["crates"]
            tolerance = { relative = 1e-3, absolute = 1e-12 }
            [[step]]
            name = "a"
            command = "true"
            [[step]]
            name = "b"
            command = "true"
            chaotic = true
            [[part]]
            text = """
            | name | {a > force :.1} | {b > slip :.2} |
            |---|---|---|
            """
            [[part]]
            each = "a > rows"
            text = "| {name :s} | {size > 0 :.1e} | |"
        "#;
        Manifest::read(text).unwrap()
    }

    fn found(force: f64, slip: f64, size: f64) -> Found {
        let a = json!({"force": force, "rows": [{"name": "x", "size": [size]}, {"name": "y", "size": [0.0]}]});
        let documents = BTreeMap::from([("a".into(), a), ("b".into(), json!({"slip": slip}))]);
        Found::take(&manifest(), &documents).unwrap()
    }

    #[test]
    fn a_table_is_printed_from_the_results_alone() {
        let found = found(100.26, 0.125, 4e-16);
        let kept: Found = serde_json::from_str(&serde_json::to_string(&found).unwrap()).unwrap();
        let wanted = "            | name | 100.3 | 0.12 |\n            |---|---|---|\n            \
                      \n| x | 4.0e-16 | |\n| y | 0.0e0 | |\n";
        assert_eq!(kept.print(&manifest()).unwrap(), wanted);
    }

    #[test]
    fn what_the_results_lack_is_told_with_its_path() {
        let error = Found::default().print(&manifest()).unwrap_err();
        assert!(error.contains("lack {a > force}"), "{error}");
        let error = Found::take(&manifest(), &BTreeMap::new()).unwrap_err();
        assert!(error.contains("{a > force} is not in what the command gave"), "{error}");
    }

    #[test]
    fn a_rerun_within_the_tolerance_is_well_and_one_beyond_it_is_named() {
        let (old, manifest) = (found(100.0, 0.125, 4e-16), manifest());
        let differences = |new: &Found, same| old.differences(new, &manifest, same);
        assert_eq!(differences(&found(100.05, 0.125, 2e-16), true), Vec::<String>::new());
        let beyond = differences(&found(100.2, 0.125, 1e-3), true);
        assert_eq!(beyond.len(), 2, "{beyond:?}");
        assert!(beyond[0].contains("{a > force} is 100.2 now, the document has 100.0"));
        assert!(beyond[1].contains("a > rows > 0 > size > 0"));
    }

    #[test]
    fn chaotic_runs_are_compared_on_the_same_kernels_alone() {
        let (old, manifest) = (found(100.0, 0.125, 0.0), manifest());
        let other = found(100.0, 0.15, 0.0);
        assert_eq!(old.differences(&other, &manifest, true).len(), 1);
        assert_eq!(old.differences(&other, &manifest, false).len(), 0);
    }

    #[test]
    fn rows_that_came_or_went_are_told() {
        let (mut fewer, all, manifest) = (found(1.0, 1.0, 1.0), found(1.0, 1.0, 1.0), manifest());
        fewer.rows.get_mut("a > rows").unwrap().pop();
        assert!(fewer.differences(&all, &manifest, true)[0].contains("2 rows instead of 1"));
        assert!(all.differences(&fewer, &manifest, true)[0].contains("is nothing now"));
    }
}
