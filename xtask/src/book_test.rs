//! `cargo xtask book-test`: the program takes the commands of the documents, and the short ones are run.
//!
//! | fence | what is done with its commands |
//! |---|---|
//! | `sh run`, or `sh run exit=1` | they are run, and must end with this exit code |
//! | `sh long` | they are read; with `--long` they are run |
//! | `sh elsewhere` | they are read: they need what a checkout lacks, or change the machine |
//!
//! Blocks are run in the order of the book, in one copy of the checkout, so that later pages find the runs of earlier
//! ones. The runs that short tables make (`cargo xtask results`) are there from the beginning: the commands that make
//! them stand in blocks of `sh long`. To read commands, bash goes through them with functions in place of the
//! programs: `creepage` looks at its options, its case and its sweep, and of others packages, cases and scripts must
//! exist. Inline code that is a whole command is read as well.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::markdown::{pages, parse};
use crate::step::{Ended, bash, built, copy, missing, python, search, target, without};
use crate::{results, structure};

/// Which commands are run, and by what.
#[derive(Debug, Default, clap::Args)]
pub struct Options {
    /// Run the long ones, too; this takes many hours
    #[arg(long)]
    long: bool,
    /// Pages, such as docs/start.md, with those before them whose runs they read [default: all]
    pages: Vec<String>,
}

/// A block of commands of a document, or inline code.
struct Script {
    /// `file:line`.
    at: String,
    /// The exit code to expect; none if the commands are only read.
    exit: Option<i32>,
    text: String,
}

