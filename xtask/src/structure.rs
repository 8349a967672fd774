//! The crates use one another as `docs/architecture.md` draws it, and the program and the tests share what they compile.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::step::output;

/// The document with the drawing.
const DRAWING: &str = "docs/architecture.md";

/// The first line of its list.
const LIST: &str = "```text crates";

/// Packages that are no part of the program.
const TOOLS: [&str; 3] = ["xtask", "tests", "benches"];

/// What differs between the drawing and the sources of the checkout at `root`, one line each.
pub fn differences(root: &Path) -> Result<Vec<String>, String> {
    let text =
        std::fs::read_to_string(root.join(DRAWING)).map_err(|e| format!("{DRAWING}: {e}"))?;
    let list = text.lines().skip_while(|line| *line != LIST).skip(1);
    let drawn: BTreeSet<String> =
        list.take_while(|line| *line != "```").map(str::to_owned).collect();
    let words = ["metadata", "--no-deps", "--format-version", "1"];
    let metadata = output(Command::new("cargo").args(words).current_dir(root))?;
    let metadata = serde_json::from_str(&metadata).map_err(|e| e.to_string())?;
    let built = built(&metadata);
    let not_built = drawn.difference(&built).map(|line| format!("{DRAWING} draws `{line}`"));
    let not_drawn = built.difference(&drawn).map(|line| format!("the sources have `{line}`"));
    Ok(not_built.chain(not_drawn).collect())
}

/// The lines of the packages as Cargo has them, `crate: those that it uses`, without what tests alone use.
fn built(metadata: &Value) -> BTreeSet<String> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let name = |package: &Value| {
        let name = package["name"].as_str().unwrap_or_default();
        name.strip_prefix("creepage-").unwrap_or(name).to_owned()
    };
    let ours: BTreeSet<String> = packages.clone().map(name).collect();
    let line = |package: &Value| {
        let all = package["dependencies"].as_array().into_iter().flatten();
        let used: BTreeSet<String> = all.filter(|used| used["kind"].is_null()).map(name).collect();
        let used = used.intersection(&ours).map(|used| format!(" {used}"));
        format!("{}:{}", name(package), used.collect::<String>())
    };
    packages.filter(|package| !TOOLS.contains(&&*name(package))).map(line).collect()
}

/// The builds that the tests go on from: the README's first command, and all commands of the program.
const BUILDS: [&[&str]; 2] =
    [&["--package", "creepage", "--no-default-features"], &["--package", "creepage"]];

/// Foreign packages that a build selects with other features than the tests: Cargo would compile them again.
pub fn compiled_twice(root: &Path) -> Result<Vec<String>, String> {
    let tests = foreign(root, &["--workspace", "--edges", "normal,build,dev"])?;
    let mut differ = BTreeSet::new();
    for build in BUILDS {
        let build = foreign(root, &[build, &["--edges", "normal,build"]].concat())?;
        differ.extend(build.difference(&tests).cloned());
    }
    let remedy =
        "has other features than in the tests: name those of the tests in crates/cli/Cargo.toml";
    Ok(differ.iter().map(|package| format!("{package} {remedy}")).collect())
}

/// The packages of a selection with their versions and features, without our own, whose lines name their folder.
fn foreign(root: &Path, selection: &[&str]) -> Result<BTreeSet<String>, String> {
    let words = ["tree", "--no-dedupe", "--prefix", "none", "--format", "{p} {f}"];
    let tree = output(Command::new("cargo").args(words).args(selection).current_dir(root))?;
    let is_foreign =
        |line: &&str| !line.is_empty() && !line.contains(" (/") && !line.contains(":\\");
    Ok(tree.lines().filter(is_foreign).map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crate_is_drawn_with_those_of_ours_that_it_uses_besides_its_tests() {
        let metadata = serde_json::json!({ "packages": [
            { "name": "creepage-mesh", "dependencies": [] },
            { "name": "creepage-solid", "dependencies": [
                { "name": "serde", "kind": null },
                { "name": "creepage-mesh", "kind": null },
                { "name": "creepage-tests", "kind": "dev" },
            ] },
            { "name": "creepage-tests", "dependencies": [] },
        ] });
        assert_eq!(built(&metadata), ["mesh:", "solid: mesh"].map(str::to_owned).into());
    }
}
