//! Values of a TOML table: found by their dotted path, read as numbers, shown in messages.

use toml::{Table, Value};

/// `prefix.key`; the key alone where the prefix is empty.
pub fn join(prefix: &str, key: &str) -> String {
    if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") }
}

/// The value at a dotted path without indices, if there is one.
pub fn get<'a>(table: &'a Table, path: &str) -> Option<&'a Value> {
    match path.split_once('.') {
        Some((section, rest)) => get(table.get(section)?.as_table()?, rest),
        None => table.get(path),
    }
}

/// Removes the value at a dotted path without indices; whether there was one.
pub(crate) fn remove(table: &mut Table, path: &str) -> bool {
    match path.split_once('.') {
        Some((section, rest)) => {
            let inner = table.get_mut(section).and_then(Value::as_table_mut);
            inner.is_some_and(|inner| remove(inner, rest))
        }
        None => table.remove(path).is_some(),
    }
}

/// The number that a value holds, written as a float or as an integer; none for any other value.
pub fn float(value: &Value) -> Option<f64> {
    match value {
        Value::Float(x) => Some(*x),
        Value::Integer(n) => Some(*n as f64),
        _ => None,
    }
}

/// The number that a value holds, if it is whole and at least 0, written as an integer or as a float such as `1e2`; none
/// for any other value.
pub fn whole(value: &Value) -> Option<u64> {
    /// Every whole number up to this is a float.
    const LARGEST: f64 = 9_007_199_254_740_992.0;
    match value {
        Value::Integer(n) => u64::try_from(*n).ok(),
        Value::Float(x) if x.fract() == 0.0 && (0.0..=LARGEST).contains(x) => Some(*x as u64),
        _ => None,
    }
}

/// The pairs (or `N` at a time) of numbers that a value holds, if it is a list of them.
pub fn points<const N: usize>(value: &Value) -> Option<Vec<[f64; N]>> {
    let point = |value: &Value| {
        let numbers: Vec<f64> = value.as_array()?.iter().map(float).collect::<Option<_>>()?;
        numbers.try_into().ok()
    };
    value.as_array()?.iter().map(point).collect()
}

/// A list of points as a value.
pub fn listed<const N: usize>(points: &[[f64; N]]) -> Value {
    Value::Array(points.iter().map(|point| Value::from(point.to_vec())).collect())
}

/// A number as a person would write it.
pub fn number(x: f64) -> String {
    let size = x.abs();
    if size != 0.0 && !(1e-3..1e6).contains(&size) { format!("{x:e}") } else { format!("{x}") }
}

/// A computed number with at most four digits.
pub(crate) fn digits(x: f64) -> String {
    let rounded = format!("{x:.3e}").parse().unwrap_or(x);
    number(rounded)
}

/// A value as it would be written in a file, with at most 60 characters.
pub fn show(value: &Value) -> String {
    let text = match value {
        Value::Float(x) => number(*x),
        other => other.to_string(),
    };
    if text.chars().count() <= 60 {
        return text;
    }
    let head: String = text.chars().take(57).collect();
    format!("{head}...")
}

/// Words in quotes, with `or` between them.
pub(crate) fn quoted(words: &[&str]) -> String {
    let words: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
    words.join(" or ")
}
