//! No key is given that another makes useless, and none is missing that another needs, by the table of keys.

use toml::{Table, Value};

use super::Findings;
use crate::case::key::Key;
use crate::case::keys::KEYS;
use crate::case::schema::Case;
use crate::case::value::{get, join, quoted, remove};

/// Checks each key against those that it depends on or stands for.
pub(super) fn check(case: &Case, found: &mut Findings<'_>) {
    // A case holds nothing that TOML cannot.
    let mut given = Table::try_from(case).unwrap_or_default();
    drop_default_crowns(&mut given, found);
    for key in KEYS.iter() {
        let is_given = get(&given, key.path).is_some();
        let rival = key.instead_of.filter(|other| is_given && get(&given, other).is_some());
        match (rival, key.only) {
            (Some(other), _) => {
                let path = key.path;
                found.require(
                    path > other,
                    &[path, other],
                    format_args!("{path} and {other} are both given"),
                    "give one of them, not both",
                );
            }
            (None, Some((other, words))) => {
                check_use(key, is_given, (other, words), get(&given, other), found);
            }
            (None, None) => {}
        }
    }
}

/// Removes the crowns that no file gives, where there is a profile in their place.
fn drop_default_crowns(given: &mut Table, found: &Findings<'_>) {
    for [profile, crown] in
        ["disk", "bar"].map(|body| ["profile", "crown_radius"].map(|key| join(body, key)))
    {
        if get(given, &profile).is_some() && !found.places.origins.contains_key(crown.as_str()) {
            remove(given, &crown);
        }
    }
}

/// Checks a key that is used only where `other`, which now has the value `now`, is one of `words`.
fn check_use(
    key: &Key,
    is_given: bool,
    (other, words): (&str, &[&str]),
    now: Option<&Value>,
    found: &mut Findings<'_>,
) {
    let path = key.path;
    let word = now.and_then(Value::as_str).unwrap_or_default();
    let used = now.is_some() && (words.is_empty() || words.contains(&word));
    let (problem, remedy) = match words {
        [] => (format!("without {other}"), format!("give {other}")),
        _ => (format!("with {other} = \"{word}\""), format!("set {other} = {}", quoted(words))),
    };
    found.require(
        used || !is_given,
        &[path, other],
        format_args!("{path} is not used {problem}"),
        &format!("{remedy}, or leave {path} out"),
    );
    let section = path.split('.').next().unwrap_or(path);
    found.require(
        !key.needed || !used || is_given,
        &[other, section],
        format_args!("{path} is missing: {other} = \"{word}\" needs it, {}", key.allowed()),
        &format!("in [{section}] {}", key.remedy),
    );
}
