//! The JSON Schema of a case file, for editors and for people.

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

use crate::case::form::{Form, Range, STIFFNESS};
use crate::case::key::Key;
use crate::case::keys::KEYS;
use crate::case::schema::Case;
use friction::LAWS;

/// The JSON Schema (draft 2020-12) of a case file, with every key's unit and allowed range.
pub fn json_schema() -> Value {
    let settings = SchemaSettings::draft2020_12().with(|s| s.inline_subschemas = true);
    let mut schema = settings.into_generator().into_root_schema_for::<Case>().to_value();
    drop_nulls(&mut schema);
    for key in KEYS.iter() {
        if let Some(at) = locate(&mut schema, key.path) {
            annotate(at, key);
        }
    }
    allow_extending(&mut schema);
    if let Some(top) = schema.as_object_mut() {
        top.insert("title".into(), json!("Creepage case"));
    }
    schema
}

/// Removes the defaults of keys that are left out: TOML has no null.
fn drop_nulls(schema: &mut Value) {
    match schema {
        Value::Object(map) => {
            map.retain(|_, value| !value.is_null());
            map.values_mut().for_each(drop_nulls);
        }
        Value::Array(items) => items.iter_mut().for_each(drop_nulls),
        _ => {}
    }
}

/// The schema of one key, by its path in the table of keys.
fn locate<'a>(schema: &'a mut Value, path: &str) -> Option<&'a mut Map<String, Value>> {
    let mut at = schema;
    for segment in path.split('.') {
        at = at.get_mut("properties")?.get_mut(segment.trim_end_matches("[]"))?;
        if segment.ends_with("[]") {
            at = at.get_mut("items")?;
        }
    }
    at.as_object_mut()
}

fn annotate(schema: &mut Map<String, Value>, key: &Key) {
    // an optional key is left out
    if let Some(Value::Array(types)) = schema.get("type") {
        let kept = types.iter().find(|name| *name != "null").cloned();
        schema.insert("type".into(), kept.unwrap_or(Value::Null));
    }
    if let Some(Value::Array(choices)) = schema.get_mut("anyOf") {
        choices.retain(|choice| choice.get("type") != Some(&json!("null")));
    }
    if !key.unit.is_empty() {
        schema.insert("x-unit".into(), json!(key.unit));
    }
    match key.form {
        Form::Number(range) => limit(schema, range),
        Form::Count(low, high) => {
            schema.insert("minimum".into(), json!(low));
            schema.insert("maximum".into(), json!(high));
        }
        Form::Crown(range) | Form::OverTime(range) => limit_form(schema, 0, "", range),
        Form::Stiffness => {
            for (form, (name, range, _)) in STIFFNESS.into_iter().enumerate() {
                limit_form(schema, form, name, range);
            }
        }
        _ => {}
    }
    let said = schema.get("description").and_then(Value::as_str).unwrap_or_default();
    let mut description = format!("{said}\nAllowed: {}.", key.allowed());
    if let Some(model) = key.model {
        description += &format!("\nOnly with model = \"{}\".", model.word());
    }
    schema.insert("description".into(), json!(description));
}

fn limit(schema: &mut Map<String, Value>, range: Range) {
    if range.or_zero {
        let none_or = json!([{ "const": 0.0 }, { "minimum": range.low }]);
        schema.insert("anyOf".into(), none_or);
    } else {
        schema.insert("minimum".into(), json!(range.low));
    }
    schema.insert("maximum".into(), json!(range.high));
}

/// Limits one of the forms of a value, or the key `name` of it.
fn limit_form(schema: &mut Map<String, Value>, form: usize, name: &str, range: Range) {
    let at = schema.get_mut("oneOf").and_then(|forms| forms.get_mut(form));
    let at = match name {
        "" => at,
        name => at.and_then(|at| at.pointer_mut(&format!("/properties/{name}"))),
    };
    if let Some(at) = at.and_then(Value::as_object_mut) {
        limit(at, range);
    }
}

/// Keys that a case must have may come from the file that it extends.
fn allow_extending(schema: &mut Value) {
    let mut required = Map::new();
    for key in KEYS.iter().filter(|key| key.is_always_needed()) {
        let Some((section, name)) = key.path.rsplit_once('.') else {
            continue;
        };
        let section = required.entry(section).or_insert_with(|| json!({ "required": [] }));
        if let Some(names) = section.get_mut("required").and_then(Value::as_array_mut) {
            names.push(json!(name));
        }
    }
    // a law may do without the coefficient at rest
    if let Some(friction) = required.get_mut("friction") {
        let without = LAWS.iter().filter(|law| !law.has("static")).map(|law| law.word);
        let law = json!({ "enum": without.collect::<Vec<_>>() });
        let then = std::mem::take(friction);
        *friction = json!({
            "if": { "not": { "required": ["law"], "properties": { "law": law } } },
            "then": then
        });
    }
    for section in required.keys() {
        if let Some(at) = locate(schema, section) {
            at.remove("required");
        }
    }
    let sections: Vec<_> = required.keys().cloned().collect();
    if let Some(top) = schema.as_object_mut() {
        top.remove("required");
        top.insert("if".into(), json!({ "not": { "required": ["extends"] } }));
        top.insert("then".into(), json!({ "required": sections, "properties": required }));
    }
}
