//! What a sweep came to, found by its folder.

use std::path::Path;

use crate::check::PostError;
use crate::sweep::{SweepResult, Table};
use output::files::input;

use crate::Error;

/// What `sweep.json` in `folder` holds; `None` where there is none.
pub fn read(folder: &Path) -> Result<Option<SweepResult>, Error> {
    let path = folder.join("sweep.json");
    let failed = |reason: String| Error::from(PostError::Text { path: path.clone(), reason });
    let text = match input::text(&path, input::DOCUMENT) {
        Ok(text) => text,
        Err(error) if error.is_missing() => return Ok(None),
        Err(error) => return Err(failed(error.problem())),
    };
    serde_json::from_str(&text).map(Some).map_err(|error| {
        failed(format!("{}: {error}", if error.is_data() { "is no sweep" } else { "is no JSON" }))
    })
}

/// The table of the sweep in `folder`, and what it came to; `None` where there is none.
///
/// # Errors
/// A `sweep.json` that cannot be read.
pub fn sweep_table(folder: &Path) -> Result<Option<(Table, SweepResult)>, Error> {
    Ok(read(folder)?.map(|result| (Table::of(&result), result)))
}

/// The name of a sweep: that of its folder.
pub fn name(folder: &Path) -> String {
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
