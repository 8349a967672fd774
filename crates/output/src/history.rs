//! Rows of scalars over time: one extendable 1-D dataset per column.

use crate::OutputError;
use crate::checksums::{Checksums, Kept};
use crate::field::FieldSpec;
use crate::hdf5::{Appender, Creator, DatasetSpec, Growing, cut_to_go_on, undo};
use crate::layout::ROW_COUNT;
use crate::provenance::Provenance;
use std::path::{Path, PathBuf};

/// The extendible datasets of the columns.
fn growing(columns: &[FieldSpec]) -> Vec<Growing> {
    let dataset = |column: &FieldSpec| Growing { name: column.name.to_string(), rows: 1 };
    columns.iter().map(dataset).collect()
}

fn names(columns: &[FieldSpec]) -> impl Iterator<Item = String> {
    columns.iter().map(|column| column.name.to_string())
}

/// Writer of a table of scalars over time, `history.h5` or `probes.h5`.
#[derive(Debug)]
pub struct History {
    path: PathBuf,
    columns: Vec<FieldSpec>,
    rows: usize,
    sums: Checksums,
    scratch: Vec<f64>,
}

impl History {
    /// Writes the metadata of an empty history to `path` (replacing what is there) and closes it.
    ///
    /// # Errors
    /// Column names that are empty, repeat or contain `/`; a file that cannot be written.
    pub fn create(
        path: impl AsRef<Path>,
        columns: &[FieldSpec],
        provenance: &Provenance,
    ) -> Result<Self, OutputError> {
        let path = path.as_ref().to_owned();
        let mut seen = std::collections::BTreeSet::new();
        for column in columns {
            let name = &column.name;
            if name.is_empty() || name.contains('/') || !seen.insert(name) {
                let problem = format!(
                    "`{name}` cannot name a column: names must not be empty, contain `/` or repeat"
                );
                return Err(OutputError::Shape { path, problem });
            }
        }
        let mut file = Creator::new(&path, provenance)?;
        for column in columns {
            file.rows::<f64>(&DatasetSpec {
                group: &[],
                name: &column.name,
                units: &column.units,
                components: 1,
                description: &column.description,
            })?;
        }
        file.count(&[], ROW_COUNT, 0)?;
        file.close(&growing(columns))?;
        let sums = Checksums::of_new(&path, names(columns))?;
        Ok(Self { path, columns: columns.to_vec(), rows: 0, sums, scratch: Vec::new() })
    }

    /// Continues a history at `path` that was created with the same columns, truncated to the rows of `kept`;
    /// [`prove`](crate::verify) says whether it still holds them.
    ///
    /// # Errors
    /// A file that cannot be read or written, has fewer rows, or is damaged.
    pub fn reopen(
        path: impl AsRef<Path>,
        columns: &[FieldSpec],
        kept: &Kept,
    ) -> Result<Self, OutputError> {
        let (path, rows) = (path.as_ref().to_owned(), kept.records as usize);
        cut_to_go_on(&path, &growing(columns), &[], ROW_COUNT, rows)?;
        let sums = Checksums::of_kept(kept, names(columns));
        Ok(Self { path, columns: columns.to_vec(), rows, sums, scratch: Vec::new() })
    }

    /// Appends rows, one after the other, in the units of the columns (length: rows times columns).
    ///
    /// Each call opens the file once, however many rows it appends: pass many at once.
    ///
    /// # Errors
    /// A length that is no multiple of the number of columns; a file that cannot be written or that another
    /// process has changed. The file then still has the rows that it had before.
    pub fn append(&mut self, rows: &[f64]) -> Result<(), OutputError> {
        let width = self.columns.len();
        if width == 0 || !rows.len().is_multiple_of(width) {
            return Err(OutputError::Shape {
                path: self.path.clone(),
                problem: format!("{} numbers do not fill rows of {width} columns", rows.len()),
            });
        }
        if rows.is_empty() {
            return Ok(());
        }
        // the checksums of the rows in the file, to return to should this fail
        let before = self.sums.clone();
        let appended = self.try_append(rows, width);
        if appended.is_err() {
            self.sums = before;
        }
        if !matches!(appended, Ok(()) | Err(OutputError::Another { .. })) {
            undo(&self.path, &growing(&self.columns), &[], ROW_COUNT, self.rows);
        }
        appended
    }

    fn try_append(&mut self, rows: &[f64], width: usize) -> Result<(), OutputError> {
        let count = rows.len() / width;
        let mut file = Appender::open(&self.path)?;
        if let Some(column) = self.columns.last() {
            file.check_length(&column.name, self.rows)?;
        }
        file.extend_file(size_of_val(rows))?;
        for (index, column) in self.columns.iter().enumerate() {
            self.scratch.clear();
            self.scratch.extend(rows.iter().skip(index).step_by(width));
            file.append(&column.name, &self.scratch)?;
            self.sums.add(&column.name, &self.scratch);
        }
        file.close_with_count(&[], ROW_COUNT, (self.rows + count) as i64)?;
        self.rows += count;
        Ok(())
    }

    /// Number of rows in the file, those kept from before included.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// What a checkpoint keeps of the rows written: their number and checksums.
    pub fn kept(&self) -> Kept {
        self.sums.kept(self.rows)
    }

    /// The columns, in the order of a row.
    pub fn columns(&self) -> &[FieldSpec] {
        &self.columns
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
