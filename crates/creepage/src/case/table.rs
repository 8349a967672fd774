//! A table in columns in a file of its own, and how a friction table is read into the case.

use friction::{Table, TableError};
use output::files::input;
use toml::Value;

use crate::case::column::unit_size;
use crate::case::error::CaseError;
use crate::case::file::CaseFile;
use crate::case::layers::Layers;
use crate::case::places::Source;
use crate::case::quantity::rounded;
use crate::case::value::{get, listed};

const KEY: &str = "friction.table";

/// What the file of a friction table is.
pub const REMEDY: &str = "two columns: slip velocity, rising from 0, and coefficient, with a comma between and \
                          decimal points; in m/s and without a unit, or in the units that a heading names: \
                          `slip (mm/s), mu (%)`; lines that start with # are passed over";

/// What the columns of a file are, and their units in the case.
pub(crate) struct Columns<const N: usize> {
    /// Each with its article.
    pub what: [&'static str; N],
    /// SI units.
    pub units: [&'static str; N],
}

const FRICTION: Columns<2> =
    Columns { what: ["a slip velocity", "a coefficient of friction"], units: ["m/s", "-"] };

/// Replaces a path in `friction.table` by the points of that file: slip velocity (m/s) and coefficient. The path is
/// relative to the case file that holds it; of an option, to the working directory.
///
/// # Errors
/// A file that cannot be read, or is no table.
pub fn inline(layers: &mut Layers) -> Result<(), CaseError> {
    let read = |text: &str| Ok(read(text)?.points().to_vec());
    let points = of_file(layers, KEY, input::TABLE, REMEDY, read)?;
    if let (Some(points), Some(Value::Table(friction))) = (points, layers.table.get_mut("friction"))
    {
        friction.insert("table".into(), listed(&points));
    }
    Ok(())
}

/// What `read` finds in the file whose path is the value of `key`; none where it is no path.
///
/// # Errors
/// A file that cannot be read, or in which `read` finds a mistake.
pub(crate) fn of_file<T>(
    layers: &Layers,
    key: &str,
    kind: input::Kind,
    remedy: &str,
    read: impl Fn(&str) -> Result<T, Mistake>,
) -> Result<Option<T>, CaseError> {
    let Some(path) = layers.file_at(key) else { return Ok(None) };
    let text = input::text(&path, kind).map_err(|error| {
        let shown = get(&layers.table, key).and_then(Value::as_str).unwrap_or_default();
        let (_, relative) = layers.places.folder_of(key);
        layers.error(
            key,
            &format!("\"{shown}\": {}: {}", path.display(), error.problem()),
            &format!("give the path of a CSV file, {relative}"),
        )
    })?;
    let found = read(&text).map_err(|Mistake { line, problem, points }| {
        let source = Source::file(CaseFile::Disk(path.clone()), text.clone());
        let (span, message) = (line_span(&text, line), format!("{key}: {problem}"));
        // A file without a point may be any readable file, also a private one: nothing of it is quoted.
        if points {
            source.error(span, key, &message, remedy)
        } else {
            source.unquoted_error(span, key, &message, remedy)
        }
    })?;
    Ok(Some(found))
}

/// Bytes of a line, counted from 1.
fn line_span(text: &str, line: usize) -> std::ops::Range<usize> {
    let start = text.split_inclusive('\n').take(line - 1).map(str::len).sum::<usize>();
    let length = text[start..].lines().next().map_or(0, str::len);
    start..start + length
}

/// A mistake in a table, at a line counted from 1.
#[derive(Clone, Debug)]
pub struct Mistake {
    /// The line.
    pub line: usize,
    /// What is wrong.
    pub problem: String,
    /// Whether points stand before it: then the file is meant as a table, and may be quoted.
    pub points: bool,
}

/// The friction table in a text.
///
/// # Errors
/// Those of its columns, and points that are no friction law.
pub fn read(text: &str) -> Result<Table, Mistake> {
    let (points, lines) = columns(text, &FRICTION)?;
    Table::new(points).map_err(|error| {
        let number = match error {
            TableError::Range { number, .. } | TableError::Order { number, .. } => number,
            TableError::Start { .. } | TableError::Empty => 1,
        };
        Mistake::of_point(number, &lines, error.to_string())
    })
}

impl Mistake {
    /// In the point with this number, from 1, of those that stand in `lines`.
    pub(crate) fn of_point(number: usize, lines: &[usize], problem: String) -> Self {
        let line = lines.get(number - 1).copied().unwrap_or(1);
        Self { line, problem, points: !lines.is_empty() }
    }
}

/// How many numbers stand in the first line of a text that holds nothing else.
pub(crate) fn width(text: &str) -> Option<usize> {
    let numbers = |row: &str| fields(row).iter().all(|field| field.parse::<f64>().is_ok());
    text.lines().find(|row| numbers(row)).map(|row| fields(row).len())
}

/// The points in a text and the line of each: lines of `N` numbers with a comma between. Columns whose heading names a unit
/// are converted.
///
/// # Errors
/// A line of another kind, a unit that cannot be converted.
pub(crate) fn columns<const N: usize>(
    text: &str,
    columns: &Columns<N>,
) -> Result<(Vec<[f64; N]>, Vec<usize>), Mistake> {
    let mut points = Vec::new();
    let mut lines = Vec::new();
    let mut heading = None;
    let mut comments = Vec::new();
    let mut in_one = [1.0; N];
    // a byte order mark is no part of the heading
    for (line, row) in (1..).zip(text.trim_start_matches('\u{feff}').lines()) {
        let row = row.trim();
        if row.is_empty() {
            continue;
        }
        if let Some(comment) = row.strip_prefix('#') {
            comments.push((line, fields(comment)));
            continue;
        }
        let row_fields = fields(row);
        let parsed = |field: &&str| field.parse::<f64>().ok();
        let numbers: Option<Vec<f64>> = row_fields.iter().map(parsed).collect();
        let numbers = numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok());
        let words = row_fields.len() == N && row_fields.iter().all(|field| parsed(field).is_none());
        match numbers {
            Some(numbers) => {
                if points.is_empty() {
                    // only now is the file known to be a table, of which a message may quote the heading
                    in_one = units_in_one(heading.as_ref(), &comments, columns)?;
                }
                // 9 mm/s divided by 1000 are 0.009 m/s, times 1e-3 a bit more
                points.push(std::array::from_fn(|i| numbers[i] / in_one[i]));
                lines.push(line);
            }
            None if words && points.is_empty() && heading.is_none() => {
                heading = Some((line, row_fields));
            }
            None => {
                let points = !points.is_empty();
                let what = if points { format!("'{row}'") } else { "this line".into() };
                let problem = match row.contains([';', '\t']) {
                    true => format!("{what} has semicolons or tabs, where a comma must stand"),
                    false => format!("{what} is not {}", columns.what.join(" and ")),
                };
                return Err(Mistake { line, problem, points });
            }
        }
    }
    Ok((points, lines))
}

/// The fields of a line, of which those in quotes may hold commas.
fn fields(row: &str) -> Vec<&str> {
    let mut quoted = false;
    let outside = |c: char| {
        quoted ^= c == '"';
        c == ',' && !quoted
    };
    row.split(outside).map(|field| field.trim().trim_matches('"').trim()).collect()
}

type Heading<'a> = (usize, Vec<&'a str>);

