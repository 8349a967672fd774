//! The files of a run in HDF5: created, extended and read.
//!
//! [`ResultFile`] says what a library of HDF5 must do to write them. rust-hdf5 does it unless the crate is built
//! with the feature `libhdf5`, which links HDF5's own library.

#[cfg(feature = "libhdf5")]
mod libhdf5;
mod library;
#[cfg_attr(feature = "libhdf5", allow(dead_code, reason = "then it only reads"))]
mod rust_hdf5;
mod source;

use crate::OutputError;
use crate::disk_space::free_space;
use crate::files::input;
use crate::layout::attribute;
use crate::provenance::Provenance;
use library::{Layout, LibraryError, LibraryResult, Number, ResultFile};
use std::fs::OpenOptions;
use std::path::{Path, PathBuf};

pub(crate) use library::DatasetSpec;
pub(crate) use source::Source;

/// The library that writes.
#[cfg(feature = "libhdf5")]
type Written = libhdf5::Libhdf5File;
#[cfg(not(feature = "libhdf5"))]
type Written = rust_hdf5::RustHdf5File;

/// Rows per chunk of the small per-step datasets.
const ROWS_PER_CHUNK: usize = 256;
/// Wanted rows per chunk of snapshots.
const CHUNK_ROWS: std::ops::RangeInclusive<usize> = 2_048..=32_768;

/// A file being created, under another name until it is closed: a process killed meanwhile leaves no
/// incomplete file under the name that readers look for.
pub(crate) struct Creator {
    path: PathBuf,
    partial: PathBuf,
    file: Written,
}

impl Creator {
    pub fn new(path: &Path, provenance: &Provenance) -> Result<Self, OutputError> {
        let partial = partial(path);
        let open = || -> LibraryResult<Written> {
            let file = Written::create(&partial)?;
            file.text(attribute::VERSION, &provenance.creepage_version)?;
            file.text(attribute::CASE_HASH, &provenance.case_hash)?;
            file.text(attribute::CREATED, &provenance.created)?;
            for (name, text) in &provenance.attributes {
                file.text(name, text)?;
            }
            Ok(file)
        };
        let file = open().map_err(|error| create_error(path, error))?;
        Ok(Self { path: path.to_owned(), partial, file })
    }

    fn check(&self, result: LibraryResult<()>) -> Result<(), OutputError> {
        result.map_err(|error| create_error(&self.path, error))
    }

    pub fn group(&mut self, path: &[&str]) -> Result<(), OutputError> {
        self.check(self.file.group(path))
    }

    /// The attributes by which VTK recognises its format; it reads `Type` as ASCII of fixed length only.
    pub fn vtkhdf_header<const N: usize>(&mut self, kind: &[u8; N]) -> Result<(), OutputError> {
        let group = ["VTKHDF"];
        self.check(self.file.integers(&group, "Version", &[2, 2]))?;
        self.check(self.file.ascii(&group, "Type", kind))
    }

    /// A dataset written once.
    pub fn constant<T: Number>(
        &mut self,
        at: &DatasetSpec<'_>,
        data: &[T],
    ) -> Result<(), OutputError> {
        let rows = data.len() / at.components;
        let layout = Layout {
            shape: shape(rows, at.components),
            chunk: Some(shape(rows.clamp(1, *CHUNK_ROWS.end()), at.components)),
            // even where that saves nothing: compressed data carry a checksum
            compressed: true,
            grows: false,
        };
        self.check(self.file.dataset(at, &layout, data))
    }

    /// An empty compressed dataset to which snapshots of `rows` rows will be appended. Its chunks
    /// divide a snapshot, so that no chunk is ever written twice.
    pub fn snapshots<T: Number>(
        &mut self,
        at: &DatasetSpec<'_>,
        rows: usize,
    ) -> Result<(), OutputError> {
        self.growing::<T>(at, chunk_rows(rows), true, at.components > 1)
    }

    /// An empty 1-D dataset to which single rows will be appended. Not compressed: its last chunk
    /// is rewritten by every append, and only a chunk of fixed size is rewritten in place, so that a
    /// kill does no harm.
    pub fn rows<T: Number>(&mut self, at: &DatasetSpec<'_>) -> Result<(), OutputError> {
        self.growing::<T>(at, ROWS_PER_CHUNK, false, false)
    }

    /// As [`Self::rows`], with shape (rows, 1).
    pub fn column<T: Number>(&mut self, at: &DatasetSpec<'_>) -> Result<(), OutputError> {
        self.growing::<T>(at, ROWS_PER_CHUNK, false, true)
    }

    fn growing<T: Number>(
        &mut self,
        at: &DatasetSpec<'_>,
        chunk: usize,
        compressed: bool,
        two_dimensional: bool,
    ) -> Result<(), OutputError> {
        let dims = |rows: usize| {
            if two_dimensional { vec![rows, at.components] } else { vec![rows] }
        };
        let layout = Layout { shape: dims(0), chunk: Some(dims(chunk)), compressed, grows: true };
        self.check(self.file.dataset::<T>(at, &layout, &[]))
    }

