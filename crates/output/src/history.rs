//! Rows of scalars over time: one extendable 1-D dataset per column.

use crate::hdf5::{Appender, Creator, LayOut};
use crate::{OutputError, Provenance};
use std::path::{Path, PathBuf};

/// One column of a [`History`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name of the dataset.
    pub name: String,
    /// SI units, `"1"` for a pure number.
    pub units: String,
    /// What it is, in a phrase.
    pub description: String,
}

impl Column {
    /// A column from its three texts.
    pub fn new(name: &str, units: &str, description: &str) -> Self {
        Self { name: name.into(), units: units.into(), description: description.into() }
    }
}

/// Writer of `history.h5`.
#[derive(Debug)]
pub struct History {
    path: PathBuf,
    columns: Vec<Column>,
    rows: usize,
    scratch: Vec<f64>,
}

impl History {
    /// Writes the metadata of an empty history to `path` (replacing what is there) and closes it.
    pub fn create(
        path: impl AsRef<Path>,
        columns: &[Column],
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
            file.rows::<f64>(&LayOut {
                group: &[],
                name: &column.name,
                units: &column.units,
                components: 1,
                description: &column.description,
            })?;
        }
        file.count(&[], "rows", 0)?;
        file.close()?;
        Ok(Self { path, columns: columns.to_vec(), rows: 0, scratch: Vec::new() })
    }

    /// Appends any number of rows, row after row (length: rows times columns).
    ///
    /// One call costs one opening of the file however many rows it brings: hand over many at once.
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
        let count = rows.len() / width;
        let mut file = Appender::open(&self.path)?;
        for (index, column) in self.columns.iter().enumerate() {
            self.scratch.clear();
            self.scratch.extend(rows.iter().skip(index).step_by(width));
            file.append(&column.name, &self.scratch)?;
        }
        file.close_with_count(&[], "rows", (self.rows + count) as i64)?;
        self.rows += count;
        Ok(())
    }

    /// Number of rows written.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The columns, in the order of a row.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
