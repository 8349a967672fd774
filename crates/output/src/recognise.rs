//! How result files of this program are recognised.

use crate::files::Made;
use crate::hdf5::Source;
use crate::layout::attribute;
use std::path::Path;

/// A grid that this program wrote, recognised by its root attribute `creepage_version`.
pub const VTKHDF: Made = Made {
    what: "file of results",
    endings: &["vtkhdf"],
    start: b"\x89HDF\r\n\x1a\n",
    marks: &[],
    proof: Some(is_ours),
};

/// Whether the file at `path` is an HDF5 file that this program wrote; false where it cannot be read.
pub fn is_ours(path: &Path) -> bool {
    Source::open(path).is_ok_and(|file| file.root_text(attribute::VERSION).is_ok())
}
