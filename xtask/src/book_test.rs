//! `cargo xtask book-test`: the commands of the documents do what they say.
//!
//! Commands stand in blocks whose fence says how they are tested:
//!
//! | fence | here | with `--all` or `--rest` |
//! |---|---|---|
//! | `sh run`, or `sh run exit=1` | run, with this exit code | run |
//! | `sh long` | checked | run, and kept in `docs/book-test.json` |
//! | `sh elsewhere` | checked | checked: it needs what a checkout lacks, or changes the machine |
//!
//! Blocks are run in the order of the book, in one copy of the checkout, so that later chapters find
//! the runs of earlier ones. `creepage`, also as `cargo run --release --` or `target/release/creepage`, is
//! the program just built; other calls of cargo work in the checkout itself, which spares a second compilation. A command is
//! checked by having the program read its options, its case and its sweep, and by looking for the files,
//! packages and chores that it names. Inline code that is a whole command is checked as well. Runs that the
//! tables of the documents just made are taken from there. `--rest` leaves out the long blocks that passed
//! before as they stand, or whose commands made a table.

mod made;
mod passed;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use clap::Parser;

use crate::book::chapters;
use crate::chores::Args;
use crate::markdown::{Block, parse};
use crate::shell::commands;
use made::Made;
use passed::Passed;

/// Programs that the documents are about.
const PROGRAMS: [&str; 4] = ["cargo", "creepage", "pip", "python"];

/// Programs that no checkout holds. That their lines are right is not tested.
const FOREIGN: [&str; 18] = [
    "anim_to_vtk_linux64_gf",
    "cat",
    "cd",
    "cp",
    "curl",
    "engine_linux64_gf",
    "git",
    "jupyter",
    "ls",
    "mkdir",
    "paraview",
    "pip",
    "printf",
    "rustup",
    "sbatch",
    "sh",
    "starter_linux64_gf",
    "timeout",
];

/// What runs commands.
pub struct Programs {
    /// Folder with `creepage`.
    pub release: PathBuf,
    /// Folder with `python` and the packages of the checks; none where Python is missing.
    pub python: Option<PathBuf>,
}

/// Which long blocks are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Long {
    None,
    /// Those that neither passed before as they stand nor made a table.
    Rest,
    All,
}

/// Which blocks are run, besides those whose runs they read.
#[derive(Clone, Debug)]
pub struct Chosen {
    pub long: Long,
    /// The documents by their names without folder, or blocks by that and their line (`start.md:19`); all if there
    /// are none.
    pub chapters: Vec<String>,
}

impl Chosen {
    fn holds(&self, script: &Script, passed: &Passed) -> bool {
        let here = |chapter: &String| is_in(script, chapter);
        let kind = match (script.kind, self.long) {
            (Kind::Elsewhere, _) | (Kind::Long { .. }, Long::None) => false,
            (Kind::Long { .. }, Long::Rest) => !passed.has(script),
            _ => true,
        };
        kind && (self.chapters.is_empty() || self.chapters.iter().any(here))
    }
}

/// Whether the block is of the document, or is the one at `document:line`.
fn is_in(script: &Script, chosen: &str) -> bool {
    let document = script.at.split(':').next().unwrap_or_default();
    [document, &script.at].iter().any(|at| Path::new(at).file_name() == Some(chosen.as_ref()))
}

/// How a block is tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Run { exit: i32 },
    Long { exit: i32 },
    Elsewhere,
}

/// A block of commands of a document.
#[derive(Debug)]
struct Script {
    /// `file:line`.
    at: String,
    kind: Kind,
    text: String,
}

