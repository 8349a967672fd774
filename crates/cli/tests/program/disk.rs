//! Trouble with the disk: no room, no folder, no right to write, a second writer.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use output::{GridFile, HistoryFile};
use runs::{results, timeless};

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");

/// Much output of every kind.
const BUSY: [&str; 6] = [
    "--set",
    "output.fields_interval=1e-5",
    "--set",
    "output.contact_interval=2e-7",
    "--set",
    "output.history_interval=1",
];

fn creepage(out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
    command.args(["run", CASE, "--threads", "1", "--out"]).arg(out).args(more);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[track_caller]
fn ends(output: &Output, code: i32, words: &[&str]) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(code), "{said}");
    words.iter().for_each(|word| assert!(said.contains(word), "{word:?} is not in:\n{said}"));
}

fn begin(out: &Path, more: &[&str]) -> Child {
    let mut run = creepage(out, more).spawn().unwrap();
    let clock = Instant::now();
    while HistoryFile::open(out.join("history.h5")).map_or(0, |h| h.rows()) == 0 {
        assert!(run.try_wait().unwrap().is_none(), "the run ended before it was disturbed");
        assert!(clock.elapsed() < Duration::from_secs(120), "no rows");
        std::thread::sleep(Duration::from_millis(5));
    }
    run
}

/// The files hold complete steps only; how many.
#[track_caller]
fn whole(out: &Path) -> [usize; 3] {
    let steps = ["fields.vtkhdf", "contact.vtkhdf"].map(|name| {
        let grid = GridFile::open(out.join(name)).unwrap();
        assert_eq!(grid.times().unwrap().len(), grid.steps());
        for field in grid.fields().iter().filter(|field| !field.constant) {
            for step in 0..grid.steps() {
                let values = grid.read(&field.name, field.on_cells, step).unwrap();
                assert!(values.iter().all(|x| x.is_finite()), "{name} {} {step}", field.name);
            }
        }
        grid.steps()
    });
    let history = HistoryFile::open(out.join("history.h5")).unwrap();
    for column in history.columns().unwrap() {
        assert_eq!(history.read(&column).unwrap().len(), history.rows(), "{column}");
    }
    [steps[0], steps[1], history.rows()]
}

/// A limit of the size of files stands for a full disk: the system then refuses to write in the same way,
/// and needs no rights. `tests/python/check_disk.py` does it with a real one.
#[test]
fn a_file_that_cannot_grow_stops_the_run_and_keeps_its_steps_and_the_run_goes_on_with_room() {
    let folder = tempfile::tempdir().unwrap();
    let complete = folder.path().join("complete");
    // with fields so often that their file is the largest
    let roll = ["--set", "time.roll=0.003", "--set", "output.fields_interval=8e-7"];
    let wanted = [&BUSY[..], &roll].concat();
    ends(&creepage(&complete, &wanted).output().unwrap(), 0, &[]);
    // in halves of kilobytes
    let size = |name: &str| fs::metadata(complete.join(name)).unwrap().len() / 512;
    let [fields, contact, history] = ["fields.vtkhdf", "contact.vtkhdf", "history.h5"].map(size);
    assert!(fields > contact && contact > history, "{fields} {contact} {history}");
    for (limit, name) in [(fields / 2, "fields.vtkhdf"), (fields * 4 / 5, "fields.vtkhdf")] {
        let out = folder.path().join(format!("limit-{limit}"));
        let program = env!("CARGO_BIN_EXE_creepage");
        // which the system tells with a signal that ends a program, unless it listens
        let script = format!("ulimit -f {limit}; exec \"$@\"");
        let mut command = Command::new("sh");
        command.args(["-c", &script, "sh", program, "run", CASE, "--threads", "1", "--out"]);
        let output = command.arg(&out).args(&wanted).output().unwrap();
        ends(&output, 3, &[name, "File too large", "MB are free", "by ulimit -f", "--resume"]);
        let held = whole(&out);
        assert!(held[0] > 0 && held[1] > 0 && held[2] > 0, "{held:?}");
        assert!(!out.join("summary.json").exists());
        let log = fs::read_to_string(out.join("run.log")).unwrap();
        assert!(log.lines().last().unwrap().starts_with("end: Failed, cannot append"), "{log}");

        let resume = [&wanted[..], &["--resume"]].concat();
        ends(&creepage(&out, &resume).output().unwrap(), 0, &[]);
        let (whole, found) = (results(&complete), results(&out));
        assert_eq!(whole.differing(&found), Vec::<&str>::new());
        assert_eq!(timeless(&whole.summary), timeless(&found.summary));
    }
}

