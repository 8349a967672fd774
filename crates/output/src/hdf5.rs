//! The only place that speaks to the HDF5 library.
//!
//! `LibverBound::V110` because newer bounds are unreadable in VTK; deflate because it is the only
//! compression that VTK's build reads; no locks because a viewer holding the file must not make an
//! opening fail. Appends close without `fsync`: the pages survive the death of the process, and a
//! checkpoint syncs the files before it names their lengths.

use crate::OutputError;
use crate::disk_space::free_space;
use crate::file_end::{Extension, end_of_file};
use crate::files::input;
use crate::layout::{MESH, attribute, mesh_path};
use crate::panics::catch_panic;
use crate::provenance::Provenance;
use rust_hdf5::{
    DatatypeMessage, FileSpaceStrategy, H5Dataset, H5File, H5Group, H5Type, Hdf5Error, LibverBound,
};
use std::fs::OpenOptions;
use std::path::{Path, PathBuf};

/// Measured on fields of elastic waves with shuffled bytes: level 2 takes three times as long as
/// level 1 for files 9 % smaller, level 6 five times for 12 %. The shuffle filter itself, which is not
/// used, takes 20 % longer for 3 %.
const DEFLATE_LEVEL: u32 = 1;
/// Rows per chunk of the small per-step datasets.
const ROWS_PER_CHUNK: usize = 256;
/// Wanted rows per chunk of snapshots.
const CHUNK_ROWS: std::ops::RangeInclusive<usize> = 2_048..=32_768;

/// Page size of the file space (bytes): nothing smaller crosses a multiple of it. Headers and index blocks,
/// which carry checksums, therefore lie within a page of memory, and a kill within the call that rewrites
/// one leaves it old or new.
pub(crate) const PAGE: u64 = 512;

type H5Result<T> = Result<T, Hdf5Error>;

/// Group, name, units, shape and description of a dataset to be created.
pub(crate) struct DatasetSpec<'a> {
    pub group: &'a [&'a str],
    pub name: &'a str,
    pub units: &'a str,
    pub components: usize,
    pub description: &'a str,
}

/// A file being created, under another name until it is closed: a process killed meanwhile leaves no
/// incomplete file under the name that readers look for.
pub(crate) struct Creator {
    path: PathBuf,
    partial: PathBuf,
    file: H5File,
}

impl Creator {
    pub fn new(path: &Path, provenance: &Provenance) -> Result<Self, OutputError> {
        let partial = partial(path);
        let open = || -> H5Result<H5File> {
            let file = H5File::options()
                .no_locking()
                .libver(LibverBound::V110)
                .file_space(FileSpaceStrategy::Page, false, 1)
                .file_space_page_size(PAGE)
                .create(&partial)?;
            file.set_attr_string(attribute::VERSION, &provenance.creepage_version)?;
            file.set_attr_string(attribute::CASE_HASH, &provenance.case_hash)?;
            file.set_attr_string(attribute::CREATED, &provenance.created)?;
            for (name, text) in &provenance.attributes {
                file.set_attr_string(name, text)?;
            }
            Ok(file)
        };
        let file = open().map_err(|error| create_error(path, error))?;
        Ok(Self { path: path.to_owned(), partial, file })
    }

    fn check<T>(&self, result: H5Result<T>) -> Result<T, OutputError> {
        result.map_err(|error| create_error(&self.path, error))
    }

    pub fn group(&mut self, path: &[&str]) -> Result<(), OutputError> {
        let Some((name, parents)) = path.split_last() else {
            return Ok(());
        };
        let created = descend(&self.file, parents).and_then(|group| group.create_group(name));
        self.check(created.map(|_| ()))
    }

    /// The attributes by which VTK recognises its format; it reads `Type` as ASCII of fixed length only.
    pub fn vtkhdf_header(&mut self, kind: &str) -> Result<(), OutputError> {
        let write = || -> H5Result<()> {
            let group = descend(&self.file, &["VTKHDF"])?;
            group.set_attr_array_numeric("Version", &[2i64, 2])?;
            let ascii =
                DatatypeMessage::FixedString { size: kind.len() as u32, padding: 1, charset: 0 };
            group.set_attr_typed("Type", ascii, kind.as_bytes().to_vec())
        };
        self.check(write())
    }

