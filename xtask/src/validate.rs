//! `cargo xtask validate`: what the continuous integration runs and what a contributor runs.

use std::env;
use std::fs;
use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use crate::soak::{Trial, sample_of_kills, soak};
use crate::step::{
    Ended, Outcome, PARTS, Step, built, cargo, done, missing, output, part, python, root,
    sample_variable, skipped, target, without,
};
use crate::{book, book_test, markdown, results, sources, structure, wheel};

/// The steps, cheapest first.
pub const STEPS: [(&str, Step); 22] = [
    ("format", |root| cargo(root, &["fmt", "--all", "--check"], &[])),
    ("links", |root| without(&markdown::broken(root))),
    ("spelling", sources::spelling),
    ("structure", |root| without(&structure::differences(root))),
    ("lints", lints),
    ("documentation", documentation),
    ("other machines", sources::other_machines),
    ("tests", tests),
    ("schema", schema),
    ("smoke run", smoke_run),
    ("libhdf5", libhdf5),
    ("shared runs", shared_runs),
    ("kernels on a device", device_kernels),
    ("tables of the documents", results::step),
    ("report page", report_page),
    ("sweep through Dask", |root| with_program(root, "check_dask.py")),
    ("full and read-only disks", |root| with_program(root, "check_disk.py")),
    // the same 30 damaged files each time
    ("damaged files", |root| soak(root, Trial::Damage, &["--mutations", "15", "--seed", "1"])),
    ("kills at system calls", sample_of_kills),
    ("Python package", wheel::tests),
    ("book", book::step),
    ("commands of the book", book_test::step),
];

/// The parts of the continuous integration that alone make these steps; all others are made by all.
const IN_TURN: [(&str, [usize; 2]); 6] = [
    ("documentation", [0, 4]),
    ("other machines", [1, 3]),
    ("libhdf5", [0, 3]),
    ("shared runs", [4, 4]),
    ("kernels on a device", [4, 4]),
    ("book", [2, 5]),
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
        let is_of = |part| IN_TURN.iter().all(|(n, parts)| *n != name || parts.contains(&part));
        let is_left_out = part(root).is_some_and(|part| !is_of(part));
        if is_left_out || code != ExitCode::SUCCESS {
            let word = if is_left_out { "skipped" } else { "not run" };
            report.push(format!("{word:<19} {name}"));
            continue;
        }
        eprintln!("\n== {name}");
        let start = Instant::now();
        let word = match step(root) {
            Ok(Outcome::Passed) => "passed",
            Ok(Outcome::Skipped) => "skipped",
            Err(problem) => {
                eprintln!("error: {problem}");
                code = ExitCode::FAILURE;
                "FAILED"
            }
        };
        report.push(format!("{word:<8} {:>7.1} s  {name}", start.elapsed().as_secs_f64()));
    }
    eprintln!("\n== validate\n{}", report.join("\n"));
    code
}

fn lints(root: &Path) -> Ended {
    // in the profile of the tests, so that macros and build scripts are compiled once
    let clippy = ["clippy", "--release", "--workspace", "--all-targets", "--", "-D", "warnings"];
    cargo(root, &clippy, &[])
}

fn documentation(root: &Path) -> Ended {
    let doc = ["doc", "--release", "--no-deps", "--workspace"];
    cargo(root, &doc, &[("RUSTDOCFLAGS", "-D warnings")])
}

/// The README's test command. In the continuous integration a sixth of the verification problems and of the long tests,
/// another one after each change.
fn tests(root: &Path) -> Ended {
    // with it, what kills leave is opened with h5py too
    let python = python(root).map(|python| python.display().to_string()).unwrap_or_default();
    let part_of = sample_variable(root);
    let mut vars = vec![("CREEPAGE_PYTHON", &*python)];
    vars.extend(part_of.as_ref().map(|(name, part)| (*name, &**part)));
    let left_out = part(root).map(|part| left_out(root, part)).transpose()?.unwrap_or_default();
    let mut test = vec!["test", "--release", "--workspace", "--"];
    test.extend(left_out.iter().flat_map(|name| ["--skip", &**name]));
    cargo(root, &test, &vars)
}

/// Modules of tests, and tests, that take from seconds to a minute each: whole runs, planted errors, kills.
const LONG: &str = "
    checkpoint contact_layers damage determinism disk exact friction_laws half_model half_space nearly_incompressible
    own_mu plane_strain planted preload ranks resume sideways slider stopped sweep terminal window
    a_grid_cut_off_and_continued_holds_what_one_written_at_once_holds
    figures::reference::tests::steady_rolling_of_half_spaces_is_that_of_contact
    tests::implicit::elastic_energy_is_kept_with_theta_one_half_and_lost_with_theta_one_as_booked
    tests::search::search_misses_no_node_of_a_disk_that_moves_smoothly";

