//! Runs that do not come to their end: stopped by their guards, by Ctrl-C or by a kill.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use output::{GridFile, HistoryFile, OutputError};
use runs::heeding_signals;
use serde_json::Value;

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");

fn start(out: &Path, more: &[&str]) -> Child {
    heeding_signals(env!("CARGO_BIN_EXE_creepage"))
        .args(["run", CASE, "--threads", "1", "--out"])
        .arg(out)
        .args(more)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// A run that would take minutes: slow rolling, so many steps.
const LONG: [&str; 2] = ["--set", "drive.speed=0.5"];

/// How many steps and rows the files of a run hold, every one of them read.
#[derive(Debug, PartialEq)]
struct Held {
    fields: usize,
    contact: usize,
    rows: usize,
}

fn read(out: &Path) -> Result<Held, OutputError> {
    let fields = GridFile::open(out.join("fields.vtkhdf"))?;
    let contact = GridFile::open(out.join("contact.vtkhdf"))?;
    for grid in [&fields, &contact] {
        let times = grid.times()?;
        assert!(times.len() == grid.steps() && times.is_sorted_by(|a, b| a < b), "{times:?}");
        let points = grid.points()?.len();
        for field in grid.fields() {
            let rows = if field.on_cells { grid.cells() } else { points };
            let steps = if field.constant { 1 } else { grid.steps() };
            for step in 0..steps {
                let values = grid.read(&field.name, field.on_cells, step)?;
                assert_eq!(values.len(), rows * field.components, "{} {step}", field.name);
                assert!(values.iter().all(|x| x.is_finite()), "{} {step}", field.name);
            }
        }
    }
    let history = HistoryFile::open(out.join("history.h5"))?;
    for column in history.columns()? {
        assert_eq!(history.read(&column)?.len(), history.rows(), "{column}");
    }
    let steps = history.read("step")?;
    assert!(steps.is_sorted_by(|a, b| a < b), "{steps:?}");
    Ok(Held { fields: fields.steps(), contact: contact.steps(), rows: history.rows() })
}

/// Waits until the history of a run has rows. While the run writes, an opening can meet a closing
/// and fail; it is then tried again.
fn wait_until_it_rolls(run: &mut Child, out: &Path) {
    let clock = Instant::now();
    while HistoryFile::open(out.join("history.h5")).map_or(0, |h| h.rows()) == 0 {
        assert!(run.try_wait().unwrap().is_none(), "the run ended before it was stopped");
        assert!(clock.elapsed() < Duration::from_secs(120), "no rows");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn interrupt(run: &Child) {
    let pid = run.id().to_string();
    assert!(Command::new("kill").args(["-INT", &pid]).status().unwrap().success());
}

fn summary(out: &Path) -> Value {
    serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn an_unstable_run_ends_with_code_3_the_cause_the_remedy_and_readable_results() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let frequent = ["--set", "output.fields_interval=1e-7", "--set", "output.history_interval=1"];
    let run = start(&out, &[&["--set", "time.factor=1.6"], &frequent[..]].concat());
    let output = run.wait_with_output().unwrap();
    let message = said(&output);
    assert_eq!(output.status.code(), Some(3), "{message}");
    for words in ["1.60 times the stability limit", "set it below 1", "node", "det F"] {
        assert!(message.contains(words), "{words:?} is not in:\n{message}");
    }
    let summary = summary(&out);
    assert_eq!(summary["status"], "failed");
    let diagnosis = summary["diagnosis"].as_str().unwrap();
    assert!(message.contains(diagnosis), "{message}");
    assert!(fs::read_to_string(out.join("run.log")).unwrap().contains(diagnosis));
    let steps = summary["steps"].as_u64().unwrap() as usize;
    let held = read(&out).unwrap();
    assert!((1..500).contains(&steps), "{steps}");
    assert!(held.rows + 1 >= steps && held.rows <= steps, "{held:?} of {steps} steps");
    assert!(held.fields > 1, "{held:?}");
}

#[test]
fn a_preload_without_equilibrium_ends_with_code_3_the_worst_node_and_the_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let run = start(&out, &["--set", "preload.max_iterations=2", "--json"]);
    let output = run.wait_with_output().unwrap();
    let message = said(&output);
    assert_eq!(output.status.code(), Some(3), "{message}");
    for words in
        ["2 Newton iterations", "node", "body 'disk'", "mm", "raise preload.max_iterations"]
    {
        assert!(message.contains(words), "{words:?} is not in:\n{message}");
    }
    let printed: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(printed["status"], "failed");
    assert_eq!(printed["steps"], 0);
    assert_eq!(summary(&out)["diagnosis"], printed["diagnosis"]);
}

#[test]
fn an_absurd_load_is_refused_with_code_2_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let output = start(&out, &["--set", "load.normal=5e6"]).wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("the patch's width"), "{}", said(&output));
    assert!(!out.exists());
}

