//! The table of all keys.

use std::sync::LazyLock;

use crate::case::key::Key;
use crate::case::schema::Case;
use crate::case::section::Section;

/// Every key of a case file.
pub static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| Case::keys(""));

/// The row of a key by its path, indices written as `[]`.
pub fn find(path: &str) -> Option<&'static Key> {
    KEYS.iter().find(|key| key.path == path)
}

/// What a path names.
#[derive(Clone, Copy, Debug)]
pub enum Place {
    /// A key.
    Key(&'static Key),
    /// A section.
    Section,
    /// A list of sections.
    List,
    /// Nothing of a case.
    Nowhere,
}

/// What a path names, indices written as `[]`.
pub fn place(path: &str) -> Place {
    let rests = KEYS.iter().filter_map(|key| Some((key, key.path.strip_prefix(path)?)));
    let mut places = rests.filter_map(|(key, rest)| match rest {
        "" => Some(Place::Key(key)),
        rest if rest.starts_with('.') => Some(Place::Section),
        rest if rest.starts_with("[]") => Some(Place::List),
        _ => None,
    });
    places.next().unwrap_or(Place::Nowhere)
}

/// The names of the keys and sections right below a section, keys first; all of the file's top for an empty path.
pub fn names_in(section: &str) -> Vec<&'static str> {
    let prefix = if section.is_empty() { String::new() } else { format!("{section}.") };
    let mut below: Vec<&str> =
        KEYS.iter().filter_map(|key| key.path.strip_prefix(prefix.as_str())).collect();
    below.sort_by_key(|rest| rest.contains(['.', '[']));
    let mut names: Vec<&str> =
        below.iter().map(|rest| rest.split(['.', '[']).next().unwrap_or(rest)).collect();
    names.dedup();
    names
}

/// Characters of a name that are looked at.
const LONGEST: usize = 64;

/// The name that a misspelt one was most likely meant to be, if one is near enough by Levenshtein's distance.
pub fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let name: String = name.chars().take(LONGEST).collect();
    names
        .map(|other| (strsim::levenshtein(&name, other), other))
        .min()
        .filter(|(distance, other)| *distance <= 1 + other.len() / 4)
        .map(|(_, other)| other)
}

/// The remedy for an unknown key: a key of a similar name, if there is one, and the keys of its section. `pattern`
/// is the dotted path with `[]` for indices.
pub fn meant_key(pattern: &str) -> String {
    let (section, name) = pattern.rsplit_once('.').unwrap_or(("", pattern));
    let here = names_in(section);
    let paths = KEYS.iter().map(|key| key.path);
    let same_name = paths.filter(|path| path.rsplit('.').next() == Some(name));
    let elsewhere = same_name.min_by_key(|path| path.matches('.').count());
    let meant = nearest(name, here.iter().copied()).or(elsewhere);
    let meant = meant.map(|meant| format!("did you mean `{meant}`? ")).unwrap_or_default();
    let place =
        if section.is_empty() { "at the top level".to_owned() } else { format!("in [{section}]") };
    format!("{meant}{place} there are: {}", here.join(", "))
}
