//! The document of a sweep, found by its folder.

use std::path::Path;

use crate::check::PostError;
use crate::sweep::Table;
use output::files::input;
use serde_json::Value;

use crate::Error;

/// What `sweep.json` in `folder` holds; `None` where there is none.
pub fn read(folder: &Path) -> Result<Option<Value>, Error> {
    let path = folder.join("sweep.json");
    let failed = |reason: String| Error::from(PostError::Text { path: path.clone(), reason });
    let text = match input::text(&path, input::DOCUMENT) {
        Ok(text) => text,
        Err(error) if error.is_missing() => return Ok(None),
        Err(error) => return Err(failed(error.problem())),
    };
    serde_json::from_str(&text).map(Some).map_err(|error| failed(format!("is no JSON: {error}")))
}

/// The table of the sweep in `folder`, and its document; `None` where there is none.
///
/// # Errors
/// A document that cannot be read.
pub fn sweep_table(folder: &Path) -> Result<Option<(Table, Value)>, Error> {
    Ok(read(folder)?.map(|document| (Table::of(&document), document)))
}

/// The name of a sweep: that of its folder.
pub fn name(folder: &Path) -> String {
    let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
