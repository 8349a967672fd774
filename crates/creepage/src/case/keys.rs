//! The table of all keys.

use crate::case::friction_law;
use crate::case::key::Form::{Count, Crown, Flag, Number, OverTime, Points, Stiffness, Text, Word};
use crate::case::key::{FLAG, Form, Key, STIFFNESS};
use crate::case::schema::{
    Bar, Case, Checkpoint, Contact, Damping, Disk, Drive, Element, Evaluate, Guards, HalfSpace,
    Load, Material, MaterialOverride, MeshSets, Meshing, Output, Penalty, Preload, Probes, Time,
    Window, Zone,
};

/// The keys of each section.
const SECTIONS: &[&[&[Key]]] = &[
    Case::KEYS,
    Disk::KEYS,
    Bar::KEYS,
    Material::KEYS,
    MaterialOverride::KEYS,
    Meshing::KEYS,
    MeshSets::KEYS,
    Zone::KEYS,
    HalfSpace::KEYS,
    Element::KEYS,
    Load::KEYS,
    Drive::KEYS,
    &[friction_law::LAW, friction_law::KEYS],
    Contact::KEYS,
    Penalty::KEYS,
    Damping::KEYS,
    Preload::KEYS,
    Time::KEYS,
    Evaluate::KEYS,
    Output::KEYS,
    Probes::KEYS,
    Window::KEYS,
    Checkpoint::KEYS,
    Guards::KEYS,
];

/// Every key of a case file.
pub const KEYS: &[Key] = &all_of::<{ count(SECTIONS) }>(SECTIONS);

const fn count(sections: &[&[&[Key]]]) -> usize {
    let (mut found, mut section) = (0, 0);
    while section < sections.len() {
        let mut place = 0;
        while place < sections[section].len() {
            found += sections[section][place].len();
            place += 1;
        }
        section += 1;
    }
    found
}

const fn all_of<const N: usize>(sections: &[&[&[Key]]]) -> [Key; N] {
    let mut all = [FLAG; N];
    let (mut found, mut section) = (0, 0);
    while section < sections.len() {
        let mut place = 0;
        while place < sections[section].len() {
            let keys = sections[section][place];
            let mut key = 0;
            while key < keys.len() {
                all[found] = keys[key];
                (found, key) = (found + 1, key + 1);
            }
            place += 1;
        }
        section += 1;
    }
    all
}

/// The row of a key by its path, indices written as `[]`.
pub fn find(path: &str) -> Option<&'static Key> {
    KEYS.iter().find(|key| key.path == path)
}

/// Whether every dotted path in a text is that of a key or a section, and every word in square brackets
/// that of a section. For assertions at compile time: see [`remedy!`](crate::remedy!) and [`key!`](crate::key!).
pub const fn names_only_keys(text: &str) -> bool {
    let text = text.as_bytes();
    let mut at = 0;
    while at < text.len() {
        let start = at;
        let mut dots = 0;
        while at < text.len() && (is_of_path(text[at]) || dotted(text, at)) {
            dots += (text[at] == b'.') as usize;
            at += 1;
        }
        let in_brackets =
            start > 0 && text[start - 1] == b'[' && at < text.len() && text[at] == b']';
        let begins = at > start && text[start].is_ascii_lowercase();
        if begins && (dots > 0 || in_brackets) && !is_there(text, start, at) {
            return false;
        }
        at += 1;
    }
    true
}

const fn is_of_path(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Whether there is a dot with a letter on both its sides.
const fn dotted(text: &[u8], at: usize) -> bool {
    text[at] == b'.'
        && at > 0
        && is_of_path(text[at - 1])
        && at + 1 < text.len()
        && text[at + 1].is_ascii_alphabetic()
}

/// Whether the bytes from `start` to `end` are the path of a key or of a section.
const fn is_there(text: &[u8], start: usize, end: usize) -> bool {
    let mut key = 0;
    while key < KEYS.len() {
        let path = KEYS[key].path.as_bytes();
        let mut same = 0;
        while start + same < end && same < path.len() && text[start + same] == path[same] {
            same += 1;
        }
        let whole = start + same == end;
        if whole && (same == path.len() || path[same] == b'.' || path[same] == b'[') {
            return true;
        }
        key += 1;
    }
    false
}

/// Whether the path is that of a list of sections.
pub fn is_list(path: &str) -> bool {
    KEYS.iter().any(|key| key.path.strip_prefix(path).is_some_and(|rest| rest.starts_with("[]")))
}

impl Form {
    /// What the form allows, as a noun phrase; `unit` is that of the key.
    pub fn allowed(&self, unit: &str) -> String {
        let unit = match unit {
            "" | "-" => String::new(),
            unit => format!(" {unit}"),
        };
        match self {
            Number(range) => {
                let none = if range.or_zero { "0, or " } else { "" };
                format!("{none}a number {range}{unit}")
            }
            Count(low, high) => format!("a whole number from {low} to {high}"),
            Flag => "true or false".into(),
            Word(words) => {
                let quoted: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
                quoted.join(" or ")
            }
            Text => "text in quotes".into(),
            Crown(range) => format!("\"flat\" or a number {range}{unit}"),
            Stiffness => {
                let [factor, areal, stability] = STIFFNESS;
                format!(
                    "a number {}, {{ stiffness = ... }} {} N/m^3, or {{ stability = ... }} {}",
                    factor.1, areal.1, stability.1
                )
            }
            Form::Curve(speed, mu) => format!(
                "the path of a CSV file or a list of pairs [slip velocity {speed} m/s, coefficient {mu}]"
            ),
            OverTime(range) => {
                format!(
                    "a number {range}{unit}, or a list of pairs [time, number], times in s rising from 0"
                )
            }
            Points(range) => format!("a list of pairs of numbers {range}{unit}"),
        }
    }
}
