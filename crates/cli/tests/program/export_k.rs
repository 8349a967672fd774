//! Cases as keyword files from the command line.

use runs::Results;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn creepage(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(args).output().unwrap()
}

/// The tests' small case.
fn small() -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/small.toml").display().to_string()
}

#[track_caller]
fn done(args: &[&str]) -> Value {
    let output = creepage(args);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{args:?}: {said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[track_caller]
fn refused(args: &[&str], words: &[&str]) {
    let output = creepage(args);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
    for word in words {
        assert!(said.contains(word), "{word:?} is not in:\n{said}");
    }
}

#[test]
fn a_case_that_was_exported_and_imported_runs() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (deck, back, run) = (path("small.k"), path("back"), path("run"));
    let sets = ["--set", "mesh.zone.size=2e-3", "--set", "mesh.symmetry=half"];
    let made = done(&[&["export-k", &small(), "--out", &deck, "--json"], &sets[..]].concat());
    let read = done(&[
        "import-k",
        &deck,
        "--unit",
        made["unit"].as_str().unwrap(),
        "--out",
        &back,
        "--json",
    ]);
    // the case cuts the half out of the whole that it reads
    assert_eq!(read["elements"], made["elements"]);
    assert!(made["notes"].to_string().contains("contact.curvature"), "{made}");
    let case = format!("{back}/case.toml");
    let short = ["--set", "time.duration=1e-5", "--out", &run, "--json"];
    let ran = done(&[&["run", &case], &short[..]].concat());
    assert_eq!(ran["status"], "completed");
}

/// What cards do not say, set as every imported case has it: contact on flat facets by the normals of single faces (Benson and
/// Hallquist), where a case has averaged normals and the curvature of the surfaces by default. Elements with one point: the fully
/// integrated layers of an imported case reach as far as its fine zone as measured, which is wider than the one that was asked for
/// (336 elements for 112). The step in seconds: a share of the stability limit, which the deck gives, changes by 5e-4 with the
/// iteration that finds the limit.
const AS_CARDS_SAY: [&str; 10] = [
    "--set",
    "contact.curvature=false",
    "--set",
    "contact.normals=face",
    "--set",
    "element.contact_layers=one-point",
    "--set",
    "mesh.zone.size=2e-3",
    "--set",
    "time.step=2e-7",
];

/// The largest difference at any time of normal and of tangential force, over the largest such force, between a run of the tests'
/// small case and one of the case that its deck becomes; `planted` may change the deck.
fn off_by_cards(planted: impl Fn(&str) -> String) -> [f64; 2] {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let [deck, back] = ["small.k", "back"].map(path);
    done(&[&["export-k", &small(), "--out", &deck, "--json"], &AS_CARDS_SAY[..]].concat());
    fs::write(&deck, planted(&fs::read_to_string(&deck).unwrap())).unwrap();
    done(&["import-k", &deck, "--unit", "mm-ton-s", "--out", &back, "--json"]);
    let case = format!("{back}/case.toml");
    let text = fs::read_to_string(&case).unwrap();
    let step =
        text.lines().map(|line| if line.starts_with("factor") { "step = 2e-7" } else { line });
    fs::write(&case, step.collect::<Vec<_>>().join("\n")).unwrap();
    let run = |case: &str, name: &str, sets: &[&str]| -> Results {
        let out = path(name);
        let ran = done(&[&["run", case, "--out", &out, "--json"], sets].concat());
        assert_eq!(ran["status"], "completed");
        runs::results(Path::new(&out))
    };
    let [here, there] = [run(&small(), "here", &AS_CARDS_SAY), run(&case, "there", &[])];
    let times = here.history("time").iter().zip(there.history("time"));
    assert!(times.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) < 1e-5 * 2e-4, "{text}");
    ["normal_force", "tangential_force"].map(|column| {
        let [mine, theirs] = [&here, &there].map(|run| run.history(column));
        assert_eq!(mine.len(), theirs.len());
        let largest = mine.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
        mine.iter().zip(theirs).map(|(a, b)| (a - b).abs() / largest).fold(0.0, f64::max)
    })
}

