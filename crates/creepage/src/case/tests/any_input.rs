//! Whatever is written, the loader answers: it never panics.

use std::fs;
use std::path::Path;

use proptest::prelude::*;

use super::{SHORT, read, set};
use crate::case::Case;
use crate::case::keys::KEYS;

/// Any value that TOML can hold, as text.
fn value() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<i64>().prop_map(|n| n.to_string()),
        any::<f64>().prop_map(|x| toml::Value::Float(x).to_string()),
        any::<bool>().prop_map(|b| b.to_string()),
        "[a-z]{0,8}".prop_map(|s| format!("\"{s}\"")),
        Just("[]".to_string()),
        Just("{}".to_string()),
        Just("[[1.0, 2.0], [nan, 3]]".to_string()),
        Just("[{ from = 1, to = 0 }, 3]".to_string()),
        Just("{ stiffness = nan }".to_string()),
        Just("1979-05-27T07:32:00Z".to_string()),
        (-3i32..3, -9i32..9).prop_map(|(m, e)| format!("{m}e{e}")),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_text_makes_the_loader_panic(text in "\\PC{0,200}") {
        let _ = read(&text);
        let _ = set(&[&text]);
    }

    #[test]
    fn no_bytes_make_the_loader_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("bytes.toml");
        fs::write(&path, &bytes).unwrap();
        let _ = Case::load(&path, &[]);
    }

    /// Any values of known keys are refused, or make a case that loads to itself.
    #[test]
    fn any_values_of_known_keys_are_refused_or_resolved(
        entries in proptest::collection::vec((0..KEYS.len(), value()), 0..6)
    ) {
        let sets: Vec<String> = entries
            .iter()
            .map(|(i, value)| format!("{}={value}", KEYS[*i].path.split("[]").next().unwrap()))
            .collect();
        if let Ok(case) = Case::from_text(SHORT, Path::new("short.toml"), &sets) {
            let _ = case.warnings();
            let again = Case::from_text(&case.to_toml(), Path::new("short.toml"), &[]).unwrap();
            prop_assert_eq!(case, again);
        }
    }
}