    /// A dataset written once.
    pub fn constant<T: H5Type>(
        &mut self,
        at: &DatasetSpec<'_>,
        data: &[T],
    ) -> Result<(), OutputError> {
        let rows = data.len() / at.components;
        let write = || -> H5Result<()> {
            // compressed even where that saves nothing: compressed data carry a checksum
            let chunk = rows.clamp(1, *CHUNK_ROWS.end());
            let dataset = descend(&self.file, at.group)?
                .new_dataset::<T>()
                .shape(shape(rows, at.components))
                .chunk(&shape(chunk, at.components))
                .deflate(DEFLATE_LEVEL)
                .create(at.name)?;
            dataset.write_raw(data)?;
            describe(&dataset, at)
        };
        self.check(write())
    }

    /// An empty compressed dataset to which snapshots of `rows` rows will be appended. Its chunks
    /// divide a snapshot, so that no chunk is ever written twice.
    pub fn snapshots<T: H5Type>(
        &mut self,
        at: &DatasetSpec<'_>,
        rows: usize,
    ) -> Result<(), OutputError> {
        self.growing::<T>(at, chunk_rows(rows), true, at.components > 1)
    }

    /// An empty 1-D dataset to which single rows will be appended. Not compressed: its last chunk
    /// is rewritten by every append, and only a chunk of fixed size is rewritten in place, so that a
    /// kill does no harm.
    pub fn rows<T: H5Type>(&mut self, at: &DatasetSpec<'_>) -> Result<(), OutputError> {
        self.growing::<T>(at, ROWS_PER_CHUNK, false, false)
    }

    /// As [`Self::rows`], with shape (rows, 1).
    pub fn column<T: H5Type>(&mut self, at: &DatasetSpec<'_>) -> Result<(), OutputError> {
        self.growing::<T>(at, ROWS_PER_CHUNK, false, true)
    }

    fn growing<T: H5Type>(
        &mut self,
        at: &DatasetSpec<'_>,
        chunk: usize,
        compressed: bool,
        two_dimensional: bool,
    ) -> Result<(), OutputError> {
        let dims = |rows: usize| {
            if two_dimensional { vec![rows, at.components] } else { vec![rows] }
        };
        let limit: &[Option<usize>] =
            if two_dimensional { &[None, Some(at.components)] } else { &[None] };
        let write = || -> H5Result<()> {
            let builder = descend(&self.file, at.group)?
                .new_dataset::<T>()
                .shape(dims(0))
                .chunk(&dims(chunk))
                .max_shape(limit);
            let builder = if compressed { builder.deflate(DEFLATE_LEVEL) } else { builder };
            describe(&builder.create(at.name)?, at)
        };
        self.check(write())
    }

    /// Creates the attribute that counts the valid records.
    pub fn count(&mut self, group: &[&str], name: &str, value: i64) -> Result<(), OutputError> {
        let written = set_count(&self.file, group, name, value);
        self.check(written)
    }

    /// A dataset written once, contiguous and not compressed.
    pub fn plain<T: H5Type>(
        &mut self,
        at: &DatasetSpec<'_>,
        data: &[T],
    ) -> Result<(), OutputError> {
        let write = || -> H5Result<()> {
            let dataset = descend(&self.file, at.group)?
                .new_dataset::<T>()
                .shape(shape(data.len() / at.components, at.components))
                .create(at.name)?;
            if !data.is_empty() {
                dataset.write_raw(data)?;
            }
            describe(&dataset, at)
        };
        self.check(write())
    }

