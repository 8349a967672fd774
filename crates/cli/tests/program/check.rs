//! `creepage check` on files that are whole, and on files that are not.

use crate::planted::{self, COULOMB, Leave, hertz, perfect, write};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn creepage(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).args(args).output().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[track_caller]
fn refused(args: &[&str], words: &[&str]) {
    let output = creepage(args);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
    assert!(output.stdout.is_empty());
    assert!(!said.contains("panicked"), "{said}");
    for word in words {
        assert!(said.contains(word), "{args:?}: {word:?} is not in:\n{said}");
    }
}

fn document(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_perfect_run_ends_with_code_0_and_one_beyond_a_limit_with_code_1() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write(&run, COULOMB, "exact", 5, |x, _| perfect(COULOMB, x, 0));
    let output = creepage(&["check", text(&run), "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let found = document(&output);
    for key in ["window", "steps", "nodes", "limits", "metrics", "pass"] {
        assert!(found.get(key).is_some(), "{key}");
    }
    assert_eq!((&found["steps"], &found["pass"]), (&5.into(), &true.into()));
    for (name, metric) in found["metrics"].as_object().unwrap() {
        for key in ["value", "limit", "pass", "where"] {
            assert!(metric.get(key).is_some(), "{name}: {key}");
        }
        assert_eq!(found["limits"][name], metric["limit"]);
    }
    let page = creepage(&["check", text(&run)]);
    let page = String::from_utf8_lossy(&page.stdout).into_owned();
    for word in ["violating_fraction", "every limit holds", "half length", "kN"] {
        assert!(page.contains(word), "{word} is not in\n{page}");
    }

    write(&run, COULOMB, "exact", 5, |x, _| {
        let mut node = perfect(COULOMB, x, 0);
        node.gap = -0.3 * planted::APPROACH * hertz(x) / planted::P0;
        node
    });
    let output = creepage(&["check", text(&run), "--json"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(document(&output)["metrics"]["penetration"]["pass"], false);
    let raised = ["--limit", "penetration=0.31", "--limit", "complementarity=1"];
    let output = creepage(&[&["check", text(&run), "--json"], &raised[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", document(&output));
    assert_eq!(document(&output)["limits"]["penetration"], 0.31);
}

#[test]
fn a_window_limits_what_is_judged() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "exact", 9, |x, step| {
        let mut node = perfect(COULOMB, x, 0);
        node.gap = if step < 4 { -1e-5 } else { 0.0 };
        node
    });
    let run = text(folder.path());
    assert_eq!(creepage(&["check", run]).status.code(), Some(1));
    let output = creepage(&["check", run, "--json", "--window", "4e-7:7e-7"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(document(&output)["steps"], 4);
    let output = creepage(&["check", run, "--json", "--window", "4e-7:"]);
    assert_eq!(document(&output)["steps"], 5);
    refused(&["check", run, "--window", "1:2"], &["no record from", "the file has 9"]);
    refused(&["check", run, "--window", "2:1"], &["ends before it begins"]);
    refused(&["check", run, "--window", "now"], &["two times in seconds"]);
}

#[test]
fn wrong_names_and_values_are_refused_with_the_names_that_exist() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "exact", 2, |x, _| perfect(COULOMB, x, 0));
    let run = text(folder.path());
    refused(&["check", run, "--limit", "law=1"], &["no measure 'law'", "law_error"]);
    refused(&["check", run, "--limit", "cone"], &["a name and a number"]);
    refused(&["check", run, "--limit", "cone=-1"], &["at least 0"]);
    for limit in ["roughness_ratio=0", "roughness_ratio=5e-324"] {
        refused(&["check", run, "--limit", limit], &["above 0", "from 1/x to x"]);
    }
    refused(&["check", run, "--scale", "p0=1"], &["no scale 'p0'", "peak_pressure"]);
    refused(&["check", run, "--scale", "approach=0"], &["greater than 0"]);
    refused(&["check", run, "--case", "no.toml"], &["no.toml", "no such file"]);
    let own = folder.path().join("contact.vtkhdf");
    refused(&["check", run, "--map", text(&own)], &["file of the run itself"]);
    refused(&["check", run, "--pairing", "both"], &["stricter, before, after"]);
    refused(&["check", "nowhere"], &["nowhere", "no such file or folder"]);
    let empty = tempfile::tempdir().unwrap();
    refused(&["check", text(empty.path())], &["contact.vtkhdf", "folder of a run"]);
}

#[test]
fn truncated_foreign_and_empty_files_are_refused_with_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write(&run, COULOMB, "exact", 20, |x, _| perfect(COULOMB, x, 0));
    let path = run.join("contact.vtkhdf");
    let whole = fs::read(&path).unwrap();
    for length in [0, 1, 7, 48, 100, 1000, 5000, whole.len() / 2, whole.len() - 1000] {
        fs::write(&path, &whole[..length]).unwrap();
        refused(&["check", text(&run)], &["contact.vtkhdf"]);
    }
    for junk in [&b"not HDF5 at all"[..], b"\x89HDF\r\n\x1a\n", &[0; 4096]] {
        fs::write(&path, junk).unwrap();
        refused(&["check", text(&run)], &["cannot read"]);
    }
    // another file of a run
    let history = output::History::create(
        &path,
        &[output::FieldSpec::scalar("time", "s", "t")],
        &output::Provenance {
            creepage_version: "0".into(),
            case_hash: "0".into(),
            created: "0".into(),
            attributes: Vec::new(),
        },
    )
    .unwrap();
    assert_eq!(history.rows(), 0);
    refused(&["check", text(&run)], &["cannot read"]);
    // created, nothing recorded yet
    planted::create(&path, &planted::surfaces(), Leave::default());
    refused(&["check", text(&run)], &["no record yet"]);
}

#[test]
fn damaged_bytes_anywhere_never_panic() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write(&run, COULOMB, "exact", 3, |x, _| perfect(COULOMB, x, 0));
    let path = run.join("contact.vtkhdf");
    let whole = fs::read(&path).unwrap();
    let mut random = 12345u64;
    for _ in 0..40 {
        let mut bytes = whole.clone();
        for _ in 0..8 {
            random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let at = (random >> 20) as usize % bytes.len();
            bytes[at] ^= (random >> 11) as u8 | 1;
        }
        fs::write(&path, &bytes).unwrap();
        let output = creepage(&["check", text(&run)]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{said}");
        assert!(matches!(output.status.code(), Some(0..=2)), "{said}");
    }
}

#[test]
fn values_that_are_not_numbers_are_named_with_field_node_and_time() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "exact", 4, |x, step| {
        let mut node = perfect(COULOMB, x, 0);
        if step == 2 && x[0] == 0.0 {
            node.slip[1] = f64::NAN;
        }
        node
    });
    let run = text(folder.path());
    refused(&["check", run], &["slip_velocity is not a number", "2e-7", "--window"]);
    assert_eq!(creepage(&["check", run, "--window", "0:1e-7"]).status.code(), Some(0));
    write(folder.path(), COULOMB, "exact", 2, |_, _| planted::Node {
        pressure: f64::NAN,
        ..planted::OPEN
    });
    refused(&["check", run], &["pressure is not a number at node 0"]);
}

#[test]
fn a_run_without_contact_says_so() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), COULOMB, "exact", 2, |_, _| planted::OPEN);
    refused(&["check", text(folder.path())], &["no node is in contact"]);
}

