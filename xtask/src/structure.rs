//! The crates use one another, and packages of others, as `docs/architecture.md` says.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::step::output;

/// The document with the drawing and the table.
const DRAWING: &str = "docs/architecture.md";

/// The first line of its list.
const LIST: &str = "```text crates";

/// The first line of the table of packages of others.
const TABLE: &str = "| package | for |";

/// Packages that are no part of the program.
const TOOLS: [&str; 3] = ["xtask", "tests", "benches"];

/// What differs between the drawing and the sources of the checkout at `root`, one line each.
pub fn differences(root: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(root.join(DRAWING)).unwrap_or_default();
    let list = text.lines().skip_while(|line| *line != LIST).skip(1);
    let list = list.take_while(|line| *line != "```").map(str::to_owned);
    let table = text.lines().skip_while(|line| *line != TABLE).skip(2);
    let table = table.map_while(|row| Some(row.strip_prefix("| `")?.split_once('`')?.0.to_owned()));
    let drawn: BTreeSet<String> = list.chain(table).collect();
    let built = match metadata(root) {
        Ok(metadata) => built(&metadata),
        Err(problem) => return vec![problem],
    };
    let not_built = drawn.difference(&built).map(|line| format!("{DRAWING} draws `{line}`"));
    let not_drawn = built.difference(&drawn).map(|line| format!("the sources have `{line}`"));
    not_built.chain(not_drawn).collect()
}

/// What Cargo knows of our packages.
fn metadata(root: &Path) -> Result<Value, String> {
    let words = ["metadata", "--no-deps", "--format-version", "1"];
    let metadata = output(Command::new("cargo").args(words).current_dir(root))?;
    serde_json::from_str(&metadata).map_err(|e| e.to_string())
}

/// The names of our packages, with blanks between.
pub fn packages(root: &Path) -> Result<String, String> {
    let metadata = metadata(root)?;
    let packages = metadata["packages"].as_array().into_iter().flatten();
    Ok(packages.filter_map(|package| package["name"].as_str()).collect::<Vec<_>>().join(" "))
}

/// The lines of the packages as Cargo has them, `crate: those that it uses`, and the names of the others that
/// they use; without what tests alone use.
fn built(metadata: &Value) -> BTreeSet<String> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let name = |package: &Value| {
        let name = package["name"].as_str().unwrap_or_default();
        name.strip_prefix("creepage-").unwrap_or(name).to_owned()
    };
    let ours: BTreeSet<String> = packages.clone().map(name).collect();
    let mut built = BTreeSet::new();
    for package in packages.filter(|package| !TOOLS.contains(&&*name(package))) {
        let all = package["dependencies"].as_array().into_iter().flatten();
        let used: BTreeSet<String> = all.filter(|used| used["kind"].is_null()).map(name).collect();
        let own = used.intersection(&ours).map(|used| format!(" {used}"));
        built.insert(format!("{}:{}", name(package), own.collect::<String>()));
        built.extend(used.difference(&ours).cloned());
    }
    built
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crate_is_drawn_with_those_that_it_uses_besides_its_tests() {
        let metadata = serde_json::json!({ "packages": [
            { "name": "creepage-mesh", "dependencies": [] },
            { "name": "creepage-solid", "dependencies": [
                { "name": "serde", "kind": null },
                { "name": "creepage-mesh", "kind": null },
                { "name": "creepage-tests", "kind": "dev" },
            ] },
            { "name": "creepage-tests", "dependencies": [] },
        ] });
        let wanted = ["mesh:", "solid: mesh", "serde"].map(str::to_owned);
        assert_eq!(built(&metadata), wanted.into());
    }
}
