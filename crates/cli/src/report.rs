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
#[cfg(feature = "verify")]
pub mod verify;

use std::io::Write;

use serde_json::Value;

/// Prints one JSON document on standard output.
pub fn print_json(document: &Value) {
    // Pretty-printing a value cannot fail; a reader that closed the pipe wants no more.
    let text = serde_json::to_string_pretty(document).unwrap_or_default();
    let _ = writeln!(std::io::stdout(), "{text}");
}
