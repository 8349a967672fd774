//! `cargo xtask book`: the documents as a book, without a dead link.
//!
//! Chapters are the Markdown files of `docs/` and `docs/tables/`, which also lead to sources by relative links, as a Git
//! host shows them. The book takes those sources along as text, so that it stands alone.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::links::links;
use crate::markdown::parse;

/// The builder, and its version.
const MDBOOK: &str = "0.5.4";

/// Why there is no book.
pub enum Problem {
    /// The documents or the book are at fault: one line each.
    Faults(Vec<String>),
    /// The builder cannot be had.
    NoBuilder(String),
}

impl From<io::Error> for Problem {
    fn from(error: io::Error) -> Self {
        Self::Faults(vec![error.to_string()])
    }
}

/// Checks the chapters of the checkout at `root` and builds them below the folder `target`. Returns the
/// book's first page.
pub fn book(root: &Path, target: &Path) -> Result<PathBuf, Problem> {
    let mut faults = crate::links::broken(root)?;
    faults.iter_mut().for_each(|link| link.push_str(" does not exist"));
    faults.extend(unlisted(root)?);
    faults.extend(unnumbered(&fs::read_to_string(root.join("docs/theory.md"))?));
    if !faults.is_empty() {
        return Err(Problem::Faults(faults));
    }
    let stage = target.join("book");
    if stage.exists() {
        fs::remove_dir_all(&stage)?;
    }
    set_out(root, &stage)?;
    let html = stage.join("html");
    let built = Command::new(builder(target)?)
        .args(["build", "--dest-dir"])
        .arg(&html)
        .arg(&stage)
        .output()?;
    let said = String::from_utf8_lossy(&built.stderr);
    if !built.status.success() || said.contains("WARN") || said.contains("ERROR") {
        return Err(Problem::Faults(vec![format!("mdbook: {}\n{said}", built.status)]));
    }
    let dead = dead(&html)?;
    if dead.is_empty() { Ok(html.join("index.html")) } else { Err(Problem::Faults(dead)) }
}

/// Chapters in the order of the table of contents, as paths below `docs/`.
pub fn chapters(root: &Path) -> io::Result<Vec<String>> {
    let summary = parse(&fs::read_to_string(root.join("docs/SUMMARY.md"))?);
    Ok(links(&summary).map(|(_, link)| link.trim_start_matches("./").into()).collect())
}

/// Documents that the table of contents does not list.
fn unlisted(root: &Path) -> io::Result<Vec<String>> {
    let listed = chapters(root)?;
    let others =
        pages(root)?.into_iter().filter(|name| name != "SUMMARY.md" && !listed.contains(name));
    Ok(others.map(|name| format!("docs/SUMMARY.md does not list {name}")).collect())
}

/// The Markdown files in `docs/` and in `docs/tables/`, as paths below `docs/`.
pub fn pages(root: &Path) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for folder in ["", "tables/"] {
        let path = root.join("docs").join(folder);
        if !folder.is_empty() && !path.exists() {
            continue;
        }
        for entry in fs::read_dir(path)? {
            let name = entry?.file_name().to_string_lossy().into_owned();
            if name.ends_with(".md") {
                names.push(format!("{folder}{name}"));
            }
        }
    }
    Ok(names)
}

/// Equations of the theory without a number of their own or a module that computes them. Each stands in
/// a block after a line `**(T1)** name, [module](../crates/...)`.
fn unnumbered(theory: &str) -> Vec<String> {
    let document = parse(theory);
    let mut faults = Vec::new();
    let mut next = 1;
    for block in document.blocks.iter().filter(|block| !block.fenced) {
        let above: Vec<&str> = document
            .prose
            .iter()
            .filter(|(line, text)| *line < block.line && !text.is_empty())
            .map(|(_, text)| text.as_str())
            .collect();
        // the paragraph above begins with the number, at most three lines up
        let paragraph = above.iter().rev().take(3).position(|line| line.starts_with("**(T"));
        let Some(start) = paragraph else {
            faults.push(format!("docs/theory.md:{}: an equation without a number", block.line));
            continue;
        };
        let paragraph: Vec<_> = above.iter().rev().take(start + 1).copied().collect();
        if !above[above.len() - 1 - start].starts_with(&format!("**(T{next})**")) {
            faults.push(format!("docs/theory.md:{}: this is equation T{next}", block.line));
        }
        if !paragraph.iter().any(|line| line.contains("](../crates/")) {
            let line = block.line;
            faults.push(format!("docs/theory.md:{line}: no module in crates/ computes this"));
        }
        next += 1;
    }
    if next == 1 {
        faults.push("docs/theory.md has no equation".into());
    }
    faults
}

/// Lays chapters and what they lead to below `stage`.
fn set_out(root: &Path, stage: &Path) -> io::Result<()> {
    let docs = stage.join("docs");
    copy(&root.join("docs"), &docs)?;
    fs::copy(root.join("book.toml"), stage.join("book.toml"))?;
    let mut taken = BTreeSet::new();
    for name in chapters(root)? {
        let path = docs.join(&name);
        let text = fs::read_to_string(&path)?;
        // from the chapter's folder up to docs/
        let up = "../".repeat(name.matches('/').count());
        let mut rewritten = text.clone();
        for (_, link) in links(&parse(&text)) {
            let Some(outside) = link.strip_prefix(&format!("{up}../")) else { continue };
            let file = outside.split('#').next().unwrap_or_default().trim_end_matches('/');
            // mdBook takes everything with `.md` in it for a chapter
            let inside = format!("source/{}.txt", file.replace(".md", "-md"));
            rewritten = rewritten.replace(&format!("]({link})"), &format!("]({up}{inside})"));
            if taken.insert(file.to_owned()) {
                let to = docs.join(&inside);
                fs::create_dir_all(to.parent().unwrap_or(&docs))?;
                let from = root.join(file);
                fs::write(to, if from.is_dir() { listing(&from)? } else { fs::read(from)? })?;
            }
        }
        fs::write(path, rewritten)?;
    }
    Ok(())
}

