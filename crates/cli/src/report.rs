//! What a command prints when its work is done.

pub mod bench;
pub mod check;
pub mod compare;
pub mod files;
pub mod layout;
pub mod mesh;
pub mod run;
pub mod slider;
pub mod sweep;

use serde_json::Value;

use crate::terminal;

/// Prints one JSON document on standard output.
pub fn print_json(document: &Value) {
    // Pretty-printing a value cannot fail.
    let text = serde_json::to_string_pretty(document).unwrap_or_default();
    terminal::print(format!("{text}\n").as_bytes());
}
