use crate::OutputError;
use serde::Serialize;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes `value` as indented JSON to `path`, which holds the complete old text or the complete new one at any
/// time: the text goes to a temporary file beside it, which is synced and then renamed.
///
/// # Errors
/// A path without a file name, a value that is no JSON, a file that cannot be written.
pub fn write_json_atomically<T: Serialize + ?Sized>(
    path: impl AsRef<Path>,
    value: &T,
) -> Result<(), OutputError> {
    let path = path.as_ref();
    let failed = |reason: String| OutputError::Create { path: path.to_owned(), reason };
    let mut name =
        path.file_name().ok_or_else(|| failed("the path names no file".into()))?.to_owned();
    name.push(".partial");
    let partial = path.with_file_name(name);
    let write = || -> std::io::Result<()> {
        let mut out = BufWriter::new(File::create(&partial)?);
        serde_json::to_writer_pretty(&mut out, value)?;
        out.write_all(b"\n")?;
        out.into_inner()?.sync_all()?;
        std::fs::rename(&partial, path)
    };
    write().map_err(|error| {
        // An incomplete temporary file is of no use; the error to report is `error`.
        let _ = std::fs::remove_file(&partial);
        failed(error.to_string())
    })
}
