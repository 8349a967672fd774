//! Cases as keyword files from the command line.

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