    /// Creates the attribute that counts the valid records.
    pub fn count(&mut self, group: &[&str], name: &str, value: i64) -> Result<(), OutputError> {
        self.check(self.file.integer(group, name, value))
    }

    /// A dataset written once, contiguous and not compressed.
    pub fn plain<T: Number>(
        &mut self,
        at: &DatasetSpec<'_>,
        data: &[T],
    ) -> Result<(), OutputError> {
        let shape = shape(data.len() / at.components, at.components);
        let layout = Layout { shape, chunk: None, compressed: false, grows: false };
        self.check(self.file.dataset(at, &layout, data))
    }

    /// Closes the file, to whose `datasets` rows will be appended, and renames it to its final name.
    pub fn close(self, datasets: &[Growing]) -> Result<(), OutputError> {
        let path = self.path.clone();
        self.close_by(|partial| {
            Written::fix_link_storage(partial, datasets)?;
            Ok(std::fs::rename(partial, path)?)
        })
    }

    /// Closes the file with `fsync` and lets `place` rename it.
    pub fn close_by(
        self,
        place: impl FnOnce(&Path) -> LibraryResult<()>,
    ) -> Result<(), OutputError> {
        let placed = self.file.close().and_then(|()| place(&self.partial));
        if placed.is_err() {
            // An incomplete file is of no use; the error to report is the first.
            let _ = std::fs::remove_file(&self.partial);
        }
        placed.map_err(|error| create_error(&self.path, error))
    }
}

/// An extendible dataset, to which rows are appended.
pub(crate) struct Growing {
    pub name: String,
    /// Rows per snapshot.
    pub rows: usize,
}

/// Truncates the datasets of a file to their first `snapshots` snapshots.
pub(crate) fn cut(
    path: &Path,
    datasets: &[Growing],
    group: &[&str],
    count: &str,
    snapshots: usize,
) -> Result<(), OutputError> {
    let mut file = Appender::open(path)?;
    for dataset in datasets {
        file.cut(&dataset.name, snapshots * dataset.rows)?;
    }
    file.close_with_count(group, count, snapshots as i64)
}

/// As [`cut`], before a run is resumed: on a copy, which is renamed over the file once its links
/// no longer move: those of a file that a kill interrupted within an append still do, and a kill while they are
/// moved would leave a file that nothing can read. Errors are reported as damage of the file unless
/// the disk is full.
pub(crate) fn cut_to_go_on(
    path: &Path,
    datasets: &[Growing],
    group: &[&str],
    count: &str,
    snapshots: usize,
) -> Result<(), OutputError> {
    let of_file = |reason: String| OutputError::Append { path: path.to_owned(), reason };
    regular(path).map_err(of_file)?;
    let copy = partial(path);
    let copied = std::fs::copy(path, &copy).map_err(|error| append_error(path, error.into()));
    let cut_and_fixed = || {
        cut(&copy, datasets, group, count, snapshots)?;
        Written::fix_link_storage(&copy, datasets).map_err(|error| append_error(&copy, error))
    };
    let made = copied.and_then(|_| match cut_and_fixed() {
        Err(OutputError::Append { reason, .. }) if disk_is_full(path) => Err(of_file(reason)),
        Err(OutputError::Append { reason, .. }) => {
            Err(OutputError::Damaged { path: path.to_owned(), reason })
        }
        Err(OutputError::Read { reason, .. }) => Err(read_error(path, reason)),
        other => other,
    });
    let place = || {
        OpenOptions::new().write(true).open(&copy)?.sync_all()?;
        std::fs::rename(&copy, path)
    };
    made.and_then(|()| place().map_err(|error| append_error(path, error.into()))).inspect_err(
        |_| {
            // an incomplete copy is of no use; the error to report is the first
            let _ = std::fs::remove_file(&copy);
        },
    )
}

/// The temporary name of a file while it is created or copied.
fn partial(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".partial");
    PathBuf::from(name)
}

/// A disk with less free space than this is full (bytes).
const LEAST_SPACE: u64 = 512;

/// Whether the disk of a file has less than a sector left.
fn disk_is_full(path: &Path) -> bool {
    free_space(path.parent().unwrap_or(Path::new("."))).is_some_and(|free| free < LEAST_SPACE)
}

/// Truncates a file to its first snapshots where a failed append has left more rows in some datasets. Its own
/// errors are ignored: the error of the append is the one to report.
pub(crate) fn undo(
    path: &Path,
    datasets: &[Growing],
    group: &[&str],
    count: &str,
    snapshots: usize,
) {
    let longer = |source: Source| {
        let wanted = |dataset: &Growing| snapshots * dataset.rows;
        datasets.iter().any(|d| source.length(&d.name).is_ok_and(|length| length > wanted(d)))
    };
    if Source::open(path).is_ok_and(longer) {
        let _ = cut(path, datasets, group, count, snapshots);
    }
}

