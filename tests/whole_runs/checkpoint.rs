//! A run that was interrupted and resumed leaves the bits of one that was not.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use creepage::case::Case;
use creepage::run::{RunError, RunOptions};
use creepage::scenario::Stage;
use output::summary::{Status, Summary};
use output::{CHECKPOINTS, Checkpoint};
use runs::{load, log, options, project, results, run, same_bits, timeless};

/// The small case with every kind of output: a window of every step, and probes.
const OUTPUTS: [&str; 5] = [
    "time.roll=0.0016",
    "output.fields_interval=6e-6",
    "output.window=[{ from = 10e-6, to = 14e-6 }]",
    "output.probes.bar=[[0.0, 0.0], [0.001, 0.001]]",
    "output.probes.disk=[[0.001, 0.0]]",
];

fn small(more: &[&str]) -> Case {
    load(&project("tests/small.toml"), &[&OUTPUTS[..], more].concat())
}

/// Runs until at least `step`, then asks the run to stop; returns its summary.
fn run_until(case: &Case, options: &RunOptions, step: u64) -> Result<Summary, RunError> {
    let stop = AtomicBool::new(false);
    creepage::run::run(case, options, &stop, &mut |progress| {
        if progress.stage == Stage::Roll && progress.step >= step {
            stop.store(true, Ordering::SeqCst);
        }
    })
}

fn resuming(out: &Path, threads: usize) -> RunOptions {
    RunOptions { resume: true, ..options(out, threads) }
}

