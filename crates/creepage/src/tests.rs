//! The modules of this crate use one another as `docs/architecture.md` says.

use std::fs;
use std::path::{Path, PathBuf};

/// Each uses only those before it; those of the last row but one also those beside them.
const ORDER: [&[&str]; 11] = [
    &["python"],
    &["rule"],
    &["case"],
    &["scenario"],
    &["run"],
    &["chart"],
    &["check"],
    &["sweep"],
    &["ls_dyna"],
    &["figures", "compare", "trends", "scene", "subsurface", "report"],
    &["commands"],
];

fn sources(path: PathBuf, found: &mut Vec<PathBuf>) {
    if path.is_dir() {
        fs::read_dir(path).unwrap().for_each(|entry| sources(entry.unwrap().path(), found));
    } else if path.extension().is_some_and(|extension| extension == "rs") {
        found.push(path);
    }
}

#[test]
fn a_module_uses_only_those_before_it() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let row = |name: &str| ORDER.iter().position(|row| row.contains(&name));
    let (mut found, mut seen) = (Vec::new(), 0);
    sources(folder.clone(), &mut found);
    for file in found {
        let within = file.strip_prefix(&folder).unwrap().iter().next().unwrap().to_string_lossy();
        let Some(own) = row(within.trim_end_matches(".rs")) else { continue };
        for used in fs::read_to_string(&file).unwrap().split("crate::").skip(1) {
            let name = used.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap();
            let Some(other) = row(name) else {
                // at the root are the macros of keys, and what the commands offer
                let known = within == "commands" || within == "commands.rs";
                assert!(known || ["key", "remedy"].contains(&name), "{}: {name}", file.display());
                continue;
            };
            seen += 1;
            assert!(other <= own, "{} uses {name}", file.display());
        }
    }
    assert!(seen > 300, "{seen}");
}
