//! JSON text, as Python writes it, and TOML text, as cases are written.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// JSON text as TOML text.
#[pyfunction]
pub fn toml(json: &str) -> PyResult<String> {
    let value: serde_json::Value = serde_json::from_str(json).map_err(|error| wrong(&error))?;
    ::toml::to_string(&value).map_err(|error| wrong(&error))
}

/// TOML text as JSON text.
#[pyfunction]
pub fn from_toml(toml: &str) -> PyResult<String> {
    let value: serde_json::Value = ::toml::from_str(toml).map_err(|error| wrong(&error))?;
    Ok(value.to_string())
}

fn wrong(error: &dyn std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}
