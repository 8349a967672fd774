//! Creepage for Python: the native part of the package `creepage`, whose Python part gives it the form in
//! which people use it.
//!
//! Commands are those of the command line (crate `cli`), held by Python instead of a terminal: the same
//! documents, messages and exit codes. Results are read through `output`.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod command;
mod files;
mod law;

use pyo3::prelude::*;

/// The native part of Creepage.
#[pymodule]
mod _creepage {
    #[pymodule_export]
    use crate::command::{command, from_toml, main, toml};
    #[pymodule_export]
    use crate::files::{Grid, History, layout};
    #[pymodule_export]
    use crate::law::check_law;
}
