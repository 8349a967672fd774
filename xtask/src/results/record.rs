//! What the commands of a table found: `docs/results/NAME.json`. A table is printed from it alone.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::extract::{at, one, split};
use super::manifest::{Manifest, Tolerance};
use super::template::{fill, paths};

/// Values by their paths.
pub type Values = BTreeMap<String, Value>;

/// Results with what they were made by.
#[derive(Debug, Deserialize, Serialize)]
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

impl Found {
    /// Takes what a manifest asks for from what its steps gave.
    pub fn take(manifest: &Manifest, documents: &BTreeMap<String, Value>) -> Result<Self, String> {
        let mut found = Self::default();
        let of = |step: &str| documents.get(step).unwrap_or(&Value::Null);
        for part in &manifest.parts {
            let paths = paths(&part.text)?;
            let Some(each) = &part.each else {
                for path in paths {
                    let (step, rest) = split(path);
                    found.values.insert(path.into(), taken(of(step), rest, path)?);
                }
                continue;
            };
            let (step, rest) = split(each);
            let items = match &at(of(step), rest)[..] {
                [] => return Err(format!("{{{each}}} fits nothing")),
                [Value::Array(items)] => items.iter().collect(),
                items => items.to_vec(),
            };
            let row = |item| -> Result<Values, String> {
                let value = |path: &&str| Ok(((*path).to_owned(), taken(item, path, path)?));
                paths.iter().map(value).collect()
            };
            let rows = items.into_iter().map(row).collect::<Result<_, _>>()?;
            found.rows.insert(each.clone(), rows);
        }
        Ok(found)
    }

    /// What stands between the markers.
    pub fn print(&self, manifest: &Manifest) -> Result<String, String> {
        let mut text = String::new();
        for part in &manifest.parts {
            let lacks = |path: &str| format!("the results lack {{{path}}}: make them anew");
            let rows = match &part.each {
                None => std::slice::from_ref(&self.values),
                Some(each) => self.rows.get(each).ok_or_else(|| lacks(each))?.as_slice(),
            };
            for row in rows {
                let line = fill(&part.text, |path| row.get(path).ok_or_else(|| lacks(path)))?;
                text = text + line.trim_end_matches('\n') + "\n";
            }
        }
        Ok(text)
    }

    /// Where a rerun differs from these results by more than the manifest allows. Chaotic runs and texts are
    /// compared where kernels are the `same` alone.
    pub fn differences(&self, rerun: &Self, manifest: &Manifest, same: bool) -> Vec<String> {
        let (old, new) = (self.by_path(), rerun.by_path());
        let differs = |path: &str, old: &Value| {
            let chaotic = manifest.step_of(path).is_some_and(|step| step.chaotic);
            let near = new.get(path).is_some_and(|new| near(old, new, manifest.tolerance));
            !near && (same || !(chaotic || old.is_string()))
        };
        let changed = old.iter().filter(|(path, old)| differs(path, old)).map(|(path, old)| {
            let now = new.get(path).map_or("nothing".to_owned(), |new| new.to_string());
            format!("{{{path}}} is {now} now, the document has {old}")
        });
        let came = new.keys().filter(|path| !old.contains_key(*path));
        changed.chain(came.map(|path| format!("{{{path}}} came"))).collect()
    }

    /// All values, those of rows with the number of the row in their path.
    fn by_path(&self) -> BTreeMap<String, &Value> {
        let mut all: BTreeMap<String, &Value> =
            self.values.iter().map(|(path, value)| (path.clone(), value)).collect();
        for (each, rows) in &self.rows {
            for (number, row) in rows.iter().enumerate() {
                let path = |key: &String| format!("{each} > {number} > {key}");
                all.extend(row.iter().map(|(key, value)| (path(key), value)));
            }
        }
        all
    }
}

fn taken(document: &Value, rest: &str, path: &str) -> Result<Value, String> {
    one(document, rest).cloned().map_err(|problem| format!("{{{path}}} {problem}"))
}

fn near(old: &Value, new: &Value, allowed: Tolerance) -> bool {
    match (old, new) {
        (Value::Array(old), Value::Array(new)) => {
            old.len() == new.len() && old.iter().zip(new).all(|(old, new)| near(old, new, allowed))
        }
        _ => match (old.as_f64(), new.as_f64()) {
            (Some(old), Some(new)) => {
                (new - old).abs() <= allowed.relative * old.abs() + allowed.absolute
            }
            _ => new == old,
        },
    }
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
            step = [
                { name = "a", command = "true" },
                { name = "b", command = "true", chaotic = true },
            ]
            part = [
                { text = "| name | {a > force :.1} | {b > slip :.2} |\n|---|---|---|" },
                { each = "a > rows", text = "| {name :s} | {size > 0 :.1e} | |" },
            ]
        "#;
        Manifest::read(text).unwrap()
    }

    fn found(force: f64, slip: f64, size: f64) -> Found {
        let a = json!({"force": force, "rows": [{"name": "x", "size": [size]}, {"name": "y", "size": [0.0]}]});
        let documents = BTreeMap::from([("a".into(), a), ("b".into(), json!({"slip": slip}))]);
        Found::take(&manifest(), &documents).unwrap()
    }

    #[test]
    fn a_table_is_printed_from_the_results_alone_and_what_they_lack_is_told() {
        let found = found(100.26, 0.125, 4e-16);
        let kept: Found = serde_json::from_str(&serde_json::to_string(&found).unwrap()).unwrap();
        let wanted = "| name | 100.3 | 0.12 |\n|---|---|---|\n| x | 4.0e-16 | |\n| y | 0.0e0 | |\n";
        assert_eq!(kept.print(&manifest()).unwrap(), wanted);
        let error = Found::default().print(&manifest()).unwrap_err();
        assert!(error.contains("lack {a > force}"), "{error}");
        let error = Found::take(&manifest(), &BTreeMap::new()).unwrap_err();
        assert!(error.contains("{a > force} is not in what the command gave"), "{error}");
    }

    #[test]
    fn a_rerun_beyond_the_tolerance_is_named_and_a_chaotic_one_on_the_same_kernels_alone() {
        let (old, manifest) = (found(100.0, 0.125, 4e-16), manifest());
        let differences = |new: &Found, same| old.differences(new, &manifest, same);
        assert_eq!(differences(&found(100.05, 0.125, 2e-16), true), Vec::<String>::new());
        let wanted = [
            "{a > force} is 100.2 now, the document has 100.0",
            "{a > rows > 0 > size > 0} is 0.001 now, the document has 4e-16",
        ];
        assert_eq!(differences(&found(100.2, 0.125, 1e-3), true), wanted);
        let chaotic = found(100.0, 0.15, 4e-16);
        assert_eq!(differences(&chaotic, true).len(), 1);
        assert_eq!(differences(&chaotic, false).len(), 0);
        let mut fewer = found(100.0, 0.125, 4e-16);
        fewer.rows.get_mut("a > rows").unwrap().pop();
        assert!(differences(&fewer, true)[0].contains("a > rows > 1 > name} is nothing now"));
        assert!(fewer.differences(&old, &manifest, true)[0].contains("a > rows > 1 > name} came"));
    }
}