#[test]
fn a_case_that_was_exported_and_imported_has_the_same_forces() {
    // a case by import has six digits, and some ten numbers of it bear on the forces
    const LIMIT: f64 = 10.0 * 5e-6;
    let [normal, tangential] = off_by_cards(str::to_owned);
    assert!(normal < LIMIT && tangential < LIMIT, "{normal:e} {tangential:e}");
    // what such a difference must not hide: a load and a friction off by a thousandth
    let instead = |old: &'static str, new: &'static str| {
        move |deck: &str| {
            assert_eq!(deck.matches(old).count(), 1, "{old}");
            deck.replace(old, new)
        }
    };
    let [normal, _] = off_by_cards(instead("    -10000\n", "    -10010\n"));
    let [_, tangential] = off_by_cards(instead("       0.3       0.3 ", "    0.3003    0.3003 "));
    assert!(normal > LIMIT && tangential > LIMIT, "{normal:e} {tangential:e}");
}

#[test]
fn import_tells_how_many_cards_were_used_and_ignored() {
    let folder = tempfile::tempdir().unwrap();
    let deck = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/small.k");
    let deck = deck.display().to_string();
    let out = |name: &str| folder.path().join(name).display().to_string();
    let args = ["import-k", &deck, "--unit", "mm-ton-s", "--out"];
    let read = done(&[&args[..], &[&out("a"), "--json"]].concat());
    assert_eq!(read["cards"], serde_json::json!({ "used": 21, "ignored": 2, "refused": 0 }));
    let page = creepage(&[&args[..], &[&out("b")]].concat()).stdout;
    let page = String::from_utf8_lossy(&page).into_owned();
    assert!(page.contains("cards: 21 used, 2 ignored"), "{page}");
}

#[test]
fn units_of_another_deck_are_refused_in_one_message_that_names_them() {
    let folder = tempfile::tempdir().unwrap();
    let deck = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes/small.k");
    let deck = deck.display().to_string();
    let out = folder.path().join("small").display().to_string();
    let output = creepage(&["import-k", &deck, "--unit", "m-kg-s", "--out", &out]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("--unit m-kg-s") && said.contains("give --unit mm-ton-s"), "{said}");
    assert!(!said.contains("case.toml"), "{said}");
    assert!(!Path::new(&out).exists(), "nothing is written");
}

#[test]
fn cards_that_are_refused_are_told_together_with_their_lines() {
    let folder = tempfile::tempdir().unwrap();
    let deck = folder.path().join("bad.k").display().to_string();
    fs::write(&deck, "*KEYWORD\n*MAT_RIGID\n1\n*CONTROL_TERMINATION\n1.0,0,0.5\n*END\n").unwrap();
    let words = ["bad.k:2", "first of 2 cards", "bad.k:5", "DTMIN = 0.5", "leave the field blank"];
    refused(&["import-k", &deck, "--unit", "mm-ton-s"], &words);
}

#[test]
fn a_case_that_keyword_files_cannot_say_ends_with_the_reasons() {
    let folder = tempfile::tempdir().unwrap();
    let deck = folder.path().join("small.k").display().to_string();
    let sets = ["--set", "contact.enforcement=exact", "--set", "drive.spin=0.1"];
    let words = ["keyword files cannot say", "contact.enforcement", "drive.spin", "--set"];
    refused(&[&["export-k", &small(), "--out", &deck], &sets[..]].concat(), &words);
    assert!(!Path::new(&deck).exists());
}

#[test]
fn a_file_that_is_no_deck_of_ours_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let deck = folder.path().join("theirs.k").display().to_string();
    fs::write(&deck, "*KEYWORD\n*END\n").unwrap();
    refused(
        &["export-k", &small(), "--out", &deck],
        &["theirs.k", "is not a keyword file that this program wrote"],
    );
    assert_eq!(fs::read_to_string(&deck).unwrap(), "*KEYWORD\n*END\n");
    let other = folder.path().join("deck.txt").display().to_string();
    refused(&["export-k", &small(), "--out", &other], &["must end in .k"]);
    refused(&["export-k", &small(), "--unit", "ft-lb-s"], &["mm-ton-s"]);
}
