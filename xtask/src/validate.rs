//! `cargo xtask validate`: what the continuous integration runs and what a contributor runs.

use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use crate::step::{
    Outcome, Step, built, cargo, execute, missing, output, python, root, sample, target, without,
};
use crate::{book, book_test, markdown, results, soak, sources, structure, wheel};

/// The steps, cheapest first.
pub const STEPS: [(&str, Step); 19] = [
    ("format", |root| cargo(root, &["fmt", "--all", "--check"], &[])),
    ("links", |root| without(markdown::broken(root))),
    ("spelling", sources::spelling),
    ("structure", |root| without(structure::differences(root))),
    ("lints", lints),
    ("documentation", documentation),
    ("other machines", sources::other_machines),
    ("tests", tests),
    ("schema", schema),
    ("smoke run", smoke_run),
    ("tables of the documents", results::step),
    ("report page", report_page),
    ("sweep through Dask", |root| with_program(root, "check_dask.py")),
    ("full and read-only disks", |root| with_program(root, "check_disk.py")),
    ("damaged files", soak::sample_of_damage),
    ("kills at system calls", soak::sample_of_kills),
    ("Python package", wheel::tests),
    ("book", book::step),
    ("commands of the book", book_test::step),
];

/// Runs the steps with these names, all if there are none, up to the first that fails, and reports on each.
pub fn validate(names: &[String]) -> ExitCode {
    let root = &root();
    let mut report = Vec::new();
    let mut code = ExitCode::SUCCESS;
    for (name, step) in STEPS {
        if !names.is_empty() && !names.iter().any(|chosen| chosen == name) {
            continue;
        }
        if code != ExitCode::SUCCESS {
            report.push(format!("not run             {name}"));
            continue;
        }
        eprintln!("\n== {name}");
        let start = Instant::now();
        let word = match step(root) {
            Outcome::Passed => "passed",
            Outcome::Skipped => "skipped",
            Outcome::Failed => {
                code = ExitCode::FAILURE;
                "FAILED"
            }
        };
        report.push(format!("{word:<8} {:>7.1} s  {name}", start.elapsed().as_secs_f64()));
    }
    eprintln!("\n== validate\n{}", report.join("\n"));
    code
}

fn lints(root: &Path) -> Outcome {
    // in the profile of the tests, so that macros and build scripts are compiled once
    let clippy = ["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"];
    cargo(root, &clippy, &[])
}

fn documentation(root: &Path) -> Outcome {
    let doc = ["doc", "--release", "--no-deps", "--workspace"];
    cargo(root, &doc, &[("RUSTDOCFLAGS", "-D warnings")])
}

/// The README's test command.
fn tests(root: &Path) -> Outcome {
    // with it, what kills leave is opened with h5py too
    let python = python(root).map(|python| python.display().to_string()).unwrap_or_default();
    let mut vars = vec![("CREEPAGE_PYTHON", &*python)];
    // in the continuous integration a third of the verification problems, another one after each change
    let sample = sample(root).map(|third| format!("{third}/3"));
    vars.extend(sample.as_deref().map(|third| ("CREEPAGE_SAMPLE", third)));
    cargo(root, &["test", "--release", "--workspace"], &vars)
}

/// The JSON Schema accepts every case file of the project, and refuses bad ones.
fn schema(root: &Path) -> Outcome {
    let Some(program) = built(root, "creepage") else { return Outcome::Failed };
    let file = target(root).join("case.schema.json");
    let written = output(Command::new(program).arg("schema"))
        .and_then(|schema| fs::write(&file, schema).map_err(|error| error.to_string()));
    match written {
        Ok(()) => check_with_python(root, "check_schema.py", &[&file, &root.join("cases")]),
        Err(problem) => without([problem]),
    }
}

/// Runs the smallest case and has its files read by the libraries that users read them with.
fn smoke_run(root: &Path) -> Outcome {
    let Some(program) = built(root, "creepage") else { return Outcome::Failed };
    let folder = target(root).join("smoke");
    let mut run = Command::new(program);
    run.args(["run", "cases/smoke.toml", "--force", "--out"]).arg(&folder).current_dir(root);
    match execute(&mut run) {
        Outcome::Passed => check_with_python(root, "check_run.py", &[&folder]),
        failed => failed,
    }
}

/// Has a browser render the report of the smoke run. Machines without one skip this: that pages are
/// well-formed and ask for no address is tested everywhere.
fn report_page(root: &Path) -> Outcome {
    let browsers = ["chromium", "chromium-browser", "google-chrome"];
    if !browsers.iter().any(|name| Command::new(name).arg("--version").output().is_ok()) {
        eprintln!("warning: there is no Chromium; tests/python/check_page.py was skipped");
        return Outcome::Skipped;
    }
    let Some(program) = built(root, "creepage") else { return Outcome::Failed };
    let folder = target(root).join("smoke");
    match execute(Command::new(program).arg("report").arg(&folder).current_dir(root)) {
        Outcome::Passed => check_with_python(root, "check_page.py", &[&folder.join("report.html")]),
        failed => failed,
    }
}

/// Runs a script of `tests/python` on the program: a plan of `creepage sweep` run by the Dask driver gives the sweep's
/// own numbers; runs on small file systems of their own fill them up.
fn with_program(root: &Path, script: &str) -> Outcome {
    let Some(program) = built(root, "creepage") else { return Outcome::Failed };
    check_with_python(root, script, &[&program, root])
}

/// Runs a script of `tests/python`; without Python it is skipped, except in the continuous
/// integration.
fn check_with_python(root: &Path, script: &str, arguments: &[&Path]) -> Outcome {
    let script = root.join("tests/python").join(script);
    match python(root) {
        Ok(python) => execute(Command::new(python).arg(script).args(arguments).current_dir(root)),
        Err(problem) => missing(&problem, &script.display().to_string()),
    }
}
