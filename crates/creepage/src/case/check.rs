//! Each key of a case against the table of keys: it exists, has the right type and lies in range.

use toml::{Table, Value};

use crate::case::error::{CaseError, KeyError};
use crate::case::forms::{float, whole};
use crate::case::key::{Form, Key, STIFFNESS, number};
use crate::case::keys::{self, KEYS};
use crate::case::layers::{Layers, get, join, key_error_in};
use crate::case::{quantity, units};
use friction::Declaration;

/// Most mistakes in one message: more would hide the first.
const MOST_MISTAKES: usize = 20;

/// Keys of a sweep file that no case has.
const SWEEP_KEYS: [&str; 2] = ["base", "axis"];

/// Checks every key: it exists, has the right type and lies in its range; none is missing.
///
/// # Errors
/// All mistakes, the first with the others in [`KeyError::others`]; no more than some twenty.
pub fn keys(layers: &Layers) -> Result<(), CaseError> {
    if let Some(key) = SWEEP_KEYS.into_iter().find(|key| layers.table.contains_key(*key)) {
        let message = format!("this is a sweep file and no case: it has the key `{key}`");
        let help = "use `creepage sweep` with it, or give its base, which is a case";
        return raise(vec![error_at_name(layers, key, key, &message, help)]);
    }
    let mut errors = Vec::new();
    check_table(layers, &layers.table, "", "", &mut errors);
    if errors.len() >= MOST_MISTAKES {
        let more = format!("{MOST_MISTAKES} mistakes are shown, there may be more");
        errors.push(layers.error_nowhere("", &more, "see `creepage schema` for every key"));
    } else {
        check_needed(layers, &mut errors);
    }
    raise(errors)
}

/// The error `message` about `key` at the place where the name of the key or section `named` was written, if it was.
fn error_at_name(layers: &Layers, named: &str, key: &str, message: &str, help: &str) -> KeyError {
    match layers.origins.get(named) {
        Some(origin) => {
            let source = layers.sources[origin.source].clone();
            key_error_in(source, origin.key.clone(), key, message, help)
        }
        None => layers.error_nowhere(key, message, help),
    }
}

/// The errors as one, if there are any.
///
/// # Errors
/// The first of `errors`, with the rest in [`KeyError::others`].
pub fn raise(mut errors: Vec<KeyError>) -> Result<(), CaseError> {
    if errors.is_empty() {
        return Ok(());
    }
    let mut first = errors.remove(0);
    first.others = errors;
    Err(CaseError::Key(Box::new(first)))
}

/// Walks a table; `path` holds indices, `pattern` holds `[]` in their place.
fn check_table(
    layers: &Layers,
    table: &Table,
    path: &str,
    pattern: &str,
    errors: &mut Vec<KeyError>,
) {
    for (name, value) in table {
        if errors.len() >= MOST_MISTAKES {
            return;
        }
        let (path, pattern) = (join(path, name), join(pattern, name));
        let section = format!("{pattern}.");
        let list = format!("{pattern}[].");
        let mistake = |problem: &str, remedy: &str| {
            layers.key_error(layers.origins.get(&path), &path, problem, remedy)
        };
        if name.contains('.') {
            errors.push(unknown(layers, &path, &pattern));
        } else if let Some(key) = keys::find(&pattern) {
            if let Some(problem) = refused(key, value) {
                errors.push(mistake(&problem, &remedy(key, value)));
            }
        } else if KEYS.iter().any(|key| key.path.starts_with(&section)) {
            match value {
                Value::Table(inner) => check_table(layers, inner, &path, &pattern, errors),
                other => errors.push(mistake(
                    &format!("{} must be a section", show(other)),
                    &format!("write a section [{path}] with its keys: {}", siblings(&section)),
                )),
            }
        } else if KEYS.iter().any(|key| key.path.starts_with(&list)) {
            let remedy = format!("write sections [[{path}]] with the keys: {}", siblings(&list));
            let Value::Array(items) = value else {
                let problem = format!("{} must be a list of sections", show(value));
                errors.push(mistake(&problem, &remedy));
                continue;
            };
            for (i, item) in items.iter().enumerate() {
                if errors.len() >= MOST_MISTAKES {
                    return;
                }
                let (path, pattern) = (format!("{path}[{i}]"), format!("{pattern}[]"));
                match item {
                    Value::Table(inner) => {
                        check_table(layers, inner, &path, &pattern, errors);
                        for key in KEYS.iter().filter(|k| k.needed && k.path.starts_with(&list)) {
                            let name = &key.path[list.len()..];
                            if !inner.contains_key(name) {
                                errors.push(missing(layers, &path, name, key));
                            }
                        }
                    }
                    other => errors.push(layers.key_error(
                        layers.origins.get(&path),
                        &path,
                        &format!("{} must be a section", show(other)),
                        &remedy,
                    )),
                }
            }
        } else {
            errors.push(unknown(layers, &path, &pattern));
        }
    }
}

fn check_needed(layers: &Layers, errors: &mut Vec<KeyError>) {
    for key in KEYS.iter().filter(|key| key.is_always_needed()) {
        let Some((section, name)) = key.path.rsplit_once('.') else {
            continue;
        };
        // A section that is no table was refused before.
        let no_section = get(&layers.table, section).is_some_and(|value| !value.is_table());
        let spared = key.path == "friction.static" && !needs_static(layers);
        if !no_section && !spared && get(&layers.table, key.path).is_none() {
            errors.push(missing(layers, section, name, key));
        }
    }
}

/// Whether the friction law uses `static`; true for an unknown law, which was refused before.
fn needs_static(layers: &Layers) -> bool {
    let law = get(&layers.table, "friction.law").and_then(Value::as_str);
    law.and_then(Declaration::of).is_none_or(|law| law.has("static"))
}

