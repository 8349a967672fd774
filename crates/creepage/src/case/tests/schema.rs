//! The JSON Schema and the table of keys agree.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::case::form::{Form, Range, STIFFNESS};
use crate::case::json_schema;
use crate::case::keys::KEYS;

/// Paths of all keys in the JSON Schema.
fn paths(schema: &Value, prefix: &str, found: &mut Vec<String>) {
    let Some(properties) = schema.get("properties").and_then(Value::as_object) else {
        found.push(prefix.to_owned());
        return;
    };
    for (name, inner) in properties {
        let path = if prefix.is_empty() { name.clone() } else { format!("{prefix}.{name}") };
        match inner.get("items") {
            Some(items) if items.get("properties").is_some() => {
                paths(items, &format!("{path}[]"), found);
            }
            _ => paths(inner, &path, found),
        }
    }
}

#[test]
fn the_table_of_keys_and_the_schema_name_the_same_keys() {
    let mut in_schema = Vec::new();
    paths(&json_schema(), "", &mut in_schema);
    in_schema.sort();
    let mut in_table: Vec<_> = KEYS.iter().map(|key| key.path.to_owned()).collect();
    in_table.sort();
    assert_eq!(in_schema, in_table);
}

#[test]
fn every_key_of_the_schema_tells_unit_default_and_range() {
    let schema = json_schema();
    for key in KEYS.iter() {
        let pointer = key.path.replace("[]", "/items").replace('.', "/properties/");
        let at = schema.pointer(&format!("/properties/{pointer}")).unwrap();
        let text = at.get("description").and_then(Value::as_str).unwrap();
        assert!(text.contains("Default") || text.contains("Required"), "{}: {text}", key.path);
        assert!(text.contains("Allowed: "), "{}: {text}", key.path);
        let unit = match key.unit {
            "-" => "dimensionless",
            unit => unit,
        };
        // A stiffness has a unit for each of its forms.
        if key.form != Form::Stiffness {
            assert!(text.contains(unit), "{} lacks {unit}: {text}", key.path);
        }
        if let Form::Number(range) = key.form {
            assert_eq!(at.get("type"), Some(&Value::from("number")), "{}", key.path);
            let low = at.get("minimum").or(at.pointer("/anyOf/1/minimum"));
            assert_eq!(low, Some(&Value::from(range.low)), "{}", key.path);
            assert_eq!(at.get("maximum"), Some(&Value::from(range.high)), "{}", key.path);
        }
    }
}

#[test]
fn of_two_keys_that_exclude_each_other_both_say_so() {
    for key in KEYS.iter() {
        let Some(other) = key.instead_of else { continue };
        let rival = KEYS.iter().find(|rival| rival.path == other);
        assert_eq!(rival.and_then(|rival| rival.instead_of), Some(key.path));
    }
}

/// The ranges of the numbers of a key.
fn ranges(form: Form) -> Vec<Range> {
    match form {
        Form::Number(range) | Form::Crown(range) | Form::OverTime(range) | Form::Points(range) => {
            vec![range]
        }
        Form::Curve(first, second) => vec![first, second],
        Form::Stiffness => STIFFNESS.map(|(_, range, _)| range).to_vec(),
        Form::Count(low, high) => {
            vec![Range { low: low as f64, high: high as f64, or_zero: false }]
        }
        Form::Flag
        | Form::Word(_)
        | Form::Words(_)
        | Form::Text
        | Form::Profile
        | Form::Heights(_) => Vec::new(),
    }
}

