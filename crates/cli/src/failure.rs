//! The documents of commands that fail.

use creepage::{BAD_INPUT, Error};
use miette::Diagnostic;
use serde_json::{Value, json};

/// The JSON document of a failure: what was wrong, what to do, and what else was wrong.
pub fn document(error: &Error) -> Value {
    let mut document = failure(&error.to_string(), error.exit_code());
    let help = |diagnostic: &dyn Diagnostic| diagnostic.help().map(|help| help.to_string());
    document["help"] = json!(help(error).unwrap_or_default());
    let others = error.related().into_iter().flatten();
    let others: Vec<_> =
        others.map(|other| json!({ "error": other.to_string(), "help": help(other) })).collect();
    document["others"] = json!(others);
    document
}

/// The JSON document of wrong usage, from the text for the terminal: the first paragraph says what was wrong, the others
/// what to do.
pub fn usage(text: &str) -> Value {
    let (error, help) = text.split_once("\n\n").unwrap_or((text, ""));
    let words: Vec<_> = error.trim_start_matches("error: ").split_whitespace().collect();
    let mut document = failure(&words.join(" "), BAD_INPUT);
    document["help"] = json!(help.trim());
    document
}

/// The JSON document of a command that failed: with `--json`, standard output holds one document
/// whatever happens.
pub fn failure(message: &str, code: u8) -> Value {
    json!({ "status": "failed", "exit_code": code, "error": message })
}