/// Names in a folder, one a line.
fn listing(folder: &Path) -> io::Result<Vec<u8>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        names.push(entry?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok((names.join("\n") + "\n").into_bytes())
}

/// Copies a folder.
pub fn copy(from: &Path, to: &Path) -> io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if from.is_dir() {
            copy(&from, &to)?;
        } else {
            fs::copy(from, to)?;
        }
    }
    Ok(())
}

/// The builder, fetched where it is missing.
fn builder(target: &Path) -> Result<PathBuf, Problem> {
    let tools = target.join("tools");
    let program = tools.join("bin").join(format!("mdbook{}", std::env::consts::EXE_SUFFIX));
    let has = Command::new(&program).arg("--version").output();
    if has.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).contains(MDBOOK)) {
        return Ok(program);
    }
    eprintln!("mdbook {MDBOOK} is compiled, once");
    let build = tools.join("build");
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let installed = Command::new(cargo)
        .args(["install", "mdbook", "--version", &format!("={MDBOOK}"), "--locked"])
        .args(["--no-default-features", "--debug", "--force", "--quiet", "--root"])
        .arg(&tools)
        // a book of this size is built in seconds without optimisation, the builder in half the time
        .envs([("CARGO_PROFILE_DEV_DEBUG", "0"), ("CARGO_PROFILE_DEV_INCREMENTAL", "false")])
        .env("CARGO_TARGET_DIR", &build)
        .status();
    // what is left of the compilation serves nothing else
    let _ = fs::remove_dir_all(&build);
    match installed {
        Ok(status) if status.success() => Ok(program),
        Ok(status) => Err(Problem::NoBuilder(format!("cargo install mdbook: {status}"))),
        Err(error) => Err(Problem::NoBuilder(format!("cargo install mdbook: {error}"))),
    }
}

/// Links of the pages in a folder that lead to no file or no place in it, as `page: link`.
fn dead(html: &Path) -> io::Result<Vec<String>> {
    let mut pages = BTreeMap::new();
    for entry in fs::read_dir(html)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "html") {
            pages.insert(path.clone(), fs::read_to_string(path)?);
        }
    }
    let mut dead = BTreeSet::new();
    for (page, text) in &pages {
        let name = page.file_name().unwrap_or_default().to_string_lossy();
        // the page to print gathers the others and gives their anchors other names; the page for
        // missing addresses is not read from a folder
        if name == "print.html" || name == "404.html" {
            continue;
        }
        for opening in ["href=\"", "src=\""] {
            for rest in text.split(opening).skip(1) {
                let link = rest.split('"').next().unwrap_or_default();
                let outside = link.contains(':') || link.starts_with("//");
                if !outside && !leads(&pages, html, page, link) {
                    dead.insert(format!("{name}: {link} leads nowhere"));
                }
            }
        }
    }
    Ok(dead.into_iter().collect())
}

fn leads(pages: &BTreeMap<PathBuf, String>, html: &Path, page: &Path, link: &str) -> bool {
    let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
    let target = if path.is_empty() { page.to_owned() } else { html.join(path) };
    let Some(text) = pages.get(&target) else { return target.exists() };
    anchor.is_empty() || text.contains(&format!("id=\"{anchor}\""))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn equations_need_their_number_and_their_module() {
        let good = "**(T1)** Strain, [`k`](../crates/k.rs)\n\n    E = F\n\ntext\n\n\
                    **(T2)** Stress, a\nlong [`k`](../crates/k.rs)\n\n    S = E\n";
        assert_eq!(unnumbered(good), Vec::<String>::new());
        let second = good.replace("T2", "T3");
        assert_eq!(unnumbered(&second), ["docs/theory.md:10: this is equation T2"]);
        let homeless = good.replace("long [`k`](../crates/k.rs)", "long");
        assert_eq!(
            unnumbered(&homeless),
            ["docs/theory.md:10: no module in crates/ computes this"]
        );
        let bare = "one\n\ntwo\n\nthree\n\n    E = F\n";
        assert!(unnumbered(bare)[0].contains("without a number"));
    }

    #[test]
    fn a_link_to_no_page_or_no_place_in_it_is_dead() {
        let folder = std::env::temp_dir().join(format!("creepage-book-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let page = "<a href=\"b.html#in\"></a><a href=\"b.html#out\"></a><img src=\"c.png\">\
                    <a href=\"https://example.org\"></a><a href=\"#here\" id=\"here\"></a>";
        fs::write(folder.join("a.html"), page).unwrap();
        fs::write(folder.join("b.html"), "<h1 id=\"in\"></h1>").unwrap();
        let dead = dead(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(dead, ["a.html: b.html#out leads nowhere", "a.html: c.png leads nowhere"]);
    }
}