/// A file being extended.
pub(crate) struct Appender {
    path: PathBuf,
    file: Written,
}

impl Appender {
    pub fn open(path: &Path) -> Result<Self, OutputError> {
        regular(path).map_err(|reason| OutputError::Append { path: path.to_owned(), reason })?;
        let file = Written::open(path).map_err(|error| append_error(path, error))?;
        Ok(Self { path: path.to_owned(), file })
    }

    fn check<T>(&self, result: LibraryResult<T>) -> Result<T, OutputError> {
        result.map_err(|error| append_error(&self.path, error))
    }

    /// Checks that a dataset still has the `left` rows with which this process left it: of two processes that
    /// write to one file, the first that finds the other's rows stops.
    pub fn check_length(&self, name: &str, left: usize) -> Result<(), OutputError> {
        let found = self.check(self.file.rows(name))?;
        if found == left {
            return Ok(());
        }
        Err(OutputError::Another { path: self.path.clone(), found, left })
    }

    /// Makes room for `bytes` of data and their indices.
    pub fn extend_file(&mut self, bytes: usize) -> Result<(), OutputError> {
        let extended = self.file.extend(bytes);
        self.check(extended)
    }

    pub fn append<T: Number>(&mut self, name: &str, data: &[T]) -> Result<(), OutputError> {
        let appended = self.file.append(name, data);
        self.check(appended)
    }

    /// Truncates a dataset to its first `rows` rows.
    fn cut(&mut self, name: &str, rows: usize) -> Result<(), OutputError> {
        let found = self.check(self.file.rows(name))?;
        if found < rows {
            let reason = format!("`{name}` has {found} rows, fewer than the {rows} that it must");
            return Err(read_error(&self.path, reason));
        }
        if found > rows { self.check(self.file.truncate(name, rows)) } else { Ok(()) }
    }

    /// Sets the count and closes the file, which writes the count after the data that it counts.
    pub fn close_with_count(
        self,
        group: &[&str],
        name: &str,
        value: i64,
    ) -> Result<(), OutputError> {
        let Self { path, file } = self;
        let counted = file.integer(group, name, value).and_then(|()| file.close_no_sync());
        counted.map_err(|error| append_error(&path, error))
    }
}

pub(crate) fn damaged(path: &Path, reason: String) -> OutputError {
    OutputError::Damaged { path: path.to_owned(), reason }
}

/// Refuses what is no regular file: the library would wait for a pipe, and read a device without end.
fn regular(path: &Path) -> Result<(), String> {
    input::regular(path, input::RESULTS).map_err(|error| error.problem())
}

fn create_error(path: &Path, error: LibraryError) -> OutputError {
    OutputError::Create { path: path.to_owned(), reason: error.to_string() }
}

/// Says of a file that is gone that there is none, also where it was removed while the library opened it.
fn append_error(path: &Path, error: LibraryError) -> OutputError {
    let reason = regular(path).err().unwrap_or_else(|| error.to_string());
    OutputError::Append { path: path.to_owned(), reason }
}

pub(crate) fn read_error(path: &Path, reason: String) -> OutputError {
    OutputError::Read { path: path.to_owned(), reason }
}

fn shape(rows: usize, components: usize) -> Vec<usize> {
    if components == 1 { vec![rows] } else { vec![rows, components] }
}

/// The largest divisor of `rows` in [`CHUNK_ROWS`]; where there is none, the smallest above that range.
fn chunk_rows(rows: usize) -> usize {
    let divides = |chunk: &usize| rows.is_multiple_of(*chunk);
    let wanted = CHUNK_ROWS.rev().find(divides);
    wanted.or_else(|| (*CHUNK_ROWS.end()..rows).find(divides)).unwrap_or(rows.max(1))
}

#[cfg(test)]
mod tests {
    use super::{append_error, chunk_rows};
    use std::path::Path;

    #[test]
    fn a_file_that_went_while_it_was_opened_is_named_as_one_that_was_gone_before() {
        let gone = std::io::Error::from(std::io::ErrorKind::NotFound);
        let error = append_error(Path::new("/none/contact.vtkhdf"), gone.into());
        assert!(error.to_string().contains("there is no such file"), "{error}");
    }

    #[test]
    fn chunks_divide_a_snapshot_and_are_neither_tiny_nor_huge_where_possible() {
        assert_eq!(chunk_rows(150_000), 30_000);
        assert_eq!(chunk_rows(3_400), 3_400);
        assert_eq!(chunk_rows(7), 7);
        assert_eq!(chunk_rows(104_729), 104_729, "a prime leaves no choice");
        assert_eq!(chunk_rows(2 * 104_729), 104_729);
        for rows in 1..5_000 {
            assert_eq!(rows % chunk_rows(rows), 0);
        }
    }
}
