use crate::OutputError;
use serde::Serialize;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes `value` as indented JSON so that `path` holds either the old text or the new one whole:
/// to a neighbouring file first, synchronised, then renamed into place.
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
        // The half-written neighbour is of no use to anyone; the error that matters is `error`.
        let _ = std::fs::remove_file(&partial);
        failed(error.to_string())
    })
}