    /// Closes the file, calls `fix_headers` on it and then renames it to its final name. The first closings
    /// after an append move headers and link tables, and a kill between two of their writes would leave
    /// neither the old file nor the new one: they must be over before the file has its name.
    pub fn close_with_headers_fixed(
        self,
        fix_headers: impl FnOnce(&Path) -> Result<(), OutputError>,
    ) -> Result<(), OutputError> {
        let (path, partial) = (self.path.clone(), self.partial.clone());
        self.close_by(|_| Ok(()))?;
        fix_headers(&partial)?;
        std::fs::rename(&partial, &path).map_err(|error| create_error(&path, error.into()))
    }

    /// Closes the file with `fsync` and lets `place` rename it.
    pub fn close_by(
        self,
        place: impl FnOnce(&Path) -> std::io::Result<()>,
    ) -> Result<(), OutputError> {
        let placed = self.file.close().and_then(|()| Ok(place(&self.partial)?));
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
    pub kind: Kind,
    pub components: usize,
    /// Rows per snapshot.
    pub rows: usize,
}

/// Number type of a dataset.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Real,
    Int64,
    Byte,
}

/// Number of closings after which a closing no longer moves headers. Measured: 4 for a grid of ten fields,
/// 2 for a history.
const CLOSINGS: usize = 6;

