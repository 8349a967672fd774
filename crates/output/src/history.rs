//! Rows of scalars over time: one extendable 1-D dataset per column.

use crate::OutputError;
use crate::field::FieldSpec;
use crate::hdf5::{Appender, Creator, Growing, Kind, LayOut, cut_to_go_on, fix_headers, undo};
use crate::layout::ROW_COUNT;
use crate::provenance::Provenance;
use crate::sums::{Kept, Sums};
use std::path::{Path, PathBuf};

/// The datasets of the columns.
fn growing(columns: &[FieldSpec]) -> Vec<Growing> {
    let dataset = |column: &FieldSpec| Growing {
        name: column.name.to_string(),
        kind: Kind::Real,
        components: 1,
        rows: 1,
    };
    columns.iter().map(dataset).collect()
}

fn names(columns: &[FieldSpec]) -> impl Iterator<Item = String> {
    columns.iter().map(|column| column.name.to_string())
}

/// Writer of `history.h5`.
#[derive(Debug)]
pub struct History {
    path: PathBuf,
    columns: Vec<FieldSpec>,
    rows: usize,
    sums: Sums,
    scratch: Vec<f64>,
}

impl History {
    /// Writes the metadata of an empty history to `path` (replacing what is there) and closes it.
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
            file.rows::<f64>(&LayOut {
                group: &[],
                name: &column.name,
                units: &column.units,
                components: 1,
                description: &column.description,
            })?;
        }
        file.count(&[], ROW_COUNT, 0)?;
        file.close_with_headers_fixed(|path| {
            fix_headers(path, &growing(columns), &[], ROW_COUNT, 0)
        })?;
        let sums = Sums::of_new(&path, names(columns))?;
        Ok(Self { path, columns: columns.to_vec(), rows: 0, sums, scratch: Vec::new() })
    }

    /// Goes on with a history at `path` that was created with the same columns, cut off behind the rows
    /// that are kept; [`prove`](crate::prove) says whether it still holds them.
    pub fn reopen(
        path: impl AsRef<Path>,
        columns: &[FieldSpec],
        kept: &Kept,
    ) -> Result<Self, OutputError> {
        let (path, rows) = (path.as_ref().to_owned(), kept.records as usize);
        cut_to_go_on(&path, &growing(columns), &[], ROW_COUNT, rows)?;
        let sums = Sums::of_kept(kept, names(columns));
        Ok(Self { path, columns: columns.to_vec(), rows, sums, scratch: Vec::new() })
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
        // of the rows that are in the file, should this fail
        let before = self.sums.clone();
        let appended = self.append_whole(rows, width);
        if appended.is_err() {
            self.sums = before;
        }
        if !matches!(appended, Ok(()) | Err(OutputError::Another { .. })) {
            undo(&self.path, &growing(&self.columns), &[], ROW_COUNT, self.rows);
        }
        appended
    }

    fn append_whole(&mut self, rows: &[f64], width: usize) -> Result<(), OutputError> {
        let count = rows.len() / width;
        let mut file = Appender::open(&self.path)?;
        if let Some(column) = self.columns.last() {
            file.expect(&column.name, self.rows)?;
        }
        file.make_room(size_of_val(rows))?;
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

    /// Number of rows written.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// What a checkpoint needs to know of the rows written.
    pub fn kept(&self) -> Kept {
        self.sums.kept(self.rows)
    }

    /// The columns, in the order of a row.
    pub fn columns(&self) -> &[FieldSpec] {
        &self.columns
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
