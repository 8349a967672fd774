//! The table of a sweep for Python.

use crate::held::json;
use creepage::Cell;
use pyo3::exceptions::{PyFileNotFoundError, PyOSError};
use pyo3::prelude::*;
use serde::Serialize;
use std::path::PathBuf;

/// Name, units and meaning of a column.
type Described = (String, String, String);

/// The rows of a table.
#[derive(Serialize)]
struct Rows {
    runs: Vec<Vec<Cell>>,
    points: Vec<Vec<Cell>>,
}

/// The table of the sweep in a folder: its columns, the rows of its runs and points as JSON text, and what
/// `creepage sweep --json` prints, as JSON text.
#[pyfunction]
pub fn sweep_table(py: Python<'_>, folder: PathBuf) -> PyResult<(Vec<Described>, String, String)> {
    let found = py
        .detach(|| creepage::sweep_table(&folder))
        .map_err(|error| PyOSError::new_err(error.to_string()))?;
    let (table, result) = found.ok_or_else(|| {
        PyFileNotFoundError::new_err(format!("{} holds no sweep.json", folder.display()))
    })?;
    let columns = table.columns.into_iter().map(|c| (c.name, c.units, c.meaning)).collect();
    let rows = Rows { runs: table.runs, points: table.points };
    Ok((columns, json(&rows), json(&result)))
}
