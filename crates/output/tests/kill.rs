//! A process that is killed while it writes leaves whole files.

#![allow(clippy::unwrap_used, missing_docs)]

use output::{GridFile, HistoryFile};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

#[allow(dead_code)]
#[path = "../examples/endless.rs"]
mod endless;

const KILLS: u64 = 20;
const FOLDER: &str = "CREEPAGE_TEST_KILL_FOLDER";

#[test]
fn after_a_kill_at_any_instant_every_counted_snapshot_is_whole() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        // This is the process to be killed.
        endless::write_forever(Path::new(&folder), Duration::ZERO, endless::QUADS).unwrap();
    }
    let mut steps = 0;
    for kill in 0..KILLS {
        let folder = tempfile::tempdir().unwrap();
        let mut writer = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "after_a_kill_at_any_instant_every_counted_snapshot_is_whole"])
            .env(FOLDER, folder.path())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let history = folder.path().join("history.h5");
        wait_for(|| HistoryFile::open(&history).is_ok_and(|file| file.rows() > 0));
        // Spread over several snapshots, at instants that do not follow their rhythm.
        std::thread::sleep(Duration::from_micros(1_000 + 7_919 * kill + 313 * kill * kill));
        writer.kill().unwrap();
        writer.wait().unwrap();
        steps += check_strip(&folder.path().join("strip.vtkhdf"));
        check_history(&history);
    }
    assert!(steps as u64 > 2 * KILLS, "the kills came too early to show anything: {steps} steps");
}

#[test]
fn a_reader_finds_more_and_more_whole_snapshots_while_they_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "after_a_kill_at_any_instant_every_counted_snapshot_is_whole"])
        .env(FOLDER, folder.path())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let history = folder.path().join("history.h5");
    wait_for(|| HistoryFile::open(&history).is_ok_and(|file| file.rows() > 0));
    let mut seen = Vec::new();
    for _ in 0..20 {
        seen.push(check_strip(&folder.path().join("strip.vtkhdf")));
    }
    writer.kill().unwrap();
    writer.wait().unwrap();
    assert!(seen.is_sorted() && seen[0] < seen[19], "steps seen while writing: {seen:?}");
}

fn wait_for(condition: impl Fn() -> bool) {
    let start = Instant::now();
    while !condition() {
        assert!(start.elapsed() < Duration::from_secs(60), "the writer has written nothing");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Compares every number of every complete step; returns the number of steps.
fn check_strip(path: &Path) -> usize {
    let file = GridFile::open(path).unwrap();
    let expected_times: Vec<f64> = (0..file.steps()).map(|step| step as f64).collect();
    assert_eq!(file.times().unwrap(), expected_times);
    for step in 0..file.steps() {
        for (name, on_cells) in [("scalar", false), ("vector", false), ("tensor", true)] {
            let read = file.read(name, on_cells, step).unwrap();
            let wrong = (0..read.len()).find(|&i| read[i] != endless::value(step, i));
            assert_eq!(wrong, None, "{name} at step {step} of {}", file.steps());
        }
        let labels = file.read("label", false, step).unwrap();
        let wrong = (0..labels.len())
            .find(|&i| labels[i] != f64::from(endless::value(step, i) as u64 as u8));
        assert_eq!(wrong, None, "label at step {step} of {}", file.steps());
    }
    assert_eq!(file.read("body", true, 0).unwrap(), vec![1.0; endless::QUADS]);
    file.steps()
}

fn check_history(path: &Path) {
    let file = HistoryFile::open(path).unwrap();
    for (place, column) in ["time", "force", "energy"].into_iter().enumerate() {
        let expected: Vec<f64> = (0..file.rows()).map(|row| endless::value(row, place)).collect();
        assert_eq!(file.read(column).unwrap(), expected, "{column}");
    }
}
