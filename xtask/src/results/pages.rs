//! The documents' tables and pictures against the results.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::Path;

use super::manifest::{self, FOLDER, Manifest};
use super::markers::{find, first_difference, replace};
use super::record::Record;
use super::steps::sum;

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
        let manifests = manifest::all(root, faults);
        let mut records = BTreeMap::new();
        for name in manifest::names(root, "json") {
            let file = format!("{FOLDER}/{name}.json");
            if !root.join(FOLDER).join(format!("{name}.toml")).exists() {
                faults.push(format!("{file}: there is no manifest {FOLDER}/{name}.toml"));
            }
            match Record::read(root, &name) {
                Ok(Some(record)) => drop(records.insert(name, record)),
                Ok(None) => {}
                Err(problem) => faults.push(format!("{file}: {problem}")),
            }
        }
        Self { manifests, records }
    }
}

/// What in the documents is not what the results say, with file and line.
pub fn check(root: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    let tables = Tables::read(root, &mut faults);
    let mut shown = BTreeSet::new();
    for (file, text) in documents(root, &mut faults) {
        let found = match find(&text) {
            Ok(found) => found,
            Err((line, problem)) => {
                faults.push(format!("{file}:{line}: {problem}"));
                continue;
            }
        };
        for marked in found {
            let (name, line) = (marked.name.as_str(), marked.begin);
            shown.insert(name.to_owned());
            if !root.join(FOLDER).join(format!("{name}.toml")).exists() {
                faults.push(format!("{file}:{line}: there is no manifest {FOLDER}/{name}.toml"));
            }
            let both = tables.manifests.get(name).zip(tables.records.get(name));
            let Some((manifest, record)) = both else { continue };
            match record.found.print(manifest) {
                Err(problem) => faults.push(format!("{file}:{line}: table `{name}`: {problem}")),
                Ok(content) => {
                    if let Some((line, problem)) = first_difference(&text, &marked, &content) {
                        faults.push(format!("{file}:{line}: table `{name}`: {problem}"));
                    }
                }
            }
        }
    }
    for (name, manifest) in &tables.manifests {
        if !manifest.parts.is_empty() && !shown.contains(name) {
            faults.push(format!("{FOLDER}/{name}.toml: no document has its markers"));
        }
        let Some(record) = tables.records.get(name) else {
            if !manifest.long {
                faults.push(format!(
                    "{FOLDER}/{name}.toml: was not made yet: cargo xtask results {name}"
                ));
            }
            continue;
        };
        if record.steps != manifest.steps_sum() {
            faults.push(format!("{FOLDER}/{name}.toml: its commands changed since it was made"));
        }
        for picture in &manifest.pictures {
            let kept = record.pictures.get(&picture.to);
            if kept.is_none() || sum(&root.join(&picture.to)).ok().as_ref() != kept {
                faults.push(format!("{}: is not the picture that `{name}` drew", picture.to));
            }
        }
    }
    faults.extend(drawn_by_hand(root, &tables));
    faults
}

/// Pictures of the documents that no manifest makes anew.
fn drawn_by_hand(root: &Path, tables: &Tables) -> Vec<String> {
    let manifests = tables.manifests.values();
    let drawn: BTreeSet<&str> = manifests
        .flat_map(|manifest| &manifest.pictures)
        .map(|picture| picture.to.as_str())
        .collect();
    let entries = fs::read_dir(root.join(PICTURES)).into_iter().flatten().flatten();
    let files = entries.map(|entry| format!("{PICTURES}/{}", entry.file_name().to_string_lossy()));
    let others: BTreeSet<String> = files.filter(|file| !drawn.contains(file.as_str())).collect();
    others.iter().map(|file| format!("{file}: no manifest draws it")).collect()
}

