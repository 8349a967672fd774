//! Every relative link of the documents leads to something, with its anchor.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::markdown::{Document, parse};

/// Links of the Markdown files below `root` that lead nowhere, as `file:line: link`.
pub fn broken(root: &Path) -> io::Result<Vec<String>> {
    let mut files = Vec::new();
    find(root, &mut files)?;
    files.sort();
    let mut documents = BTreeMap::new();
    for file in files {
        let document = parse(&fs::read_to_string(&file)?);
        documents.insert(file.canonicalize()?, (file, document));
    }
    let mut broken = Vec::new();
    for (document_path, (file, document)) in &documents {
        let folder = file.parent().unwrap_or(root);
        let name = file.strip_prefix(root).unwrap_or(file).display().to_string();
        for (line, link) in links(document) {
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            // A link from the root of the host is about the repository.
            let from = if path.starts_with('/') { root } else { folder };
            let target = match path {
                "" => Ok(document_path.clone()),
                path => from.join(path.trim_start_matches('/')).canonicalize(),
            };
            let leads = target.is_ok_and(|target| {
                // Anchors of other files than documents are their viewers' business.
                let known = documents.get(&target).map(|(_, document)| &document.anchors);
                anchor.is_empty() || known.is_none_or(|known| known.iter().any(|a| a == anchor))
            });
            if !leads {
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

/// Relative links of a document with their lines, with anchors.
pub fn links(document: &Document) -> impl Iterator<Item = &(usize, String)> {
    let relative = |link: &str| !link.contains("://") && !link.starts_with("mailto:");
    document.links.iter().filter(move |(_, link)| !link.is_empty() && relative(link))
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
        let wanted = [(1, "docs/a.md#part"), (1, "p.png"), (2, "#below"), (6, "q.png")];
        let document = parse(text);
        let found: Vec<_> = links(&document).map(|(line, link)| (*line, link.as_str())).collect();
        assert_eq!(found, wanted);
    }

    #[test]
    fn a_link_that_leads_nowhere_is_told_with_file_and_line() {
        let root = std::env::temp_dir().join(format!("creepage-links-{}", std::process::id()));
        fs::create_dir_all(root.join("docs")).unwrap();
        fs::write(root.join("README.md"), "[a](docs/a.md)\n[b](docs/b.md)\n").unwrap();
        fs::write(
            root.join("docs/a.md"),
            "# Part\n[up](../README.md)\n[in](#part) [out](#whole)\n[x](a.md#parts)\n",
        )
        .unwrap();
        let broken = broken(&root).unwrap();
        fs::remove_dir_all(&root).unwrap();
        assert_eq!(
            broken,
            ["README.md:2: docs/b.md", "docs/a.md:3: #whole", "docs/a.md:4: a.md#parts"]
        );
    }
}
