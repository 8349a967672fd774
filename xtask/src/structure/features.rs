//! What a newcomer compiles first is what the tests use: Cargo compiles a package again where its features differ.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// The builds that the tests go on from: the README's first command, and all commands of the program.
const BUILDS: [&[&str]; 2] =
    [&["--package", "creepage", "--no-default-features"], &["--package", "creepage"]];

/// Foreign packages that a build selects with other features than the tests, one line each.
pub fn compiled_twice(root: &Path) -> Result<Vec<String>, String> {
    let tests = packages(root, &["--workspace", "--edges", "normal,build,dev"])?;
    let mut differ = BTreeSet::new();
    for build in BUILDS {
        let build = packages(root, &[build, &["--edges", "normal,build"]].concat())?;
        differ.extend(build.difference(&tests).cloned());
    }
    let remedy =
        "has other features than in the tests: name those of the tests in crates/cli/Cargo.toml";
    Ok(differ.iter().map(|package| format!("{package} {remedy}")).collect())
}

/// The foreign packages of a selection, each with its version and features.
fn packages(root: &Path, selection: &[&str]) -> Result<BTreeSet<String>, String> {
    let output = Command::new("cargo")
        .args(["tree", "--no-dedupe", "--prefix", "none", "--format", "{p} {f}"])
        .args(selection)
        .current_dir(root)
        .output()
        .map_err(|e| format!("cargo tree: {e}"))?;
    if !output.status.success() {
        return Err(format!("cargo tree: {}", String::from_utf8_lossy(&output.stderr)));
    }
    Ok(foreign(&String::from_utf8_lossy(&output.stdout)))
}

/// Without the packages of the workspace, whose lines name their folder.
fn foreign(tree: &str) -> BTreeSet<String> {
    let is_foreign =
        |line: &&str| !line.is_empty() && !line.contains(" (/") && !line.contains(":\\");
    tree.lines().filter(is_foreign).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_of_the_workspace_are_left_out_and_others_kept_with_their_features() {
        let tree = "creepage v0.1.0 (/a/crates/cli) verify\nserde v1.0.229 derive,std\n\n\
                    serde_derive v1.0.229 (proc-macro) default\n";
        let kept = ["serde v1.0.229 derive,std", "serde_derive v1.0.229 (proc-macro) default"];
        assert_eq!(foreign(tree), kept.map(str::to_owned).into());
    }
}