/// Prints all results into the documents.
pub fn write(root: &Path) -> Result<(), Vec<String>> {
    let mut faults = Vec::new();
    let tables = Tables::read(root, &mut faults);
    for (file, text) in documents(root, &mut faults) {
        let mut changed = text.clone();
        let found =
            find(&text).map_err(|(line, problem)| vec![format!("{file}:{line}: {problem}")])?;
        // from the last on, so that lines above stay where they are
        for marked in found.iter().rev() {
            let name = &marked.name;
            let both = tables.manifests.get(name).zip(tables.records.get(name));
            match both.map(|(manifest, record)| record.found.print(manifest)) {
                Some(Ok(content)) => changed = replace(&changed, marked, &content),
                Some(Err(problem)) => faults.push(format!("{file}: table `{name}`: {problem}")),
                None => {}
            }
        }
        if changed != text
            && let Err(error) = fs::write(root.join(&file), changed)
        {
            faults.push(format!("{file}: {error}"));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// The documents with their texts: the README and the pages of the book.
fn documents(root: &Path, faults: &mut Vec<String>) -> Vec<(String, String)> {
    let chapters = || -> io::Result<Vec<String>> {
        let mut names = vec!["README.md".to_owned()];
        names.extend(crate::book::pages(root)?.iter().map(|name| format!("docs/{name}")));
        names.sort();
        Ok(names)
    };
    let mut texts = Vec::new();
    match chapters() {
        Err(error) => faults.push(format!("docs: {error}")),
        Ok(names) => {
            for name in names {
                match fs::read_to_string(root.join(&name)) {
                    Ok(text) => texts.push((name, text)),
                    Err(error) => faults.push(format!("{name}: {error}")),
                }
            }
        }
    }
    texts
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::path::PathBuf;

    use super::*;

    const MANIFEST: &str = "title = \"A\"\ndepends = [\"crates\"]\n\
                            tolerance = { relative = 0.0, absolute = 0.0 }\n\
                            [[step]]\nname = \"a\"\ncommand = \"true\"\n\
                            [[part]]\ntext = \"| T/N | {a > t :.3} |\"\n";
    /// Results of the commands of the manifest.
    fn record() -> String {
        RECORD.replace("STEPS", &Manifest::read(MANIFEST).unwrap().steps_sum())
    }

    const RECORD: &str = r#"{"date": "2000-01-01T00:00:00Z", "steps": "STEPS", "commit": "0", "uncommitted": [],
        "version": "0", "program": "0", "kernels": "avx2", "threads": 1, "cases": {},
        "found": {"values": {"a > t": 0.2605}, "rows": {}}, "pictures": {}}"#;
    const PAGE: &str =
        "# Page\n\n<!-- results: a -->\n| T/N | 0.261 |\n<!-- end of results -->\n\nend\n";

    /// A project with one table.
    struct Project(PathBuf);

    impl Project {
        fn new(name: &str) -> Self {
            let root =
                std::env::temp_dir().join(format!("creepage-pages-{name}-{}", std::process::id()));
            fs::create_dir_all(root.join(FOLDER)).unwrap();
            fs::create_dir_all(root.join(PICTURES)).unwrap();
            let project = Self(root);
            project.put("README.md", "# A\n");
            project.put("docs/page.md", PAGE);
            project.put("docs/results/a.toml", MANIFEST);
            project.put("docs/results/a.json", &record());
            assert_eq!(check(&project.0), Vec::<String>::new());
            project
        }

        fn put(&self, file: &str, text: &str) {
            fs::write(self.0.join(file), text).unwrap();
        }
    }

    impl Drop for Project {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_changed_digit_in_a_table_is_told_with_table_and_line_and_printed_anew() {
        let project = Project::new("digit");
        project.put("docs/page.md", &PAGE.replace("0.261", "0.271"));
        let faults = check(&project.0);
        let wanted = "docs/page.md:4: table `a`: `| T/N | 0.271 |` stands where the results give \
                      `| T/N | 0.261 |`";
        assert_eq!(faults, [wanted]);
        write(&project.0).unwrap();
        assert_eq!(fs::read_to_string(project.0.join("docs/page.md")).unwrap(), PAGE);
    }

    #[test]
    fn a_changed_digit_in_the_results_is_told_too() {
        let project = Project::new("json");
        project.put("docs/results/a.json", &record().replace("0.2605", "0.2705"));
        assert!(check(&project.0)[0].contains("table `a`"));
    }

    #[test]
    fn a_marker_without_a_manifest_a_manifest_without_a_marker_and_results_without_either_are_told()
    {
        let project = Project::new("orphans");
        project.put("docs/page.md", &PAGE.replace("results: a", "results: b"));
        project.put("docs/results/c.json", &record());
        assert_eq!(
            check(&project.0),
            [
                "docs/results/c.json: there is no manifest docs/results/c.toml",
                "docs/page.md:3: there is no manifest docs/results/b.toml",
                "docs/results/a.toml: no document has its markers",
            ]
        );
    }

    #[test]
    fn a_table_that_was_never_made_stays_as_it_is() {
        let project = Project::new("never");
        fs::remove_file(project.0.join("docs/results/a.json")).unwrap();
        project.put("docs/page.md", &PAGE.replace("0.261", "0.3"));
        let told = "docs/results/a.toml: was not made yet: cargo xtask results a";
        assert_eq!(check(&project.0), [told]);
        write(&project.0).unwrap();
        assert!(fs::read_to_string(project.0.join("docs/page.md")).unwrap().contains("0.3 |"));
        project.put("docs/results/a.toml", &MANIFEST.replace("depends", "long = true\ndepends"));
        assert_eq!(check(&project.0), Vec::<String>::new(), "long ones may wait");
    }

    #[test]
    fn a_command_that_changed_since_the_table_was_made_is_told() {
        let project = Project::new("command");
        project.put("docs/results/a.toml", &MANIFEST.replace("\"true\"", "\"true --set\""));
        let told = "docs/results/a.toml: its commands changed since it was made";
        assert_eq!(check(&project.0), [told]);
    }

    #[test]
    fn a_picture_that_was_changed_is_told() {
        let project = Project::new("picture");
        let picture = "[[picture]]\nfrom = \"runs/p.svg\"\nto = \"docs/p.svg\"\n";
        project.put("docs/results/a.toml", &format!("{MANIFEST}{picture}"));
        project.put("docs/p.svg", "<svg/>");
        let kept = sum(&project.0.join("docs/p.svg")).unwrap();
        let record = record()
            .replace("\"pictures\": {}", &format!("\"pictures\": {{\"docs/p.svg\": \"{kept}\"}}"));
        project.put("docs/results/a.json", &record);
        assert_eq!(check(&project.0), Vec::<String>::new());
        project.put("docs/p.svg", "<svg></svg>");
        assert_eq!(check(&project.0), ["docs/p.svg: is not the picture that `a` drew"]);
    }

    #[test]
    fn a_picture_that_no_manifest_draws_is_told() {
        let project = Project::new("by-hand");
        project.put("docs/pictures/p.svg", "<svg/>");
        project.put("docs/pictures/q.png", "");
        assert_eq!(
            check(&project.0),
            [
                "docs/pictures/p.svg: no manifest draws it",
                "docs/pictures/q.png: no manifest draws it",
            ]
        );
        let picture = "[[picture]]\nfrom = \"runs/p.svg\"\nto = \"docs/pictures/p.svg\"\n";
        let steps = MANIFEST.split("[[part]]").next().unwrap();
        project.put("docs/results/p.toml", &format!("long = true\n{steps}{picture}"));
        assert_eq!(check(&project.0), ["docs/pictures/q.png: no manifest draws it"]);
    }
}
