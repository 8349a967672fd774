//! Damage of the files of a run that has ended is seen before anything is said of them.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");

fn creepage(words: &[&str], out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(words).arg(out).output().unwrap()
}

const SETS: [&str; 6] = [
    "--set",
    "time.roll=0.002",
    "--set",
    "evaluate.last=0.001",
    "--set",
    "output.probes.bar=[[0.0, 0.0]]",
];

fn begin(out: &Path, more: &[&str]) -> Output {
    creepage(&[&["run", CASE], more, &SETS, &["--quiet", "--out"]].concat(), out)
}

fn run(out: &Path, more: &[&str]) {
    let output = begin(out, more);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[track_caller]
fn refused(output: &Output, words: &[&str]) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    for word in words {
        assert!(said.contains(word), "{word} is not in {said}");
    }
}

#[test]
fn cut_emptied_flipped_and_missing_files_of_a_complete_run_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    run(&out, &[]);
    let whole = creepage(&["check", "--json"], &out);
    assert!(matches!(whole.status.code(), Some(0 | 1)), "{}", said(&whole));
    assert!(!said(&whole).contains("nothing proves"), "{}", said(&whole));
    for name in ["contact.vtkhdf", "history.h5", "probes.h5", "case.toml", "fields.vtkhdf"] {
        let path = out.join(name);
        let bytes = fs::read(&path).unwrap();
        for share in [0.0, 0.5, 0.95] {
            let length = (share * bytes.len() as f64) as usize;
            fs::write(&path, &bytes[..length]).unwrap();
            refused(&creepage(&["check"], &out), &[name, "copy it again"]);
        }
        refused(&creepage(&["report"], &out), &[name]);
        refused(&creepage(&["plot"], &out), &[name]);
        refused(&begin(&out, &["--resume"]), &[name, "--force"]);

        // anywhere in the file; of the fields, which no check reads, only --deep sees it
        for at in (0..bytes.len()).step_by(bytes.len() / 7 + 1) {
            let mut flipped = bytes.clone();
            flipped[at] ^= 4;
            fs::write(&path, flipped).unwrap();
            refused(&creepage(&["check", "--deep"], &out), &[name, "crc32"]);
            let found = creepage(&["check", "--json"], &out);
            if name == "fields.vtkhdf" {
                assert_eq!((found.status, found.stdout), (whole.status, whole.stdout.clone()));
            } else {
                refused(&found, &[name, "crc32"]);
            }
        }
        fs::remove_file(&path).unwrap();
        let found = creepage(&["check"], &out);
        if name == "fields.vtkhdf" {
            assert_eq!(
                found.status.code(),
                whole.status.code(),
                "left away, as when only a part is copied"
            );
        } else {
            refused(&found, &[name]);
        }
        fs::write(&path, bytes).unwrap();
    }
    let again = creepage(&["check", "--deep", "--json"], &out);
    assert_eq!((again.status, again.stdout), (whole.status, whole.stdout));
}

#[test]
fn a_changed_summary_is_refused_and_one_without_checksums_is_read_with_one_warning() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    run(&out, &[]);
    let path = out.join("summary.json");
    let text = fs::read_to_string(&path).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    let files = summary["checksums"].as_object().unwrap();
    for name in ["case.toml", "fields.vtkhdf", "contact.vtkhdf", "history.h5", "probes.h5"] {
        let bytes = files[name]["bytes"].as_u64().unwrap();
        assert_eq!(bytes, fs::metadata(out.join(name)).unwrap().len(), "{name}");
        assert_eq!(files[name]["crc32"].as_str().unwrap().len(), 8, "{name}");
    }

    let half = summary["half_space"]["peak_pressure"].as_f64().unwrap().to_string();
    let other = half.replacen(&half[..1], if half.starts_with('9') { "8" } else { "9" }, 1);
    fs::write(&path, text.replace(&half, &other)).unwrap();
    refused(&creepage(&["check"], &out), &["summary.json", "sha256"]);
    fs::write(&path, &text[..text.len() / 2]).unwrap();
    refused(&creepage(&["check"], &out), &["summary.json", "no JSON"]);
    refused(&begin(&out, &["--resume"]), &["summary.json", "--force"]);
    fs::remove_file(&path).unwrap();
    refused(&creepage(&["check"], &out), &["summary.json", "run.log"]);

    let mut older = summary;
    ["checksums", "sha256"].iter().for_each(|key| {
        older.as_object_mut().unwrap().remove(*key).unwrap();
    });
    fs::write(&path, older.to_string()).unwrap();
    let found = creepage(&["check"], &out);
    assert!(matches!(found.status.code(), Some(0 | 1)), "{}", said(&found));
    assert_eq!(said(&found).matches("nothing proves").count(), 1, "{}", said(&found));
}

#[test]
fn force_removes_the_checks_pages_and_figures_of_the_run_that_it_replaces_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    run(&out, &[]);
    let plotted = creepage(&["plot", "--json"], &out);
    assert_eq!(plotted.status.code(), Some(0), "{}", said(&plotted));
    let plotted: Value = serde_json::from_slice(&plotted.stdout).unwrap();
    for figure in plotted["figures"].as_array().unwrap() {
        let name = figure["name"].as_str().unwrap();
        assert!(creepage::run::derived::FIGURE_NAMES.contains(&name), "{name} would stay");
    }
    assert_eq!(creepage(&["report"], &out).status.code(), Some(0));
    fs::write(out.join("check.json"), creepage(&["check", "--json"], &out).stdout).unwrap();
    fs::write(out.join("notes.txt"), "mine").unwrap();
    fs::write(out.join("figures/mine.svg"), "<svg/>").unwrap();
    run(&out, &["--force"]);
    for name in ["check.json", "report.html", "figures/space-time.svg", "figures/space-time.png"] {
        assert!(!out.join(name).exists(), "{name}");
    }
    let left: Vec<_> = fs::read_dir(out.join("figures")).unwrap().collect();
    assert_eq!(left.len(), 1, "{left:?}");
    assert_eq!(fs::read_to_string(out.join("notes.txt")).unwrap(), "mine");

    fs::remove_file(out.join("figures/mine.svg")).unwrap();
    assert_eq!(creepage(&["plot", "--format", "svg"], &out).status.code(), Some(0));
    run(&out, &["--force"]);
    assert!(!out.join("figures").exists());
}
