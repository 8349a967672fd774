//! Mistakes that users make, each planted in the small case: the message must name the cause and the remedy,
//! before the run where that can be known (exit code 2), within a bounded number of steps else (3).

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use output::{CHECKPOINTS, Checkpoint, GridFile};
use serde_json::Value;

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");

fn run(case: &Path, out: &Path, sets: &[&str], more: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
    command.arg("run").arg(case).args(["--threads", "1", "--out"]).arg(out).args(more);
    sets.iter().for_each(|set| {
        command.args(["--set", set]);
    });
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[track_caller]
fn has(text: &str, words: &[&str]) {
    words.iter().for_each(|word| assert!(text.contains(word), "{word:?} is not in:\n{text}"));
}

/// Refused before anything is computed or written.
#[track_caller]
fn refused(sets: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let output = run(Path::new(CASE), &out, sets, &[]);
    has(&said(&output), words);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(!out.exists());
}

/// Stopped by a guard after at most `most` steps, with everything in place for a look at what happened.
#[track_caller]
fn stopped(case: &Path, sets: &[&str], most: u64, words: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let output = run(case, &out, sets, &[]);
    let message = said(&output);
    assert_eq!(output.status.code(), Some(3), "{message}");
    has(&message, words);
    has(&message, &["stopped at step", "t = ", "node", "element", "remedy"]);
    let text = fs::read(out.join("summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&text).unwrap();
    assert_eq!(summary["status"], "failed");
    assert!(message.contains(summary["diagnosis"].as_str().unwrap()), "{message}");
    let steps = summary["steps"].as_u64().unwrap();
    assert!(steps <= most, "{steps} steps");

    assert_eq!(summary["files"]["postmortem"], "postmortem.vtkhdf");
    let grid = GridFile::open(out.join("postmortem.vtkhdf")).unwrap();
    assert_eq!(grid.steps(), 1);
    for name in ["displacement", "velocity", "force", "suspect"] {
        assert!(!grid.read(name, false, 0).unwrap().is_empty(), "{name}");
    }
    for name in ["volume_ratio", "corner_ratio", "strain_energy", "hourglass_energy", "body"] {
        assert!(!grid.read(name, true, 0).unwrap().is_empty(), "{name}");
    }
    let named = |on_cells| {
        let marks = grid.read("suspect", on_cells, 0).unwrap();
        marks.iter().filter(|mark| **mark == 2.0).count()
    };
    assert_eq!((named(false), named(true)), (1, 1));

    // the last good state: at least that of the beginning, and never one beyond repair
    let kept = Checkpoint::read(&out.join(CHECKPOINTS[0])).unwrap();
    assert!(kept.step < steps);
    summary
}

#[test]
fn a_time_step_above_the_limit() {
    let words = ["1.30 times the stability limit", "set it below 1"];
    stopped(Path::new(CASE), &["time.factor=1.3"], 100, &words);
}

#[test]
fn a_scale_factor_of_50_whose_springs_close_after_the_step_was_chosen() {
    let sets =
        ["contact.penalty.normal=50", "contact.penalty.tangential=50", "preload.method='none'"];
    let words = [
        "contact springs that closed",
        "too stiff",
        "times the stability limit",
        "lower the contact stiffness",
    ];
    stopped(Path::new(CASE), &sets, 200, &words);
}

#[test]
fn a_scale_factor_of_50_with_a_step_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let sets = ["contact.penalty.normal=50", "contact.penalty.tangential=50", "time.step=8e-8"];
    let output = run(Path::new(CASE), &folder.path().join("run"), &sets, &[]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    has(&said(&output), &["above the stability limit", "contact springs lower"]);
}

#[test]
fn springs_far_too_soft_let_the_surfaces_pass_through_each_other() {
    let words = ["penetrate each other", "beyond 0.4000 mm", "too soft", "contact.penalty.normal"];
    stopped(Path::new(CASE), &["contact.penalty.normal=0.0005"], 1, &words);
}

#[test]
fn a_formula_that_is_no_number_for_some_microseconds() {
    // tried at nine times of the run, of which none lies there
    let sets = [
        "friction.law='expression'",
        "friction.expression='0.3 + 0.01*sqrt((t - 4e-5)^2 - 1e-10)'",
    ];
    let words = ["the friction law gives no coefficient", "slip speed", "correct the law"];
    let summary = stopped(Path::new(CASE), &sets, 345, &words);
    // at once: at the first step beyond 30 us
    let t = summary["t_end"].as_f64().unwrap();
    assert!((t - 3e-5).abs() < 1e-6, "{t}");
}

#[test]
fn a_friction_law_that_jumps_to_a_huge_coefficient() {
    let sets = ["friction.law='expression'", "friction.expression='0.3 + 200*s^3'"];
    let words = ["the friction law gives mu = ", "beyond 5", "slip speed", "guards.friction"];
    stopped(Path::new(CASE), &sets, 1000, &words);
}

#[test]
fn a_torque_in_newton_millimetres_wrings_elements_inside_out() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("torque.toml");
    let text = fs::read_to_string(CASE).unwrap();
    assert!(text.contains("creepage = 4e-3"));
    fs::write(&case, text.replace("creepage = 4e-3", "torque = 10e6")).unwrap();
    let words = ["inside out", "negative Jacobian", "drive.torque"];
    // at some stiffnesses another guard stops the run first: penetration, or energy from nowhere
    let summary = stopped(&case, &["contact.penalty.normal=2"], 1500, &words);
    assert!(summary["steps"].as_u64().unwrap() > 100, "it went well at first");
}

#[test]
fn hourglass_stiffness_switched_off() {
    let one_point = "element.contact_layers='one-point'";
    refused(
        &["element.hourglass=0", one_point],
        &["element.hourglass = 0", "without stiffness against hourglassing", "0.05"],
    );
    let sets = ["element.hourglass=0", one_point, "preload.method='none'"];
    stopped(Path::new(CASE), &sets, 501, &["hourglass", "too weak", "raise element.hourglass"]);
}

#[test]
fn a_disk_that_bounces_off_the_bar() {
    let sets = [
        "preload.method='none'",
        "disk.lift=1e-4",
        "load.normal=5e3",
        "drive.speed=10",
        "guards.parted=2e-5",
    ];
    let words = ["contact is lost: the disk has left the bar", "disk.lift", "guards.parted"];
    stopped(Path::new(CASE), &sets, 8000, &words);
}

#[test]
fn a_way_beyond_the_end_of_the_bar() {
    refused(
        &["time.roll=0.05"],
        &["ends at x =", "the fine zone ends at", "roll less (time.roll)"],
    );
}

#[test]
fn a_load_upwards() {
    refused(
        &["load.normal=-10e3"],
        &["load.normal = -10000", "positive", "would lift the disk off"],
    );
}

#[test]
fn material_in_other_units() {
    let unit = ["material.young = 210000 Pa", "softer than rubber", "MPa"];
    refused(&["material.young=210e3"], &unit);
    refused(&["material.young=210"], &["material.young = 210 must be", "in pascal: 210e9"]);
    refused(&["material.density=0"], &["material.density = 0", "kg/m^3: 7800"]);
    refused(&["material.density=7.85e-9"], &["material.density = 7.85e-9", "kg/m^3: 7800"]);
    refused(&["disk.radius=80"], &["disk.radius = 80", "in metres"]);
    // within the range, but hardly meant: a warning
    let folder = tempfile::tempdir().unwrap();
    let sets = ["material.density=7.85", "time.roll=2e-5"];
    let output = run(Path::new(CASE), &folder.path().join("run"), &sets, &[]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    has(&said(&output), &["warning: material.density = 7.85", "lighter than foam", "g/cm^3"]);
}

#[test]
fn a_load_whose_patch_is_half_an_element() {
    let words = [
        "mesh.zone.size = 0.8 mm is more than twice the shorter axis of the patch of load.normal = 1 N",
        "0.1685 by 0.1391 mm",
        "mesh.zone.size = 3.478e-5 or less",
    ];
    refused(&["load.normal=1"], &words);
    refused(&["load.normal=5e-324"], &["load.normal = 5e-324", "at least 1e-12 and at most 1e8 N"]);
}

#[test]
fn a_mean_normal_force_that_misses_the_load_is_told_and_kept() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let warned = |load: &str| {
        let sets = [load, "time.roll=4e-4"];
        let output = run(Path::new(CASE), &out, &sets, &["--force"]);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        let summary: Value =
            serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
        let list = summary["window"]["warnings"].as_array().unwrap().clone();
        let told = list.iter().all(|line| said(&output).contains(line.as_str().unwrap()));
        assert!(told, "{list:?} {}", said(&output));
        list
    };
    // the patch is shorter than an element, and the disk rides on the nodes
    let list = warned("load.normal=100");
    has(
        &list[0].to_string(),
        &["mean normal force", "% off load.normal = 100 N", "mesh.zone.size"],
    );
    assert!(warned("load.normal=10e3").is_empty());
}

#[test]
fn limits_may_be_raised_when_a_stopped_run_is_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let soft = ["contact.penalty.normal=0.0005", "time.roll=0.001"];
    let output = run(Path::new(CASE), &out, &soft, &[]);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(out.join("postmortem.vtkhdf").exists());
    let raised = [&soft[..], &["guards.penetration=1"]].concat();
    let output = run(Path::new(CASE), &out, &raised, &["--resume"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(!out.join("postmortem.vtkhdf").exists());
}
