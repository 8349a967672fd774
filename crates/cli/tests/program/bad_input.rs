//! What the program does with bad input: exit code 2 and a message that helps.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

const SHORT: &str = "load.normal = 100e3\ndrive.speed = 38.89\ndrive.creepage = 2.4e-3\n\
                     friction.static = 0.5\n";

fn creepage(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(args).output().unwrap()
}

/// A folder with a case file in it.
fn case(text: &str) -> (tempfile::TempDir, String) {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("case.toml");
    fs::write(&path, text).unwrap();
    (dir, path.display().to_string())
}

#[track_caller]
fn refused(args: &[&str], words: &[&str]) {
    let output = creepage(args);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
    assert!(output.stdout.is_empty(), "{args:?} wrote to standard output");
    assert!(!said.contains("panicked"), "{said}");
    for word in words {
        assert!(said.contains(word), "{args:?}: {word:?} is not in:\n{said}");
    }
}

#[test]
fn a_wrong_value_is_shown_with_file_line_key_value_range_and_remedy() {
    let (_dir, path) = case(&format!("{SHORT}[time]\nfactor = 3\n"));
    refused(
        &["run", &path],
        &["case.toml:6", "time.factor = 3", "at most 2", "help:", "factor = 3"],
    );
}

#[test]
fn unknown_missing_and_wrong_keys_end_with_code_2() {
    for (line, words) in [
        ("disk.radios = 1", ["disk.radios", "did you mean `radius`"]),
        ("disk.radius = \"big\"", ["disk.radius = \"big\"", "a number"]),
        ("disk.radius = nan", ["disk.radius = NaN", "at least 1e-8"]),
        ("material.poisson = 0.5", ["material.poisson = 0.5", "at most 0.49999"]),
        ("mesh.zone.length = 0.3", ["mesh.zone.length = 0.3", "bar.length"]),
        ("element.contact_layers = \"two\"", ["one-point", "full"]),
        (
            "element = { contact_layers = \"one-point\", layers = 2 }",
            ["element.layers is not used", "contact_layers"],
        ),
        ("disk.lift = 1e-3", ["disk.lift", "does not touch"]),
        ("= 3", ["case.toml:5", "TOML"]),
    ] {
        let (_dir, path) = case(&format!("{SHORT}{line}\n"));
        refused(&["run", &path], &words);
        refused(&["mesh", &path], &words);
    }
    let (_dir, path) = case("drive.speed = 38.89\n");
    refused(&["run", &path], &["load.normal is missing", "friction.static is missing"]);
}

#[test]
fn a_load_upwards_is_refused() {
    let (_dir, path) = case(SHORT);
    refused(&["run", &path, "--set", "load.normal=-1e5"], &["--set", "load.normal", "upwards"]);
}

#[test]
fn a_missing_file_and_a_folder_are_no_cases() {
    let dir = tempfile::tempdir().unwrap();
    refused(&["run", dir.path().to_str().unwrap()], &["is a folder"]);
    refused(&["run", dir.path().join("no.toml").to_str().unwrap()], &["no.toml", "no such file"]);
}

#[test]
fn wrong_usage_ends_with_code_2() {
    let (_dir, path) = case(SHORT);
    refused(&["fly"], &["fly"]);
    refused(&["run"], &["<CASE>"]);
    refused(&["run", &path, "--threads", "0"], &["--threads", "1 to 1024"]);
    refused(&["run", &path, "--set", "load.normal"], &["KEY=VALUE"]);
    refused(&["run", &path, "--resume"], &["no run to resume", "leave out --resume"]);
    refused(&["mesh", &path, "--out", "mesh.stl"], &[".vtu, .vtkhdf or .msh"]);
}

#[test]
fn an_existing_run_and_an_unusable_folder_are_refused() {
    let (dir, path) = case(SHORT);
    let out = dir.path().join("run");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("case.toml"), SHORT).unwrap();
    refused(&["run", &path, "--out", out.to_str().unwrap()], &["already holds a run", "--force"]);
    assert_eq!(fs::read_to_string(out.join("case.toml")).unwrap(), SHORT);
    let below_a_file: PathBuf = PathBuf::from(&path).join("run");
    refused(&["run", &path, "--out", below_a_file.to_str().unwrap()], &["not writable"]);
    refused(&["run", &path, "--out", &path], &["is a file"]);
}

