//! `creepage slider` from outside.
#![allow(clippy::unwrap_used)]

use std::process::{Command, Output};

fn slider(options: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_creepage")).arg("slider").args(options).output().unwrap()
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn json_has_the_keys_that_scripts_rely_on() {
    let one = slider(&["--json", "--t-end", "1"]);
    assert_eq!(one.status.code(), Some(0));
    let one = json(&one);
    assert_eq!(one["method"], "implicit");
    for key in ["dt", "mass", "damping", "x_min", "x_max", "v_max"] {
        assert!(one[key].is_number(), "{key}");
    }
    let all = json(&slider(&["--json", "--tables"]));
    for (table, rows) in [("table2", 4), ("table3", 9), ("table4", 5)] {
        let table = all[table].as_array().unwrap();
        assert_eq!(table.len(), rows);
        assert!(table[0]["paper"]["x_max"].is_number() && table[0]["v_max"].is_number());
    }
}

#[test]
fn bad_parameters_exit_2_and_are_named() {
    for (options, word) in [
        (["--dt", "0"], "dt = 0"),
        (["--dt", "nan"], "dt = NaN"),
        (["--mass", "-1"], "mass = -1"),
        (["--damping", "-0.1"], "damping = -0.1"),
        (["--dt", "1e-300"], "dt = "),
        (["--method", "foo"], "foo"),
        (["--csv", "/proc/none/slider.csv"], "slider.csv"),
    ] {
        let output = slider(&options);
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(said.contains(word), "{options:?}: {said}");
    }
}
