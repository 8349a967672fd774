//! `creepage compare`: what it says of runs, and what it refuses.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");

fn creepage(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(args).output().unwrap()
}

fn run(out: &Path, sets: &[&str]) {
    let mut args = vec!["run", CASE, "--out", out.to_str().unwrap(), "--quiet"];
    let all = ["time.roll=0.002", "contact.enforcement=exact", "output.contact_interval=1e-6"];
    for set in all.iter().chain(sets) {
        args.extend(["--set", set]);
    }
    let output = creepage(&args);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_run_is_itself_a_twin_parts_a_little_and_another_friction_differs() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    run(&place("first"), &[]);
    run(&place("twin"), &["preload.disturbance=1e-9"]);
    run(&place("slippery"), &["friction.static=0.2"]);
    let names =
        ["first", "first", "twin", "slippery"].map(|name| place(name).display().to_string());
    let figure = place("figures/slip.svg").display().to_string();
    let runs: Vec<&str> = names.iter().map(String::as_str).collect();
    let output = creepage(&[&["compare", "--json", "--plot", &figure][..], &runs].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    let local = |k: usize| found["differences"][k]["slip"]["place_and_time"].as_f64().unwrap();
    assert_eq!(local(0), 0.0);
    assert_eq!(found["differences"][0]["growth"]["reason"], "both runs have the same bits");
    assert!(local(1) > 0.0 && local(1) < 1e-3, "{}", local(1));
    assert!(local(2) > 0.05, "{}", local(2));
    assert!(!found["differences"][1]["growth"].is_null());
    assert!(found["differences"][2]["growth"].is_null(), "another friction is no disturbance");
    assert_eq!(found["runs"][0]["side"], "disk");
    // all are runs of one case, so that their folders tell them apart
    assert_eq!(found["runs"][1]["name"], found["runs"][3]["name"]);
    assert_eq!([2, 3].map(|k| &found["runs"][k]["label"]), ["twin", "slippery"]);
    assert_eq!(
        [&found["differences"][2]["from"], &found["differences"][2]["to"]],
        ["twin", "slippery"]
    );
    // the dense span is not asked for: the window ends with the evaluation window, so many transits long
    let output = creepage(&["check", runs[0], "--transits", "0.1", "--json"]);
    let checked: Value = serde_json::from_slice(&output.stdout).unwrap();
    let scale = |name: &str| checked["scales"][name]["value"].as_f64().unwrap();
    let [from, to] = [0, 1].map(|i| checked["window"][i].as_f64().unwrap());
    let transits = (to - from) * scale("speed") / (2.0 * scale("half_length"));
    assert!((transits - 0.1).abs() < 1e-9, "{transits}");
    assert!(std::fs::read_to_string(&figure).unwrap().contains("slip speed (m/s)"));
    // the largest slip is that of the evaluation window, though the window of every step is the one compared
    let dense = place("dense");
    run(&dense, &["output.window=[{ from = 49.0e-6, to = 50.0e-6 }]"]);
    let dense = dense.to_str().unwrap();
    let json = |args: &[&str]| -> Value {
        serde_json::from_slice(&creepage(&[args, &["--json"]].concat()).stdout).unwrap()
    };
    let compared = json(&["compare", dense, runs[0]]);
    assert_eq!(compared["window"], serde_json::json!([49.0e-6, 50.0e-6]));
    let checked = json(&["check", dense]);
    let [whole, part] = [&checked, &compared["runs"][0]].map(|of| &of["slip_zone"]["largest"]);
    assert_eq!(compared["runs"][0]["largest"], whole["value"]);
    assert_eq!(compared["runs"][0]["largest_over"], checked["window"]);
    assert!(whole["value"].as_f64() > part["value"].as_f64(), "{whole} {part}");
    let asked = json(&["compare", dense, runs[0], "--window", "49e-6:50e-6"]);
    assert_eq!(asked["runs"][0]["largest"], part["value"]);
    let text = creepage(&["compare", runs[0], runs[2]]);
    assert!(String::from_utf8_lossy(&text.stdout).contains("twins: "));
}

#[test]
fn one_run_a_window_without_records_and_a_figure_of_another_kind_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    run(&out, &[]);
    let run = out.to_str().unwrap();
    for (args, word) in [
        (&["compare", run][..], "2 values"),
        (&["compare", run, run, "--window", "1:2"], "there is no record"),
        (&["compare", run, run, "--transits", "1000"], "before the first record"),
        (&["check", run, "--transits", "0"], "greater than 0"),
        (&["check", run, "--transits", "1", "--window", "0:1"], "cannot be used with"),
        (&["compare", run, run, "--plot", "slip.jpg"], "must end in .svg, .pdf or .png"),
        (&["compare", run, "nowhere"], "nowhere: there is no such file or folder"),
    ] {
        let output = creepage(args);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
        assert!(said.contains(word), "{word:?} is not in:\n{said}");
    }
}