#[test]
fn every_number_has_a_finite_range_that_holds_no_number_too_small_to_matter() {
    // what may be zero passes into it without a jump: a load of friction, damping, drive or mass, a place, a time
    const TO_ZERO: [&str; 22] = [
        "bar.material.poisson",
        "contact.penalty.damping",
        "damping.bulk_linear",
        "damping.bulk_quadratic",
        "damping.kelvin_voigt",
        "damping.mass",
        "disk.lift",
        "disk.material.poisson",
        "drive.creepage",
        "drive.lateral_creepage",
        "drive.ramp",
        "drive.spin",
        "drive.torque",
        "friction.decay",
        "friction.dynamic",
        "friction.evolution",
        "friction.static",
        "friction.table",
        "load.hub_mass",
        "material.poisson",
        "output.window[].from",
        "preload.seed",
    ];
    const PLACES: [&str; 8] = [
        "bar.cant",
        "disk.lateral",
        "disk.roll",
        "disk.yaw",
        "bar.start",
        "mesh.zone.start",
        "output.probes.bar",
        "output.probes.disk",
    ];
    let mut numbers = 0;
    for key in KEYS.iter() {
        for Range { low, high, or_zero } in ranges(key.form) {
            numbers += 1;
            assert!(low.is_finite() && high.is_finite() && low < high, "{}", key.path);
            let listed = TO_ZERO.contains(&key.path) || PLACES.contains(&key.path);
            assert_eq!(low <= 0.0, listed, "{}: its range begins at {low}", key.path);
            assert!(!(or_zero && listed), "{}", key.path);
            assert!(low <= 0.0 || low >= 1e-20, "{}", key.path);
        }
    }
    assert!(numbers > 80, "{numbers}");
}

#[test]
fn no_number_beyond_its_range_is_taken_and_the_refusal_tells_range_and_unit() {
    let mut tried = 0;
    for key in KEYS.iter().filter(|key| !ranges(key.form).is_empty()) {
        for absurd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300, 1e30, -1e30] {
            let value = match key.form {
                Form::Points(_) => toml::Value::from(vec![vec![0.0, absurd]]),
                Form::Curve(..) => toml::Value::from(vec![vec![0.0, absurd]]),
                _ => toml::Value::Float(absurd),
            };
            let problem = key.mistake(&value).unwrap_or_default();
            let range = match key.form {
                Form::Count(low, high) => format!("from {low} to {high}"),
                Form::Curve(_, range) => range.to_string(),
                _ => ranges(key.form)[0].to_string(),
            };
            assert!(problem.contains(&range), "{} = {absurd}: {problem}", key.path);
            let unit = if key.unit == "-" || key.form == Form::Stiffness { "" } else { key.unit };
            let counted = matches!(key.form, Form::Count(..) | Form::Curve(..));
            assert!(counted || problem.contains(unit), "{} = {absurd}: {problem}", key.path);
            tried += 1;
        }
    }
    assert!(tried > 500, "{tried}");
}

#[test]
fn the_default_that_a_key_tells_is_the_one_that_it_has() {
    let schema = json_schema();
    let mut compared = 0;
    for key in KEYS.iter() {
        let pointer = key.path.replace("[]", "/items").replace('.', "/properties/");
        let at = schema.pointer(&format!("/properties/{pointer}")).unwrap();
        let text = at["description"].as_str().unwrap();
        let told = text.split("Default ").nth(1).and_then(|rest| rest.split_whitespace().next());
        let Some(told) = told.map(|told| told.trim_end_matches(['.', ',', ':'])) else { continue };
        let same = match &at.get("default") {
            Some(Value::Number(x)) => told.parse().ok() == x.as_f64(),
            Some(Value::Bool(x)) => told == x.to_string(),
            Some(Value::String(word)) => told == format!("`\"{word}\"`"),
            _ => continue,
        };
        compared += 1;
        assert!(same, "{}: {told} is told, {:?} is taken", key.path, at.get("default"));
    }
    assert!(compared > 40, "{compared}");
}

/// The folder of the project's cases.
fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

#[test]
fn the_committed_schema_is_the_one_that_creepage_schema_prints() {
    let file = cases().join("case.schema.json");
    let committed = fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
    let now = serde_json::to_string_pretty(&json_schema()).unwrap() + "\n";
    assert!(committed == now, "renew it: creepage schema > cases/case.schema.json");
}

/// TOML files below a folder.
fn toml_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            toml_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            found.push(path);
        }
    }
}

#[test]
fn the_first_line_of_every_case_of_the_project_leads_editors_to_the_schema() {
    let mut files = Vec::new();
    toml_files(&cases(), &mut files);
    let mut led = 0;
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        if text.contains("[[axis]]") {
            continue; // a sweep, whose keys are others
        }
        let first = text.lines().next().unwrap_or_default();
        let schema = first.strip_prefix("#:schema ").unwrap_or_default();
        let target = file.parent().unwrap().join(schema);
        assert!(
            target.is_file() && target.ends_with("case.schema.json"),
            "{}: the first line is {first:?}",
            file.display()
        );
        led += 1;
    }
    assert!(led > 5);
}