/// Interrupts a run several times and resumes it, each time on another number of threads.
#[track_caller]
fn interrupted_is_uninterrupted(sets: &[&str], uses: &[&str]) {
    let case = small(sets);
    let whole = run(&case, 2);
    let steps = whole.number("/steps") as u64;
    for name in uses {
        assert!(whole.data[*name].iter().any(|x| *x != 0.0), "{name} holds nothing");
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let mut at = 0;
    for (part, threads) in [(0.1, 1), (0.45, 3), (0.5, 2), (0.9, 1)] {
        let wanted = (part * steps as f64) as u64;
        let options = if at == 0 { options(&out, threads) } else { resuming(&out, threads) };
        let summary = run_until(&case, &options, wanted).unwrap();
        assert_eq!(summary.status, Some(Status::Interrupted));
        assert!(summary.steps >= wanted.max(at + 1));
        at = summary.steps;
        let kept = Checkpoint::read(&out.join(CHECKPOINTS[0])).unwrap();
        assert_eq!(kept.step, at);
    }
    assert!(at < steps);
    let summary = run_until(&case, &resuming(&out, 2), u64::MAX).unwrap();
    assert_eq!(summary.status, Some(Status::Completed));
    same_bits(&whole, &results(&out));
    assert!(!CHECKPOINTS.iter().any(|name| out.join(name).exists()), "a checkpoint is left");
}

#[test]
fn a_penalty_run_interrupted_and_resumed_leaves_the_bits_of_an_undisturbed_one() {
    interrupted_is_uninterrupted(&[], &["contact/slip/0001", "probes/probe1_slip_x"]);
}

#[test]
fn an_exact_run_interrupted_and_resumed_leaves_the_bits_of_an_undisturbed_one() {
    let exact = ["contact.enforcement=exact"];
    interrupted_is_uninterrupted(&exact, &["contact/slip/0001", "history/sweeps"]);
}

#[test]
fn implicit_steps_go_on_and_count_what_all_parts_took_as_one_would() {
    let implicit = ["time.integrator=implicit", "time.step=1e-7", "contact.enforcement=exact"];
    interrupted_is_uninterrupted(&implicit, &["contact/slip/0001", "history/sweeps"]);
}

#[test]
fn mortar_rows_go_on_with_the_integrals_that_they_follow() {
    let mortar = ["contact.enforcement=exact", "contact.rows=mortar", "time.roll=0.006"];
    interrupted_is_uninterrupted(&mortar, &["contact/slip/0001", "history/sweeps"]);
}

#[test]
fn a_hub_that_drifts_and_turns_goes_on_where_it_was() {
    let sideways = ["drive.lateral_creepage=2e-3", "drive.spin=0.5", "time.roll=0.004"];
    let sets = [&sideways[..], &["contact.enforcement=exact", "damping.mass=4000"]].concat();
    interrupted_is_uninterrupted(&sets, &["contact/slip/0001", "history/lateral_force"]);
}

#[test]
fn irregular_surfaces_go_on_with_the_material_that_was_there() {
    let surfaces = [
        "bar.surface={ formula = \"2e-6*cos(2*pi*x/0.008)\" }",
        "disk.out_of_round={ formula = \"2e-6*sin(40*angle)\" }",
    ];
    let window = ["contact.enforcement=exact", "mesh.window=0.0096", "time.roll=0.006"];
    let sets = [&surfaces[..], &window].concat();
    interrupted_is_uninterrupted(&sets, &["contact/slip/0001", "history/window_x"]);
}

#[test]
fn a_zone_that_follows_the_contact_goes_on_where_it_was() {
    let window = ["contact.enforcement=exact", "mesh.window=0.0096", "time.roll=0.006"];
    interrupted_is_uninterrupted(&window, &["contact/slip/0001", "history/window_x"]);
}

#[test]
fn half_spaces_go_on_where_they_were() {
    let memory =
        ["friction.law=exponential", "friction.static=0.5", "friction.memory.distance=2e-6"];
    for zone in ["mesh.zone.length=0.014", "mesh.window=0.006"] {
        let sets = [&["model=half-space", "mesh.zone.size=0.4e-3", zone][..], &memory].concat();
        interrupted_is_uninterrupted(&sets, &["contact/slip/0001", "history/sweeps"]);
    }
}

#[test]
fn half_a_model_goes_on_where_it_was() {
    for rows in ["contact.rows=node_to_face", "contact.rows=mortar"] {
        let half = ["mesh.symmetry=half", "contact.enforcement=exact", rows];
        interrupted_is_uninterrupted(&half, &["contact/slip/0001", "history/sweeps"]);
    }
}

#[test]
fn friction_with_memory_goes_on_where_it_was() {
    let law = [
        "friction.law=exponential",
        "friction.static=0.5",
        "friction.dynamic=0.32",
        "friction.decay=6.0",
        "friction.memory.distance=2e-6",
    ];
    for method in ["contact.enforcement=exact", "contact.enforcement=penalty"] {
        interrupted_is_uninterrupted(&[&law[..], &[method]].concat(), &["contact/slip/0001"]);
    }
}

#[test]
fn damping_springs_of_the_stability_limit_and_a_held_height_go_on_where_they_were() {
    let sets = [
        "contact.penalty.normal={ stability = 0.5 }",
        "contact.penalty.tangential={ stability = 0.3 }",
        "contact.penalty.damping=0.1",
        "damping.mass=2e3",
        "damping.kelvin_voigt=1e-8",
        "load.mode=height",
        "bar.ends=quiet",
    ];
    interrupted_is_uninterrupted(&sets, &["history/damping_dissipated"]);
}

#[test]
fn checkpoints_at_any_interval_change_no_bit() {
    let without = run(&small(&["checkpoint.wall_minutes=0"]), 2);
    for often in ["checkpoint.steps=7", "checkpoint.time=1e-6", "checkpoint.wall_minutes=1e-4"] {
        let with = run(&small(&[often]), 2);
        assert_eq!(without.differing(&with), Vec::<&str>::new(), "{often}");
        assert_eq!(timeless(&without.summary), timeless(&with.summary), "{often}");
    }
}

/// A run in `out` that has left two checkpoints; returns their steps, the newest first.
fn leave_two(case: &Case, out: &Path) -> [u64; 2] {
    run_until(case, &options(out, 2), 100).unwrap();
    CHECKPOINTS.map(|name| Checkpoint::read(&out.join(name)).unwrap().step)
}

#[test]
fn a_damaged_checkpoint_is_named_and_the_one_before_used() {
    let case = small(&["checkpoint.steps=50"]);
    let whole = run(&case, 2);
    for damage in ["a changed byte", "cut off", "empty"] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("run");
        let [newest, before] = leave_two(&case, &out);
        assert!(before < newest);
        let path = out.join(CHECKPOINTS[0]);
        let mut bytes = fs::read(&path).unwrap();
        match damage {
            "a changed byte" => {
                let middle = bytes.len() / 2;
                bytes[middle] ^= 1;
            }
            "cut off" => bytes.truncate(bytes.len() / 2),
            _ => bytes.clear(),
        }
        fs::write(&path, bytes).unwrap();
        let summary = run_until(&case, &resuming(&out, 2), u64::MAX).unwrap();
        assert_eq!(summary.status, Some(Status::Completed), "{damage}");
        let said = log(&out);
        assert!(said.contains("not used, checkpoint.h5: it is damaged"), "{damage}: {said}");
        assert!(said.contains(&format!("resumed from the checkpoint of step {before}")), "{said}");
        same_bits(&whole, &results(&out));
    }
}