/// Appends a row to every dataset of a file of `snapshots` snapshots and removes it again, so often that later
/// closings no longer move headers. `count` is the attribute of `group` that counts the snapshots.
pub(crate) fn fix_headers(
    path: &Path,
    datasets: &[Growing],
    group: &[&str],
    count: &str,
    snapshots: usize,
) -> Result<(), OutputError> {
    for _ in 0..CLOSINGS {
        let mut file = Appender::open(path)?;
        for dataset in datasets {
            match dataset.kind {
                Kind::Real => file.append(&dataset.name, &vec![0.0; dataset.components])?,
                Kind::Int64 => file.append(&dataset.name, &vec![0_i64; dataset.components])?,
                Kind::Byte => file.append(&dataset.name, &vec![0_u8; dataset.components])?,
            }
        }
        file.close_with_count(group, count, snapshots as i64)?;
        cut(path, datasets, group, count, snapshots)?;
    }
    Ok(())
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

/// As [`cut`], before a run is resumed: on a copy, which is renamed over the file once [`fix_headers`] has run
/// on it. A file that a kill interrupted within an append has headers that the next closings still move, and a
/// kill during those would leave a file that nothing can read. Errors are reported as damage of the file unless
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
        fix_headers(&copy, datasets, group, count, snapshots)
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

/// Whether the disk of a file has less than a page left.
fn disk_is_full(path: &Path) -> bool {
    free_space(path.parent().unwrap_or(Path::new("."))).is_some_and(|free| free < PAGE)
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
    /// `None` once it is closed.
    file: Option<H5File>,
    /// Extension of the file that the superblock does not state yet.
    extension: Option<Extension>,
}

impl Appender {
    pub fn open(path: &Path) -> Result<Self, OutputError> {
        regular(path).map_err(|reason| OutputError::Append { path: path.to_owned(), reason })?;
        let file = catch_panic(|| H5File::options().no_locking().open_rw(path))
            .map_err(|error| append_error(path, error))?;
        Ok(Self { path: path.to_owned(), file: Some(file), extension: None })
    }

    /// Checks that a dataset still has the `left` rows with which this process left it: of two processes that
    /// write to one file, the first that finds the other's rows stops.
    pub fn check_length(&self, name: &str, left: usize) -> Result<(), OutputError> {
        let rows = || -> H5Result<usize> {
            Ok(open(&self.file)?.dataset_writer(name)?.shape().first().copied().unwrap_or(0))
        };
        let found = catch_panic(rows).map_err(|error| append_error(&self.path, error))?;
        if found == left {
            return Ok(());
        }
        Err(OutputError::Another { path: self.path.clone(), found, left })
    }

    /// Lengthens the file by `bytes` of data and their indices. The first [`Self::append`] writes the new end
    /// into the superblock: late enough that no reader that saw the short file has yet to read the superblock,
    /// early enough that at the closing no reader of the old superblock has yet to read the count.
    ///
    /// Single rows need it as well: a kill between the headers and the superblock would leave a file whose
    /// headers point behind its end.
    pub fn extend_file(&mut self, bytes: usize) -> Result<(), OutputError> {
        let extension = Extension::of(&self.path, bytes);
        self.extension = Some(extension.map_err(|error| append_error(&self.path, error.into()))?);
        Ok(())
    }

    pub fn append<T: H5Type>(&mut self, name: &str, data: &[T]) -> Result<(), OutputError> {
        catch_panic(|| open(&self.file)?.dataset_writer(name)?.append(data))
            .and_then(|()| {
                self.extension.take().map_or(Ok(()), |extension| Ok(extension.announce()?))
            })
            .map_err(|error| append_error(&self.path, error))
    }

    /// Truncates a dataset to its first `rows` rows.
    fn cut(&mut self, name: &str, rows: usize) -> Result<(), OutputError> {
        let mut found = 0;
        let write = || -> H5Result<()> {
            let dataset = open(&self.file)?.dataset_writer(name)?;
            let mut shape = dataset.shape();
            if let Some(length) = shape.first_mut() {
                found = *length;
                *length = rows;
            }
            if found > rows { dataset.set_extent(&shape) } else { Ok(()) }
        };
        catch_panic(write).map_err(|error| append_error(&self.path, error))?;
        if found < rows {
            let reason = format!("`{name}` has {found} rows, fewer than the {rows} that it must");
            return Err(read_error(&self.path, reason));
        }
        Ok(())
    }

    /// Sets the count and closes the file: that writes the headers of datasets first and the group that carries
    /// the count after them.
    pub fn close_with_count(
        mut self,
        group: &[&str],
        name: &str,
        value: i64,
    ) -> Result<(), OutputError> {
        let close = || {
            set_count(open(&self.file)?, group, name, value)?;
            self.file.take().map_or(Ok(()), H5File::close_no_sync)
        };
        catch_panic(close).map_err(|error| append_error(&self.path, error))
    }
}

fn open(file: &Option<H5File>) -> H5Result<&H5File> {
    file.as_ref().ok_or_else(|| Hdf5Error::InvalidState("the file is closed".into()))
}

/// After an error, which was returned: otherwise the library would print it again on standard error.
impl Drop for Appender {
    fn drop(&mut self) {
        if let Some(file) = self.file.take() {
            let _ = catch_panic(|| file.close_no_sync());
        }
    }
}

/// How often the end of a file is read that a writer may be closing.
const ATTEMPTS: usize = 3;

/// The length of a file (bytes), which must reach the end that its superblock names.
fn complete_length(path: &Path) -> Result<u64, OutputError> {
    let failed = |error: std::io::Error| read_error(path, error.to_string());
    let mut attempts = 0;
    loop {
        let end = end_of_file(path).map_err(failed)?;
        let length = std::fs::metadata(path).map_err(failed)?.len();
        attempts += 1;
        if length >= end {
            return Ok(length);
        }
        // A closing truncates the file after it has written the new end.
        if attempts == ATTEMPTS {
            return Err(damaged(path, format!("it ends after {length} of its {end} bytes")));
        }
    }
}

pub(crate) fn damaged(path: &Path, reason: String) -> OutputError {
    OutputError::Damaged { path: path.to_owned(), reason }
}

/// Largest ratio of deflate: bytes per compressed byte.
const MOST_PER_BYTE: u64 = 1032;

/// A file being read.
pub(crate) struct Source {
    path: PathBuf,
    file: H5File,
    length: u64,
}

impl Source {
    pub fn open(path: &Path) -> Result<Self, OutputError> {
        regular(path).map_err(|reason| read_error(path, reason))?;
        let file = catch_panic(|| H5File::options().no_locking().open(path))
            .map_err(|error| read_error(path, error.to_string()))?;
        let length = complete_length(path)?;
        Ok(Self { path: path.to_owned(), file, length })
    }

    /// A dataset to be read. A damaged shape could take all memory: a dataset is refused where it does not
    /// fit into the file at the largest ratio of compression, or has more chunks than the file has bytes.
    /// No dataset of a writer is like that, since none of its chunks is missing.
    fn dataset(&self, name: &str) -> H5Result<H5Dataset> {
        let dataset = self.file.dataset(name)?;
        let product =
            |dims: &[usize]| dims.iter().fold(1_u64, |all, &n| all.saturating_mul(n as u64));
        let size = dataset.element_size() as u64;
        let most = self.length.saturating_mul(MOST_PER_BYTE);
        let shape = dataset.shape();
        let chunk = dataset.chunk_dims().unwrap_or_default();
        let bytes = |dims: &[usize]| product(dims).saturating_mul(size);
        // The library allocates the index of chunks for the largest extent, if the dataset has one.
        let limits = dataset.max_shape()?;
        let extent = shape.iter().zip(&limits).map(|(n, limit)| limit.unwrap_or(0).max(*n));
        let chunks = extent.zip(&chunk).map(|(n, chunk)| n.div_ceil((*chunk).max(1)));
        let chunks = product(&chunks.collect::<Vec<_>>());
        if bytes(&shape) <= most && bytes(&chunk) <= most && chunks <= self.length {
            return Ok(dataset);
        }
        Err(Hdf5Error::InvalidState(format!(
            "`{name}` is damaged: {shape:?} numbers in chunks of {chunk:?} do not go into {} bytes",
            self.length
        )))
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Rows per chunk of a dataset; all rows where it has no chunks.
    pub fn chunk_rows(&self, dataset: &str) -> Result<usize, OutputError> {
        let dims = self.read(|| Ok(self.file.dataset(dataset)?.chunk_dims()))?;
        match dims.as_ref().and_then(|dims| dims.first()) {
            Some(rows) => Ok(*rows),
            None => self.length(dataset),
        }
    }

    /// Rows per record of an extendible dataset: the number of points or cells of a grid, else one.
    pub fn rows_per_record(&self, dataset: &str) -> Result<usize, OutputError> {
        let count = match dataset.split('/').nth(1) {
            Some("PointData") => mesh_path(&MESH.point_count),
            Some("CellData") => mesh_path(&MESH.cell_count),
            _ => return Ok(1),
        };
        Ok(self.rows(&count, 0, 1)?.first().map_or(1, |count| (*count as usize).max(1)))
    }

    fn read<T>(&self, read: impl FnOnce() -> H5Result<T>) -> Result<T, OutputError> {
        catch_panic(read).map_err(|error| read_error(&self.path, error.to_string()))
    }

    pub fn root_text(&self, name: &str) -> Result<String, OutputError> {
        self.read(|| self.file.attr_string(name))
    }

    /// Names of the root attributes.
    pub fn root_names(&self) -> Result<Vec<String>, OutputError> {
        self.read(|| self.file.attr_names())
    }

    /// Names of all datasets with the groups that they are in.
    pub fn all_names(&self) -> Result<Vec<String>, OutputError> {
        self.read(|| Ok(self.file.dataset_names()))
    }

    /// All bytes of a dataset of [`Creator::plain`].
    pub fn bytes(&self, dataset: &str) -> Result<Vec<u8>, OutputError> {
        self.read(|| self.dataset(dataset)?.read_raw())
    }

    /// Names of the datasets directly in a group, sorted.
    pub fn names(&self, group: &[&str]) -> Result<Vec<String>, OutputError> {
        let mut names = self.read(|| descend(&self.file, group)?.dataset_names())?;
        names.sort();
        Ok(names)
    }

    pub fn text(&self, dataset: &str, attribute: &str) -> Result<String, OutputError> {
        self.read(|| self.file.dataset(dataset)?.attr(attribute)?.read_string())
    }

    pub fn shape(&self, dataset: &str) -> Result<Vec<usize>, OutputError> {
        self.read(|| Ok(self.file.dataset(dataset)?.shape()))
    }

    /// Length along the first dimension.
    pub fn length(&self, dataset: &str) -> Result<usize, OutputError> {
        Ok(self.shape(dataset)?.first().copied().unwrap_or(0))
    }

    /// Whether the dataset cannot grow.
    pub fn is_fixed(&self, dataset: &str) -> Result<bool, OutputError> {
        let limits = self.read(|| self.file.dataset(dataset)?.max_shape())?;
        Ok(limits.first().is_none_or(|limit| limit.is_some()))
    }

    /// Whether the elements are bytes, which only integer fields are.
    pub fn is_bytes(&self, dataset: &str) -> Result<bool, OutputError> {
        self.read(|| Ok(self.file.dataset(dataset)?.element_size() == 1))
    }

    /// Rows `start..start + count` as `f64`, whatever number type is stored.
    pub fn rows(&self, dataset: &str, start: usize, count: usize) -> Result<Vec<f64>, OutputError> {
        let read = || -> H5Result<Vec<f64>> {
            let dataset = self.dataset(dataset)?;
            let mut counts = dataset.shape();
            let mut starts = vec![0; counts.len()];
            if let (Some(first), Some(length)) = (starts.first_mut(), counts.first_mut()) {
                *first = start;
                *length = count;
            }
            match (dataset.datatype()?, dataset.element_size()) {
                // The two common types are read without conversion: histories consist of them.
                (DatatypeMessage::FloatingPoint { .. }, 8) => dataset.read_slice(&starts, &counts),
                (DatatypeMessage::FixedPoint { signed: false, .. }, 1) => {
                    let labels: Vec<u8> = dataset.read_slice(&starts, &counts)?;
                    Ok(labels.into_iter().map(f64::from).collect())
                }
                (DatatypeMessage::FixedPoint { .. }, _) => {
                    // Indices: far below 2^53, where f64 is exact.
                    let integers = dataset.read_numeric_slice_as::<i64>(&starts, &counts)?;
                    Ok(integers.into_iter().map(|value| value as f64).collect())
                }
                _ => dataset.read_numeric_slice_as::<f64>(&starts, &counts),
            }
        };
        self.read(read)
    }
}

/// Refuses what is no regular file: the library would wait for a pipe, and read a device without end.
fn regular(path: &Path) -> Result<(), String> {
    input::regular(path, input::RESULTS).map_err(|error| error.problem())
}

fn create_error(path: &Path, error: Hdf5Error) -> OutputError {
    OutputError::Create { path: path.to_owned(), reason: error.to_string() }
}

/// Says of a file that is gone that there is none, also where it was removed while the library opened it.
fn append_error(path: &Path, error: Hdf5Error) -> OutputError {
    let reason = regular(path).err().unwrap_or_else(|| error.to_string());
    OutputError::Append { path: path.to_owned(), reason }
}

pub(crate) fn read_error(path: &Path, reason: String) -> OutputError {
    OutputError::Read { path: path.to_owned(), reason }
}

fn descend(file: &H5File, path: &[&str]) -> H5Result<H5Group> {
    path.iter().try_fold(file.root_group(), |group, name| group.group(name))
}

fn set_count(file: &H5File, group: &[&str], name: &str, value: i64) -> H5Result<()> {
    if group.is_empty() {
        file.set_attr_numeric(name, &value)
    } else {
        descend(file, group)?.set_attr_numeric(name, &value)
    }
}

fn describe(dataset: &H5Dataset, at: &DatasetSpec<'_>) -> H5Result<()> {
    for (name, text) in [("units", at.units), ("description", at.description)] {
        dataset
            .new_attr::<rust_hdf5::VarLenUnicode>()
            .shape(())
            .create(name)?
            .write_string(text)?;
    }
    Ok(())
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
    use super::{Hdf5Error, append_error, chunk_rows};
    use std::path::Path;

    #[test]
    fn a_file_that_went_while_it_was_opened_is_named_as_one_that_was_gone_before() {
        let gone = std::io::Error::from(std::io::ErrorKind::NotFound);
        let error = append_error(Path::new("/none/contact.vtkhdf"), Hdf5Error::Io(gone));
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
