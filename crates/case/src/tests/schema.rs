//! The JSON Schema and the table of keys agree.

use serde_json::Value;

use crate::json_schema;
use crate::keys::{Form, KEYS};

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
    for key in KEYS {
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
        if let Form::Number(_) = key.form {
            assert_eq!(at.get("type"), Some(&Value::from("number")), "{}", key.path);
        }
    }
}
