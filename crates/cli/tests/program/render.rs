//! `creepage render`: pictures and films of a run in three dimensions.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const CASE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/small.toml");

fn creepage(words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_creepage"));
    command.args(words);
    command
}

/// A run of some records in `folder`.
fn run(folder: &Path, more: &[&str]) -> PathBuf {
    let out = folder.join("run");
    let sets = ["mesh.zone.size=1.6e-3", "time.roll=0.1e-3", "output.fields_interval=0.5e-6"];
    let mut command = creepage(&["run", CASE, "--quiet", "--threads", "1", "--out"]);
    command.arg(&out).args(sets.iter().flat_map(|set| ["--set", *set])).args(more);
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    out
}

fn render(run: &Path, more: &[&str]) -> Output {
    // narrow pictures are drawn faster
    creepage(&["render", "--width", "300", "--json"]).arg(run).args(more).output().unwrap()
}

#[track_caller]
fn drawn(run: &Path, more: &[&str]) -> Value {
    let output = render(run, more);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[track_caller]
fn refused(run: &Path, more: &[&str], words: &[&str]) {
    let output = render(run, more);
    let said = String::from_utf8_lossy(&output.stderr);
    // the terminal's lines break words apart
    let line = said.split_whitespace().filter(|word| *word != "│").collect::<Vec<_>>().join(" ");
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    words.iter().for_each(|word| assert!(line.contains(word), "{word:?} is not in:\n{said}"));
}

#[test]
fn a_picture_shows_the_last_record_or_the_nearest_to_a_time_and_a_film_shows_all() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path(), &[]);
    let last = drawn(&run, &[]);
    let picture = run.join("render.png");
    assert_eq!(last["file"], picture.to_str().unwrap());
    assert_eq!(&fs::read(&picture).unwrap()[1..4], b"PNG");
    assert_eq!(last["field"], "von_mises");
    assert!(last["top"].as_f64().unwrap() > 100.0, "MPa: {last}");
    assert!(last["magnifications"].as_array().unwrap().iter().all(|m| m.as_f64().unwrap() > 1.0));

    let film = folder.path().join("film.gif");
    let film = ["--out", film.to_str().unwrap()];
    let all = drawn(&run, &film);
    let times: Vec<f64> =
        all["times"].as_array().unwrap().iter().map(|t| t.as_f64().unwrap()).collect();
    assert!(times.len() > 3 && times[0] == 0.0, "{times:?}");
    assert_eq!(last["times"][0].as_f64(), times.last().copied());
    let few = drawn(&run, &[&film[..], &["--frames", "2"]].concat());
    assert_eq!(few["times"].as_array().unwrap().len(), 2);
    assert_eq!(few["records"].as_u64(), Some(times.len() as u64));

    let near = format!("{}", times[1] + 0.1 * (times[2] - times[1]));
    for (field, view) in [("velocity", &["--view", "whole"][..]), ("pressure", &[])] {
        let found = drawn(&run, &[&["--field", field, "--time", &near], view].concat());
        assert_eq!(found["field"], field);
        let off = found["times"][0].as_f64().unwrap() - times[1];
        assert!(off.abs() < 1e-6, "{found}");
    }
    // the picture of the bodies stays beside that of the surfaces
    let bodies = fs::read(&picture).unwrap();
    let surfaces = drawn(&run, &["--what", "contact"]);
    assert_eq!(surfaces["field"], "pressure");
    assert_eq!(surfaces["file"], run.join("render-contact.png").to_str().unwrap());
    assert_eq!(fs::read(&picture).unwrap(), bodies);
    assert_eq!(drawn(&run, &["--magnify", "7"])["magnifications"], serde_json::json!([7.0, 7.0]));
}

#[test]
fn what_is_not_there_is_said_with_the_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path(), &["--set", "output.stress=false"]);
    assert_eq!(drawn(&run, &[])["field"], "velocity");
    refused(&run, &["--field", "von_mises"], &["no field stress", "output.stress = true"]);
    refused(
        &run,
        &["--field", "temperature"],
        &["von_mises, velocity, deformation", "slip_velocity"],
    );
    refused(&run, &["--field", "shear", "--what", "fields"], &["it has von_mises, velocity"]);
    refused(&run, &["--out", "film.avi"], &["must end in .png, .gif or .mp4"]);
    refused(&run, &["--out", run.join("no/a.png").to_str().unwrap()], &["there is no folder"]);

    // what another program wrote stays; what this one wrote is written over
    let mine = folder.path().join("mine.png");
    fs::write(&mine, "of somebody").unwrap();
    refused(&run, &["--out", mine.to_str().unwrap()], &["is there already"]);
    assert_eq!(fs::read(&mine).unwrap(), b"of somebody");

    let bare =
        creepage(&["render", "--out", "film.mp4"]).arg(&run).env("PATH", "").output().unwrap();
    let said = String::from_utf8_lossy(&bare.stderr);
    assert_eq!(bare.status.code(), Some(2));
    assert!(said.contains("ffmpeg") && said.contains(".gif"), "{said}");

    fs::remove_file(run.join("fields.vtkhdf")).unwrap();
    refused(&run, &["--field", "velocity"], &["fields.vtkhdf"]);
    fs::remove_file(run.join("summary.json")).unwrap();
    fs::remove_file(run.join("run.log")).unwrap();
    refused(&run, &[], &["holds no fields.vtkhdf", "output.fields_interval", "--what contact"]);
    refused(folder.path(), &["--what", "contact"], &["holds no contact.vtkhdf"]);
}

#[test]
fn a_damaged_file_is_refused_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path(), &[]);
    for (name, what) in [("fields.vtkhdf", "fields"), ("contact.vtkhdf", "contact")] {
        let path = run.join(name);
        let bytes = fs::read(&path).unwrap();
        let mut flipped = bytes.clone();
        flipped[bytes.len() / 2] ^= 4;
        fs::write(&path, &flipped).unwrap();
        refused(&run, &["--what", what], &[name, "crc32", "copy it again"]);
        fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
        refused(&run, &["--what", what], &[name]);
        fs::write(&path, &bytes).unwrap();
    }
    // without checksums the reader has to see it
    fs::remove_file(run.join("summary.json")).unwrap();
    fs::remove_file(run.join("run.log")).unwrap();
    for (name, what) in [("fields.vtkhdf", "fields"), ("contact.vtkhdf", "contact")] {
        let path = run.join(name);
        let bytes = fs::read(&path).unwrap();
        for share in [0.0, 0.02, 0.5, 0.9] {
            fs::write(&path, &bytes[..(share * bytes.len() as f64) as usize]).unwrap();
            refused(&run, &["--what", what], &[name]);
        }
        for at in (0..bytes.len()).step_by(bytes.len() / 23 + 1) {
            let mut flipped = bytes.clone();
            flipped[at] ^= 0x40;
            fs::write(&path, flipped).unwrap();
            let output = render(&run, &["--what", what]);
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(matches!(output.status.code(), Some(0 | 2)), "{name} at {at}: {said}");
            assert!(!said.contains("panicked"), "{name} at {at}: {said}");
        }
        fs::write(&path, &bytes).unwrap();
    }
}
