//! The functions of the library for Python.
//!
//! Each takes its options as TOML text, one key a line with the names of the library's structs, and returns a dict:
//! `code` (the exit code of the command line), `document` (as JSON text), `folder` (of a run), `interrupted` (by
//! Ctrl-C), and, where it failed, `error`, `text` (the error as it is shown) and `help`. `listen(kind, what)` hears
//! how far it is ("run", "sweep") and remarks ("said"), as JSON text.

use crate::held::{Answer, held};
use crate::law::PythonLaw;
use creepage::{FAILED, OwnLaw, RunOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::ffi::OsString;
use std::sync::Arc;

type Answered<'py> = PyResult<Bound<'py, PyDict>>;

/// Runs a case with the friction law `law`, where the case leaves it to Python.
#[pyfunction]
#[pyo3(signature = (options, law, listen))]
pub fn run<'py>(
    py: Python<'py>,
    options: &str,
    law: Option<Py<PyAny>>,
    listen: &Bound<'py, PyAny>,
) -> Answered<'py> {
    let law = law.map(|law| PythonLaw::new(py, law)).transpose()?.map(Arc::new);
    let mine = law.clone().map(|law| law as Arc<dyn OwnLaw>);
    let answer = held(options, listen, move |options: RunOptions, listener| {
        let done = creepage::run(&RunOptions { law: mine, ..options }, listener)?;
        Ok(Answer::new(done.exit_code(), &done.summary))
    });
    match law.and_then(|law| law.take_failure()) {
        Some(error) => Err(error),
        None => answer,
    }
}

/// Builds the mesh of a case.
#[pyfunction]
pub fn mesh<'py>(options: &str, listen: &Bound<'py, PyAny>) -> Answered<'py> {
    held(options, listen, |options, listener| {
        Ok(Answer::new(0, &creepage::mesh(&options, listener)?))
    })
}

/// Checks a run against the contact conditions.
#[pyfunction]
pub fn check<'py>(options: &str, listen: &Bound<'py, PyAny>) -> Answered<'py> {
    held(options, listen, |options, _| {
        let found = creepage::check(&options)?;
        Ok(Answer::new(if found.result.pass { 0 } else { FAILED }, &found.result))
    })
}

/// Functions whose answer is the document of the library's function of the same name.
macro_rules! documents {
    ($($(#[$about:meta])* $name:ident)*) => {$(
        $(#[$about])*
        #[pyfunction]
        pub fn $name<'py>(options: &str, listen: &Bound<'py, PyAny>) -> Answered<'py> {
            held(options, listen, |options, _| Ok(Answer::new(0, &creepage::$name(&options)?)))
        }
    )*};
}

documents! {
    /// Draws the figures of a run.
    plot
    /// The stress over the depth below the patch of a run, of the disk and of the bar.
    stress_profile
    /// Writes the page with the interactive scene of a run.
    view
    /// Writes the page about a run.
    report
    /// Makes a case and a mesh file of a keyword file of LS-DYNA.
    import_k
    /// Reads the contact of a keyword file of any model.
    interface_of_k
}

/// Runs a sweep.
#[pyfunction]
pub fn sweep<'py>(options: &str, listen: &Bound<'py, PyAny>) -> Answered<'py> {
    held(options, listen, |options, listener| {
        let done = creepage::sweep(&options, listener)?;
        Ok(Answer::new(done.exit_code(), &done.result))
    })
}

/// Computes with the 1-D slider.
#[pyfunction]
pub fn slider<'py>(options: &str, listen: &Bound<'py, PyAny>) -> Answered<'py> {
    held(options, listen, |options, listener| {
        let found = creepage::slider(&options, listener)?;
        Ok(Answer::new(found.exit_code(), &found))
    })
}

/// JSON Schema of a case, as JSON text.
#[pyfunction]
pub fn schema() -> String {
    creepage::schema().to_string()
}

/// Runs the command line for the terminal; `words` begin with the program's name. Returns the exit code.
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| cli::main(words))
}