fn missing(layers: &Layers, section: &str, name: &str, key: &Key) -> KeyError {
    let path = join(section, name);
    let message = format!("{path} is missing: it must be given, {}", key.form.allowed(key.unit));
    let help = format!("in [{section}] {}", key.remedy);
    error_at_name(layers, section, &path, &message, &help)
}

/// Why a value is not allowed for its key, if it is not: the value, then what is allowed.
pub fn refused(key: &Key, value: &Value) -> Option<String> {
    let allowed = key.form.allowed(key.unit);
    let not_allowed = || Some(format!("{} must be {allowed}", show(value)));
    let fine = match (&key.form, value) {
        (Form::Number(range) | Form::Crown(range) | Form::OverTime(range), value)
            if float(value).is_some() =>
        {
            float(value).is_some_and(|x| range.holds(x))
        }
        (Form::OverTime(range), Value::Array(points)) => {
            let Some(points) = crate::case::table::points(points) else { return not_allowed() };
            match crate::case::creepage::mistake(&points, *range) {
                None => true,
                Some(problem) => return Some(format!("{}: {problem}", show(value))),
            }
        }
        (Form::Crown(_), Value::String(word)) => word == "flat",
        (Form::Count(low, high), value) => {
            whole(value).is_some_and(|n| (*low..=*high).contains(&n))
        }
        (Form::Flag, Value::Boolean(_)) | (Form::Text, Value::String(_)) => true,
        (Form::Word(words), Value::String(word)) => words.contains(&word.as_str()),
        (Form::Stiffness, Value::Table(table)) => {
            table.len() == 1
                && STIFFNESS.iter().any(|(name, range, _)| {
                    table.get(*name).and_then(float).is_some_and(|x| range.holds(x))
                })
        }
        (Form::Stiffness, value) => float(value).is_some_and(|x| STIFFNESS[0].1.holds(x)),
        (Form::Points(range), Value::Array(points)) => crate::case::table::points(points)
            .is_some_and(|points| points.iter().flatten().all(|x| range.holds(*x))),
        (Form::Curve(speeds, coefficients), Value::Array(points)) => {
            let Some(points) = crate::case::table::points(points) else { return not_allowed() };
            let beyond =
                |[speed, mu]: &[f64; 2]| !(speeds.holds(*speed) && coefficients.holds(*mu));
            if let Some(at) = points.iter().position(beyond) {
                let ([speed, mu], point) = (points[at].map(number), at + 1);
                return Some(format!(
                    "{}: point {point}, slip velocity {speed} m/s and coefficient {mu}: the first must be {speeds} m/s, \
                     the second {coefficients}",
                    show(value)
                ));
            }
            match friction::Table::new(points) {
                Ok(_) => true,
                Err(error) => return Some(format!("{}: {error}", show(value))),
            }
        }
        _ => false,
    };
    if fine { None } else { not_allowed() }
}

/// What to do where a value is refused: with the word that a misspelt one was most likely meant to be, or the number that
/// one in another unit was.
fn remedy(key: &Key, value: &Value) -> String {
    let meant = match (&key.form, value) {
        (Form::Word(words), Value::String(word)) => {
            nearest(word, words.iter().copied()).map(|near| format!("\"{near}\""))
        }
        (Form::Number(range) | Form::Crown(range) | Form::OverTime(range), Value::String(text)) => {
            quantity::in_unit(text, key.unit).filter(|x| range.holds(*x)).map(number)
        }
        _ => units::meant(key, value),
    };
    match meant {
        Some(meant) => format!("did you mean {meant}? {}", key.remedy),
        None => key.remedy.to_owned(),
    }
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

/// The keys and sections right below a prefix that ends in a dot.
fn siblings(prefix: &str) -> String {
    let mut names: Vec<&str> = Vec::new();
    for key in KEYS {
        if let Some(rest) = key.path.strip_prefix(prefix) {
            let name = rest.split(['.', '[']).next().unwrap_or(rest);
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names.join(", ")
}

fn unknown(layers: &Layers, path: &str, pattern: &str) -> KeyError {
    let help = suggestion(pattern);
    let value = get(&layers.table, path).map(|value| format!(" = {}", show(value)));
    let message = format!("unknown key {path}{}", value.unwrap_or_default());
    error_at_name(layers, path, path, &message, &help)
}

/// The remedy for an unknown key: a key of a similar name, if there is one, and the keys of its section. `pattern`
/// is the dotted path with `[]` for indices.
pub fn suggestion(pattern: &str) -> String {
    let (section, name) = match pattern.rsplit_once('.') {
        Some((section, name)) => (format!("{section}."), name),
        None => (String::new(), pattern),
    };
    let here = siblings(&section);
    let near = nearest(name, here.split(", "));
    let elsewhere = KEYS.iter().find(|key| key.path.rsplit('.').next() == Some(name));
    let place = if section.is_empty() {
        "at the top level".to_owned()
    } else {
        format!("in [{}]", section.trim_end_matches('.'))
    };
    match (near, elsewhere) {
        (Some(sibling), _) => format!("did you mean `{sibling}`? {place} there are: {here}"),
        (None, Some(key)) => format!("did you mean `{}`? {place} there are: {here}", key.path),
        (None, None) => format!("{place} there are: {here}"),
    }
}

/// The name that a misspelt one was most likely meant to be, if one is near enough.
pub fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    names
        .map(|other| (distance(name, other), other))
        .min()
        .filter(|(distance, other)| *distance <= 1 + other.len() / 4)
        .map(|(_, other)| other)
}

/// Levenshtein's distance; of `a` no more than the first 64 characters count.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().take(64).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