/// How many units of each column are one of the case.
fn units_in_one<const N: usize>(
    heading: Option<&Heading>,
    comments: &[Heading],
    Columns { what, units }: &Columns<N>,
) -> Result<[f64; N], Mistake> {
    let mistake = |line: usize, problem: String| Err(Mistake { line, problem, points: true });
    if let Some((line, names)) = heading {
        let mut in_one = [1.0; N];
        for ((in_one, name), (unit, wanted)) in
            in_one.iter_mut().zip(names).zip(units.iter().zip(what))
        {
            match unit_size(name, unit) {
                Ok(size) => *in_one = rounded(1.0 / size),
                Err(other) => {
                    let problem = format!("'{name}': '{other}' is no known unit of {wanted}");
                    return mistake(*line, problem);
                }
            }
        }
        return Ok(in_one);
    }
    // a heading behind a # is passed over, and so would be its unit
    for (line, names) in comments {
        if names.len() != N {
            continue;
        }
        for (name, unit) in names.iter().zip(units) {
            if unit_size(name, unit).is_ok_and(|size| size != 1.0) {
                let problem =
                    format!("'{name}' names a unit, but stands in a line that starts with #");
                return mistake(*line, problem);
            }
        }
    }
    Ok([1.0; N])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points_of(text: &str) -> Vec<[f64; 2]> {
        let table = read(text).unwrap_or_else(|m| panic!("{}", m.problem));
        table.points().to_vec()
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
            ("s,mu\n0;0.5\n", 2, "semicolons or tabs"),
            ("s;mu\n0;0,5\n", 1, "semicolons or tabs"),
            ("0\t0.5\n", 1, "semicolons or tabs"),
            ("0,0,0,5\n", 1, "this line is not"),
        ] {
            let (at, problem) = mistake(text);
            assert!(at == line && problem.contains(words), "{text}: {at} {problem}");
        }
    }

    #[test]
    fn columns_are_converted_from_the_units_in_their_heading() {
        let expected = [[0.0, 0.5], [0.009, 0.32]];
        for text in [
            "slip (m/s),mu (-)\n0,0.5\n0.009,0.32\n",
            "slip (mm/s),mu\n0,0.5\n9,0.32\n",
            "\u{feff}\"slip, rms [\u{b5}m/s]\",\"mu (%)\"\n0,50\n9000,32\n",
        ] {
            assert_eq!(points_of(text), expected, "{text}");
        }
        for text in [
            "v in km/h,mu\n0,0.5\n36,0.3\n",
            "# measured (cold), dry\nslip_cm_s,mu(s)\n0,0.5\n1000,0.3\n",
        ] {
            assert_eq!(points_of(text), [[0.0, 0.5], [10.0, 0.3]], "{text}");
        }
    }

    #[test]
    fn a_unit_that_cannot_be_converted_is_refused_by_its_name() {
        for (text, line, words) in [
            ("slip (mm),mu\n0,0.5\n", 1, "'slip (mm)': 'mm' is no known unit of a slip velocity"),
            ("slip (knots),mu\n0,0.5\n", 1, "'knots'"),
            ("# a\ns,shear (MPa)\n0,0.5\n", 2, "'MPa' is no known unit of a coefficient"),
            ("mu,slip (m/s)\n0.5,0\n", 1, "'m/s' is no known unit of a coefficient"),
            ("# slip (mm/s),mu\n0,0.5\n9,0.3\n", 1, "starts with #"),
        ] {
            let (at, problem) = mistake(text);
            assert!(at == line && problem.contains(words), "{text}: {at} {problem}");
        }
    }

    #[test]
    fn nothing_of_a_file_without_a_point_is_quoted() {
        let (_, problem) = mistake("secret (key),word\nmore,of it\n");
        assert!(!problem.contains("secret") && !problem.contains("key"), "{problem}");
    }
}
