//! Every relative link of the documents leads to something.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Links of the Markdown files below `root` that lead nowhere, as `file:line: link`.
pub fn broken(root: &Path) -> io::Result<Vec<String>> {
    let mut documents = Vec::new();
    find(root, &mut documents)?;
    documents.sort();
    let mut broken = Vec::new();
    for document in documents {
        let text = fs::read_to_string(&document)?;
        let folder = document.parent().unwrap_or(root);
        let name = document.strip_prefix(root).unwrap_or(&document).display().to_string();
        for (line, link) in links(&text) {
            // A link from the root of the host is about the repository.
            let from = if link.starts_with('/') { root } else { folder };
            if !from.join(link.trim_start_matches('/')).exists() {
                broken.push(format!("{name}:{line}: {link}"));
            }
        }
    }
    Ok(broken)
}

/// Markdown files below a folder, apart from hidden folders, build output and runs.
fn find(folder: &Path, found: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        if path.is_dir() {
            if !name.starts_with('.') && name != "target" && name != "runs" {
                find(&path, found)?;
            }
        } else if name.ends_with(".md") {
            found.push(path);
        }
    }
    Ok(())
}

/// Relative links of a Markdown text with their lines, without anchors and titles.
fn links(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut fenced = false;
    for (i, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
            continue;
        }
        if fenced {
            continue;
        }
        // Between backticks stands code: every second piece.
        let prose: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
        for opening in ["](", "src=\"", "href=\""] {
            let closing = if opening == "](" { ')' } else { '"' };
            for rest in prose.split(opening).skip(1) {
                let target = rest.split(closing).next().unwrap_or_default();
                let target = target.split_whitespace().next().unwrap_or_default();
                let target = target.split('#').next().unwrap_or_default();
                if !target.is_empty() && !target.contains("://") && !target.starts_with("mailto:") {
                    found.push((i + 1, target.to_owned()));
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn relative_links_are_found_and_others_are_not() {
        let text = "[a](docs/a.md#part) ![p](p.png \"title\") [w](https://example.org)\n\
                    [here](#below) `[code](none.md)`\n```\n[fenced](none.md)\n```\n\
                    <img src=\"q.png\">\n";
        let found: Vec<_> = links(text).into_iter().collect();
        let wanted = [(1, "docs/a.md"), (1, "p.png"), (6, "q.png")];
        assert_eq!(found, wanted.map(|(line, link)| (line, link.to_owned())));
    }

    #[test]
    fn a_link_that_leads_nowhere_is_told_with_file_and_line() {
        let root = std::env::temp_dir().join(format!("creepage-links-{}", std::process::id()));
        fs::create_dir_all(root.join("docs")).unwrap();
        fs::write(root.join("README.md"), "[a](docs/a.md)\n[b](docs/b.md)\n").unwrap();
        fs::write(root.join("docs/a.md"), "[up](../README.md)\n").unwrap();
        let broken = broken(&root).unwrap();
        fs::remove_dir_all(&root).unwrap();
        assert_eq!(broken, ["README.md:2: docs/b.md"]);
    }
}
