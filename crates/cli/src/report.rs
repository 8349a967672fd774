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

use serde::Serialize;

use crate::terminal;

/// Prints one JSON document on standard output.
pub fn print_json(document: &impl Serialize) {
    // Only a key that is no text could prevent it.
    let text = serde_json::to_string_pretty(document).unwrap_or_default();
    terminal::print(format!("{text}\n").as_bytes());
}
