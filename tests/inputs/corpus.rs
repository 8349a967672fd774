//! The corpus of the fuzzers, and every input that ever broke something, read as the fuzzers read it.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use runs::inputs::{LIMIT, LIMIT_MIB, TARGETS};

/// The inputs of a target: `fuzz/corpus/NAME` and `fuzz/found/NAME`.
fn inputs_of(name: &str) -> Vec<PathBuf> {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz");
    let folders = ["corpus", "found"].map(|kind| fuzz.join(kind).join(name));
    let files = folders
        .iter()
        .filter(|folder| folder.exists())
        .flat_map(|folder| fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()));
    let mut files: Vec<_> = files.collect();
    files.sort();
    files
}

/// The most memory that this process had so far (MiB), where the system tells.
fn peak() -> Option<usize> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<usize>().ok()? / 1024)
}

#[test]
fn every_input_is_read_within_its_time_and_memory() {
    for target in TARGETS {
        let files = inputs_of(target.name);
        assert!(files.len() > 1, "{} has no corpus", target.name);
        for file in files {
            let data = fs::read(&file).unwrap();
            let start = Instant::now();
            (target.read)(&data);
            let took = start.elapsed();
            assert!(took < LIMIT, "{} took {took:?}", file.display());
            let peak = peak().unwrap_or(0);
            assert!(peak < LIMIT_MIB, "{peak} MiB after {}", file.display());
        }
    }
}

#[test]
fn the_corpus_is_below_a_mebibyte() {
    let all = TARGETS.iter().flat_map(|target| inputs_of(target.name));
    let bytes: u64 = all.map(|file| file.metadata().unwrap().len()).sum();
    assert!(bytes < 1 << 20, "{bytes} bytes");
}
