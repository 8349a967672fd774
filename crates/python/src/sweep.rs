//! The table of a sweep for Python.

use pyo3::exceptions::{PyFileNotFoundError, PyOSError};
use pyo3::prelude::*;
use serde_json::json;
use std::path::PathBuf;

/// Name, units and meaning of a column.
type Described = (String, String, String);

/// The table of the sweep in a folder: its columns, the rows of its runs and points as JSON text, and the document of
/// `creepage sweep --json`, as JSON text.
#[pyfunction]
pub fn sweep_table(py: Python<'_>, folder: PathBuf) -> PyResult<(Vec<Described>, String, String)> {
    let found = py
        .detach(|| creepage::sweep_table(&folder))
        .map_err(|error| PyOSError::new_err(error.to_string()))?;
    let (table, document) = found.ok_or_else(|| {
        PyFileNotFoundError::new_err(format!("{} holds no sweep.json", folder.display()))
    })?;
    let columns = table.columns.into_iter().map(|c| (c.name, c.units, c.meaning)).collect();
    let rows = json!({ "runs": table.runs, "points": table.points });
    Ok((columns, rows.to_string(), document.to_string()))
}
