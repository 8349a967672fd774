//! The documents' tables and pictures against the results. Tables stand between `<!-- results: NAME -->` and
//! `<!-- end of results -->`, each on a line of its own.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use super::manifest::{FOLDER, Manifest};
use super::record::Record;
use super::steps::sum;
use crate::markdown;

const BEGIN: &str = "<!-- results:";
const END: &str = "<!-- end of results -->";

/// Where the documents' pictures lie.
const PICTURES: &str = "docs/pictures";

/// All tables below a root.
pub struct Tables {
    pub manifests: BTreeMap<String, Manifest>,
    pub records: BTreeMap<String, Record>,
}

impl Tables {
    /// Reads manifests and results; what cannot be read is told in `faults`.
    pub fn read(root: &Path, faults: &mut Vec<String>) -> Self {
        let mut tables = Self { manifests: BTreeMap::new(), records: BTreeMap::new() };
        for entry in fs::read_dir(root.join(FOLDER)).into_iter().flatten().flatten() {
            let file = entry.file_name().to_string_lossy().into_owned();
            let text = fs::read_to_string(entry.path()).map_err(|error| error.to_string());
            let fault = match file.rsplit_once('.') {
                Some((name, "toml")) => text
                    .and_then(|text| Manifest::read(&text))
                    .map(|manifest| drop(tables.manifests.insert(name.into(), manifest))),
                Some((name, "json")) => text
                    .and_then(|text| serde_json::from_str(&text).map_err(|e| e.to_string()))
                    .map(|record| drop(tables.records.insert(name.into(), record))),
                _ => continue,
            };
            faults.extend(fault.err().map(|problem| format!("{FOLDER}/{file}: {problem}")));
        }
        for name in tables.records.keys().filter(|name| !tables.manifests.contains_key(*name)) {
            faults.push(format!("{FOLDER}/{name}.json: there is no manifest of this name"));
        }
        tables
    }

    /// What stands between the markers of a table; none if it was not made yet.
    fn print(&self, name: &str) -> Result<Option<String>, String> {
        let manifest = self.manifests.get(name).ok_or("there is no manifest of this name")?;
        self.records.get(name).map(|record| record.found.print(manifest)).transpose()
    }
}

/// A page with its tables printed anew. `fault` hears of markers that do not belong together and of tables that cannot
/// be printed, with their lines.
fn print(old: &str, tables: &Tables, mut fault: impl FnMut(usize, String)) -> String {
    let mut new = String::new();
    let mut in_code = false;
    let mut lines = (1..).zip(old.lines());
    while let Some((number, line)) = lines.next() {
        new = new + line + "\n";
        // a marker in a block of code is an example
        in_code ^= line.starts_with("```");
        let name = line.strip_prefix(BEGIN).and_then(|rest| rest.strip_suffix("-->"));
        let Some(name) = name.map(str::trim).filter(|_| !in_code) else {
            if line == END && !in_code {
                fault(number, format!("`{END}` without `{BEGIN} NAME -->`"));
            }
            continue;
        };
        let stands: Vec<&str> =
            lines.by_ref().map(|(_, line)| line).take_while(|line| *line != END).collect();
        let is_closed = old.lines().nth(number + stands.len()) == Some(END);
        if !is_closed || stands.iter().any(|line| line.starts_with(BEGIN)) {
            fault(number, format!("the table `{name}` has no `{END}`"));
        }
        let table = tables.print(name).unwrap_or_else(|problem| {
            fault(number, format!("table `{name}`: {problem}"));
            None
        });
        new += &table.unwrap_or_else(|| stands.iter().map(|line| format!("{line}\n")).collect());
        new = new + END + "\n";
    }
    new
}

/// The first line of a page that is not what the results say.
fn first_difference(old: &str, new: &str) -> Option<String> {
    let mut lines = (1..).zip(old.lines().zip(new.lines()));
    let (number, (old, new)) = lines.find(|(_, (old, new))| old != new)?;
    Some(format!("{number}: `{old}` stands where the results give `{new}`"))
}

/// What in the documents is not what the results say, with file and line.
pub fn check(root: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    let tables = Tables::read(root, &mut faults);
    let pages = printed(root, &tables, &mut faults);
    for (file, old, new) in &pages {
        let difference = first_difference(old, new);
        faults.extend(difference.map(|difference| format!("{file}:{difference}")));
    }
    let shows = |name: &str| {
        let marker = format!("{BEGIN} {name} -->");
        pages.iter().any(|(_, text, _)| text.contains(&marker))
    };
    let mut drawn = BTreeSet::new();
    for (name, manifest) in &tables.manifests {
        let at = format!("{FOLDER}/{name}.toml");
        drawn.extend(manifest.pictures.iter().map(|picture| picture.to.clone()));
        if !manifest.parts.is_empty() && !shows(name) {
            faults.push(format!("{at}: no document has its markers"));
        }
        let Some(record) = tables.records.get(name) else {
            if !manifest.long {
                faults.push(format!("{at}: was not made yet: cargo xtask results {name}"));
            }
            continue;
        };
        if record.steps != manifest.steps_sum() {
            faults.push(format!("{at}: its commands changed since it was made"));
        }
        for picture in &manifest.pictures {
            let kept = record.pictures.get(&picture.to);
            if kept.is_none() || sum(&root.join(&picture.to)).ok().as_ref() != kept {
                faults.push(format!("{}: is not the picture that `{name}` drew", picture.to));
            }
        }
    }
    let entries = fs::read_dir(root.join(PICTURES)).into_iter().flatten().flatten();
    let files = entries.map(|entry| format!("{PICTURES}/{}", entry.file_name().display()));
    let files: BTreeSet<String> = files.collect();
    faults.extend(files.difference(&drawn).map(|file| format!("{file}: no manifest draws it")));
    faults
}

