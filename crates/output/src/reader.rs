//! Readers of the files, also while the run goes on or after it was killed.
//!
//! A closing writer writes data first, headers of datasets after them and the counts `NSteps` and
//! `rows` last. Records that every dataset has are therefore complete; a kill between the headers
//! leaves some datasets one snapshot longer than others, and the readers ignore the excess. (They use
//! the lengths because the HDF5 library does not read numbers from a group's attributes.)

use crate::hdf5::{Source, read_error};
use crate::layout::{MESH, STEPS, data_path, mesh_path, step_path};
use crate::{FieldSpec, OutputError};
use std::ops::Range;
use std::path::Path;

/// A field of a grid as its file declares it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldInfo {
    /// Name of the dataset.
    pub name: String,
    /// Its `units` attribute.
    pub units: String,
    /// Numbers per point or cell.
    pub components: usize,
    /// Whether it is stored as unsigned bytes.
    pub integer: bool,
    /// Whether its values belong to cells instead of points.
    pub on_cells: bool,
    /// Whether it is stored once for all steps.
    pub constant: bool,
}

/// Reader of a file written by [`TransientGrid`](crate::TransientGrid). It sees the steps that
/// were complete when it was opened.
pub struct GridFile {
    source: Source,
    points: usize,
    cells: usize,
    steps: usize,
    fields: Vec<FieldInfo>,
}

impl GridFile {
    /// Opens `path` without locking it.
    ///
    /// # Errors
    /// A file that cannot be read, is damaged, or lacks the datasets of a grid.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let source = Source::open(path.as_ref())?;
        let points = first(&source, &MESH.point_count)?;
        let cells = first(&source, &MESH.cell_count)?;
        let steps = source.length(&step_path(&STEPS.times))?;
        let mut file = Self { source, points, cells, steps, fields: Vec::new() };
        for on_cells in [false, true] {
            let group = if on_cells { "CellData" } else { "PointData" };
            for name in file.source.names(&["VTKHDF", group])? {
                let (info, rows) = file.describe(name, on_cells)?;
                if !info.constant {
                    file.steps = file.steps.min(rows / file.count(on_cells).max(1));
                }
                file.fields.push(info);
            }
        }
        Ok(file)
    }

    /// Number of complete steps.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Simulated time of each step (s).
    ///
    /// # Errors
    /// A dataset that cannot be read.
    pub fn times(&self) -> Result<Vec<f64>, OutputError> {
        self.source.rows(&step_path(&STEPS.times), 0, self.steps)
    }

    /// The fields: those of points, then those of cells, each sorted by name.
    pub fn fields(&self) -> &[FieldInfo] {
        &self.fields
    }

    /// Root attribute such as `case_hash`.
    pub fn provenance(&self, attribute: &str) -> Result<String, OutputError> {
        self.source.root_text(attribute)
    }

    /// Reference coordinates of the points (m).
    ///
    /// # Errors
    /// A dataset that cannot be read.
    pub fn points(&self) -> Result<Vec<[f64; 3]>, OutputError> {
        let flat = self.source.rows(&mesh_path(&MESH.points), 0, self.points)?;
        Ok(flat.as_chunks::<3>().0.to_vec())
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.cells
    }

    /// Point indices of all cells, one cell after the other; four or eight each, by the type of the cells.
    ///
    /// # Errors
    /// A dataset that cannot be read.
    pub fn connectivity(&self) -> Result<Vec<u32>, OutputError> {
        let length = first(&self.source, &MESH.connectivity_count)?;
        let flat = self.source.rows(&mesh_path(&MESH.connectivity), 0, length)?;
        Ok(flat.into_iter().map(|index| index as u32).collect())
    }

    /// Values of a field at `step` (from 0), point after point (or cell after cell), components together, in the
    /// units of the field.
    ///
    /// # Errors
    /// A field or step that the file does not have; a dataset that cannot be read.
    pub fn read(&self, name: &str, on_cells: bool, step: usize) -> Result<Vec<f64>, OutputError> {
        self.read_steps(name, on_cells, step..step + 1)
    }

    /// As [`Self::read`] for several steps at once, one step after the other: much faster than each by
    /// itself, since every access searches the index of the file's chunks. A field that is stored once
    /// for all steps is returned once.
    ///
    /// # Errors
    /// As for [`Self::read`].
    pub fn read_steps(
        &self,
        name: &str,
        on_cells: bool,
        steps: Range<usize>,
    ) -> Result<Vec<f64>, OutputError> {
        let Some(field) = self.fields.iter().find(|f| f.name == name && f.on_cells == on_cells)
        else {
            let names: Vec<_> = self.fields.iter().map(|f| f.name.as_str()).collect();
            return Err(self.error(format!("no field `{name}`; it has {}", names.join(", "))));
        };
        if steps.end > self.steps && !field.constant {
            let last = steps.end.saturating_sub(1);
            return Err(self.error(format!("no step {last}; it has {} steps", self.steps)));
        }
        let count = self.count(on_cells);
        let (start, rows) =
            if field.constant { (0, count) } else { (steps.start * count, steps.len() * count) };
        self.source.rows(&data_path(name, on_cells), start, rows)
    }

    fn error(&self, reason: String) -> OutputError {
        read_error(self.source.path(), reason)
    }

    fn count(&self, on_cells: bool) -> usize {
        if on_cells { self.cells } else { self.points }
    }

    /// The field and the length of its dataset.
    fn describe(&self, name: String, on_cells: bool) -> Result<(FieldInfo, usize), OutputError> {
        let path = data_path(&name, on_cells);
        let shape = self.source.shape(&path)?;
        let info = FieldInfo {
            units: self.source.text(&path, "units")?,
            components: shape.get(1).copied().unwrap_or(1),
            integer: self.source.is_bytes(&path)?,
            on_cells,
            constant: self.source.is_fixed(&path)?,
            name,
        };
        Ok((info, shape.first().copied().unwrap_or(0)))
    }
}

