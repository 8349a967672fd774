//! `cargo xtask validate`: what the continuous integration runs and what a contributor runs.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

use crate::book_test::{Chosen, Long};
use crate::step::{Outcome, Step, built, cargo, execute, missing, python, root, target, told};

/// Runs the steps, cheapest first, up to the first that fails, and reports on each.
pub fn validate() -> ExitCode {
    let root = &root();
    let steps: [(&str, Step); 21] = [
        ("format", format),
        ("links", links),
        ("spelling", crate::sources::spelling),
        ("licences", crate::sources::licences),
        ("structure", structure),
        ("lints", lints),
        ("documentation", documentation),
        ("other machines", crate::sources::other_machines),
        ("tests", tests),
        ("program without verify", without_verify),
        ("schema", schema),
        ("smoke run", smoke_run),
        ("tables of the documents", crate::results::step),
        ("report page", report_page),
        ("sweep through Dask", dask),
        ("full and read-only disks", disks),
        ("damaged files", crate::soak::sample_of_damage),
        ("kills at system calls", crate::soak::sample_of_kills),
        ("Python package", crate::wheel::tests),
        ("book", book),
        ("commands of the book", book_test),
    ];
    let mut report = Vec::new();
    for (name, step) in steps {
        eprintln!("\n== {name}");
        let start = Instant::now();
        let outcome = step(root);
        report.push((name, outcome, start.elapsed()));
        if outcome == Outcome::Failed {
            break;
        }
    }
    eprintln!("\n== validate");
    for (name, outcome, time) in &report {
        let word = match outcome {
            Outcome::Passed => "passed",
            Outcome::Failed => "FAILED",
            Outcome::Skipped => "skipped",
        };
        eprintln!("{word:<8} {:>7.1} s  {name}", time.as_secs_f64());
    }
    for (name, _) in &steps[report.len()..] {
        eprintln!("not run             {name}");
    }
    let failed = report.iter().any(|(_, outcome, _)| *outcome == Outcome::Failed);
    if failed { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn format(root: &Path) -> Outcome {
    cargo(root, &["fmt", "--all", "--check"], &[])
}

fn links(root: &Path) -> Outcome {
    match crate::links::broken(root) {
        Ok(broken) if broken.is_empty() => Outcome::Passed,
        Ok(broken) => {
            told(&broken.iter().map(|link| format!("{link} does not exist")).collect::<Vec<_>>())
        }
        Err(error) => told(&[format!("a document cannot be read: {error}")]),
    }
}

/// The crates use one another as they are drawn, and no package is compiled twice.
fn structure(root: &Path) -> Outcome {
    use crate::structure::{compiled_twice, differences};
    let faults = differences(root).and_then(|drawn| Ok([drawn, compiled_twice(root)?].concat()));
    match faults {
        Ok(faults) if faults.is_empty() => Outcome::Passed,
        Ok(faults) => told(&faults),
        Err(error) => told(&[error]),
    }
}

fn lints(root: &Path) -> Outcome {
    // in the profile of the tests, so that macros and build scripts are compiled once
    let clippy = ["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"];
    cargo(root, &clippy, &[])
}

fn documentation(root: &Path) -> Outcome {
    cargo(
        root,
        &["doc", "--release", "--no-deps", "--workspace"],
        &[("RUSTDOCFLAGS", "-D warnings")],
    )
}

/// The README's test command.
fn tests(root: &Path) -> Outcome {
    // with it, what kills leave is opened with h5py too
    let python = python(root).map(|python| python.display().to_string()).unwrap_or_default();
    cargo(root, &["test", "--release", "--workspace"], &[("CREEPAGE_PYTHON", &python)])
}

/// The program of the README's first command, which leaves the verification problems out.
fn without_verify(root: &Path) -> Outcome {
    let test = ["test", "--release", "--package", "creepage", "--lib", "--no-default-features"];
    cargo(root, &test, &[])
}

/// The JSON Schema accepts every case file of the project, and refuses bad ones.
fn schema(root: &Path) -> Outcome {
    let Some(binary) = built(root, "creepage") else { return Outcome::Failed };
    let schema = match Command::new(&binary).arg("schema").output() {
        Ok(output) if output.status.success() => output.stdout,
        Ok(output) => {
            eprintln!("error: `creepage schema`: {}", output.status);
            return Outcome::Failed;
        }
        Err(error) => {
            eprintln!("error: {}: {error}", binary.display());
            return Outcome::Failed;
        }
    };
    let file = target(root).join("case.schema.json");
    if let Err(error) = std::fs::write(&file, schema) {
        eprintln!("error: {}: {error}", file.display());
        return Outcome::Failed;
    }
    check_with_python(root, "check_schema.py", &[file, root.join("cases")])
}

/// Runs the smallest case and has its files read by the libraries that users read them with.
fn smoke_run(root: &Path) -> Outcome {
    let folder = target(root).join("smoke");
    let out = folder.display().to_string();
    let Some(program) = built(root, "creepage") else { return Outcome::Failed };
    let run = ["run", "cases/smoke.toml", "--force", "--out", &out];
    if execute(Command::new(program).args(run).current_dir(root)) == Outcome::Failed {
        return Outcome::Failed;
    }
    check_with_python(root, "check_run.py", &[folder])
}

/// Has a browser render the report of the smoke run. Machines without one skip this: that pages are
/// well-formed and ask for no address is tested everywhere.
fn report_page(root: &Path) -> Outcome {
    let browsers = ["chromium", "chromium-browser", "google-chrome"];
    let runs = |name: &&str| Command::new(name).arg("--version").output().is_ok();
    if !browsers.iter().any(runs) {
        eprintln!("warning: there is no Chromium; tests/python/check_page.py was skipped");
        return Outcome::Skipped;
    }
    let folder = target(root).join("smoke").display().to_string();
    let Some(program) = built(root, "creepage") else { return Outcome::Failed };
    let report = ["report", &folder];
    if execute(Command::new(program).args(report).current_dir(root)) == Outcome::Failed {
        return Outcome::Failed;
    }
    check_with_python(root, "check_page.py", &[target(root).join("smoke/report.html")])
}

/// A plan of `creepage sweep` run by the Dask driver gives the sweep's own numbers.
fn dask(root: &Path) -> Outcome {
    let Some(binary) = built(root, "creepage") else { return Outcome::Failed };
    check_with_python(root, "check_dask.py", &[binary, root.to_path_buf()])
}

/// Runs on small file systems of their own fill them up. Says so where none can be mounted.
fn disks(root: &Path) -> Outcome {
    let Some(binary) = built(root, "creepage") else { return Outcome::Failed };
    check_with_python(root, "check_disk.py", &[binary, root.to_path_buf()])
}

/// The documents as a book, without a dead link.
pub fn book(root: &Path) -> Outcome {
    use crate::book::{Problem, book};
    match book(root, &target(root)) {
        Ok(page) => {
            println!("{}", page.display());
            Outcome::Passed
        }
        Err(Problem::Faults(faults)) => told(&faults),
        Err(Problem::NoBuilder(problem)) => missing(&problem, "the book"),
    }
}

/// The commands of the book, but for the long ones.
fn book_test(root: &Path) -> Outcome {
    commands_of_the_book(root, &Chosen { long: Long::None, chapters: Vec::new() })
}

/// Commands of the book.
pub fn commands_of_the_book(root: &Path, chosen: &Chosen) -> Outcome {
    if Command::new("bash").arg("--version").output().is_err() {
        return missing("there is no bash", "the test of the book's commands");
    }
    let python = match python(root) {
        Ok(python) => python.parent().map(Path::to_owned),
        Err(problem) => return missing(&problem, "the test of the book's commands"),
    };
    if built(root, "creepage").is_none() {
        return Outcome::Failed;
    }
    let programs = crate::book_test::Programs { release: target(root).join("release"), python };
    let scratch = target(root).join("book-test");
    match &crate::book_test::test(root, &scratch, &programs, chosen)[..] {
        [] => Outcome::Passed,
        faults => told(faults),
    }
}

/// Runs a script of `tests/python`; without Python it is skipped, except in the continuous
/// integration.
fn check_with_python(root: &Path, script: &str, arguments: &[PathBuf]) -> Outcome {
    let script = root.join("tests/python").join(script);
    match python(root) {
        Ok(python) => execute(Command::new(python).arg(script).args(arguments).current_dir(root)),
        Err(problem) => missing(&problem, &script.display().to_string()),
    }
}