/// Tests the commands of the checkout at `root` in a copy at `scratch`, and keeps which long blocks passed.
/// Returns what is wrong, a few lines each.
pub fn test(root: &Path, scratch: &Path, programs: &Programs, chosen: &Chosen) -> Vec<String> {
    let mut faults = Vec::new();
    let scripts = match scripts(root, &mut faults) {
        Ok(scripts) => scripts,
        Err(error) => return vec![error.to_string()],
    };
    for script in scripts.iter().filter(|script| !matches!(script.kind, Kind::Run { .. })) {
        faults.extend(check(root, programs, script));
    }
    faults.extend(made_twice(&scripts));
    let has_none = |place: &&String| !scripts.iter().any(|script| is_in(script, place));
    faults.extend(
        chosen.chapters.iter().filter(has_none).map(|place| format!("no commands are at {place}")),
    );
    if !faults.is_empty() {
        return faults;
    }
    if let Err(error) = lay_out(root, scratch, programs) {
        return vec![format!("{}: {error}", scratch.display())];
    }
    let made = Made::of(root, &programs.release.join("creepage"));
    let mut passed = match Passed::read(root, &scripts) {
        Ok(passed) => passed,
        Err(problem) => return vec![problem],
    };
    let may_run = |script: &Script| match script.kind {
        Kind::Run { .. } => true,
        Kind::Long { .. } => chosen.long != Long::None,
        Kind::Elsewhere => false,
    };
    let runs = with_needed(&scripts, may_run, |script| chosen.holds(script, &passed));
    let mut number = 0;
    for script in runs.into_iter().map(|index| &scripts[index]) {
        let (exit, is_long) = match script.kind {
            Kind::Run { exit } => (exit, false),
            Kind::Long { exit } => (exit, true),
            Kind::Elsewhere => continue,
        };
        match made.take(&script.text, scratch) {
            Ok(true) => {
                eprintln!("   made  {}, for a table", script.at);
                continue;
            }
            Ok(false) => {}
            Err(error) => return vec![format!("{}: {error}", script.at)],
        }
        let start = Instant::now();
        match execute(root, scratch, programs, &script.text) {
            Ok((code, _)) if code == exit => {
                let seconds = start.elapsed().as_secs_f64();
                eprintln!("{seconds:7.1} s  {}", script.at);
                number += 1;
                if is_long && let Err(problem) = passed.keep(root, script, seconds) {
                    return vec![problem];
                }
            }
            Ok((code, said)) => {
                let text = &script.text;
                let left = scratch.display();
                return vec![format!(
                    "{}: exit code {code} instead of {exit}\n{text}{said}\nwhat it left is in {left}",
                    script.at
                )];
            }
            Err(error) => return vec![format!("{}: bash: {error}", script.at)],
        }
    }
    println!(
        "{number} blocks of commands run, {} in all; {}",
        scripts.len(),
        passed.told(&scripts)
    );
    let _ = fs::remove_dir_all(scratch);
    Vec::new()
}

/// The blocks of commands of the README and of all chapters; `faults` gains what cannot be tested.
fn scripts(root: &Path, faults: &mut Vec<String>) -> std::io::Result<Vec<Script>> {
    let chapters = chapters(root)?.into_iter().map(|name| format!("docs/{name}"));
    let mut scripts = Vec::new();
    for name in ["README.md".into()].into_iter().chain(chapters) {
        let document = parse(&fs::read_to_string(root.join(&name))?);
        for block in document.blocks {
            let at = format!("{name}:{}", block.line);
            match kind(&block) {
                Ok(Some(kind)) => scripts.push(Script { at, kind, text: block.text }),
                Ok(None) => {}
                Err(problem) => faults.push(format!("{at}: {problem}")),
            }
        }
        for (line, span) in document.code.iter().filter(|(_, span)| is_whole_command(span)) {
            // a command's name, perhaps with an option, tells of the command
            let of_it = span.starts_with("creepage ")
                && span.split(' ').skip(2).all(|word| word.starts_with("--"));
            let text = format!("{span}{}", if of_it { " --help" } else { "" });
            let at = format!("{name}:{line}");
            scripts.push(Script { at, kind: Kind::Elsewhere, text });
        }
    }
    Ok(scripts)
}

/// Commands whose folder an earlier one of the book has made, which the program would refuse.
fn made_twice(scripts: &[Script]) -> Vec<String> {
    let mut places: BTreeMap<PathBuf, &str> = BTreeMap::new();
    let mut faults = Vec::new();
    for script in scripts.iter().filter(|script| script.kind != Kind::Elsewhere) {
        for (folder, again) in made::folders_made(&script.text) {
            match places.get(&folder) {
                Some(first) if !again => {
                    let (at, folder) = (&script.at, folder.display());
                    faults.push(format!(
                        "{at}: {folder} is made in {first} already: --out or --force"
                    ));
                }
                _ => drop(places.insert(folder, &script.at)),
            }
        }
    }
    faults
}

/// Of the scripts that may run those chosen, and those that make the runs that these read, in the order of the book.
fn with_needed(
    scripts: &[Script],
    may_run: impl Fn(&Script) -> bool,
    is_chosen: impl Fn(&Script) -> bool,
) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    let mut read: BTreeSet<PathBuf> = BTreeSet::new();
    for (index, script) in scripts.iter().enumerate().rev() {
        if !may_run(script) {
            continue;
        }
        let (made, named) = made::folders(&script.text);
        let is_made = |folder: &PathBuf| made.iter().any(|made| folder.starts_with(made));
        if is_chosen(script) || read.iter().any(is_made) {
            found.insert(index);
            read.retain(|folder| !is_made(folder));
            read.extend(named);
        }
    }
    found
}