#[test]
fn with_json_standard_output_is_one_document_also_on_failure() {
    let (_dir, path) = case(&format!("{SHORT}disk.radius = -1\n"));
    let output = creepage(&["run", &path, "--json"]);
    assert_eq!(output.status.code(), Some(2));
    let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["exit_code"], 2);
    assert!(document["error"].as_str().unwrap().contains("disk.radius = -1"));
    assert!(document["help"].as_str().unwrap().contains("metres"));
}

#[test]
fn with_json_wrong_usage_is_one_document_too() {
    for (args, said) in [
        (&["--json"][..], ""),
        (&["run", "--json"], "not provided: <CASE>"),
        (&["mesh", "--json", "--fly"], "'--fly'"),
    ] {
        let output = creepage(args);
        assert_eq!(output.status.code(), Some(2));
        let document: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(document["exit_code"], 2, "{args:?}");
        assert!(document["error"].as_str().unwrap().contains(said), "{document}");
        assert!(document["help"].as_str().unwrap().contains("Usage: creepage"), "{document}");
    }
}

#[test]
fn a_mesh_that_is_too_large_is_refused_at_its_line_and_costs_no_earlier_run_its_results() {
    let (dir, path) = case(&format!("{SHORT}[mesh]\ngrowth = 1.05\ncoarsest = 3e-4\n"));
    let out = dir.path().join("run");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("summary.json"), "{}").unwrap();
    let sets = ["--set", "mesh.zone.size=3e-4"];
    let run = ["run", &path, "--out", out.to_str().unwrap(), "--force"];
    let words = ["--set: mesh.zone.size: elements of 0.0003 m", "allowed", "raise mesh.zone.size"];
    refused(&[&run[..], &sets].concat(), &words);
    assert_eq!(fs::read_to_string(out.join("summary.json")).unwrap(), "{}");
    assert!(!out.join("case.toml").exists());
}

#[test]
fn an_output_file_of_a_mesh_that_cannot_be_written_is_refused_before_the_mesh_is_made() {
    let (dir, path) = case(SHORT);
    let below = dir.path().join("none/mesh.vtu");
    refused(&["mesh", &path, "--out", below.to_str().unwrap()], &["no folder", "--out"]);
    let folder = dir.path().join("mesh.vtu");
    fs::create_dir(&folder).unwrap();
    refused(&["mesh", &path, "--out", folder.to_str().unwrap()], &["is a folder", "--out"]);
}

#[test]
fn an_endless_run_is_refused_with_its_number_of_steps() {
    let (_dir, path) = case(SHORT);
    refused(&["run", &path, "--set", "drive.speed=1e-6"], &["60000 s", "time steps", "days"]);
}

#[test]
fn junk_in_place_of_a_case_is_refused_with_its_file() {
    let (_dir, path) = case("");
    for bytes in [&b""[..], b"\x00\x01\xff\xfe", b"\xff\xd8\xff\xe0", b"a = 1\0", b"<?xml?>"] {
        fs::write(&path, bytes).unwrap();
        refused(&["run", &path], &["case.toml", "help:"]);
    }
}

#[test]
fn the_version_is_told() {
    let output = creepage(&["-V"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&output.stdout).starts_with("creepage "));
}

#[test]
fn the_schema_is_one_json_document() {
    for args in [&["schema"][..], &["schema", "--json"]] {
        let output = creepage(args);
        assert_eq!(output.status.code(), Some(0));
        let schema: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let factor = &schema["properties"]["time"]["properties"]["factor"];
        assert_eq!(factor["maximum"], 2.0);
        // by enforcement
        let text = factor["description"].as_str().unwrap();
        assert!(factor["default"].is_null() && text.contains("0.67") && text.contains("0.95"));
    }
}

#[test]
fn help_shows_examples() {
    for command in [
        "run",
        "mesh",
        "check",
        "plot",
        "render",
        "view",
        "report",
        "import-contact",
        "schema",
        "bench",
        "cases",
    ] {
        let output = creepage(&[command, "--help"]);
        assert_eq!(output.status.code(), Some(0));
        assert!(String::from_utf8_lossy(&output.stdout).contains("Example"));
    }
}
