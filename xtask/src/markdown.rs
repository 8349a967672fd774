//! What the chores need to know of the documents: which there are, their blocks of code, inline code, links, anchors.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};

use crate::step::files;

/// What a document holds; lines are counted from 1.
#[derive(Debug, Default)]
pub struct Document {
    /// Blocks of code: the line of the first line of code, the words after the opening fence, the text.
    pub blocks: Vec<(usize, String, String)>,
    /// Inline code, with its line.
    pub code: Vec<(usize, String)>,
    /// Relative targets of links and pictures, with their lines.
    pub links: Vec<(usize, String)>,
    /// Anchors of the headings, as Git hosts and mdBook both make them.
    anchors: Vec<String>,
}

/// Cuts a document into its parts.
pub fn parse(text: &str) -> Document {
    let mut document = Document::default();
    let mut block = None;
    let mut heading: Option<String> = None;
    // headings of the same words so far
    let mut alike: BTreeMap<String, usize> = BTreeMap::new();
    for (event, range) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
        let line = text[..range.start].matches('\n').count() + 1;
        match event {
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(info))) => {
                block = Some((line + 1, info.to_string(), String::new()));
            }
            Event::Start(Tag::CodeBlock(CodeBlockKind::Indented)) => {
                block = Some((line, String::new(), String::new()));
            }
            Event::End(TagEnd::CodeBlock) => document.blocks.extend(block.take()),
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => {
                let slug = slug(&heading.take().unwrap_or_default());
                let before = alike.entry(slug.clone()).or_insert(0);
                let anchor = if *before == 0 { slug } else { format!("{slug}-{before}") };
                *before += 1;
                document.anchors.push(anchor);
            }
            Event::Text(words) => match (&mut block, &mut heading) {
                (Some((_, _, text)), _) | (_, Some(text)) => text.push_str(&words),
                _ => {}
            },
            Event::Code(code) => {
                heading.iter_mut().for_each(|heading| heading.push_str(&code));
                document.code.push((line, code.to_string()));
            }
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                document.links.push((line, dest_url.to_string()));
            }
            Event::Html(html) | Event::InlineHtml(html) => {
                document.links.extend(targets(&html).map(|target| (line, target.to_owned())));
            }
            _ => {}
        }
    }
    document.links.retain(|(_, link)| {
        !link.is_empty() && !link.contains("://") && !link.starts_with("mailto:")
    });
    document
}

/// What HTML refers to.
fn targets(html: &str) -> impl Iterator<Item = &str> {
    let rests = ["src=\"", "href=\""].into_iter().flat_map(|opening| html.split(opening).skip(1));
    rests.filter_map(|rest| rest.split('"').next())
}

/// Lower case; letters, digits, `_` and `-` stay, spaces become `-`, all else goes.
fn slug(heading: &str) -> String {
    let kept = heading.chars().filter_map(|c| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
        _ => None,
    });
    kept.collect::<String>().to_lowercase()
}

/// The README and the pages of the book in its order.
pub fn pages(root: &Path) -> io::Result<Vec<String>> {
    let summary = parse(&fs::read_to_string(root.join("docs/SUMMARY.md"))?);
    let mut pages = vec!["README.md".to_owned()];
    pages.extend(summary.links.into_iter().map(|(_, link)| format!("docs/{link}")));
    Ok(pages)
}

/// Links of the Markdown files below `root` that lead nowhere, and pages that the book does not list.
pub fn broken(root: &Path) -> Vec<String> {
    dead_links(root).unwrap_or_else(|error| vec![format!("a document cannot be read: {error}")])
}

fn dead_links(root: &Path) -> io::Result<Vec<String>> {
    let mut documents = BTreeMap::new();
    for file in files(root).filter(|file| file.extension() == Some("md".as_ref())) {
        // as documents write it
        let name =
            file.strip_prefix(root).unwrap_or(&file).display().to_string().replace('\\', "/");
        documents.insert(file.canonicalize()?, (name, parse(&fs::read_to_string(&file)?)));
    }
    let mut broken = Vec::new();
    let listed = pages(root)?;
    for (file, (name, document)) in &documents {
        if name.starts_with("docs/") && name != "docs/SUMMARY.md" && !listed.contains(name) {
            broken.push(format!("docs/SUMMARY.md does not list {name}"));
        }
        for (line, link) in &document.links {
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = match path.strip_prefix('/') {
                _ if path.is_empty() => Ok(file.clone()),
                // a link from the root of the host is about the repository
                Some(path) => root.join(path).canonicalize(),
                None => file.with_file_name("").join(path).canonicalize(),
            };
            let leads = target.is_ok_and(|target| {
                // anchors of other files than documents are their viewers' business
                let anchors = documents.get(&target).map(|(_, document)| &document.anchors);
                anchor.is_empty() || anchors.is_none_or(|known| known.iter().any(|a| a == anchor))
            });
            if !leads {
                broken.push(format!("{name}:{line}: {link} does not exist"));
            }
        }
    }
    Ok(broken)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn blocks_inline_code_and_relative_links_are_found_with_their_lines() {
        let text = "[a](docs/a.md#part) ![p](p.png \"title\") [w](https://example.org)\n\
                    [here](#below) `[code](none.md)`\n```sh run exit=1\n[fenced](none.md)\n```\n\
                    <img src=\"q.png\">\n";
        let document = parse(text);
        let links: Vec<_> = document.links.iter().map(|(n, link)| (*n, link.as_str())).collect();
        assert_eq!(links, [(1, "docs/a.md#part"), (1, "p.png"), (2, "#below"), (6, "q.png")]);
        assert_eq!(document.code, [(2, "[code](none.md)".to_owned())]);
        let block = (4, "sh run exit=1".to_owned(), "[fenced](none.md)\n".to_owned());
        assert_eq!(document.blocks, [block]);
    }

    #[test]
    fn anchors_are_those_of_git_hosts() {
        let text = "## Exact contact (`contact.enforcement = \"exact\"`)\n# A [b c](d.md)\n# A b c\n# A b c\n# B 1\n# B\n#no\n";
        let wanted =
            ["exact-contact-contactenforcement--exact", "a-b-c", "a-b-c-1", "a-b-c-2", "b-1", "b"];
        assert_eq!(parse(text).anchors, wanted);
    }

    #[test]
    fn a_link_that_leads_nowhere_is_told_with_file_and_line() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        fs::create_dir_all(root.join("docs/tables")).unwrap();
        fs::write(root.join("README.md"), "[a](docs/a.md)\n[b](docs/b.md)\n").unwrap();
        let page = "# Part\n[up](../README.md)\n[in](#part) [out](#whole)\n[x](a.md#parts)\n";
        fs::write(root.join("docs/a.md"), page).unwrap();
        fs::write(root.join("docs/SUMMARY.md"), "- [A](a.md)\n").unwrap();
        fs::write(root.join("docs/tables/t.md"), "[back](../a.md#part) [x](a.md)\n").unwrap();
        let broken = broken(root);
        let wanted = ["README.md:2: docs/b.md", "docs/a.md:3: #whole", "docs/a.md:4: a.md#parts"];
        let mut wanted = wanted.map(|link| format!("{link} does not exist")).to_vec();
        wanted.push("docs/SUMMARY.md does not list docs/tables/t.md".into());
        wanted.push("docs/tables/t.md:1: a.md does not exist".into());
        assert_eq!(broken, wanted);
    }
}
