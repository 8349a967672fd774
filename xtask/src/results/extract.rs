//! Values in the JSON that a command leaves, by a path such as `a > contact > traction_coefficient`.

use serde_json::{Map, Value};

/// The name of the step that a path begins with, and the path in what that step left.
pub fn split(path: &str) -> (&str, &str) {
    let (step, rest) = path.split_once(" > ").unwrap_or((path, ""));
    (step.trim(), rest)
}

/// All values at a path. A part of it is a key, an index, `KEY=VALUE` (those objects of a list that
/// have this value; `&` joins several) or `^WORD` (those lines of a text that begin with it).
pub fn at<'a>(document: &'a Value, path: &str) -> Vec<&'a Value> {
    if path.is_empty() {
        return vec![document];
    }
    let (part, rest) = split(path);
    let found: Vec<&Value> = match document {
        Value::Object(object) => object.get(part).into_iter().collect(),
        Value::Array(list) => match (part.parse::<usize>(), part.strip_prefix('^')) {
            (Ok(index), _) => list.get(index).into_iter().collect(),
            (_, Some(word)) => list.iter().filter(|line| begins(line, word)).collect(),
            _ => list.iter().filter(|item| holds(item, part)).collect(),
        },
        _ => Vec::new(),
    };
    found.into_iter().flat_map(|value| at(value, rest)).collect()
}

/// The one value at a path.
pub fn one<'a>(document: &'a Value, path: &str) -> Result<&'a Value, String> {
    match at(document, path)[..] {
        [value] => Ok(value),
        [] => Err("is not in what the command gave".into()),
        ref found => Err(format!("fits {} values", found.len())),
    }
}

fn begins(line: &Value, word: &str) -> bool {
    line.as_str().is_some_and(|line| line.split_whitespace().next() == Some(word))
}

fn holds(item: &Value, conditions: &str) -> bool {
    conditions.split(" & ").all(|condition| {
        let Some((key, wanted)) = condition.split_once('=') else { return false };
        match item.get(key.trim()) {
            Some(Value::String(text)) => text == wanted.trim(),
            Some(value) => wanted.trim().parse::<Value>().is_ok_and(|wanted| wanted == *value),
            None => false,
        }
    })
}

/// What a command left: JSON, or a list of lines.
pub fn document(text: &str) -> Value {
    let lines = || text.lines().map(Value::from).collect();
    serde_json::from_str(text).unwrap_or_else(|_| Value::Array(lines()))
}

/// A table of comma separated values as a list of objects; an empty cell is null.
pub fn table(text: &str) -> Result<Value, csv::Error> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let heads = reader.headers()?.clone();
    let row = |row: Result<csv::StringRecord, csv::Error>| {
        let row = row?;
        let cells = heads.iter().zip(&row).map(|(head, cell)| (head.to_owned(), value(cell)));
        Ok(Value::Object(cells.collect::<Map<_, _>>()))
    };
    reader.records().map(row).collect::<Result<_, _>>().map(Value::Array)
}

fn value(cell: &str) -> Value {
    match cell.parse::<f64>() {
        _ if cell.is_empty() => Value::Null,
        Ok(number) => Value::from(number),
        Err(_) => cell.parse::<bool>().map_or_else(|_| Value::from(cell), Value::from),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use serde_json::json;

    use super::*;

    #[test]
    fn a_path_leads_through_keys_indices_and_conditions() {
        let document = json!({"results": [
            {"name": "a", "quantity": "nu = 0: x (m)", "meshes": [{"value": 1.5}]},
            {"name": "b", "quantity": "x", "meshes": [], "n": 1},
            {"name": "c", "n": 1},
        ]});
        let path = "results > name=a & quantity=nu = 0: x (m) > meshes > 0 > value";
        assert_eq!(one(&document, path), Ok(&json!(1.5)));
        assert_eq!(split("v > results > name=b"), ("v", "results > name=b"));
        assert!(one(&document, "results > name=d").unwrap_err().contains("not in what"));
        assert!(one(&document, "results > n=1 > name").unwrap_err().contains("fits 2 values"));
    }

    #[test]
    fn text_is_a_list_of_lines_and_csv_a_list_of_rows() {
        let lines = document("  tension   0  pass\n  cone  1e-10\n");
        assert_eq!(one(&lines, "^cone"), Ok(&json!("  cone  1e-10")));
        let rows = table("name,x,y\nfirst,0.1,\nsecond,true,left\n").unwrap();
        let second = json!({"name": "second", "x": true, "y": "left"});
        assert_eq!(rows, json!([{"name": "first", "x": 0.1, "y": null}, second]));
        assert!(table("a,b\n1\n").is_err());
    }
}
