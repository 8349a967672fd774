//! Result files for Python: only what is asked for is read.
//!
//! A file is opened for every reading and closed again: nothing stands in the way of a run that writes it, or of
//! other threads.

use numpy::{IntoPyArray, PyArray1};
use output::layout::{CONSTANT, HISTORY, file};
use output::{FieldSpec, GridFile, HistoryFile, OutputError};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

fn failed(error: OutputError) -> PyErr {
    PyOSError::new_err(error.to_string())
}

/// The names of a run's files and of the datasets that the package itself reads, and what each file holds: for each
/// dataset its name, units, shape and meaning.
#[pyfunction]
pub fn layout(py: Python<'_>) -> PyResult<(Bound<'_, PyDict>, Bound<'_, PyDict>)> {
    let (names, files) = (PyDict::new(py), PyDict::new(py));
    for (key, name) in [
        ("case", file::CASE),
        ("fields", file::FIELDS),
        ("contact", file::CONTACT),
        ("history", file::HISTORY),
        ("probes", file::PROBES),
        ("summary", file::SUMMARY),
        ("body", &CONSTANT.body.name),
        ("time", &HISTORY.time.name),
    ] {
        names.set_item(key, name)?;
    }
    for (file, fields) in output::layout::files() {
        let described = |field: &FieldSpec| {
            [&*field.name, &*field.units, &*field.shape(), &*field.description].map(str::to_owned)
        };
        files.set_item(file, fields.iter().map(described).collect::<Vec<_>>())?;
    }
    Ok((names, files))
}

/// A field: name, units, components, integer, on_cells, constant.
type Described = (String, String, usize, bool, bool, bool);

/// A transient VTKHDF file, with the records that were complete when it was first opened.
#[pyclass(frozen)]
pub struct Grid {
    path: PathBuf,
    times: Vec<f64>,
    fields: Vec<Described>,
    cells: usize,
}

impl Grid {
    fn ask<T: Send>(
        &self,
        py: Python<'_>,
        question: impl FnOnce(&GridFile) -> Result<T, OutputError> + Send,
    ) -> PyResult<T> {
        py.detach(|| question(&GridFile::open(&self.path)?)).map_err(failed)
    }
}

#[pymethods]
impl Grid {
    #[new]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let open = || -> Result<Self, OutputError> {
            let file = GridFile::open(&path)?;
            let fields = file.fields().iter().map(|field| {
                let (name, units) = (field.name.clone(), field.units.clone());
                (name, units, field.components, field.integer, field.on_cells, field.constant)
            });
            let fields = fields.collect();
            Ok(Self { times: file.times()?, fields, cells: file.cells(), path })
        };
        py.detach(open).map_err(failed)
    }

    /// Time of each record (s).
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.times)
    }

    /// The fields: name, units, components, integer, on_cells, constant.
    fn fields(&self) -> Vec<Described> {
        self.fields.clone()
    }

    /// Number of cells.
    fn cells(&self) -> usize {
        self.cells
    }

    /// Reference coordinates (m), those of one point after the other.
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(self.ask(py, GridFile::points)?.into_flattened().into_pyarray(py))
    }

    /// Points of the cells, one cell after the other.
    fn connectivity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        Ok(self.ask(py, GridFile::connectivity)?.into_pyarray(py))
    }

    /// Values of the records from `start` up to `stop`, one record after the other.
    fn read<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        on_cells: bool,
        start: usize,
        stop: usize,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = self.ask(py, |file| file.read_steps(name, on_cells, start..stop))?;
        Ok(values.into_pyarray(py))
    }

    /// A root attribute such as `case_hash`.
    fn attribute(&self, py: Python<'_>, name: &str) -> PyResult<String> {
        self.ask(py, |file| file.provenance(name))
    }
}

/// A history, with the rows that were complete when it was first opened.
#[pyclass(frozen)]
pub struct History {
    path: PathBuf,
    rows: usize,
    /// Names and units.
    columns: Vec<(String, String)>,
}

#[pymethods]
impl History {
    #[new]
    fn open(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let open = || -> Result<Self, OutputError> {
            let file = HistoryFile::open(&path)?;
            let names = file.columns()?.into_iter();
            let columns = names.map(|name| Ok((name.clone(), file.units(&name)?)));
            let columns = columns.collect::<Result<_, OutputError>>()?;
            Ok(Self { rows: file.rows(), columns, path })
        };
        py.detach(open).map_err(failed)
    }

    /// Number of rows.
    fn rows(&self) -> usize {
        self.rows
    }

    /// Names and units of the columns, by name.
    fn columns(&self) -> Vec<(String, String)> {
        self.columns.clone()
    }

    /// A column.
    fn read<'py>(&self, py: Python<'py>, column: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let read = || HistoryFile::open(&self.path)?.read(column);
        let mut values = py.detach(read).map_err(failed)?;
        values.truncate(self.rows);
        Ok(values.into_pyarray(py))
    }
}