/// How a block says that it is tested; none for a block that is no script.
fn kind(block: &Block) -> Result<Option<Kind>, String> {
    let words: Vec<&str> = block.info.iter().map(String::as_str).collect();
    let (how, exit) = match words[..] {
        ["sh", how] => (how, 0),
        ["sh", how, exit] => match exit.strip_prefix("exit=").map(str::parse) {
            Some(Ok(code)) => (how, code),
            _ => return Err(format!("{exit:?} is not exit=CODE")),
        },
        ["sh"] | ["bash" | "shell" | "console", ..] => ("", 0),
        _ if block.text.lines().any(is_command) => ("", 0),
        _ => return Ok(None),
    };
    match how {
        "run" => Ok(Some(Kind::Run { exit })),
        "long" => Ok(Some(Kind::Long { exit })),
        "elsewhere" => Ok(Some(Kind::Elsewhere)),
        _ => Err("commands stand in blocks of `sh run`, `sh long` or `sh elsewhere`".into()),
    }
}

/// Whether a line calls one of the programs that the documents are about.
fn is_command(line: &str) -> bool {
    let mut words = line.split_whitespace();
    let program = words.next().is_some_and(|word| PROGRAMS.contains(&word));
    // `creepage = 2.4e-3` is a key of a case
    program && !line.starts_with(' ') && words.next().is_some_and(|word| word != "=")
}

/// Whether inline code is a command without anything to fill in.
fn is_whole_command(span: &str) -> bool {
    let to_fill_in = |word: &str| {
        let letters = word.chars().filter(char::is_ascii_alphabetic);
        let all_capitals = letters.clone().count() > 2 && letters.clone().all(|c| c.is_uppercase());
        all_capitals || word.contains(['[', '<', '|', '*']) || word.contains("...")
    };
    let parts = || span.split(|c: char| c.is_whitespace() || c == '/' || c == '=' || c == '.');
    is_command(span) && !span.contains("...") && !span.ends_with(" --") && !parts().any(to_fill_in)
}

/// What is wrong with a script that is not run.
fn check(root: &Path, programs: &Programs, script: &Script) -> Vec<String> {
    let mut faults = Vec::new();
    for command in commands(&script.text) {
        if let Err(problem) = check_command(root, programs, &command) {
            faults.push(format!("{}: {}\n  {problem}", script.at, command.join(" ")));
        }
    }
    faults
}

/// The words after the program, however a command calls it; none for a command of another program.
fn arguments(command: &[String]) -> Option<&[String]> {
    const CALLS: [&[&str]; 5] = [
        &["creepage"],
        &["$CREEPAGE"],
        &["target/release/creepage"],
        &["cargo", "run", "--release", "--"],
        &["cargo", "run", "--release", "--no-default-features", "--"],
    ];
    let call = CALLS.iter().find(|call| command.iter().take(call.len()).eq(call.iter()))?;
    Some(&command[call.len()..])
}

fn check_command(root: &Path, programs: &Programs, command: &[String]) -> Result<(), String> {
    let words: Vec<&str> = command.iter().map(String::as_str).collect();
    match arguments(command) {
        Some(given) => reads(root, programs, given),
        None => is_there(root, &words),
    }?;
    // Files below the project's folders are there, whoever reads them.
    for word in &words {
        let below = |folder: &str| word.starts_with(folder) && !word.contains(['*', '$']);
        if ["cases/", "crates/", "meshes/", "tests/"].iter().any(|folder| below(folder)) {
            exists(root, word)?;
        }
    }
    Ok(())
}

fn exists(root: &Path, file: &str) -> Result<(), String> {
    if root.join(file).exists() { Ok(()) } else { Err(format!("there is no {file}")) }
}

/// What the command of another program names exists.
fn is_there(root: &Path, words: &[&str]) -> Result<(), String> {
    match *words {
        ["cargo", "xtask", ..] => match Args::try_parse_from(&words[1..]) {
            Err(error) if error.use_stderr() => Err(error.to_string()),
            _ => Ok(()),
        },
        ["cargo", ..] => cargo_finds(root, &words[1..]),
        ["python", "-m", ..] => Ok(()),
        ["python", file, ..] => exists(root, file),
        [program, ..] if FOREIGN.contains(&program) || program.contains('/') => Ok(()),
        _ => Err(format!("an unknown program (known are {})", FOREIGN.join(", "))),
    }
}

