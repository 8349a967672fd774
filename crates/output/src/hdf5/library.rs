//! What a library of HDF5 must do to write the files of a run.

use super::Growing;
use std::path::Path;

/// Group, name, units, shape and description of a dataset to be created.
pub(crate) struct DatasetSpec<'a> {
    pub group: &'a [&'a str],
    pub name: &'a str,
    pub units: &'a str,
    pub components: usize,
    pub description: &'a str,
}

/// How a new dataset is stored.
pub(crate) struct Layout {
    pub shape: Vec<usize>,
    /// Shape of its chunks; contiguous without.
    pub chunk: Option<Vec<usize>>,
    pub compressed: bool,
    /// Whether rows can be appended.
    pub grows: bool,
}

/// Measured on fields of elastic waves with shuffled bytes: level 2 takes three times as long as
/// level 1 for files 9 % smaller, level 6 five times for 12 %. The shuffle filter itself, which is not
/// used, takes 20 % longer for 3 %.
pub(crate) const DEFLATE_LEVEL: u8 = 1;

/// A type of number that both libraries know.
#[cfg(not(feature = "libhdf5"))]
pub(crate) trait Number: rust_hdf5::H5Type {}
/// A type of number that both libraries know.
#[cfg(feature = "libhdf5")]
pub(crate) trait Number: rust_hdf5::H5Type + hdf5_metno::H5Type {}

impl Number for f64 {}
impl Number for i64 {}
impl Number for u8 {}

/// Why a file cannot be written.
#[derive(Debug, thiserror::Error)]
pub(crate) enum LibraryError {
    #[error(transparent)]
    RustHdf5(#[from] rust_hdf5::Hdf5Error),
    #[cfg(feature = "libhdf5")]
    #[error(transparent)]
    Libhdf5(#[from] hdf5_metno::Error),
    #[error(transparent)]
    System(#[from] std::io::Error),
}

pub(crate) type LibraryResult<T> = Result<T, LibraryError>;

/// A file that is open for writing. Deflate is the only compression, because VTK's build reads no other; no
/// file is locked, because a viewer that holds one must not make an opening fail.
pub(crate) trait ResultFile: Sized {
    fn create(path: &Path) -> LibraryResult<Self>;

    /// Opens a file to extend or truncate it.
    fn open(path: &Path) -> LibraryResult<Self>;

    /// Brings the links of a closed file where an append to these datasets leaves them: a kill while they are moved
    /// would leave neither the old file nor the new one.
    fn fix_link_storage(path: &Path, datasets: &[Growing]) -> LibraryResult<()>;

    /// Creates a group.
    fn group(&self, path: &[&str]) -> LibraryResult<()>;

    /// Creates a text as an attribute of the root.
    fn text(&self, name: &str, text: &str) -> LibraryResult<()>;

    /// Creates a text of fixed length as an attribute of a group.
    fn ascii<const N: usize>(
        &self,
        group: &[&str],
        name: &str,
        text: &[u8; N],
    ) -> LibraryResult<()>;

    /// Creates an array of integers as an attribute of a group.
    fn integers(&self, group: &[&str], name: &str, values: &[i64]) -> LibraryResult<()>;

    /// Sets an integer as an attribute of a group.
    fn integer(&self, group: &[&str], name: &str, value: i64) -> LibraryResult<()>;

    /// Creates a dataset with its units and description.
    fn dataset<T: Number>(
        &self,
        at: &DatasetSpec<'_>,
        layout: &Layout,
        data: &[T],
    ) -> LibraryResult<()>;

    /// Rows of the dataset at this path.
    fn rows(&self, dataset: &str) -> LibraryResult<usize>;

    /// Makes room for `bytes` of data that will be appended, before anything in the file refers to it.
    fn extend(&mut self, bytes: usize) -> LibraryResult<()>;

    /// Appends whole rows.
    fn append<T: Number>(&mut self, dataset: &str, data: &[T]) -> LibraryResult<()>;

    /// Leaves the first rows of a dataset, which has more.
    fn truncate(&self, dataset: &str, rows: usize) -> LibraryResult<()>;

    /// Closes the file with `fsync`.
    fn close(self) -> LibraryResult<()>;

    /// Closes the file without: the pages survive the death of the process, and a checkpoint syncs the files
    /// before it names their lengths.
    fn close_no_sync(self) -> LibraryResult<()>;
}
