//! The crates use one another as `docs/architecture.md` draws it, the modules of a crate without circles, and the
//! program and the tests share what they compile.

mod circles;
mod features;
mod paths;

pub use circles::circles;
pub use features::compiled_twice;

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

/// By crate, those of the workspace that it uses.
type Graph = BTreeMap<String, BTreeSet<String>>;

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
    let drawn = drawn(&text).ok_or_else(|| format!("{DRAWING} has no block {LIST}"))?;
    let metadata = Command::new("cargo")
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .current_dir(root)
        .output()
        .map_err(|e| format!("cargo metadata: {e}"))?;
    let metadata = serde_json::from_slice(&metadata.stdout).map_err(|e| e.to_string())?;
    Ok(compared(&drawn, &built(&metadata)))
}

/// The list of the drawing: `crate: those that it uses`.
fn drawn(text: &str) -> Option<Graph> {
    let list = text.lines().skip_while(|line| *line != LIST).skip(1);
    let graph: Graph = list
        .take_while(|line| *line != "```")
        .filter_map(|line| line.split_once(':'))
        .map(|(name, used)| (name.into(), used.split_whitespace().map(str::to_owned).collect()))
        .collect();
    (!graph.is_empty()).then_some(graph)
}

/// The graph of the packages as Cargo has it, without what tests alone use.
fn built(metadata: &Value) -> Graph {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let name = |package: &Value| {
        let name = package["name"].as_str().unwrap_or_default();
        name.strip_prefix("creepage-").unwrap_or(name).to_owned()
    };
    let ours: BTreeSet<String> = packages.clone().map(name).collect();
    let used = |package: &Value| {
        let all = package["dependencies"].as_array().into_iter().flatten();
        all.filter(|used| used["kind"].is_null()).map(name).filter(|n| ours.contains(n)).collect()
    };
    packages
        .map(|package| (name(package), used(package)))
        .filter(|(name, _)| !TOOLS.contains(&name.as_str()))
        .collect()
}

fn compared(drawn: &Graph, built: &Graph) -> Vec<String> {
    let names: BTreeSet<&String> = drawn.keys().chain(built.keys()).collect();
    let nothing = BTreeSet::new();
    let mut differences = Vec::new();
    for name in names {
        match (drawn.get(name), built.get(name)) {
            (None, _) => differences.push(format!("the crate {name} is not drawn")),
            (_, None) => differences.push(format!("{name} is drawn, but there is no such crate")),
            _ => {}
        }
        let [drawn, built] = [drawn, built].map(|graph| graph.get(name).unwrap_or(&nothing));
        for used in built.difference(drawn) {
            differences.push(format!("{name} uses {used}, which is not drawn"));
        }
        for used in drawn.difference(built) {
            differences.push(format!("{name} is drawn to use {used}, and does not"));
        }
    }
    differences
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "words\n```text crates\nmesh:\nsolid: mesh\n```\nmore: words\n";

    fn metadata(uses: &str) -> Value {
        serde_json::json!({ "packages": [
            { "name": "creepage-mesh", "dependencies": [] },
            { "name": "creepage-solid", "dependencies": [
                { "name": uses, "kind": null },
                { "name": "serde", "kind": null },
                { "name": "creepage-tests", "kind": "dev" },
            ] },
            { "name": "creepage-tests", "dependencies": [] },
        ] })
    }

    #[test]
    fn a_drawing_of_the_sources_has_no_difference() {
        let drawn = drawn(TEXT).unwrap();
        assert_eq!(compared(&drawn, &built(&metadata("creepage-mesh"))), Vec::<String>::new());
    }

    #[test]
    fn what_is_used_and_not_drawn_or_drawn_and_not_used_is_named() {
        let drawn = drawn(TEXT).unwrap();
        let found = compared(&drawn, &built(&metadata("serde")));
        assert_eq!(found, ["solid is drawn to use mesh, and does not"]);
        let found = compared(&Graph::new(), &built(&metadata("creepage-mesh")));
        let expected = [
            "the crate mesh is not drawn",
            "the crate solid is not drawn",
            "solid uses mesh, which is not drawn",
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn a_document_without_the_list_is_no_drawing() {
        assert!(drawn("```text\nmesh:\n```").is_none());
    }
}
