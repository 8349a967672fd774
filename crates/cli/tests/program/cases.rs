//! The reference cases in a folder that has no file: run by their names, listed, copied.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn creepage(folder: &Path, line: &str) -> Output {
    let words = line.split_whitespace();
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(words).current_dir(folder).output().unwrap()
}

#[track_caller]
fn printed(folder: &Path, line: &str) -> String {
    let output = creepage(folder, line);
    assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

#[track_caller]
fn refused(folder: &Path, line: &str, wanted: &str) {
    let output = creepage(folder, line);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{line}: {said}");
    assert!(said.contains(wanted), "{line}: {wanted:?} is not in:\n{said}");
}

#[test]
fn a_name_means_the_reference_case_where_no_file_has_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    // what a run takes is another at every time
    let mesh = |folder, name| {
        let document = printed(folder, &format!("mesh {name} --json"));
        document.split("\"estimate\"").next().unwrap().to_owned()
    };
    let smoke = mesh(&project, "cases/smoke.toml");
    for name in ["smoke", "cases/smoke.toml"] {
        assert_eq!(mesh(folder, name), smoke, "{name}");
    }
    for line in ["run b-falling", "run zhao-li/c-memory", "sweep kt", "sweep sweeps/tutorial"] {
        let output = creepage(folder, &format!("{line} --check-args"));
        assert!(output.status.success(), "{line}");
    }
    refused(folder, "run kt", "kt.toml (reference case):");
    refused(folder, "run quik", "did you mean the reference case `quick`?");
    refused(folder, "run quick.toml", "did you mean the reference case `quick`?");
    refused(folder, "run quick --set load.normal=-1", "--set");
    fs::write(folder.join("quick"), "load.normal = 0\n").unwrap();
    refused(folder, "run quick", "quick:1: load.normal");
}

#[test]
fn copies_run_where_they_are_and_replace_no_other_text() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for case in printed(folder, "cases").lines().filter(|line| line.starts_with("  ")) {
        printed(folder, &format!("cases {}", case.split_whitespace().next().unwrap()));
    }
    for line in ["run cases/verdict/falling.toml", "sweep cases/sweeps/creep-curve.toml"] {
        let output = creepage(folder, &format!("{line} --check-args"));
        assert!(output.status.success() && output.stderr.is_empty(), "{line}");
    }
    assert_eq!(fs::read(folder.join("cases/case.schema.json")).unwrap(), {
        creepage(folder, "schema").stdout
    });
    let base = folder.join("cases/zhao-li/a-coulomb.toml");
    fs::write(&base, "# mine\n").unwrap();
    refused(folder, "cases zhao-li/b-falling", "a-coulomb.toml: there is another file");
    assert_eq!(fs::read_to_string(&base).unwrap(), "# mine\n");
    refused(folder, "cases elsewhere", "`creepage cases` lists them");
    printed(folder, "cases zhao-li/b-falling --force");
    assert!(fs::read_to_string(&base).unwrap().contains("title"));
}
