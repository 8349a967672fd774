//! A terminal that is gone: signals that were ignored, streams without a reader, full disks below them.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use output::HistoryFile;
use runs::heeding_signals;

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");
const PROGRAM: &str = env!("CARGO_BIN_EXE_creepage");

/// A run of a few seconds.
const SLOW: [&str; 4] = ["--set", "drive.speed=4", "--set", "time.roll=0.002"];

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Starts the program below a shell that ignores these signals and no other.
fn with_ignored(signals: &str, words: &[&str]) -> Child {
    let script = format!("trap '' {signals}; exec \"$@\"");
    let mut command = heeding_signals("sh");
    command.args(["-c", &script, "sh", PROGRAM]).args(words);
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

fn signal(name: &str, pid: u32) {
    assert!(Command::new("kill").args([name, &pid.to_string()]).status().unwrap().success());
}

/// Waits until the run in `folder` has rows in its history.
#[track_caller]
fn wait_until_it_rolls(process: &mut Child, folder: &Path) {
    let clock = Instant::now();
    while HistoryFile::open(folder.join("history.h5")).map_or(0, |h| h.rows()) == 0 {
        assert!(process.try_wait().unwrap().is_none(), "it ended before the signal");
        assert!(clock.elapsed() < Duration::from_secs(120), "no rows");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn signals_that_were_ignored_at_the_start_do_not_end_a_run_and_the_others_do() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("protected");
    let place = out.to_str().unwrap();
    let words = [&["run", CASE, "--threads", "1", "--out", place][..], &SLOW].concat();
    let mut run = with_ignored("HUP INT TERM", &words);
    wait_until_it_rolls(&mut run, &out);
    for name in ["-HUP", "-INT", "-TERM"] {
        signal(name, run.id());
    }
    let output = run.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(out.join("summary.json").exists() && !said(&output).contains("stopping"));

    for name in ["-HUP", "-INT", "-TERM"] {
        let out = folder.path().join(name);
        let place = out.to_str().unwrap();
        // two others are ignored
        let others = ["HUP", "INT", "TERM"].into_iter().filter(|other| !name.ends_with(other));
        let others = others.collect::<Vec<_>>().join(" ");
        let words = [&["run", CASE, "--threads", "1", "--out", place][..], &SLOW].concat();
        let mut run = with_ignored(&others, &words);
        wait_until_it_rolls(&mut run, &out);
        signal(name, run.id());
        let output = run.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{name}: {}", said(&output));
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_sweep_under_nohup_goes_on_after_the_logout() {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(CASE, folder.path().join("small.toml")).unwrap();
    let file = folder.path().join("sweep.toml");
    let text = "base = \"small.toml\"\n[set]\ndrive.speed = 4\ntime.roll = 0.002\n[[axis]]\nkey = \"friction.static\"\n\
                values = [0.2, 0.3]\n";
    fs::write(&file, text).unwrap();
    let out = folder.path().join("sweep");
    let (file, place) = (file.to_str().unwrap(), out.to_str().unwrap());
    let mut sweep = with_ignored("HUP", &["sweep", file, "--jobs", "1", "--out", place]);
    let runs = || -> Vec<_> {
        let entries = fs::read_dir(out.join("runs")).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).filter(|path| path.join("history.h5").exists()).collect()
    };
    let clock = Instant::now();
    while runs().is_empty() {
        assert!(sweep.try_wait().unwrap().is_none() && clock.elapsed() < Duration::from_secs(120));
        std::thread::sleep(Duration::from_millis(5));
    }
    signal("-HUP", sweep.id());
    let output = sweep.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(runs().iter().all(|run| run.join("summary.json").exists()) && runs().len() == 2);
}

/// A run with these streams; its exit code. What it did is in its folder.
fn run_with(out: &Path, more: &[&str], stdout: Stdio, stderr: Stdio) -> Option<i32> {
    let mut command = Command::new(PROGRAM);
    command.args(["run", CASE, "--set", "time.roll=0.001", "--threads", "1", "--out"]).arg(out);
    command.args(more).stdout(stdout).stderr(stderr).status().unwrap().code()
}

/// A pipe whose reader is gone.
fn closed_pipe() -> Stdio {
    let mut reader =
        Command::new("true").stdin(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    let pipe = reader.stdin.take().unwrap();
    reader.wait().unwrap();
    pipe.into()
}

fn full() -> Stdio {
    File::options().write(true).open("/dev/full").unwrap().into()
}

#[test]
#[cfg(target_os = "linux")]
fn a_run_whose_messages_nobody_can_read_comes_to_its_end() {
    let folder = tempfile::tempdir().unwrap();
    // a warning at its beginning, and information of every line of its log
    for (k, more) in [&[][..], &["-vv"], &["--set", "disk.material.young=200e9"]].iter().enumerate()
    {
        for (name, stderr) in [("closed", closed_pipe()), ("full", full())] {
            let out = folder.path().join(format!("{name}-{k}"));
            assert_eq!(run_with(&out, more, Stdio::null(), stderr), Some(0), "{name} {more:?}");
            assert!(out.join("summary.json").exists(), "{name} {more:?}");
        }
    }
    // nor do they hide a failure
    let out = folder.path().join("unstable");
    let unstable = ["--set", "time.factor=1.6"];
    assert_eq!(run_with(&out, &unstable, closed_pipe(), full()), Some(3));
    assert_eq!(run_with(&folder.path().join("x"), &["--set", "a=1"], full(), full()), Some(2));
}

#[test]
#[cfg(target_os = "linux")]
fn standard_output_on_a_full_disk_is_an_error_of_every_command_and_a_reader_that_left_is_none() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    assert_eq!(run_with(&run, &[], Stdio::null(), Stdio::null()), Some(0));
    let [again, run] = [folder.path().join("again"), run].map(|path| path.display().to_string());
    let page = folder.path().join("page.html").display().to_string();
    let short = ["run", CASE, "--set", "time.roll=0.001", "--out", &again, "--force"];
    for words in [
        &short[..],
        &[&short[..], &["--json"]].concat(),
        &["mesh", CASE],
        &["mesh", CASE, "--json"],
        &["compare", &run, &run],
        &["compare", &run, &run, "--json"],
        &["report", &run, "--out", &page],
        &["schema"],
        &["slider"],
        &["slider", "--json"],
        &["completions", "bash"],
        &["man"],
        &["man", "run"],
        &["--help"],
        &["run", "--help"],
        &["--version"],
    ] {
        let with = |stdout: Stdio| {
            Command::new(PROGRAM)
                .args(words)
                .stdout(stdout)
                .stderr(Stdio::piped())
                .output()
                .unwrap()
        };
        let output = with(full());
        assert_eq!(output.status.code(), Some(2), "{words:?}: {}", said(&output));
        let wanted = "standard output cannot be written: No space left on device";
        assert_eq!(said(&output).matches(wanted).count(), 1, "{words:?}: {}", said(&output));
        let output = with(closed_pipe());
        assert_eq!(output.status.code(), Some(0), "{words:?}: {}", said(&output));
    }
    assert!(Path::new(&again).join("summary.json").exists());
    // a run that its guards stopped keeps its own code
    let unstable = ["--set", "time.factor=1.6"];
    let out = folder.path().join("unstable");
    assert_eq!(run_with(&out, &unstable, full(), Stdio::null()), Some(3));
}
