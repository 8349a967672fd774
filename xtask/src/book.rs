//! `cargo xtask book`: the documents as a book, without a dead link.
//!
//! Pages are the Markdown files of `docs/`, which also lead to sources by relative links, as a Git host shows them.
//! The book takes those sources along as text, so that it stands alone.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::markdown::{broken, pages, parse};
use crate::step::{Ended, Outcome, cargo, copy, files, missing, output, target, without};

/// The builder, and its version.
const MDBOOK: &str = "0.5.4";

/// Builds the book from pages without broken links, and prints where its first page is. The continuous integration must
/// first build the builder.
pub fn step(root: &Path) -> Ended {
    let Some(mdbook) = builder(root)? else {
        let problem = format!("`cargo install mdbook --version {MDBOOK} --locked` is missing");
        return missing(problem, "the book");
    };
    without(&broken(root))?;
    let html = target(root).join("book/html");
    build(root, &mdbook, &html).map_err(|error| error.to_string())?;
    println!("{}", html.join("index.html").display());
    Ok(Outcome::Passed)
}

/// The builder of this version; the continuous integration builds it, without optimisation, which would take longer than
/// the book.
fn builder(root: &Path) -> Result<Option<PathBuf>, String> {
    let tools = target(root).join("tools");
    let is_there = |program: &Path| {
        let version = output(Command::new(program).arg("--version")).unwrap_or_default();
        version.contains(MDBOOK)
    };
    let places = ["mdbook".into(), tools.join("bin/mdbook")];
    let found = places.iter().find(|place| is_there(place)).cloned();
    if found.is_some() || env::var_os("CI").is_none() {
        return Ok(found);
    }
    let [root_of_tools, work] =
        [&tools, &tools.join("build")].map(|path| path.display().to_string());
    let install = ["install", "mdbook", "--version", MDBOOK, "--locked", "--no-default-features"];
    let quick = ["--debug", "--quiet", "--root", &root_of_tools, "--target-dir", &work];
    cargo(root, &[&install[..], &quick].concat(), &[("CARGO_PROFILE_DEV_DEBUG", "0")])?;
    Ok(places.into_iter().find(|place| is_there(place)))
}

fn build(root: &Path, mdbook: &Path, html: &Path) -> io::Result<()> {
    let stage = html.with_file_name("");
    if stage.exists() {
        fs::remove_dir_all(&stage)?;
    }
    let pages =
        pages(root)?.into_iter().filter_map(|page| Some(page.strip_prefix("docs/")?.into()));
    let pages: Vec<String> = pages.collect();
    set_out(root, &stage, &pages)?;
    let built =
        Command::new(mdbook).args(["build", "--dest-dir"]).arg(html).arg(&stage).output()?;
    let said = String::from_utf8_lossy(&built.stderr);
    if !built.status.success() || said.contains("WARN") || said.contains("ERROR") {
        return Err(io::Error::other(format!("mdbook: {}\n{said}", built.status)));
    }
    Ok(())
}

/// Lays the pages and what they lead to below `stage`.
fn set_out(root: &Path, stage: &Path, pages: &[String]) -> io::Result<()> {
    let (root, docs) = (root.canonicalize()?, stage.join("docs"));
    copy(&root.join("docs"), &docs)?;
    fs::copy(root.join("book.toml"), stage.join("book.toml"))?;
    for page in pages {
        let folder = root.join("docs").join(page).with_file_name("");
        let up = "../".repeat(page.matches('/').count());
        let text = fs::read_to_string(docs.join(page))?;
        let mut rewritten = text.clone();
        for (_, link) in parse(&text).links {
            let path = link.split('#').next().unwrap_or_default();
            let file = folder.join(path).canonicalize()?;
            if file.starts_with(root.join("docs")) {
                continue;
            }
            let name = file.strip_prefix(&root).unwrap_or(&file).display().to_string();
            // mdBook takes everything with `.md` in it for a page
            let inside = format!("source/{}.txt", name.replace(".md", "-md"));
            rewritten = rewritten.replace(&format!("]({link})"), &format!("]({up}{inside})"));
            let to = docs.join(&inside);
            fs::create_dir_all(to.with_file_name(""))?;
            let listing = || files(&file).map(|file| format!("{}\n", file.display())).collect();
            fs::write(to, if file.is_dir() { listing() } else { fs::read_to_string(&file)? })?;
        }
        fs::write(docs.join(page), rewritten)?;
    }
    Ok(())
}