#[test]
fn ctrl_c_while_rolling_ends_with_code_130_and_readable_results() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut run = start(&out, &[&LONG[..], &["--json"]].concat());
    wait_until_it_rolls(&mut run, &out);
    interrupt(&run);
    let clock = Instant::now();
    let output = run.wait_with_output().unwrap();
    assert!(clock.elapsed() < Duration::from_secs(10), "it stops at once");
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    let summary = summary(&out);
    assert_eq!(summary["status"], "interrupted");
    let printed: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(printed, summary);
    let steps = summary["steps"].as_u64().unwrap();
    let held = read(&out).unwrap();
    // A row every ten steps from step 0 on, none of them lost.
    assert_eq!(held.rows as u64, steps.div_ceil(10), "{steps} steps");
    assert!(held.fields >= 2 && held.contact >= 1, "{held:?}");
    let fields = GridFile::open(out.join("fields.vtkhdf")).unwrap();
    let last = *fields.times().unwrap().last().unwrap();
    assert_eq!(last, summary["t_end"].as_f64().unwrap(), "the last state is written");
}

#[test]
fn ctrl_c_during_the_preload_ends_with_code_130() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let run =
        start(&out, &["--set", "preload.method='relaxation'", "--set", "preload.tolerance=1e-14"]);
    let log = out.join("run.log");
    let clock = Instant::now();
    while !fs::read_to_string(&log).is_ok_and(|text| text.contains("mesh:")) {
        assert!(clock.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(5));
    }
    interrupt(&run);
    let output = run.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", said(&output));
    assert!(said(&output).contains("interrupted"), "{}", said(&output));
    assert_eq!(summary(&out)["status"], "interrupted");
}

#[test]
fn the_files_of_a_run_are_there_during_its_preload_and_not_after_a_preload_that_fails() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let endless = ["--set", "preload.method='relaxation'", "--set", "preload.tolerance=1e-14"];
    let run = start(&out, &endless);
    let clock = Instant::now();
    while !out.join("history.h5").exists() {
        assert!(clock.elapsed() < Duration::from_secs(60), "no file");
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(read(&out).unwrap(), Held { fields: 0, contact: 0, rows: 0 });
    let early =
        Command::new(env!("CARGO_BIN_EXE_creepage")).arg("check").arg(&out).output().unwrap();
    assert_eq!(early.status.code(), Some(2), "{}", said(&early));
    interrupt(&run);
    assert_eq!(run.wait_with_output().unwrap().status.code(), Some(130));
    for name in ["fields.vtkhdf", "contact.vtkhdf", "history.h5"] {
        assert!(!out.join(name).exists(), "{name} of a run that did not roll");
    }
    // a run that was killed in its preload left nothing that another case could not replace
    let mut run = start(&out, &[&endless[..], &["--resume"]].concat());
    while !out.join("history.h5").exists() {
        assert!(run.try_wait().unwrap().is_none(), "it did not go on");
        std::thread::sleep(Duration::from_millis(5));
    }
    run.kill().unwrap();
    run.wait().unwrap();
    let other = start(&out, &["--resume", "--set", "time.roll=0.0002", "--set", "drive.ramp=1e-6"]);
    let output = other.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(said(&output).contains("holds no results"), "{}", said(&output));
}

#[test]
fn rows_of_the_history_are_in_the_file_a_second_after_they_were_made() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    // a row takes about a tenth of a second: they are handed over before there are enough to fill a block
    let seldom = ["--set", "output.history_interval=500", "--set", "preload.method='none'"];
    let mut run = start(&out, &[&LONG[..], &seldom].concat());
    wait_until_it_rolls(&mut run, &out);
    let rows = HistoryFile::open(out.join("history.h5")).unwrap().rows();
    interrupt(&run);
    assert_eq!(run.wait_with_output().unwrap().status.code(), Some(130));
    assert!((1..64).contains(&rows), "{rows} rows");
}