#[test]
fn without_a_whole_checkpoint_the_run_is_refused_and_begins_anew_only_with_force() {
    let case = small(&["checkpoint.steps=50"]);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    leave_two(&case, &out);
    for name in CHECKPOINTS {
        fs::write(out.join(name), b"nothing").unwrap();
    }
    let error = run_until(&case, &resuming(&out, 2), u64::MAX).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    for words in ["checkpoint.h5: it is damaged", "checkpoint-1.h5: it is damaged"] {
        assert!(error.to_string().contains(words), "{error}");
    }
    let forced = RunOptions { force: true, ..resuming(&out, 2) };
    assert_eq!(run_until(&case, &forced, u64::MAX).unwrap().status, Some(Status::Completed));
    assert!(log(&out).contains("nothing to go on from"), "{}", log(&out));
}

#[test]
fn another_case_or_version_is_refused_with_what_differs() {
    let case = small(&[]);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    run_until(&case, &options(&out, 2), 50).unwrap();
    let other = small(&["friction.static=0.31", "drive.creepage=3e-3"]);
    let error = run_until(&other, &resuming(&out, 2), u64::MAX).unwrap_err();
    assert_eq!(error.exit_code(), 2);
    for words in ["another case", "friction.static", "drive.creepage"] {
        assert!(error.to_string().contains(words), "{error}");
    }
    // a checkpoint of another version, whole as it is
    let path = out.join(CHECKPOINTS[0]);
    let mut checkpoint = Checkpoint::read(&path).unwrap();
    checkpoint.provenance.creepage_version = "0.0.9".into();
    checkpoint.write(&out).unwrap();
    fs::remove_file(out.join(CHECKPOINTS[1])).unwrap();
    let error = run_until(&case, &resuming(&out, 2), u64::MAX).unwrap_err();
    assert!(error.to_string().contains("version 0.0.9"), "{error}");
    assert_eq!(error.exit_code(), 2);
    // and one of another case under the run's name
    checkpoint.provenance.creepage_version = env!("CARGO_PKG_VERSION").into();
    checkpoint.provenance.case_hash = other.hash();
    checkpoint.write(&out).unwrap();
    fs::remove_file(out.join(CHECKPOINTS[1])).unwrap();
    let error = run_until(&case, &resuming(&out, 2), u64::MAX).unwrap_err();
    assert!(error.to_string().contains("it is of another case"), "{error}");
}

#[test]
fn the_interval_of_checkpoints_may_change_when_a_run_is_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    run_until(&small(&[]), &options(&out, 2), 50).unwrap();
    let other = small(&["checkpoint.steps=100", "checkpoint.wall_minutes=0"]);
    assert_eq!(small(&[]).hash(), other.hash());
    let summary = run_until(&other, &resuming(&out, 2), u64::MAX).unwrap();
    assert_eq!(summary.status, Some(Status::Completed));
}

#[test]
fn a_run_without_a_checkpoint_begins_anew_a_complete_one_is_left_alone_and_none_is_refused() {
    let case = small(&[]);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let error = run_until(&case, &resuming(&out, 2), u64::MAX).unwrap_err();
    assert!(error.to_string().contains("no run to resume"), "{error}");
    assert_eq!(error.exit_code(), 2);
    assert!(!out.exists());

    run_until(&case, &options(&out, 2), 50).unwrap();
    for name in CHECKPOINTS {
        let _ = fs::remove_file(out.join(name));
    }
    let summary = run_until(&case, &resuming(&out, 2), u64::MAX).unwrap();
    assert_eq!(summary.status, Some(Status::Completed));
    assert!(log(&out).contains("no checkpoint yet"), "{}", log(&out));

    let before = fs::read(out.join("history.h5")).unwrap();
    let again = run_until(&case, &resuming(&out, 2), u64::MAX).unwrap();
    assert_eq!(again, summary);
    assert_eq!(fs::read(out.join("history.h5")).unwrap(), before);
}

#[test]
fn results_shorter_than_the_newest_checkpoint_send_the_run_to_the_one_before() {
    let case = small(&["checkpoint.steps=50"]);
    let whole = run(&case, 2);
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let [newest, before] = leave_two(&case, &out);
    // as if a power cut had taken the last records: the newest checkpoint wants more than there is
    let path = out.join(CHECKPOINTS[0]);
    let mut checkpoint = Checkpoint::read(&path).unwrap();
    checkpoint.results.history.records += 1_000;
    let older = fs::read(out.join(CHECKPOINTS[1])).unwrap();
    checkpoint.write(&out).unwrap();
    fs::write(out.join(CHECKPOINTS[1]), older).unwrap();
    let summary = run_until(&case, &resuming(&out, 2), u64::MAX).unwrap();
    assert_eq!(summary.status, Some(Status::Completed));
    let said = log(&out);
    assert!(said.contains("history.h5 is damaged: holds"), "{said}");
    assert!(said.contains(&format!("step {before}")) && before < newest, "{said}");
    same_bits(&whole, &results(&out));
}