/// Prints all results into the documents, unless a marker is missing: then what follows it would be lost.
pub fn write(root: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    let tables = Tables::read(root, &mut faults);
    let printed = printed(root, &tables, &mut faults);
    if faults.is_empty() {
        let changed = printed.into_iter().filter(|(_, old, new)| old != new);
        let written = changed.map(|(file, _, new)| fs::write(root.join(file), new));
        faults.extend(written.filter_map(|written| Some(written.err()?.to_string())));
    }
    faults
}

/// The documents by name with their texts, and their texts printed anew; `faults` gains what cannot be printed.
fn printed(
    root: &Path,
    tables: &Tables,
    faults: &mut Vec<String>,
) -> Vec<(String, String, String)> {
    let page = |file: String| {
        // that every document is there is checked with the links
        let old = fs::read_to_string(root.join(&file)).unwrap_or_default();
        let new = print(&old, tables, |line, fault| faults.push(format!("{file}:{line}: {fault}")));
        (file, old, new)
    };
    markdown::pages(root).unwrap_or_default().into_iter().map(page).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const MANIFEST: &str = "title = \"A\"\ndepends = [\"crates\"]\n\
                            tolerance = { relative = 0.0, absolute = 0.0 }\n\
                            [[step]]\nname = \"a\"\ncommand = \"true\"\n\
                            [[part]]\ntext = \"| T/N | {a > t :.3} |\"\n\
                            [[picture]]\nfrom = \"runs/p.svg\"\nto = \"docs/pictures/p.svg\"\n";
    const RECORD: &str = r#"{"date": "2000-01-01T00:00:00Z", "steps": "STEPS", "commit": "0", "uncommitted": [],
        "version": "0", "program": "0", "kernels": "avx2", "threads": 1,
        "found": {"values": {"a > t": 0.2605}, "rows": {}}, "pictures": {"docs/pictures/p.svg": "PICTURE"}}"#;
    const PAGE: &str = "# Page\n\n<!-- results: a -->\n| T/N | 0.261 |\n<!-- end of results -->\n\n\
                        ```text\n<!-- results: b -->\n```\n";

    /// A project with one table, and what changes its files.
    fn project() -> (tempfile::TempDir, impl Fn(&str, &str)) {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().to_owned();
        fs::create_dir_all(root.join(FOLDER)).unwrap();
        fs::create_dir_all(root.join(PICTURES)).unwrap();
        let put = move |file: &str, text: &str| fs::write(root.join(file), text).unwrap();
        put("README.md", "# A\n");
        put("docs/SUMMARY.md", "- [Page](page.md)\n");
        put("docs/page.md", PAGE);
        put("docs/pictures/p.svg", "<svg/>");
        put("docs/results/a.toml", MANIFEST);
        let picture = sum(&folder.path().join("docs/pictures/p.svg")).unwrap();
        let steps = Manifest::read(MANIFEST).unwrap().steps_sum();
        let record = RECORD.replace("STEPS", &steps).replace("PICTURE", &picture);
        put("docs/results/a.json", &record);
        assert_eq!(check(folder.path()), Vec::<String>::new());
        (folder, put)
    }

    #[test]
    fn a_changed_digit_in_a_table_is_told_with_its_line_and_printed_anew() {
        let (folder, put) = project();
        put("docs/page.md", &PAGE.replace("0.261", "0.271"));
        let wanted =
            "docs/page.md:4: `| T/N | 0.271 |` stands where the results give `| T/N | 0.261 |`";
        assert_eq!(check(folder.path()), [wanted]);
        write(folder.path());
        assert_eq!(fs::read_to_string(folder.path().join("docs/page.md")).unwrap(), PAGE);
    }

    #[test]
    fn markers_manifests_results_and_pictures_belong_together() {
        let (folder, put) = project();
        put("docs/page.md", &PAGE.replace("results: a", "results: b"));
        put("docs/results/c.json", &RECORD.replace("STEPS", "0"));
        put("docs/results/a.toml", &MANIFEST.replace("\"true\"", "\"true --set\""));
        put("docs/pictures/p.svg", "<svg></svg>");
        put("docs/pictures/q.png", "");
        let unshown = MANIFEST.split("[[part]]").next().unwrap();
        put("docs/results/d.toml", unshown);
        put("docs/results/e.toml", &format!("long = true\n{unshown}"));
        let wanted = [
            "docs/results/c.json: there is no manifest of this name",
            "docs/page.md:3: table `b`: there is no manifest of this name",
            "docs/results/a.toml: no document has its markers",
            "docs/results/a.toml: its commands changed since it was made",
            "docs/pictures/p.svg: is not the picture that `a` drew",
            "docs/results/d.toml: was not made yet: cargo xtask results d",
            "docs/pictures/q.png: no manifest draws it",
        ];
        assert_eq!(check(folder.path()), wanted);
    }

    #[test]
    fn a_marker_without_its_fellow_is_told_and_the_page_stays_as_it_is() {
        let (folder, put) = project();
        for (text, problem) in [
            (PAGE.replace("\n<!-- end of results -->", ""), "3: the table `a` has no"),
            (PAGE.replace("<!-- results: a -->\n", ""), "4: `<!-- end of results -->` without"),
            (PAGE.replace("| T", "<!-- results: a -->\n| T"), "3: the table `a` has no"),
        ] {
            put("docs/page.md", &text);
            let faults = write(folder.path());
            assert!(faults[0].contains(problem), "{faults:?}");
            assert_eq!(fs::read_to_string(folder.path().join("docs/page.md")).unwrap(), text);
        }
    }
}