/// The program reads these words as a command of its own, with all options, keys and cases.
fn reads(root: &Path, programs: &Programs, words: &[String]) -> Result<(), String> {
    let read = Command::new(programs.release.join("creepage"))
        .arg("--check-args")
        .args(words)
        .current_dir(root)
        .output()
        .map_err(|error| error.to_string())?;
    if read.status.success() {
        return Ok(());
    }
    Err(String::from_utf8_lossy(&read.stderr).into_owned())
}

/// The packages, examples, tests and benchmarks of a call of cargo exist.
fn cargo_finds(root: &Path, words: &[&str]) -> Result<(), String> {
    let mut folder = None;
    for pair in words.windows(2) {
        if let ["-p" | "--package", package] = *pair {
            folder = Some(package_folder(root, package).ok_or(format!("no package {package}"))?);
        }
    }
    // without a package it is about the command line's
    let folder = folder.unwrap_or_else(|| root.join("crates/cli"));
    for pair in words.windows(2) {
        let [kind, name] = *pair else { continue };
        let files = match kind {
            "--example" => vec![format!("examples/{name}.rs")],
            "--test" => vec![format!("tests/{name}.rs"), format!("tests/{name}/main.rs")],
            "--bench" => {
                vec![format!("benches/{name}.rs"), format!("{name}.rs"), format!("src/{name}.rs")]
            }
            "--bin" => {
                vec![format!("src/bin/{name}.rs"), format!("src/{}.rs", name.replace('-', "_"))]
            }
            "--path" => {
                exists(root, name)?;
                continue;
            }
            _ => continue,
        };
        if !files.iter().any(|file| folder.join(file).exists()) {
            return Err(format!("{} has no {}", folder.display(), files.join(" or ")));
        }
    }
    Ok(())
}

fn package_folder(root: &Path, package: &str) -> Option<PathBuf> {
    let crates = fs::read_dir(root.join("crates")).ok()?.flatten().map(|entry| entry.path());
    let others = ["xtask", "tests", "benches"].map(|name| root.join(name));
    crates.chain(others).find(|folder| {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        manifest.contains(&format!("\nname = \"{package}\""))
    })
}

/// A copy of the checkout without runs and hidden files, and of what is built the program alone.
fn lay_out(root: &Path, scratch: &Path, programs: &Programs) -> std::io::Result<()> {
    if scratch.exists() {
        fs::remove_dir_all(scratch)?;
    }
    let release = scratch.join("target/release");
    fs::create_dir_all(&release)?;
    fs::copy(programs.release.join("creepage"), release.join("creepage"))?;
    let left_out = BTreeSet::from(["target", "runs"]);
    for entry in fs::read_dir(root)? {
        let entry = entry?;
        let name = entry.file_name();
        let text = name.to_string_lossy();
        if text.starts_with('.') || left_out.contains(&*text) {
            continue;
        }
        if entry.path().is_dir() {
            crate::book::copy(&entry.path(), &scratch.join(name))?;
        } else {
            fs::copy(entry.path(), scratch.join(name))?;
        }
    }
    Ok(())
}

/// Before every script: the first command that fails ends it.
const PRELUDE: &str = r#"set -euo pipefail
cargo() {
    if [ "${1-} ${2-}" = "run --release" ]; then
        case "${3-}" in
        --) shift 3; creepage "$@"; return;;
        --no-default-features) shift 4; creepage "$@"; return;;
        esac
    fi
    (builtin cd "$CREEPAGE_CHECKOUT" && command cargo "$@")
}
"#;