#[test]
fn a_folder_that_vanishes_stops_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let run = begin(&out, &[&BUSY[..], &["--set", "drive.speed=1"]].concat());
    fs::rename(&out, folder.path().join("elsewhere")).unwrap();
    let output = run.wait_with_output().unwrap();
    ends(&output, 3, &["cannot append to", "no such file", "not moved or removed"]);
    assert!(!out.exists(), "nothing is written where the folder was");
    let held = whole(&folder.path().join("elsewhere"));
    assert!(held[2] > 0, "{held:?}");
}

#[test]
fn a_folder_that_may_not_be_written_to_is_refused_before_anything_is_computed() {
    let words = ["is not writable", "--out DIR"];
    // nobody may write there, root neither
    let nowhere = Path::new("/proc/creepage/run");
    if Path::new("/proc").is_dir() {
        ends(&creepage(nowhere, &[]).output().unwrap(), 2, &words);
    }
    let folder = tempfile::tempdir().unwrap();
    let closed = folder.path().join("closed");
    fs::create_dir(&closed).unwrap();
    let mode = |mode: u32| {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&closed, fs::Permissions::from_mode(mode)).unwrap();
    };
    mode(0o555);
    if fs::write(closed.join("probe"), "").is_ok() {
        eprintln!("this user may write everywhere: closed folders are left to others");
        return;
    }
    let clock = Instant::now();
    let output = creepage(&closed.join("run"), &["--set", "mesh.zone.size=0.2e-3"]).output();
    ends(&output.unwrap(), 2, &words);
    assert!(clock.elapsed() < Duration::from_secs(5), "the mesh was made first");
    mode(0o755);
}

#[test]
fn a_second_process_may_not_write_the_run_of_the_first() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let slow = ["--set", "drive.speed=1"];
    let mut first = begin(&out, &[&slow[..], &["--set", "checkpoint.steps=20"]].concat());
    for more in ["--resume", "--force"] {
        let output = creepage(&out, &[&slow[..], &[more]].concat()).output().unwrap();
        ends(&output, 2, &["another process is at work in", "wait for it"]);
    }
    assert!(first.try_wait().unwrap().is_none(), "the first goes on");
    // the system frees a killed process's folder
    first.kill().unwrap();
    first.wait().unwrap();
    let sets = ["--set", "time.roll=0.001", "--force"];
    ends(&creepage(&out, &sets).output().unwrap(), 0, &[]);
}

/// The lock is a file, and files are deleted.
#[test]
#[cfg(target_os = "linux")]
fn without_its_lock_a_run_lets_no_other_in_and_stops_and_goes_on_with_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let (out, whole) = (folder.path().join("run"), folder.path().join("whole"));
    let sets =
        ["--set", "time.factor=0.2", "--set", "time.roll=0.002", "--set", "checkpoint.steps=20"];
    ends(&creepage(&whole, &sets).output().unwrap(), 0, &[]);
    let first = begin(&out, &sets);
    let signal = |name: &str| {
        let pid = first.id().to_string();
        assert!(Command::new("kill").args([name, &pid]).status().unwrap().success());
    };
    signal("-STOP");
    fs::remove_file(out.join("run.lock")).unwrap();
    for more in ["--resume", "--force"] {
        let output = creepage(&out, &[&sets[..], &[more]].concat()).output().unwrap();
        ends(&output, 2, &["another process is at work in"]);
    }
    signal("-CONT");
    ends(&first.wait_with_output().unwrap(), 3, &["run.lock is gone", "--resume goes on"]);
    assert!(!out.join("summary.json").exists());
    ends(&creepage(&out, &[&sets[..], &["--resume"]].concat()).output().unwrap(), 0, &[]);
    let (whole, found) = (results(&whole), results(&out));
    assert_eq!(whole.differing(&found), Vec::<&str>::new());
    assert_eq!(timeless(&whole.summary), timeless(&found.summary));
}

/// Without memory the program would be aborted: what is too small for the run is refused before.
#[test]
#[cfg(target_os = "linux")]
fn a_limit_of_the_address_space_below_what_a_run_needs_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v 1000000; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_creepage")]);
    command.args(["run", CASE, "--threads", "1", "--set", "mesh.zone.size=0.08e-3", "--out"]);
    let output = command.arg(&out).output().unwrap();
    ends(&output, 2, &["GB of memory", "that are free", "mesh.zone.size"]);
    assert!(!out.exists());
}
