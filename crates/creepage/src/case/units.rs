//! The units of a case: as comments behind the numbers of its text, and where a value looks as if given in another one.

use crate::case::form::{Form, STIFFNESS};
use crate::case::key::Key;
use crate::case::keys::{self, KEYS};
use crate::case::value::{digits, float, get, join, number, points, show};
use toml::{Table, Value};

/// What a resolved case begins with.
const HEAD: &str =
    "# As resolved, every default written out. SI units; a number without a unit has none.\n";

/// The TOML text of a case, one key a line, with the unit of each key behind its value.
pub(crate) fn with_units(text: &str) -> String {
    let mut noted = HEAD.to_owned();
    let mut section = String::new();
    let mut open = None;
    for line in text.lines() {
        noted.push_str(line);
        match open {
            Some(quotes) => open = Some(quotes).filter(|quotes| !line.contains(*quotes)),
            None => {
                if let Some(header) = line.strip_prefix('[') {
                    let list = if header.starts_with('[') { "[]" } else { "" };
                    section = format!("{}{list}", header.trim_matches(['[', ']']));
                } else if let Some((name, value)) = line.split_once(" = ") {
                    let quotes = ["\"\"\"", "'''"].into_iter().find(|q| value.starts_with(q));
                    open = quotes.filter(|quotes| !value[3..].contains(quotes));
                    // a word in the place of a number has no unit
                    let unit = unit_of(&section, name).filter(|_| !value.starts_with(['"', '\'']));
                    if let Some(unit) = unit {
                        noted.push_str(&format!("  # {unit}"));
                    }
                }
            }
        }
        noted.push('\n');
    }
    noted
}

/// The unit of a key, if it has one.
fn unit_of(section: &str, name: &str) -> Option<&'static str> {
    let unit = match (keys::find(&join(section, name)), keys::find(section)) {
        (Some(key), _) => key.unit,
        // a penalty stiffness by its name
        (None, Some(key)) if key.form == Form::Stiffness => {
            STIFFNESS.iter().find(|(form, ..)| *form == name)?.2
        }
        _ => return None,
    };
    Some(unit).filter(|unit| !unit.is_empty() && *unit != "-")
}

/// One sentence for each value that is not plausible in the unit of its key but would be in another one.
pub(crate) fn mistaken(case: &Table) -> Vec<String> {
    let mistake = |key: &Key| {
        let value = get(case, key.path)?;
        let (meant, value) = (meant(key, value)?, show(value));
        let unit = if key.unit == "-" { String::new() } else { format!(" {}", key.unit) };
        Some(format!("{} = {value}{unit} is unusual: did you mean {meant}?", key.path))
    };
    KEYS.iter().filter_map(mistake).collect()
}

/// What a value that is not plausible was likely meant to be: it as if given in the other units in which people think of
/// this quantity, where it is plausible then.
pub(crate) fn meant(key: &Key, value: &Value) -> Option<String> {
    let usual = key.usual.as_ref()?;
    let x = furthest(value).filter(|x| x.is_finite() && !usual.range.holds(*x))?;
    let readings = usual.also_in.iter().map(|(unit, size)| (unit, x * size));
    let plausible = readings.filter(|(_, meant)| usual.range.holds(*meant));
    let texts = plausible.map(|(unit, meant)| format!("{} ({} {unit})", digits(meant), number(x)));
    let texts: Vec<_> = texts.collect();
    (!texts.is_empty()).then(|| texts.join(" or "))
}

/// The number, or that of a table over time with the largest size.
fn furthest(value: &Value) -> Option<f64> {
    let of_table = || {
        let values = points(value)?.into_iter().map(|[_, x]| x);
        values.max_by(|a, b| a.abs().total_cmp(&b.abs()))
    };
    float(value).or_else(of_table)
}