/// Reader of a file written by [`History`](crate::History).
pub struct HistoryFile {
    source: Source,
    rows: usize,
}

impl HistoryFile {
    /// Opens `path` without locking it.
    ///
    /// # Errors
    /// A file that cannot be read or is damaged.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OutputError> {
        let source = Source::open(path.as_ref())?;
        let lengths = source.names(&[])?.into_iter().map(|name| source.length(&name));
        let rows = lengths.reduce(|a, b| Ok(a?.min(b?))).unwrap_or(Ok(0))?;
        Ok(Self { source, rows })
    }

    /// Number of complete rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Names of the columns, sorted.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn columns(&self) -> Result<Vec<String>, OutputError> {
        self.source.names(&[])
    }

    /// Units of a column, such as `m/s`; `1` for a pure number.
    ///
    /// # Errors
    /// A column that the file does not have.
    pub fn units(&self, column: &str) -> Result<String, OutputError> {
        self.source.text(column, "units")
    }

    /// Root attribute such as `case_hash`.
    pub fn provenance(&self, attribute: &str) -> Result<String, OutputError> {
        self.source.root_text(attribute)
    }

    /// All complete rows of a column in its units; `None` where the file does not have it.
    ///
    /// # Errors
    /// A dataset that cannot be read.
    pub fn column(&self, column: &FieldSpec) -> Result<Option<Vec<f64>>, OutputError> {
        let there = self.columns()?.iter().any(|name| *name == column.name);
        there.then(|| self.read(&column.name)).transpose()
    }

    /// All complete rows of the column of this name, in its units.
    ///
    /// # Errors
    /// A column that the file does not have or that cannot be read.
    pub fn read(&self, column: &str) -> Result<Vec<f64>, OutputError> {
        self.source.rows(column, 0, self.rows)
    }
}

fn first(source: &Source, dataset: &FieldSpec) -> Result<usize, OutputError> {
    let values = source.rows(&mesh_path(dataset), 0, 1)?;
    let value = values.first().copied();
    value
        .map(|count| count as usize)
        .ok_or_else(|| read_error(source.path(), format!("`{}` is empty", mesh_path(dataset))))
}