#[test]
fn a_kill_while_rolling_leaves_readable_files() {
    let mut chance = 0x2545_f491_4f6c_dd1d_u64;
    let mut seen = Vec::new();
    for kill in 0..4 {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        let frequent = [
            "--set",
            "output.fields_interval=1e-7",
            "--set",
            "output.contact_interval=1e-8",
            "--set",
            "output.history_interval=1",
            "--set",
            "preload.method='none'",
        ];
        let mut run = start(&out, &[&LONG[..], &frequent].concat());
        wait_until_it_rolls(&mut run, &out);
        chance ^= chance << 13;
        chance ^= chance >> 7;
        chance ^= chance << 17;
        std::thread::sleep(Duration::from_micros(chance % 200_000));
        run.kill().unwrap();
        run.wait().unwrap();
        let held = read(&out).unwrap_or_else(|error| panic!("kill {kill}: {error}"));
        assert!(held.rows > 0 && held.fields > 0 && held.contact > 0, "{held:?}");
        assert!(!out.join("summary.json").exists());
        seen.push(held);
    }
    assert!(seen.windows(2).any(|w| w[0] != w[1]), "kills fell at different moments: {seen:?}");
}

/// The history is created last and appending begins after it: without it, a kill fell into the
/// creation of the files.
#[test]
fn a_kill_while_the_files_are_created_leaves_no_half_file_under_its_name() {
    let mut chance = 0x9e37_79b9_7f4a_7c15_u64;
    let mut early = 0;
    for kill in 0..8 {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        let mut run = start(&out, &[&LONG[..], &["--set", "preload.method='none'"]].concat());
        let clock = Instant::now();
        while !out.join("fields.vtkhdf").exists() && !out.join("fields.vtkhdf.partial").exists() {
            assert!(clock.elapsed() < Duration::from_secs(60), "no file");
            std::thread::sleep(Duration::from_micros(200));
        }
        chance ^= chance << 13;
        chance ^= chance >> 7;
        chance ^= chance << 17;
        // The first at once, so that at least one falls before the last file is in place.
        let wait = if kill == 0 { 0 } else { chance % 20_000 };
        std::thread::sleep(Duration::from_micros(wait));
        run.kill().unwrap();
        run.wait().unwrap();
        if out.join("history.h5").exists() {
            continue;
        }
        early += 1;
        for name in ["fields.vtkhdf", "contact.vtkhdf"] {
            if out.join(name).exists() {
                let file = GridFile::open(out.join(name));
                assert_eq!(file.unwrap_or_else(|e| panic!("kill {kill}: {e}")).steps(), 0);
            }
        }
    }
    assert!(early > 0, "some kills fell before the files were in place");
}

fn terminate(run: &Child) {
    let pid = run.id().to_string();
    assert!(Command::new("kill").args(["-TERM", &pid]).status().unwrap().success());
}

/// The exit code once the process has ended; a process that does not is killed.
#[track_caller]
fn code_of(mut run: Child) -> Option<i32> {
    let clock = Instant::now();
    loop {
        if let Some(status) = run.try_wait().unwrap() {
            return status.code();
        }
        if clock.elapsed() > Duration::from_secs(120) {
            run.kill().unwrap();
            panic!("it does not end");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
}

#[test]
fn sigterm_ends_commands_that_hold_nothing_half_done_with_code_130() {
    for words in [
        &["verify", "rupture"][..],
        &["mesh", "../../cases/quick.toml", "--set", "mesh.zone.size=4e-4"],
    ] {
        let command = Command::new(env!("CARGO_BIN_EXE_creepage"))
            .args(words)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        wait_until_it_listens(&command);
        terminate(&command);
        assert_eq!(code_of(command), Some(130), "{words:?}");
    }
}

/// A run that is held up before it rolls, here by a log that is a pipe without a reader, cannot look at
/// what it is asked.
#[test]
fn sigterm_ends_a_run_that_is_held_up_before_it_rolls() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut run = start(&out, &LONG);
    wait_until_it_rolls(&mut run, &out);
    terminate(&run);
    assert_eq!(code_of(run), Some(130));
    fs::remove_file(out.join("run.log")).unwrap();
    pipe(&out.join("run.log"));
    let run = start(&out, &[&LONG[..], &["--resume"]].concat());
    wait_until_it_listens(&run);
    terminate(&run);
    assert_eq!(code_of(run), Some(130));
}

/// Waits until a process handles SIGTERM itself (the bit of signal 15 in its `SigCgt`, `man 5 proc`).
fn wait_until_it_listens(run: &Child) {
    let clock = Instant::now();
    let listens = || {
        let status = fs::read_to_string(format!("/proc/{}/status", run.id())).ok()?;
        let caught =
            status.lines().find_map(|line| line.strip_prefix("SigCgt:"))?.trim().to_owned();
        Some(u64::from_str_radix(&caught, 16).ok()? & (1 << 14) != 0)
    };
    if !cfg!(target_os = "linux") {
        std::thread::sleep(Duration::from_secs(5));
    }
    while cfg!(target_os = "linux") && listens() != Some(true) {
        assert!(clock.elapsed() < Duration::from_secs(60), "no handler");
        std::thread::sleep(Duration::from_millis(5));
    }
}