/// Exit code of a script, and what it said.
fn execute(
    root: &Path,
    scratch: &Path,
    programs: &Programs,
    text: &str,
) -> std::io::Result<(i32, String)> {
    // the Python package brings a `creepage` of its own
    let folders = std::iter::once(&programs.release).chain(&programs.python).cloned();
    let before = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(folders.chain(std::env::split_paths(&before)))
        .map_err(std::io::Error::other)?;
    let output = Command::new("bash")
        .args(["-c", &format!("{PRELUDE}{text}")])
        .env("PATH", path)
        .env("CREEPAGE_CHECKOUT", root)
        .env("MPLBACKEND", "agg")
        .current_dir(scratch)
        .stdin(std::process::Stdio::null())
        .output()?;
    let said = [output.stdout, output.stderr].concat();
    Ok((output.status.code().unwrap_or(-1), String::from_utf8_lossy(&said).into_owned()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    fn kind_of(text: &str) -> Result<Option<Kind>, String> {
        kind(&parse(text).blocks[0])
    }

    #[test]
    fn a_fence_says_how_its_commands_are_tested() {
        assert_eq!(kind_of("```sh run\ntrue\n```"), Ok(Some(Kind::Run { exit: 0 })));
        assert_eq!(kind_of("```sh run exit=1\nfalse\n```"), Ok(Some(Kind::Run { exit: 1 })));
        assert_eq!(kind_of("```sh long\ntrue\n```"), Ok(Some(Kind::Long { exit: 0 })));
        assert_eq!(kind_of("```toml\na = 1\n```"), Ok(None));
    }

    #[test]
    fn a_folder_that_an_earlier_block_has_made_is_told() {
        let script = |text: &str| Script {
            at: "docs/a.md:1".into(),
            kind: Kind::Long { exit: 0 },
            text: text.into(),
        };
        let twice = |second: &str| made_twice(&[script("creepage run a.toml"), script(second)]);
        assert_eq!(twice("creepage run b/a.toml").len(), 1);
        for fine in ["creepage run a.toml --force", "creepage run a.toml --out runs/c", "true"] {
            assert!(twice(fine).is_empty(), "{fine}");
        }
    }

    #[test]
    fn a_block_is_chosen_by_its_document_or_by_that_and_its_line() {
        let script =
            Script { at: "docs/a.md:19".into(), kind: Kind::Long { exit: 0 }, text: "true".into() };
        for (chosen, wanted) in
            [("a.md", true), ("a.md:19", true), ("a.md:1", false), ("b.md", false), ("docs", false)]
        {
            assert_eq!(is_in(&script, chosen), wanted, "{chosen}");
        }
    }

    #[test]
    fn what_a_block_reads_is_run_before_it() {
        let script =
            |kind, text: &str| Script { at: "docs/a.md:1".into(), kind, text: text.into() };
        let (long, short) = (Kind::Long { exit: 0 }, Kind::Run { exit: 0 });
        let made = "creepage run a.toml --out runs/b";
        let other = "creepage run a.toml --out runs/b/runs/01";
        let of_last = |first, second, may_run: fn(&Script) -> bool| {
            let last = script(short, "creepage check runs/b/runs/0");
            let scripts = [script(first, made), script(second, made), script(long, other), last];
            with_needed(&scripts, may_run, |script| script.text.contains("check"))
        };
        let all = |script: &Script| script.kind != Kind::Elsewhere;
        assert_eq!(of_last(long, Kind::Elsewhere, all), BTreeSet::from([0, 3]));
        assert_eq!(of_last(long, short, all), BTreeSet::from([1, 3]));
        let short_ones = |script: &Script| matches!(script.kind, Kind::Run { .. });
        assert_eq!(of_last(long, Kind::Elsewhere, short_ones), BTreeSet::from([3]));
    }

    #[test]
    fn commands_that_no_fence_classifies_are_refused() {
        for text in ["```sh\ntrue\n```", "```\ncreepage run a.toml\n```", "    cargo test\n"] {
            assert!(kind_of(text).is_err(), "{text}");
        }
        assert!(kind_of("```sh run exit=one\n```").is_err());
    }

    #[test]
    fn inline_code_with_something_to_fill_in_is_no_command() {
        assert!(is_whole_command("creepage check runs/quick --limit law_error=0.05"));
        for span in [
            "creepage run CASE.toml",
            "creepage plot runs/NAME",
            "creepage run [--out DIR]",
            "creepage mesh ...",
            "runs/quick",
        ] {
            assert!(!is_whole_command(span), "{span}");
        }
    }

    #[test]
    fn a_script_ends_with_the_code_of_the_first_command_that_fails() {
        let here = std::env::temp_dir();
        let programs = Programs { release: here.clone(), python: None };
        let ends = |text: &str| execute(&here, &here, &programs, text).unwrap();
        assert_eq!(ends("echo a; (exit 3)\necho b\n"), (3, "a\n".into()));
        assert_eq!(ends("true\n").0, 0);
    }

    #[test]
    fn files_packages_and_chores_that_do_not_exist_are_told() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let programs = Programs { release: root.clone(), python: None };
        let check = |text: &str| check_command(&root, &programs, &commands(text)[0]);
        for good in [
            "cargo xtask validate",
            "cargo run --release -p creepage-contact --example own_law",
            "python tests/python/violations.py a.vtkhdf b.png",
        ] {
            assert_eq!(check(good), Ok(()), "{good}");
        }
        for bad in [
            "cargo xtask vali",
            "cargo run --release -p creepage-contact --example our_law",
            "cargo test -p creepage-contract",
            "python tests/python/violation.py",
            "cat cases/quack.toml",
            "creepeg run cases/quick.toml",
        ] {
            assert!(check(bad).is_err(), "{bad}");
        }
    }
}
