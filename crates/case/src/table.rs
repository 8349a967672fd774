//! A friction table in a file of its own, read into the case.

use files::input;
use friction::{Table, TableError};
use toml::Value;

use crate::error::CaseError;
use crate::layers::{Layers, Source, get, key_error_at, key_error_in, read_text};

const KEY: &str = "friction.table";
const REMEDY: &str = "two columns: slip velocity (m/s), rising from 0, and coefficient, with a comma between; \
                      a heading and lines that start with # are passed over";

/// Replaces a path in `friction.table` by the points of that file: slip velocity (m/s) and coefficient. The path is
/// relative to the case file that holds it; of an option, to the working directory.
///
/// # Errors
/// A file that cannot be read, or is no table.
pub fn inline(layers: &mut Layers) -> Result<(), CaseError> {
    let Some(file) = get(&layers.table, KEY).and_then(Value::as_str).map(str::to_owned) else {
        return Ok(());
    };
    let origin = layers.origins.get(KEY);
    let (folder, relative) = layers.paths_from(origin);
    let path = folder.join(&file);
    let text = read_text(&path, input::TABLE).map_err(|error| match error {
        CaseError::File { problem, .. } => layers.error(
            origin,
            KEY,
            &format!("\"{file}\": {}: {problem}", path.display()),
            &format!("give the path of a CSV file, {relative}"),
        ),
        other => other,
    })?;
    let points = read(&text).map_err(|Mistake { line, problem, points }| {
        let source = Source { name: path.display().to_string(), text: text.clone() };
        let message = format!("{KEY}: {problem}");
        let span = line_span(&text, line);
        // A file without a point may be any readable file, also a private one: nothing of it is quoted.
        CaseError::Key(Box::new(if points {
            key_error_in(source, span, KEY, &message, REMEDY)
        } else {
            key_error_at(&source, span, KEY, &message, REMEDY)
        }))
    })?;
    let value = points.map(|point| Value::from(point.to_vec())).collect::<Vec<_>>();
    if let Some(Value::Table(friction)) = layers.table.get_mut("friction") {
        friction.insert("table".into(), Value::Array(value));
    }
    Ok(())
}

/// The values as pairs of numbers, if all of them are.
pub fn points(values: &[Value]) -> Option<Vec<[f64; 2]>> {
    let number = crate::forms::float;
    let pair = |value: &Value| match value.as_array()?.as_slice() {
        [speed, mu] => Some([number(speed)?, number(mu)?]),
        _ => None,
    };
    values.iter().map(pair).collect()
}

/// Bytes of a line, counted from 1.
fn line_span(text: &str, line: usize) -> std::ops::Range<usize> {
    let start = text.split_inclusive('\n').take(line - 1).map(str::len).sum::<usize>();
    let length = text[start..].lines().next().map_or(0, str::len);
    start..start + length
}

/// A mistake in a table, at a line counted from 1.
struct Mistake {
    line: usize,
    problem: String,
    /// Whether points stand before it: then the file is meant as a table, and may be quoted.
    points: bool,
}

/// The points of a CSV file.
fn read(text: &str) -> Result<impl Iterator<Item = [f64; 2]>, Mistake> {
    let mut points = Vec::new();
    let mut lines = Vec::new();
    let mut headed = false;
    for (i, line) in text.lines().enumerate() {
        // a byte order mark is no part of the heading
        let row = line.trim_start_matches('\u{feff}').trim();
        if row.is_empty() || row.starts_with('#') {
            continue;
        }
        let numbers: Vec<Option<f64>> =
            row.split(',').map(|field| field.trim().parse().ok()).collect();
        match numbers[..] {
            [Some(speed), Some(mu)] => {
                points.push([speed, mu]);
                lines.push(i + 1);
            }
            [None, None] if points.is_empty() && !headed => headed = true,
            _ => {
                let points = !points.is_empty();
                let what = if points { format!("'{row}'") } else { "this line".into() };
                let problem = format!("{what} is not a slip velocity and a coefficient");
                return Err(Mistake { line: i + 1, problem, points });
            }
        }
    }
    let table = Table::new(points).map_err(|error| {
        let number = match error {
            TableError::Range { number, .. } | TableError::Order { number, .. } => number,
            TableError::Start { .. } | TableError::Empty => 1,
        };
        let line = lines.get(number - 1).copied().unwrap_or(1);
        Mistake { line, problem: error.to_string(), points: !lines.is_empty() }
    })?;
    Ok(table.points().to_vec().into_iter())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points_of(text: &str) -> Vec<[f64; 2]> {
        read(text).map(Iterator::collect).unwrap_or_else(|m| panic!("{}", m.problem))
    }

    fn mistake(text: &str) -> (usize, String) {
        let Mistake { line, problem, .. } = read(text).map(|_| ()).unwrap_err();
        (line, problem)
    }

    #[test]
    fn headings_comments_and_blank_lines_are_passed_over() {
        let expected = [[0.0, 0.5], [1.5, 0.4]];
        assert_eq!(points_of("0,0.5\n1.5, 0.4\n"), expected);
        assert_eq!(points_of("# measured\r\ns,mu\r\n\r\n0,0.5\r\n1.5,0.4"), expected);
    }

    #[test]
    fn a_mistake_is_told_with_its_line() {
        for (text, line, words) in [
            ("s,mu\n0,0.5\n# down\n0,0.4\n", 4, "above that of the point before"),
            ("0,0.5\n1,-0.1\n", 2, "at least 0"),
            ("0,0.5\n1,x\n", 2, "'1,x'"),
            ("0,0.5\n1\n", 2, "'1'"),
            ("s,mu\nspeed,mu\n", 2, "this line is not"),
            ("\n\n1,0.5\n", 3, "starts at"),
            ("", 1, "empty"),
        ] {
            let (at, problem) = mistake(text);
            assert!(at == line && problem.contains(words), "{text}: {at} {problem}");
        }
    }
}