/// The long tests that are not of this part.
fn left_out(root: &Path, part: usize) -> Result<Vec<String>, String> {
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let list = "test --release --workspace --lib --bins --tests --quiet -- --list".split(' ');
    let listed = output(Command::new(cargo).args(list).current_dir(root))?;
    let names = || listed.lines().filter_map(|line| line.strip_suffix(": test"));
    let is_of = |name: &str, long: &str| match name.strip_prefix(long) {
        Some("") => true,
        Some(rest) => rest.starts_with("::") && !rest.contains("::tests::"),
        None => false,
    };
    let long = || LONG.split_whitespace();
    if let Some(gone) = long().find(|long| !names().any(|name| is_of(name, long))) {
        return Err(format!("there is no test or module of tests `{gone}`"));
    }
    let long = names().filter(|name| long().any(|long| is_of(name, long))).enumerate();
    Ok(long.filter(|(n, _)| n % PARTS != part).map(|(_, name)| name.to_owned()).collect())
}

/// The JSON Schema accepts every case file of the project, and refuses bad ones.
fn schema(root: &Path) -> Ended {
    let schema = output(Command::new(built(root, "creepage")?).arg("schema"))?;
    let file = target(root).join("case.schema.json");
    fs::write(&file, schema).map_err(|error| format!("{}: {error}", file.display()))?;
    check_with_python(root, "check_schema.py", &[&file, &root.join("cases")])
}

/// Runs the smallest case and has its files read by the libraries that users read them with.
fn smoke_run(root: &Path) -> Ended {
    let mut run = Command::new(built(root, "creepage")?);
    let folder = target(root).join("smoke");
    run.args(["run", "cases/smoke.toml", "--force", "--out"]).arg(&folder).current_dir(root);
    done(&mut run)?;
    check_with_python(root, "check_run.py", &[&folder])
}

/// Has HDF5's own library write the files of the smoke run again, and compares all that is in them. Machines without
/// that library skip this.
fn libhdf5(root: &Path) -> Ended {
    let found = Command::new("pkg-config").args(["--exists", "hdf5"]).status();
    if !found.is_ok_and(|status| status.success()) {
        return skipped("pkg-config finds no hdf5 (Debian: libhdf5-dev); the comparison with it");
    }
    let run = target(root).join("smoke").display().to_string();
    // the other features of the whole workspace, so that no package of others is compiled twice
    let test =
        "test --release --workspace --features creepage-output/libhdf5 --test libhdf5 -- --ignored";
    cargo(root, &test.split(' ').collect::<Vec<_>>(), &[("CREEPAGE_RUN", &run)])
}

/// Has processes of MPI share runs, and compares their files with those of one. Machines without MPI skip this.
fn shared_runs(root: &Path) -> Ended {
    if Command::new("mpirun").arg("--version").output().is_err() {
        return skipped("there is no mpirun (Debian: libopenmpi-dev, libclang-dev); shared runs");
    }
    feature_test(root, "creepage/mpi", "processes")
}

/// Has a device of OpenCL, which may be a processor, compute the elements, and compares their bits. Machines without one skip this.
fn device_kernels(root: &Path) -> Ended {
    if !std::fs::read_dir("/etc/OpenCL/vendors").is_ok_and(|mut drivers| drivers.next().is_some()) {
        return skipped("there is no driver of OpenCL (Debian: pocl-opencl-icd); device kernels");
    }
    feature_test(root, "creepage-device/gpu", "opencl")
}

/// Runs a test that needs a feature.
fn feature_test(root: &Path, feature: &str, test: &str) -> Ended {
    cargo(root, &["test", "--release", "--workspace", "--features", feature, "--test", test], &[])
}

/// Has a browser render the report of the smoke run. Machines without one skip this: that pages are
/// well-formed and ask for no address is tested everywhere.
fn report_page(root: &Path) -> Ended {
    let browsers = ["chromium", "chromium-browser", "google-chrome"];
    if !browsers.iter().any(|name| Command::new(name).arg("--version").output().is_ok()) {
        return skipped("there is no Chromium; tests/python/check_page.py");
    }
    let folder = target(root).join("smoke");
    let mut report = Command::new(built(root, "creepage")?);
    done(report.arg("report").arg(&folder).current_dir(root))?;
    check_with_python(root, "check_page.py", &[&folder.join("report.html")])
}

/// Runs a script of `tests/python` on the program: a plan of `creepage sweep` run by the Dask driver gives the sweep's
/// own numbers; runs on small file systems of their own fill them up.
fn with_program(root: &Path, script: &str) -> Ended {
    check_with_python(root, script, &[&built(root, "creepage")?, root])
}

/// Runs a script of `tests/python`; without Python it is skipped, except in the continuous
/// integration.
fn check_with_python(root: &Path, script: &str, arguments: &[&Path]) -> Ended {
    let script = root.join("tests/python").join(script);
    match python(root) {
        Ok(python) => done(Command::new(python).arg(script).args(arguments).current_dir(root)),
        Err(problem) => missing(problem, &script.display().to_string()),
    }
}