#[test]
fn data_of_other_codes_need_pressure_shear_slip_and_scales_only() {
    let folder = tempfile::tempdir().unwrap();
    let bare = Leave { gap: true, motion: true, mu: false };
    planted::write_with(folder.path(), COULOMB, "other", 5, 1e-6, bare, |x, _| {
        perfect(COULOMB, x, 0)
    });
    let file = folder.path().join("foreign.vtkhdf");
    fs::rename(folder.path().join("contact.vtkhdf"), &file).unwrap();
    let output = creepage(&["check", text(&file), "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let found = document(&output);
    assert_eq!(found["metrics"]["penetration"]["value"], Value::Null);
    assert_eq!(found["metrics"]["penetration"]["note"], "the file has no field gap");
    let notes = found["notes"].to_string();
    assert!(notes.contains("no gap") && notes.contains("slip of the pair"), "{notes}");
    // a limit that was asked for and cannot be judged is not met
    let output = creepage(&["check", text(&file), "--limit", "penetration=1"]);
    assert_eq!(output.status.code(), Some(1));
    // no case: the law's bound is the field mu, scales come by options
    fs::remove_file(folder.path().join("case.toml")).unwrap();
    refused(&["check", text(&file)], &["scale of slip", "--scale slip_speed"]);
    let scales = ["--scale", "slip_speed=0.1", "--scale", "speed=40"];
    let output = creepage(&[&["check", text(&file), "--json"], &scales[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", document(&output));
    let own = document(&output)["metrics"]["law_error_own"]["value"].as_f64().unwrap();
    assert!(own < 1e-12, "{own}");
}

#[test]
fn a_run_in_progress_is_checked_while_it_grows() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    planted::case(&run, COULOMB, "exact");
    let surfaces = planted::surfaces();
    let leave = Leave::default();
    let mut file = planted::create(&run.join("contact.vtkhdf"), &surfaces, leave);
    let mut seen = 0;
    for step in 0..30 {
        planted::append(&mut file, &surfaces, step, planted::DT, leave, &|x, _| {
            perfect(COULOMB, x, 0)
        });
        if step % 10 == 3 {
            let output = creepage(&["check", text(&run), "--json"]);
            assert_eq!(output.status.code(), Some(0));
            seen = document(&output)["steps"].as_u64().unwrap();
            assert_eq!(seen, step as u64 + 1);
        }
    }
    assert_eq!(seen, 24);
}

#[test]
fn a_map_holds_the_violations_of_every_node_over_time() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    write(&run, COULOMB, "penalty", 6, |x, step| {
        let mut node = perfect(COULOMB, x, 0);
        if node.state == 2 && step == 4 {
            node.shear = node.shear.map(|c| 0.8 * c);
        }
        node
    });
    let map = folder.path().join("map.vtkhdf");
    let output = creepage(&["check", text(&run), "--map", text(&map)]);
    assert_eq!(output.status.code(), Some(1));
    let grid = output::GridFile::open(&map).unwrap();
    assert_eq!(grid.times().unwrap().len(), 6);
    let of = |name: &str, step| grid.read(name, false, step).unwrap();
    let points = grid.points().unwrap();
    for step in [3, 4] {
        let (errors, violates) = (of("law_error", step), of("violates", step));
        for (row, x) in points.iter().enumerate() {
            let state = perfect(COULOMB, *x, 0).state;
            if hertz(*x) <= 0.02 * planted::P0 {
                assert!(errors[row].is_nan() && violates[row] == 0.0);
            } else if state == 2 && step == 4 {
                assert!((errors[row] + 0.2).abs() < 1e-12 && violates[row] == 1.0);
            } else {
                assert!(errors[row].is_nan() || errors[row].abs() < 1e-12);
                assert_eq!(violates[row], 0.0);
            }
        }
    }
}

#[test]
fn a_case_in_the_place_of_a_run_is_told_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case-of-mine.toml");
    fs::write(&case, "[load]\nnormal = 1.0\n").unwrap();
    for command in ["check", "plot", "report", "view"] {
        refused(&[command, text(&case)], &["case-of-mine.toml is a case or a sweep", "run it"]);
    }
}
