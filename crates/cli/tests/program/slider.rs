//! `creepage slider` from outside.

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
        (["--dt", "1e-300"], "dt = 1e-300 s is out of range: it must be from 1e-12 to 10"),
        (["--mass", "5e-324"], "mass = 5e-324 kg is out of range: it must be from 1e-12 to"),
        (["--belt", "1e300"], "belt = 1e300 m/s is out of range"),
        (["--dt", "6"], "dt = 6 s is out of range: it must be at most t_end"),
        (["--method", "foo"], "foo"),
        (["--csv", "/proc/none/slider.csv"], "slider.csv"),
        (["--plot", "/proc/none"], "/proc/none"),
        (["--mu-dynamic", "0.6"], "mu_dynamic = 0.6"),
        (["--law", "table"], "--table"),
        (["--belt", "inf"], "belt = inf"),
        (["--plot=figures", "--dt=1e-8"], "dt = 1e-8"),
    ] {
        let output = slider(&options);
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(said.contains(word), "{options:?}: {said}");
    }
}

#[test]
fn what_is_wrong_with_a_parameter_file_is_shown_at_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("slider.toml");
    for (text, words) in [
        ("dt = 1e-4\nmass = -1\n", ["slider.toml:2", "mass = -1"]),
        ("method = \"wrong\"\n", ["slider.toml:1", "wrong"]),
        ("speed = 1\n", ["slider.toml:1", "speed"]),
        ("law = \"coulomb\"\ndecay = 3\n", ["slider.toml:2", "does not use decay"]),
        ("mu_static = 0.3\nmu_dynamic = 0.4\n", ["slider.toml:2", "--allow-strengthening"]),
        ("dt = 1e-4\nspeed = 1\n", ["slider.toml:2", "unknown field `speed`"]),
        ("dt = 1e-4\ndecay = \"six\"\n", ["slider.toml:2", "invalid type: string"]),
        ("mass = 1\nmu_static = 6\n", ["slider.toml:2", "mu_static = 6  is out of range"]),
        ("law = \"rate_state\"\n", ["slider.toml:1", "is none of the slider"]),
        ("law = \"polach\"\nratio = 0.4\n", ["slider.toml:1", "needs --decay"]),
        ("= 3\n", ["slider.toml:1", "slider.toml"]),
        ("expression = \"0.3 + q\"\n", ["slider.toml:1", "'q' at position 7"]),
    ] {
        std::fs::write(&path, text).unwrap();
        let output = slider(&["--config", &path.display().to_string()]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}: {said}");
        for word in words {
            assert!(said.contains(word), "{text}: {word} is not in {said}");
        }
    }
}

#[test]
fn options_come_before_the_parameter_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("slider.toml");
    std::fs::write(&path, "method = \"exact\"\ndt = 1e-3\nmass = 0.02\nt_end = 1\n").unwrap();
    let out = json(&slider(&["--json", "--config", &path.display().to_string(), "--dt", "1e-4"]));
    assert_eq!((&out["method"], &out["dt"]), (&"exact".into(), &1e-4.into()));
    assert_eq!((&out["mass"], &out["steps"]), (&0.02.into(), &10_000.into()));
}

#[test]
fn polachs_law_moves_the_block_as_the_same_law_of_equation_8() {
    let run =
        |law: &[&str]| json(&slider(&[&["--json", "--t-end", "1"], law].concat()))["x_max"].clone();
    let polach = ["--law", "polach", "--mu-static", "0.5", "--ratio", "0.64", "--decay", "6"];
    let [x, same] = [run(&polach), run(&[])].map(|x_max| x_max.as_f64().unwrap());
    assert!((x - same).abs() < 1e-9, "{x} {same}");
}

#[test]
fn strengthening_friction_needs_its_flag() {
    let rising = ["--mu-static", "0.3", "--mu-dynamic", "0.4", "--t-end", "0.1"];
    assert_eq!(slider(&rising).status.code(), Some(2));
    let allowed = slider(&[&rising[..], &["--allow-strengthening"]].concat());
    assert_eq!(allowed.status.code(), Some(0));
}

#[test]
fn a_friction_table_is_read_and_its_mistakes_are_shown_at_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mu.csv");
    let options = |path: &std::path::Path| path.display().to_string();
    std::fs::write(&path, "# measured\nslip speed, mu\n0, 0.5\n1, 0.4\n").unwrap();
    let slid = |text: &str| {
        std::fs::write(&path, text).unwrap();
        json(&slider(&["--json", "--table", &options(&path), "--t-end", "2"]))["x_max"]
            .as_f64()
            .unwrap()
    };
    let metres = slid("# measured\nslip speed, mu\n0, 0.5\n1, 0.4\n");
    assert_eq!(slid("slip speed (mm/s), mu (%)\n0, 50\n1000, 40\n"), metres);
    for (text, word) in [
        ("0, 0.5\n0, 0.4\n", "mu.csv:2"),
        ("0, 0.5\n1, many\n", "mu.csv:2"),
        ("0, 0.5, 3\n", "mu.csv:1"),
        ("0.1, 0.5\n", "at 0"),
        ("", "empty"),
        ("0, 0.3\n1, 0.4\n", "rises"),
        ("slip (mm), mu\n0, 0.5\n", "mu.csv:1: 'slip (mm)': 'mm' is no known unit"),
        ("s, shear (MPa)\n0, 0.5\n", "mu.csv:1: 'shear (MPa)': 'MPa' is no known unit"),
        ("s;mu\n0;0,5\n", "semicolons or tabs"),
    ] {
        std::fs::write(&path, text).unwrap();
        let output = slider(&["--table", &options(&path)]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{text}: {said}");
        assert!(said.contains(word), "{text}: {said}");
    }
}

#[test]
fn figures_are_written_as_svg_and_png() {
    let folder = tempfile::tempdir().unwrap();
    let out = slider(&["--json", "--t-end", "1", "--plot", &folder.path().display().to_string()]);
    let out = json(&out);
    let figures = out["figures"].as_array().unwrap();
    assert_eq!(figures.len(), 8);
    for figure in figures {
        assert!(std::fs::metadata(figure.as_str().unwrap()).unwrap().len() > 10_000, "{figure}");
    }
}

#[test]
fn thresholds_are_printed_by_formula_and_by_bisection() {
    let out = json(&slider(&["--json", "--thresholds"]));
    for (name, value) in [("dt_1", 2.0e-6), ("dt_2", 2.254e-5)] {
        for route in ["formula", "bisection"] {
            let found = out[name][route].as_f64().unwrap();
            assert!((found / value - 1.0).abs() < 0.02, "{name} {route}: {found}");
        }
    }
}

#[test]
fn a_blow_up_exits_3_and_leaves_its_history() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("slider.csv").display().to_string();
    let options = ["--method", "explicit", "--spring", "1e6", "--dt", "1e-2", "--csv", &csv];
    let output = slider(&options);
    assert_eq!(output.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&output.stderr).contains("blew up in step"));
    assert!(std::fs::read_to_string(&csv).unwrap().lines().count() > 2);
}
