//! Several processes that share a run leave the files of one process.

use creepage::case::Case;
use creepage::{Leader, RunOptions};
use dynamics::{CHUNK, Partition, Ranks};
use output::summary::{Status, Summary};
use runs::threads_as_ranks::threads_as_ranks;
use runs::{Results, load, options, project, results, run, same_bits};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

fn run_of(case: &Case, options: &RunOptions) -> Result<Summary, creepage::run::RunError> {
    creepage::run::run(case, options, &AtomicBool::new(false), &mut |_| {})
}

/// What process 0 of so many returns of a case; the others assist it, each with one thread.
fn shared(case: &Case, size: usize, options: &RunOptions) -> Result<Summary, String> {
    let mut ranks = threads_as_ranks(size);
    let first = ranks.remove(0);
    std::thread::scope(|scope| {
        let assistants: Vec<_> =
            ranks.iter().map(|rank| scope.spawn(|| creepage::assist(rank, Some(1)))).collect();
        let options = RunOptions { leader: Some(Arc::new(Leader::new(first))), ..options.clone() };
        let ran = run_of(case, &options);
        drop(options);
        for assistant in assistants {
            assistant.join().unwrap().map_err(|error| format!("a process: {error}"))?;
        }
        ran.map_err(|error| error.to_string())
    })
}

/// The results of so many processes, with the nodes as `partition` gives them out.
fn results_of(case: &Case, size: usize, partition: Option<Partition>) -> Results {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let options = RunOptions { partition, ..options(&out, 1) };
    shared(case, size, &options).unwrap();
    results(&out)
}

/// Chunks of nodes dealt out one after the other: every process has neighbours everywhere.
fn dealt_out(case: &Case, size: u32) -> Partition {
    let nodes = creepage::scenario::model(case).unwrap().mesh.nodes.len();
    Partition::new((0..nodes.div_ceil(CHUNK) as u32).map(|chunk| (chunk * 7 + 1) % size).collect())
}

#[track_caller]
fn shared_has_the_bits_of_one(case: &Case) {
    let alone = run(case, 1);
    assert!(alone.data["contact/shear/0001"].iter().any(|x| *x != 0.0));
    assert_eq!(alone.number("/stages/exchange"), 0.0);
    for size in [2, 3, 4] {
        let shared = results_of(case, size, None);
        same_bits(&alone, &shared);
        assert!(shared.number("/stages/exchange") > 0.0);
    }
    for size in [2, 4] {
        same_bits(&alone, &results_of(case, size as usize, Some(dealt_out(case, size))));
    }
}

#[test]
fn penalty_contact_with_dashpots_and_probes_has_the_same_bits_on_any_processes() {
    let sets = [
        "damping.mass=4000",
        "output.fields_interval=5e-6",
        "output.probes.bar=[[0.001, 0.0]]",
        "time.roll=0.001",
    ];
    shared_has_the_bits_of_one(&load(&project("tests/small.toml"), &sets));
}

#[test]
fn exact_contact_with_memory_and_full_elements_has_the_same_bits_on_any_processes() {
    let mut sets = runs::kill::EXACT_WITH_MEMORY.to_vec();
    sets.extend(["element.contact_layers=full", "time.roll=0.0004", "output.fields_interval=5e-6"]);
    shared_has_the_bits_of_one(&load(&project("tests/small.toml"), &sets));
}

#[test]
fn half_a_wheel_has_the_same_bits_on_any_processes() {
    let sets = ["mesh.symmetry=half", "time.roll=0.0006", "bar.ends=quiet"];
    shared_has_the_bits_of_one(&load(&project("tests/small.toml"), &sets));
}

#[test]
fn a_zone_that_follows_the_contact_has_the_same_bits_on_any_processes() {
    let window = ["mesh.window=0.0096", "time.roll=0.002", "output.probes.bar=[[0.001, 0.0]]"];
    let surface = "bar.surface={ formula = \"2e-6*cos(2*pi*x/0.008)\" }";
    let penalty = [&window[..], &[surface]].concat();
    let exact = [&window[..], &runs::kill::EXACT_WITH_MEMORY, &["mesh.symmetry=half"]].concat();
    for sets in [penalty, exact] {
        let case = load(&project("tests/small.toml"), &sets);
        let alone = run(&case, 1);
        let travelled = &alone.data["history/window_x"];
        assert!(travelled.windows(2).any(|x| x[1] > x[0]));
        for (size, partition) in [(2, None), (4, None), (3, Some(dealt_out(&case, 3)))] {
            same_bits(&alone, &results_of(&case, size, partition));
        }
    }
}

#[test]
fn a_run_goes_on_with_another_number_of_processes_to_the_same_bits() {
    let sets = ["time.roll=0.001", "checkpoint.steps=40"];
    let case = load(&project("tests/small.toml"), &sets);
    let alone = run(&case, 1);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let ranks = threads_as_ranks(3);
    interrupted(&case, &out, ranks);
    let resumed = RunOptions { resume: true, ..options(&out, 1) };
    shared(&case, 2, &resumed).unwrap();
    same_bits(&alone, &results(&out));
}

/// A run that is asked to stop as soon as it has rolled some steps.
fn interrupted(case: &Case, out: &Path, mut ranks: Vec<Arc<dyn Ranks>>) {
    let first = ranks.remove(0);
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let assistants: Vec<_> =
            ranks.iter().map(|rank| scope.spawn(|| creepage::assist(rank, Some(1)))).collect();
        let options = RunOptions { leader: Some(Arc::new(Leader::new(first))), ..options(out, 1) };
        let mut observe = |progress: &creepage::Progress| {
            stop.fetch_or(progress.step > 10, Ordering::Relaxed);
        };
        let summary = creepage::run::run(case, &options, &stop, &mut observe).unwrap();
        assert_eq!(summary.status, Some(Status::Interrupted));
        assistants.into_iter().for_each(|rank| rank.join().unwrap().unwrap());
    });
}

#[test]
fn what_one_process_must_run_is_refused_and_the_others_end() {
    let implicit = ["time.integrator=implicit", "contact.enforcement=exact", "time.step=5e-6"];
    for (file, sets, what) in [
        ("tests/small.toml", &implicit[..], "implicit"),
        ("cases/verdict/slice.toml", &[], "plane strain"),
    ] {
        let case = load(&project(file), sets);
        let folder = tempfile::tempdir().unwrap();
        let refused = shared(&case, 2, &options(&folder.path().join("run"), 1)).unwrap_err();
        assert!(refused.contains(what) && refused.contains("several processes"), "{refused}");
    }
}

#[test]
fn a_guard_that_stops_a_shared_run_says_what_it_says_of_one_process() {
    let case = load(&project("tests/small.toml"), &["guards.penetration=1e-3", "time.roll=0.001"]);
    let folder = tempfile::tempdir().unwrap();
    let one = folder.path().join("one");
    let alone = run_of(&case, &options(&one, 1)).unwrap();
    let together = shared(&case, 3, &options(&folder.path().join("three"), 1)).unwrap();
    assert_eq!(alone.status, Some(Status::Failed));
    assert_eq!(alone.diagnosis, together.diagnosis);
}
