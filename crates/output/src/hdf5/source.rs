//! Reading of the files of a run, which rust-hdf5 does whichever library wrote them.

use super::rust_hdf5::{catch_panic, descend, end_of_file};
use super::{damaged, read_error, regular};
use crate::OutputError;
use crate::layout::{MESH, mesh_path};
use rust_hdf5::{DatatypeMessage, H5Dataset, H5File, Hdf5Error};
use std::path::{Path, PathBuf};

type H5Result<T> = Result<T, Hdf5Error>;

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

    /// All bytes of a dataset of [`Creator::plain`](super::Creator::plain).
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
