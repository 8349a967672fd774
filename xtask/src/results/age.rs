//! How old results are, by git.

use std::path::Path;
use std::process::Command;

/// The last commit that changed any of these paths; none outside of a repository.
pub fn last_change(root: &Path, paths: &[String]) -> Option<String> {
    git(root, &["log", "-1", "--format=%H"], paths).map(|hash| hash.trim().to_owned())
}

/// Commits that changed any of the paths after `commit`, or after `date` where the repository lacks it: hash,
/// day and subject, the newest first.
pub fn changes_since(
    root: &Path,
    commit: &str,
    date: &str,
    paths: &[String],
) -> Option<Vec<String>> {
    let format = "--format=%h %cs %s";
    let range = format!("{commit}..HEAD");
    let since = format!("--since={date}");
    let known = git(root, &["merge-base", "--is-ancestor", commit, "HEAD"], &[]).is_some();
    let limit = if known { &range } else { &since };
    let said = git(root, &["log", format, limit], paths)?;
    Some(said.lines().map(str::to_owned).collect())
}

/// Which files of the paths are not as in the last commit.
pub fn uncommitted(root: &Path, paths: &[String]) -> Vec<String> {
    let said = git(root, &["status", "--porcelain"], paths).unwrap_or_default();
    said.lines().filter_map(|line| line.get(3..)).map(str::to_owned).collect()
}

/// What git says, if it ends well.
fn git(root: &Path, words: &[&str], paths: &[String]) -> Option<String> {
    let mut command = Command::new("git");
    command.args(words).current_dir(root);
    if !paths.is_empty() {
        command.arg("--").args(paths);
    }
    let output = command.output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::fs;

    use super::*;

    #[test]
    fn changes_after_a_commit_are_those_of_the_paths_alone() {
        let root = std::env::temp_dir().join(format!("creepage-age-{}", std::process::id()));
        fs::create_dir_all(root.join("crates")).unwrap();
        let run = |words: &[&str]| {
            let identity = ["-c", "user.name=a", "-c", "user.email=a@b.c"];
            git(&root, &[&identity[..], words].concat(), &[]).unwrap()
        };
        let commit = |file: &str, text: &str| {
            fs::write(root.join(file), text).unwrap();
            run(&["add", "-A"]);
            run(&["commit", "-q", "-m", &format!("{file} is {text}")]);
        };
        run(&["init", "-q"]);
        commit("crates/a.rs", "one");
        let paths = ["crates".to_owned()];
        let first = last_change(&root, &paths).unwrap();
        commit("README.md", "two");
        assert_eq!(last_change(&root, &paths).unwrap(), first);
        let since = |commit: &str, date: &str| changes_since(&root, commit, date, &paths).unwrap();
        assert_eq!(since(&first, "2000-01-01"), Vec::<String>::new());
        commit("crates/a.rs", "three");
        assert_eq!(since(&first, "2000-01-01").len(), 1);
        assert!(since(&first, "2000-01-01")[0].ends_with("crates/a.rs is three"));
        // a commit that went with its branch: the date decides
        assert_eq!(since(&"0".repeat(40), "2000-01-01").len(), 2);
        fs::write(root.join("crates/b.rs"), "").unwrap();
        assert_eq!(uncommitted(&root, &paths), ["crates/b.rs"]);
        fs::remove_dir_all(&root).unwrap();
    }
}
