//! Runs a case in a folder of its own and reads back every number it left, for the tests.
#![allow(clippy::unwrap_used)]

pub mod chance;
pub mod damage;
pub mod inputs;
pub mod kill;
pub mod kill_points;
pub mod threads_as_ranks;
pub mod trace;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::AtomicBool;

use creepage::case::Case;
use creepage::run::RunOptions;
use output::{GridFile, HistoryFile};
use serde_json::Value;

/// The program, to be called with the system's own reactions to the signals that end it: what a script starts in the
/// background ignores some, and so does what that starts.
pub fn heeding_signals(program: &str) -> Command {
    if !cfg!(target_os = "linux") {
        return Command::new(program);
    }
    let mut command = Command::new("env");
    command.args(["--default-signal=INT,HUP,TERM", program]);
    command
}

/// What a run left.
pub struct Results {
    /// Every dataset: `fields/displacement/0003` is step 3 of a grid's field, `fields/time` the
    /// times of its steps, `history/normal_force` a column.
    pub data: BTreeMap<String, Vec<f64>>,
    /// `summary.json`.
    pub summary: Value,
    /// `case.toml`.
    pub resolved: String,
}

/// A file below the project's root.
pub fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// Runs `tests/small.toml` on two threads with `sets` (`KEY=VALUE`) over it.
pub fn small(sets: &[&str]) -> Results {
    run(&load(&project("tests/small.toml"), sets), 2)
}

/// A case file with `sets` over it.
pub fn load(path: &Path, sets: &[&str]) -> Case {
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    Case::load(path, &sets).unwrap()
}

/// Runs a case to its end.
pub fn run(case: &Case, threads: usize) -> Results {
    run_with(case, threads, None).0
}

/// Runs a case to its end with its preload kept in `cache`; also returns its log.
pub fn run_with(case: &Case, threads: usize, cache: Option<&Path>) -> (Results, String) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let options =
        RunOptions { preload_cache: cache.map(Path::to_path_buf), ..options(&out, threads) };
    let returned =
        creepage::run::run(case, &options, &AtomicBool::new(false), &mut |_| {}).unwrap();
    let results = results(&out);
    let returned = serde_json::to_value(&returned).unwrap();
    assert_eq!(results.summary, returned, "summary.json holds what the run returns");
    (results, log(&out))
}

/// A run in `out` that neither replaces nor resumes one.
pub fn options(out: &Path, threads: usize) -> RunOptions {
    RunOptions {
        case: "test".into(),
        out: Some(out.to_path_buf()),
        threads: Some(threads),
        ..RunOptions::default()
    }
}

/// What the run in `out` said.
pub fn log(out: &Path) -> String {
    std::fs::read_to_string(out.join("run.log")).unwrap()
}

/// What the run in `out` left.
pub fn results(out: &Path) -> Results {
    let summary = std::fs::read(out.join("summary.json")).unwrap();
    let mut data = BTreeMap::new();
    for grid in ["fields", "contact"] {
        let path = out.join(format!("{grid}.vtkhdf"));
        if path.exists() {
            read_grid(&path, grid, &mut data);
        }
    }
    for table in ["history", "probes"] {
        let path = out.join(format!("{table}.h5"));
        if path.exists() {
            read_table(&path, table, &mut data);
        }
    }
    let resolved = std::fs::read_to_string(out.join("case.toml")).unwrap();
    Results { data, summary: serde_json::from_slice(&summary).unwrap(), resolved }
}

fn read_grid(path: &Path, name: &str, data: &mut BTreeMap<String, Vec<f64>>) {
    let file = GridFile::open(path).unwrap();
    data.insert(format!("{name}/points"), file.points().unwrap().concat());
    let cells = file.connectivity().unwrap();
    data.insert(format!("{name}/cells"), cells.into_iter().map(f64::from).collect());
    data.insert(format!("{name}/time"), file.times().unwrap());
    for field in file.fields() {
        let steps = if field.constant { 1 } else { file.steps() };
        for step in 0..steps {
            let values = file.read(&field.name, field.on_cells, step).unwrap();
            data.insert(format!("{name}/{}/{step:04}", field.name), values);
        }
    }
}

fn read_table(path: &Path, name: &str, data: &mut BTreeMap<String, Vec<f64>>) {
    let file = HistoryFile::open(path).unwrap();
    for column in file.columns().unwrap() {
        data.insert(format!("{name}/{column}"), file.read(&column).unwrap());
    }
}

impl Results {
    /// A column of `history.h5`.
    pub fn history(&self, column: &str) -> &[f64] {
        &self.data[&format!("history/{column}")]
    }

    /// A field of `contact.vtkhdf`, one entry per step.
    pub fn contact(&self, field: &str) -> Vec<&[f64]> {
        let prefix = format!("contact/{field}/");
        let steps = self.data.range(prefix.clone()..).take_while(|(k, _)| k.starts_with(&prefix));
        steps.map(|(_, values)| values.as_slice()).collect()
    }

    /// How many of the recorded nodes of the contact surfaces are the disk's; they come first.
    pub fn nodes_of_disk(&self) -> usize {
        let faces = self.data["contact/cells"].chunks(4).zip(&self.data["contact/body/0000"]);
        let disk = faces.filter(|(_, body)| **body == 0.0).flat_map(|(face, _)| face);
        disk.fold(0.0_f64, |last, node| last.max(*node)) as usize + 1
    }

    /// A number of the summary, by its JSON pointer.
    pub fn number(&self, pointer: &str) -> f64 {
        self.summary.pointer(pointer).and_then(Value::as_f64).unwrap()
    }

    /// The names of the datasets that differ from those of `other` in any bit.
    pub fn differing<'a>(&'a self, other: &'a Self) -> Vec<&'a str> {
        let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        let same = |name: &str, values: &[f64]| {
            other.data.get(name).is_some_and(|theirs| bits(values) == bits(theirs))
        };
        let mine = self.data.iter().filter(|(name, values)| !same(name, values));
        let theirs = other.data.iter().filter(|(name, _)| !self.data.contains_key(*name));
        mine.chain(theirs).map(|(name, _)| name.as_str()).collect()
    }
}

/// Two runs left the same bits of every dataset, the same summary but for what the clock puts in, and the same case.
#[track_caller]
pub fn same_bits(a: &Results, b: &Results) {
    assert_eq!(a.differing(b), Vec::<&str>::new());
    assert_eq!(timeless(&a.summary), timeless(&b.summary));
    assert_eq!(a.resolved, b.resolved);
}

/// A summary without what the clock, the memory and the number of threads put in, and the sums that depend
/// on it.
pub fn timeless(summary: &Value) -> Value {
    let mut summary = summary.clone();
    let map = summary.as_object_mut().unwrap();
    for key in creepage::sweep::collect::NOT_REPEATED {
        assert!(map.remove(key).is_some(), "{key}");
    }
    summary
}
