//! `summary.json` and `case.toml` say what their numbers are.

use serde_json::Value;

/// The dotted keys of all numbers, also of those that are null in one run and a number in another.
fn numbers(value: &Value, key: &str, found: &mut Vec<String>) {
    match value {
        Value::Object(entries) => {
            for (name, inner) in entries {
                let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                numbers(inner, &key, found);
            }
        }
        Value::Number(_) => found.push(key.to_owned()),
        _ => {}
    }
}

#[test]
fn every_number_of_a_summary_has_its_unit_and_short_keys_have_names() {
    let implicit = ["time.integrator='implicit'", "time.step=2e-6", "contact.enforcement='exact'"];
    let half_space = ["model='half-space'", "mesh.zone.size=0.4e-3"];
    for sets in [
        &[][..],
        &[
            "friction.law='exponential'",
            "friction.static=0.5",
            "friction.memory.distance=1e-6",
            "contact.enforcement='exact'",
        ],
        &implicit,
        &half_space,
    ] {
        let short = ["time.roll=0.0004", "drive.ramp=1e-6"];
        let summary = runs::small(&[&short[..], sets].concat()).summary;
        let mut found = Vec::new();
        numbers(&summary, "", &mut found);
        found.retain(|key| !key.starts_with("checksums."));
        for key in &found {
            assert!(summary["units"][key].is_string(), "{sets:?}: {key} has no unit");
        }
        assert!(found.len() > 40, "{found:?}");
        for key in ["dt", "energy.balance_error"] {
            assert!(summary["names"][key].is_string(), "{key} has no name");
        }
        if sets != half_space {
            for key in ["numbers.n1", "numbers.r", "stability.omega_max"] {
                assert!(summary["names"][key].is_string(), "{key} has no name");
            }
        }
        assert_eq!(summary["creepage_version"], env!("CARGO_PKG_VERSION"));
        assert_eq!(summary["case_hash"].as_str().map(str::len), Some(64));
        let created = summary["created"].as_str().unwrap();
        assert!(created.starts_with("20") && created.ends_with('Z'), "{created}");
    }
}

#[test]
fn the_case_of_a_run_has_units_as_comments() {
    let resolved = runs::small(&["time.roll=0.0004", "drive.ramp=1e-6"]).resolved;
    assert!(resolved.lines().any(|line| line.starts_with("speed = ") && line.ends_with("  # m/s")));
}
