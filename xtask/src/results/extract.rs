//! Values in the JSON that a command leaves, by a path such as `a > contact > traction_coefficient`.

use serde_json::{Map, Value};

/// The name of the step that a path begins with.
pub fn step_of(path: &str) -> &str {
    path.split(" > ").next().unwrap_or_default().trim()
}

/// All values at the path behind its first word, which names the step whose document this is.
pub fn in_step<'a>(document: &'a Value, path: &str) -> Vec<&'a Value> {
    let mut parts: Vec<&str> = path.split(" > ").map(str::trim).collect();
    parts.remove(0);
    at(document, &parts)
}

/// All values at a path. A part of it is a key, an index, `KEY=VALUE` (those objects of a list that
/// have this value; `&` joins several) or `^WORD` (those lines of a text that begin with it).
pub fn at<'a>(document: &'a Value, path: &[&str]) -> Vec<&'a Value> {
    let Some((part, rest)) = path.split_first() else { return vec![document] };
    let found: Vec<&Value> = match document {
        Value::Object(object) => object.get(*part).into_iter().collect(),
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
pub fn one<'a>(found: &[&'a Value], path: &str) -> Result<&'a Value, String> {
    match found {
        [value] => Ok(value),
        [] => Err(format!("{{{path}}} is not in what the command gave")),
        _ => Err(format!("{{{path}}} fits {} values", found.len())),
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
    let rows: Result<Vec<Value>, csv::Error> = reader
        .records()
        .map(|row| {
            let row = row?;
            let cells = heads.iter().zip(&row).map(|(head, cell)| (head.to_owned(), value(cell)));
            Ok(Value::Object(cells.collect::<Map<_, _>>()))
        })
        .collect();
    rows.map(Value::Array)
}

fn value(cell: &str) -> Value {
    match cell.parse::<f64>() {
        _ if cell.is_empty() => Value::Null,
        Ok(number) => Value::from(number),
        Err(_) => match cell {
            "true" => Value::Bool(true),
            "false" => Value::Bool(false),
            text => Value::from(text),
        },
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
            {"name": "b", "quantity": "x", "meshes": []},
        ]});
        let path = "v > results > name=a & quantity=nu = 0: x (m) > meshes > 0 > value";
        assert_eq!(in_step(&document, path), [&json!(1.5)]);
        assert_eq!(in_step(&document, "v > results > name=b > quantity"), [&json!("x")]);
        let none = in_step(&document, "v > results > name=c");
        assert!(one(&none, "v").unwrap_err().contains("not in what the command gave"));
        let twice = json!([{"k": 1, "v": 2}, {"k": 1, "v": 3}]);
        let two = in_step(&twice, "v > k=1 > v");
        assert!(one(&two, "v").unwrap_err().contains("fits 2 values"));
    }

    #[test]
    fn text_is_a_list_of_lines_and_csv_a_list_of_rows() {
        let lines = document("  tension   0  pass\n  cone  1e-10\n");
        assert_eq!(in_step(&lines, "c > ^cone"), [&json!("  cone  1e-10")]);
        let rows = table("name,x,y\nfirst,0.1,\nsecond,true,left\n").unwrap();
        assert_eq!(in_step(&rows, "s > name=first > x"), [&json!(0.1)]);
        assert_eq!(in_step(&rows, "s > name=first > y"), [&Value::Null]);
        assert_eq!(in_step(&rows, "s > name=second > x"), [&json!(true)]);
        assert!(table("a,b\n1\n").is_err());
    }
}
