//! How result files of this program are known.

use crate::hdf5::Source;
use crate::layout::attribute;
use files::Made;
use std::path::Path;

/// A grid that this program wrote, by the attribute `creepage_version` of its root.
pub const VTKHDF: Made = Made {
    what: "file of results",
    endings: &["vtkhdf"],
    start: b"\x89HDF\r\n\x1a\n",
    marks: &[],
    proof: Some(is_ours),
};

/// Whether this program wrote an HDF5 file.
pub fn is_ours(path: &Path) -> bool {
    Source::open(path).is_ok_and(|file| file.root_text(attribute::VERSION).is_ok())
}
