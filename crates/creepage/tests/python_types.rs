//! The types of the documents in the Python package are those of the library:
//! `BLESS=1 cargo test -p creepage-lib --test python_types` writes them.

#![allow(clippy::unwrap_used, missing_docs)]

use creepage::{CheckResult, StressProfile, Summary, SweepResult};
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};
use std::fmt::Write;

const HEAD: &str =
    "\"\"\"Types of the documents, written by the test `python_types` of creepage-lib.

A number that is not finite is None.
\"\"\"

from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from typing_extensions import NotRequired, TypedDict

";

/// The types that hold all documents, by their names.
fn definitions() -> Map<String, Value> {
    let mut generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    generator.subschema_for::<Summary>();
    generator.subschema_for::<CheckResult>();
    generator.subschema_for::<SweepResult>();
    generator.subschema_for::<StressProfile>();
    let mut definitions = generator.take_definitions(true);
    definitions.sort_keys();
    definitions
}

/// The name of the type that a schema refers to.
fn referred(schema: &Value) -> Option<&str> {
    schema["$ref"].as_str()?.rsplit('/').next()
}

/// The words that a schema allows.
fn words(schema: &Value) -> Vec<&str> {
    let of = |part: &'static str| schema[part].as_array().into_iter().flatten();
    let one = schema["const"].as_str();
    let of_parts = of("oneOf").chain(of("anyOf")).flat_map(words);
    one.into_iter().chain(of("enum").filter_map(Value::as_str)).chain(of_parts).collect()
}

/// A schema as a type of Python.
fn of(schema: &Value) -> String {
    if let Some(name) = referred(schema) {
        return name.to_owned();
    }
    if schema["x-numpy"] == true {
        return "NDArray[np.float64]".into();
    }
    let words = words(schema);
    if !words.is_empty() {
        return format!("Literal{words:?}");
    }
    if let Some(parts) = schema["anyOf"].as_array().or(schema["oneOf"].as_array()) {
        return parts.iter().map(of).collect::<Vec<_>>().join(" | ");
    }
    let kinds = match &schema["type"] {
        Value::Array(kinds) => kinds.iter().filter_map(Value::as_str).collect(),
        kind => kind.as_str().into_iter().collect::<Vec<_>>(),
    };
    let one = |kind: &&str| match *kind {
        "number" => "float".to_owned(),
        "integer" => "int".into(),
        "string" => "str".into(),
        "boolean" => "bool".into(),
        "null" => "None".into(),
        "array" if schema["items"].is_object() => format!("list[{}]", of(&schema["items"])),
        "array" => format!("list[{}]", of(&schema["prefixItems"][0])),
        "object" if schema["properties"].is_object() => "dict[str, Any]".into(),
        "object" => {
            let keys = referred(&schema["propertyNames"]).unwrap_or("str");
            format!("dict[{keys}, {}]", of(&schema["additionalProperties"]))
        }
        other => panic!("{other}"),
    };
    let kinds: Vec<_> = kinds.iter().map(one).collect();
    if kinds.is_empty() { "Any".into() } else { kinds.join(" | ") }
}

/// The file.
fn written(definitions: &Map<String, Value>) -> String {
    let about = |schema: &Value| {
        let text = schema["description"].as_str().unwrap_or_default();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let mut text = HEAD.to_owned();
    for (name, schema) in definitions {
        let Some(keys) = schema["properties"].as_object() else {
            writeln!(text, "# {}\n{name} = {}\n", about(schema), of(schema)).unwrap();
            continue;
        };
        writeln!(text, "# {}\n{name} = TypedDict(\n    \"{name}\",\n    {{", about(schema))
            .unwrap();
        let required = |key: &String| {
            schema["required"].as_array().is_some_and(|all| all.iter().any(|it| it == key))
        };
        let mut keys: Vec<_> = keys.iter().collect();
        keys.sort_by_key(|(key, _)| *key);
        for (key, of_key) in keys {
            let kind = of(of_key);
            let kind = if required(key) { kind } else { format!("NotRequired[{kind}]") };
            writeln!(text, "        \"{key}\": {kind},  # {}", about(of_key)).unwrap();
        }
        // keys of a map that stand beside the others
        let further = referred(&schema["propertyNames"]).map(|name| &definitions[name]);
        for word in further.map(words).unwrap_or_default() {
            let kind = of(&schema["additionalProperties"]);
            writeln!(text, "        \"{word}\": NotRequired[{kind}],").unwrap();
        }
        text += "    },\n)\n\n";
    }
    text.truncate(text.trim_end().len());
    text + "\n"
}

#[test]
fn the_python_package_has_the_types_of_the_results() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../python/python/creepage/_results.pyi");
    let wanted = written(&definitions());
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(path, &wanted).unwrap();
        return;
    }
    assert!(
        std::fs::read_to_string(path).unwrap() == wanted,
        "{path} differs from the results: BLESS=1 cargo test -p creepage-lib --test python_types"
    );
}
