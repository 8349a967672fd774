//! Checksums over what a result file holds, and the verification of a file by them.
//!
//! A writer adds every number that it appends to a CRC-32 of its dataset; a checkpoint keeps these checksums
//! beside the lengths. Before a run is resumed, everything that it keeps is read once and its checksums are
//! compared. The headers, indexes and links of a file have checksums of their own, which the HDF5 library
//! verifies.

use crate::OutputError;
use crate::hdf5::{Source, damaged};
use crate::layout::ROW_COUNT;
use crc32fast::Hasher;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// The part of a result file that belongs to a checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Kept {
    /// Number of snapshots (grid) or rows (history).
    pub records: u64,
    /// CRC-32 of what is written once, then of the records of each extendible dataset, in the order of their
    /// names.
    pub sums: Vec<u32>,
}

/// The checksums of a file being written.
#[derive(Clone, Debug, Default)]
pub(crate) struct Checksums {
    fixed: u32,
    growing: BTreeMap<String, u32>,
}

impl Checksums {
    /// Of a file that was just created, with these extendible datasets.
    pub fn of_new(path: &Path, growing: impl Iterator<Item = String>) -> Result<Self, OutputError> {
        let fixed = fixed(&Source::open(path)?)?;
        Ok(Self { fixed, growing: growing.map(|name| (name, 0)).collect() })
    }

    /// Those of `kept`.
    pub fn of_kept(kept: &Kept, growing: impl Iterator<Item = String>) -> Self {
        let (fixed, rest) = kept.sums.split_first().unwrap_or((&0, &[]));
        let names: BTreeMap<String, u32> = growing.map(|name| (name, 0)).collect();
        let growing = names.into_keys().zip(rest.iter().copied()).collect();
        Self { fixed: *fixed, growing }
    }

    /// Adds numbers appended to a dataset.
    pub fn add(&mut self, dataset: &str, values: &[f64]) {
        if let Some(sum) = self.growing.get_mut(dataset) {
            *sum = extend(*sum, values);
        }
    }

    /// The same for bytes.
    pub fn add_bytes(&mut self, dataset: &str, values: &[u8]) {
        if let Some(sum) = self.growing.get_mut(dataset) {
            *sum = extend_bytes(*sum, values);
        }
    }

    pub fn kept(&self, records: usize) -> Kept {
        let sums = [self.fixed].into_iter().chain(self.growing.values().copied()).collect();
        Kept { records: records as u64, sums }
    }
}

/// In blocks: number by number takes ten times as long.
fn extend(sum: u32, values: &[f64]) -> u32 {
    let mut hasher = Hasher::new_with_initial(sum);
    let mut block = [0; 8 * 512];
    for part in values.chunks(512) {
        for (bytes, value) in block.as_chunks_mut::<8>().0.iter_mut().zip(part) {
            *bytes = value.to_le_bytes();
        }
        hasher.update(&block[..8 * part.len()]);
    }
    hasher.finalize()
}

fn extend_bytes(sum: u32, values: &[u8]) -> u32 {
    let mut hasher = Hasher::new_with_initial(sum);
    hasher.update(values);
    hasher.finalize()
}

/// Numbers read at a time.
const BATCH: usize = 1 << 20;

/// The checksum `sum` continued over the first `rows` rows of a dataset.
fn dataset(source: &Source, name: &str, sum: u32, rows: usize) -> Result<u32, OutputError> {
    let bytes = source.is_bytes(name)?;
    let width: usize = source.shape(name)?.iter().skip(1).product();
    let chunk = source.chunk_rows(name)?.max(1);
    // whole chunks, so that none is decompressed twice
    let batch = (BATCH / width.max(1)).next_multiple_of(chunk);
    let mut sum = sum;
    for start in (0..rows).step_by(batch) {
        let values = source.rows(name, start, batch.min(rows - start))?;
        sum = if bytes {
            extend_bytes(sum, &values.iter().map(|value| *value as u8).collect::<Vec<_>>())
        } else {
            extend(sum, &values)
        };
    }
    Ok(sum)
}

/// The checksum of what is written once: the texts of the root, units and description of every dataset, and
/// the numbers of those that are not extendible.
fn fixed(source: &Source) -> Result<u32, OutputError> {
    let mut sum = 0;
    let text = |sum: &mut u32, words: &str| {
        *sum = extend_bytes(*sum, &(words.len() as u64).to_le_bytes());
        *sum = extend_bytes(*sum, words.as_bytes());
    };
    let mut names = source.root_names()?;
    names.sort();
    for name in names {
        // the count of rows changes
        if name != ROW_COUNT {
            let words = source.root_text(&name)?;
            [&name, &words].into_iter().for_each(|words| text(&mut sum, words));
        }
    }
    let mut names = source.all_names()?;
    names.sort();
    for name in names {
        text(&mut sum, &name);
        for attribute in ["units", "description"] {
            text(&mut sum, &source.text(&name, attribute)?);
        }
        if source.is_fixed(&name)? {
            sum = dataset(source, &name, sum, source.length(&name)?)?;
        }
    }
    Ok(sum)
}

/// Verifies that the result file at `path` still holds all that belongs to a checkpoint, and that the index of
/// every dataset can be read, and therefore extended. Reads all of it once.
///
/// # Errors
/// [`OutputError::Damaged`] where datasets or records are missing or a checksum differs;
/// [`OutputError::Read`] where the file cannot be read.
pub fn verify(path: impl AsRef<Path>, kept: &Kept) -> Result<(), OutputError> {
    let path = path.as_ref();
    let source = Source::open(path)?;
    let mut growing = Vec::new();
    for name in source.all_names()? {
        if !source.is_fixed(&name)? {
            growing.push(name);
        }
    }
    growing.sort();
    let (first, rest) = kept.sums.split_first().unwrap_or((&0, &[]));
    if growing.len() != rest.len() {
        return Err(damaged(path, "datasets are missing".into()));
    }
    if fixed(&source)? != *first {
        return Err(damaged(path, "what is written once is not what was written".into()));
    }
    for (name, wanted) in growing.iter().zip(rest) {
        let per_record = source.rows_per_record(name)?;
        let (found, records) = (source.length(name)?, kept.records as usize);
        if found / per_record < records {
            let found = found / per_record;
            return Err(damaged(
                path,
                format!("holds {found} of the {records} records before it (`{name}`)"),
            ));
        }
        if dataset(&source, name, 0, records * per_record)? != *wanted {
            return Err(damaged(path, format!("`{name}` is not what was written")));
        }
        // Reading anything reads the whole index.
        if records == 0 && found > 0 {
            source.rows(name, 0, 1)?;
        }
    }
    Ok(())
}

/// Lower-case hexadecimal digits of a digest.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
