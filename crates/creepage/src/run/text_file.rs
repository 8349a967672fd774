//! The small files of a run beside its results.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use output::NotWritten;

/// Removes a file if it is there.
pub(crate) fn remove(path: &Path) -> Result<(), NotWritten> {
    match std::fs::remove_file(path) {
        Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => {
            Err(NotWritten { path: path.to_owned(), cause })
        }
        _ => Ok(()),
    }
}

/// Writes a TOML file under another name, syncs it to the disk and renames it: a kill or a power cut leaves the old
/// text or the new one.
pub(crate) fn write_text(path: PathBuf, text: &str) -> Result<(), NotWritten> {
    let partial = path.with_extension("toml.partial");
    let write = || {
        let mut file = File::create(&partial)?;
        file.write_all(text.as_bytes())?;
        file.sync_all()?;
        std::fs::rename(&partial, &path)
    };
    write().map_err(|cause| NotWritten { path, cause })
}
