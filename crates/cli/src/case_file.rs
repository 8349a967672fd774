//! The case that a command computes from, and errors about its keys.

use std::path::Path;

use ::run::RunError;
use case::Case;

use crate::args::Args;
use crate::failure::Failure;

/// An error about a key of the case, with the line where the key was written.
pub fn placed(error: RunError, args: &Args, case: &Path, sets: &[String]) -> Failure {
    let text = text(args);
    match error.key() {
        Some(key) => {
            case::error_at_key(case, text, sets, key, &error.to_string(), &error.remedy()).into()
        }
        None => error.into(),
    }
}

/// Reads the case of a command, with `sets` laid over it, and says its warnings.
pub fn load(args: &Args, path: &Path, sets: &[String]) -> Result<Case, Failure> {
    let case = match text(args) {
        Some(text) => Case::from_text(text, path, sets)?,
        None => Case::load(path, sets)?,
    };
    case.warnings().iter().for_each(|warning| args.say(&format!("warning: {warning}")));
    Ok(case)
}

/// The case where it is not in a file.
fn text(args: &Args) -> Option<&str> {
    args.embedded.as_ref()?.case.as_deref()
}
