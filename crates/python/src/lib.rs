//! Creepage for Python: the native part of the package `creepage`, whose Python part gives it the form in
//! which people use it.
//!
//! Its functions are those of the library (crate `creepage-lib`): the same documents, messages and exit codes. The script
//! `creepage` is the command line (crate `cli`). Results are read through `output`.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod commands;
mod contact;
mod files;
mod held;
mod law;
mod sweep;
mod text;

use pyo3::prelude::*;

/// The native part of Creepage.
#[pymodule]
mod _creepage {
    use std::path::PathBuf;

    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::commands::{
        check, import_k, interface_of_k, main, mesh, plot, report, run, schema, slider,
        stress_profile, sweep, view,
    };
    #[pymodule_export]
    use crate::contact::ContactWriter;
    #[pymodule_export]
    use crate::files::{Grid, History, layout};
    #[pymodule_export]
    use crate::law::check_law;
    #[pymodule_export]
    use crate::sweep::sweep_table;
    #[pymodule_export]
    use crate::text::{from_toml, toml};

    /// What the library does through Python is done in the interpreter that has imported this package.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let interpreter: Option<PathBuf> =
            module.py().import("sys")?.getattr("executable")?.extract()?;
        if let Some(interpreter) = interpreter.filter(|path| path.is_file()) {
            creepage::python::runs_in(interpreter);
        }
        Ok(())
    }

    /// Version of the program.
    #[pymodule_export]
    #[allow(non_upper_case_globals)] // as Python has it
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
