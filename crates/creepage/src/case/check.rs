//! Each key of a case against the table of keys: it exists, has the right type and lies in range.

use friction::Declaration;
use toml::{Table, Value};

use crate::case::error::{CaseError, KeyError, raise};
use crate::case::form::Form;
use crate::case::key::Key;
use crate::case::keys::{KEYS, Place, meant_key, names_in, nearest, place};
use crate::case::places::Places;
use crate::case::value::{get, join, number, show};
use crate::case::{quantity, units};

/// Most mistakes in one message: more would hide the first.
const MOST_MISTAKES: usize = 20;

/// Keys of a sweep file that no case has.
const SWEEP_KEYS: [&str; 2] = ["base", "axis"];

/// Checks every key of a case that was written at `places`: it exists, has the right type and lies in its range; none is
/// missing. Values become those that the case holds.
///
/// # Errors
/// All mistakes, the first with the others in [`KeyError::others`]; no more than some twenty.
pub fn keys(table: &mut Table, places: &Places) -> Result<(), CaseError> {
    if let Some(key) = SWEEP_KEYS.into_iter().find(|key| table.contains_key(*key)) {
        let message = format!("this is a sweep file and no case: it has the key `{key}`");
        let help = "use `creepage sweep` with it, or give its base, which is a case";
        return Err(places.error_at_name(key, key, &message, help).into());
    }
    let mut mistakes = Mistakes { places, found: Vec::new() };
    mistakes.in_section(table, "", "");
    if mistakes.are_too_many() {
        let more = format!("{MOST_MISTAKES} mistakes are shown, there may be more");
        let help = "see `creepage schema` for every key";
        mistakes.found.push(places.error_nowhere("", &more, help));
    } else {
        mistakes.in_what_is_missing(table);
    }
    raise(mistakes.found)
}

/// The mistakes in single keys. A `path` holds indices; its `pattern` holds `[]` in their place.
struct Mistakes<'a> {
    places: &'a Places,
    found: Vec<KeyError>,
}

impl Mistakes<'_> {
    fn are_too_many(&self) -> bool {
        self.found.len() >= MOST_MISTAKES
    }

    fn refuse(&mut self, path: &str, problem: &str, remedy: &str) {
        self.found.push(self.places.error(path, &format!("{path} = {problem}"), remedy));
    }

    fn in_section(&mut self, table: &mut Table, path: &str, pattern: &str) {
        for (name, value) in table {
            if self.are_too_many() {
                return;
            }
            let (path, pattern) = (join(path, name), join(pattern, name));
            let place = if name.contains('.') { Place::Nowhere } else { place(&pattern) };
            match (place, value) {
                (Place::Key(key), value) => match key.mistake(value) {
                    Some(problem) => self.refuse(&path, &problem, &remedy(key, value)),
                    None => key.hold(value),
                },
                (Place::Section, Value::Table(inner)) => self.in_section(inner, &path, &pattern),
                (Place::Section, other) => self.refuse(
                    &path,
                    &format!("{} must be a section", show(other)),
                    &format!("write a section [{path}] with its keys: {}", listed(&pattern)),
                ),
                (Place::List, list) => self.in_list(list, &path, &format!("{pattern}[]")),
                (Place::Nowhere, value) => self.unknown(&path, &pattern, value),
            }
        }
    }

    fn in_list(&mut self, list: &mut Value, path: &str, pattern: &str) {
        let remedy = format!("write sections [[{path}]] with the keys: {}", listed(pattern));
        let Value::Array(items) = list else {
            let problem = format!("{} must be a list of sections", show(list));
            return self.refuse(path, &problem, &remedy);
        };
        for (i, item) in items.iter_mut().enumerate() {
            if self.are_too_many() {
                return;
            }
            let path = format!("{path}[{i}]");
            let Value::Table(inner) = item else {
                let problem = format!("{} must be a section", show(item));
                self.refuse(&path, &problem, &remedy);
                continue;
            };
            self.in_section(inner, &path, pattern);
            for key in KEYS.iter().filter(|key| key.needed) {
                let below = key.path.strip_prefix(pattern).and_then(|rest| rest.strip_prefix('.'));
                if let Some(name) = below.filter(|name| !inner.contains_key(*name)) {
                    self.missing(&path, name, key);
                }
            }
        }
    }

    fn in_what_is_missing(&mut self, table: &Table) {
        // true for an unknown law, which was refused before
        let law = get(table, "friction.law").and_then(Value::as_str).and_then(Declaration::of);
        let needs_static = law.is_none_or(|law| law.has("static"));
        for key in KEYS.iter().filter(|key| key.is_always_needed()) {
            let Some((section, name)) = key.path.rsplit_once('.') else {
                continue;
            };
            // A section that is no table was refused before.
            let no_section = get(table, section).is_some_and(|value| !value.is_table());
            let spared = key.path == "friction.static" && !needs_static;
            if !no_section && !spared && get(table, key.path).is_none() {
                self.missing(section, name, key);
            }
        }
    }

    fn missing(&mut self, section: &str, name: &str, key: &Key) {
        let path = join(section, name);
        let message = format!("{path} is missing: it must be given, {}", key.allowed());
        let help = format!("in [{section}] {}", key.remedy);
        self.found.push(self.places.error_at_name(section, &path, &message, &help));
    }

    fn unknown(&mut self, path: &str, pattern: &str, value: &Value) {
        let message = format!("unknown key {path} = {}", show(value));
        let help = meant_key(pattern);
        self.found.push(self.places.error_at_name(path, path, &message, &help));
    }
}

/// The names in a section, for messages.
fn listed(section: &str) -> String {
    names_in(section).join(", ")
}

/// What to do where a value is refused: with the word that a misspelt one was most likely meant to be, or the number that
/// one in another unit was.
fn remedy(key: &Key, value: &Value) -> String {
    let meant = match (&key.form, value) {
        (Form::Word(words), Value::String(word)) => {
            nearest(word, words.iter().copied()).map(|near| format!("\"{near}\""))
        }
        (Form::Words(words), _) => {
            let given = value.as_array().map_or(std::slice::from_ref(value), Vec::as_slice);
            let wrong = given.iter().filter_map(Value::as_str).filter(|w| !words.contains(w));
            let near = wrong.filter_map(|word| nearest(word, words.iter().copied())).next();
            near.map(|near| format!("\"{near}\""))
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