/// Before what is read.
const READ: &str = r#"set +u
known() { # packages, cases and scripts must be there
    for word; do
        case "$word" in
        creepage-*) [[ " $PACKAGES " == *" $word "* ]];;
        cases/*|crates/*|meshes/*|tests/*|benches/*) compgen -G "$word" >/dev/null;;
        esac || { echo "there is no $word" >&2; exit 1; }
    done
}
creepage() { known "$@"; command creepage --check-args "$@" >/dev/null; }
target/release/creepage() { creepage "$@"; }
cargo() {
    case "$*" in
    "run --release -- "*) creepage "${@:4}";;
    "run --release -p verification -- "*) creepage verify "${@:6}";;
    "xtask "*) "$XTASK" --check-args "${@:2}";;
    *) known "$@";;
    esac
}
for foreign in apt-get cases/sweeps/slurm.sh cd cp mpirun sbatch peers/bin/pip peers/bin/python pip python sh \
    ls-dyna {starter,engine,anim_to_vtk}_linux64_gf; do
    eval "$foreign() { known \"\$@\"; }"
done
"#;

/// The step of `validate`.
pub fn step(root: &Path) -> Ended {
    test(root, &Options::default())
}

/// Tests the commands of the documents.
pub fn test(root: &Path, options: &Options) -> Ended {
    let python = match python(root) {
        Ok(python) => python,
        Err(problem) => return missing(problem, "the test of the documents' commands"),
    };
    let scripts = scripts(root, options)?;
    let folders = [built(root, "creepage")?, python].map(|file| file.with_file_name(""));
    let shell = Shell::new(root, folders)?;
    let faults: Vec<_> = scripts.iter().filter_map(|script| shell.test(script).err()).collect();
    without(&faults)
}

/// The commands of the pages: those to be read, which takes no time, and those to be run in the order of the book.
fn scripts(root: &Path, options: &Options) -> Result<Vec<Script>, String> {
    let is_chosen = |page: &String| options.pages.is_empty() || options.pages.contains(page);
    let pages = pages(root).map_err(|error| format!("docs: {error}"))?;
    let mut scripts = Vec::new();
    for page in pages.iter().filter(|page| is_chosen(page)) {
        let text = fs::read_to_string(root.join(page)).map_err(|e| format!("{page}: {e}"))?;
        let document = parse(&text);
        for (line, info, text) in document.blocks {
            if info.starts_with("sh") || text.lines().any(is_command) {
                let at = format!("{page}:{line}");
                let exit = exit(&info, options.long).ok_or_else(|| {
                    format!("{at}: commands stand in `sh run`, `sh long`, `sh elsewhere`, perhaps with `exit=CODE`")
                })?;
                scripts.push(Script { at, exit, text });
            }
        }
        for (line, span) in document.code.iter().filter(|(_, span)| is_whole_command(span)) {
            // a command's name, perhaps with an option, tells of the command
            let of_it = span.starts_with("creepage ")
                && span.split(' ').skip(2).all(|word| word.starts_with("--"));
            let text = format!("{span}{}", if of_it { " --help" } else { "" });
            scripts.push(Script { at: format!("{page}:{line}"), exit: None, text });
        }
    }
    scripts.sort_by_key(|script| script.exit.is_some());
    if scripts.is_empty() { Err("no such page has commands".into()) } else { Ok(scripts) }
}

/// The exit code that a fence wants of its commands if they are run; none for a fence that does not say it.
fn exit(info: &str, long: bool) -> Option<Option<i32>> {
    let (how, code) = match info.split_whitespace().collect::<Vec<_>>()[..] {
        ["sh", how] => (how, 0),
        ["sh", how, exit] => (how, exit.strip_prefix("exit=")?.parse().ok()?),
        _ => return None,
    };
    match how {
        "run" => Some(Some(code)),
        "long" => Some(long.then_some(code)),
        "elsewhere" => Some(None),
        _ => None,
    }
}

/// Whether a line calls one of the programs that the documents are about.
fn is_command(line: &str) -> bool {
    let mut words = line.split(' ');
    let program = words.next().is_some_and(|word| ["cargo", "creepage", "python"].contains(&word));
    // `creepage = 2.4e-3` is a key of a case
    program && words.next().is_some_and(|word| word != "=")
}

/// Whether inline code is a command without anything to fill in: no `CASE.toml`, no `[--out DIR]`.
fn is_whole_command(span: &str) -> bool {
    let is_pattern = |c: char| c.is_ascii_uppercase() || "[<|*".contains(c);
    is_command(span)
        && !span.contains(is_pattern)
        && !span.contains("...")
        && !span.ends_with(" --")
}

/// Where scripts are run or read.
struct Shell {
    scratch: PathBuf,
    search: std::ffi::OsString,
    program: PathBuf,
    packages: String,
}

impl Shell {
    /// A copy of the checkout, with the folders of `creepage` and of `python` before all others: the Python package
    /// brings a `creepage` of its own.
    fn new(root: &Path, folders: [PathBuf; 2]) -> Result<Self, String> {
        let scratch = target(root).join("book-test");
        let tell = |error: io::Error| format!("{}: {error}", scratch.display());
        if scratch.exists() {
            fs::remove_dir_all(&scratch).map_err(tell)?;
        }
        copy(root, &scratch).map_err(tell)?;
        for made in results::short_folders(root) {
            let (from, name) = (root.join(&made), made.trim_start_matches("runs/docs/"));
            match from.is_dir() {
                true => copy(&from, &scratch.join("runs").join(name)).map_err(tell)?,
                false => eprintln!("warning: there is no {made}: `cargo xtask results` makes it"),
            }
        }
        let [program, _] = folders.clone();
        let (search, packages) = (search(folders)?, structure::packages(root)?);
        Ok(Self { scratch, search, program, packages })
    }

    /// Runs or reads a script; what is wrong with it.
    fn test(&self, script: &Script) -> Result<(), String> {
        let start = Instant::now();
        let ended = match script.exit {
            Some(code) => bash(&script.text, &self.scratch, &self.search, &[], code),
            None => {
                let chores = env::current_exe().unwrap_or_default();
                let vars = [("PACKAGES", self.packages.as_ref()), ("XTASK", chores.as_ref())];
                // other programs than the functions are not found
                let text = format!("{READ}\nPATH={:?}\n{}", self.program, script.text);
                bash(&text, &self.scratch, &self.search, &vars, 0)
            }
        };
        if script.exit.is_some() {
            eprintln!("{:7.1} s  {}", start.elapsed().as_secs_f64(), script.at);
        }
        let Script { at, text, .. } = script;
        ended.map(drop).map_err(|problem| format!("{at}: {problem}\n{}", text.trim_end()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn a_fence_says_how_its_commands_are_tested() {
        for (info, wanted) in [
            ("sh run", Some(Some(0))),
            ("sh run exit=1", Some(Some(1))),
            ("sh long", Some(None)),
            ("sh elsewhere", Some(None)),
            ("sh", None),
            ("sh run exit=x", None),
        ] {
            assert_eq!(exit(info, false), wanted, "{info}");
        }
        assert_eq!(
            [exit("sh long", true), exit("sh elsewhere", true)],
            [Some(Some(0)), Some(None)]
        );
    }

    #[test]
    fn inline_code_with_something_to_fill_in_is_no_command() {
        assert!(is_whole_command("creepage check runs/quick --limit law_error=0.05"));
        for span in ["creepage run CASE.toml", "creepage run [--out DIR]", "runs/quick"] {
            assert!(!is_whole_command(span), "{span}");
        }
    }

    #[test]
    fn what_does_not_exist_is_told_and_what_is_read_is_not_run() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        fs::create_dir(root.join("cases")).unwrap();
        fs::write(root.join("cases/a.py"), "").unwrap();
        let shell = Shell {
            scratch: root.to_owned(),
            search: env::var_os("PATH").unwrap(),
            program: root.to_owned(),
            packages: "creepage-contact".into(),
        };
        let reads = |text: &str| {
            let script = Script { at: "docs/a.md:1".into(), exit: None, text: text.into() };
            shell.test(&script).is_ok()
        };
        assert!(reads("cargo run --release -p creepage-contact --example own_law"));
        assert!(reads("cd runs && python cases/a.py --out b.png\ncp cases/a.py b.py"));
        assert!(!root.join("b.py").exists());
        for bad in ["cargo test -p creepage-contract", "cp cases/b.py b\ntrue", "creepeg run a"] {
            assert!(!reads(bad), "{bad}");
        }
    }
}
