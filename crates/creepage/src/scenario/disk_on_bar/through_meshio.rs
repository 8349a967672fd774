//! Mesh files that meshio reads: the Python package gives their mesh and its sets as VTU.

use std::io;
use std::path::Path;
use std::process::Stdio;

use crate::python;

/// The exit code of the package for a file that meshio cannot read.
const UNREADABLE: i32 = 2;

/// Its exit code after Ctrl-C, which a terminal sends to both programs.
const INTERRUPTED: i32 = 130;

/// Why a file is not read through meshio.
#[derive(Debug, thiserror::Error)]
pub enum MeshioError {
    /// No Python has the package.
    #[error(
        "it is read by meshio, through the Python package creepage, which no Python on the path has"
    )]
    NoPackage,
    /// The system does not run Python.
    #[error("Python, by which it is read, cannot be run: {0}")]
    NotRun(io::Error),
    /// The package, or what it needs to read the file, is missing or out of date.
    #[error("it is read by meshio, through the Python package creepage, which says: {said}")]
    Package {
        /// The last line of what it said.
        said: String,
    },
    /// It was asked to stop.
    #[error("it was asked to stop")]
    Interrupted,
    /// The file is none of its format.
    #[error("{said}")]
    Unreadable {
        /// What meshio says of it.
        said: String,
    },
}

/// The mesh of a file as VTU, its sets as arrays of zeros and ones.
///
/// # Errors
/// Where Python, the package or meshio is missing, and what meshio says of a file that it cannot read.
pub fn as_vtu(path: &Path) -> Result<Vec<u8>, MeshioError> {
    let mut reader = python::with_package().ok_or(MeshioError::NoPackage)?;
    reader.args(["-m", "creepage._through_meshio"]).arg(path).stdin(Stdio::null());
    let read = reader.output().map_err(MeshioError::NotRun)?;
    if read.status.success() {
        return Ok(read.stdout);
    }
    let said = String::from_utf8_lossy(&read.stderr);
    let said = said
        .lines()
        .rfind(|line| !line.trim().is_empty())
        .map_or_else(|| format!("nothing ({})", read.status), output::files::printable);
    Err(match read.status.code() {
        Some(INTERRUPTED) => MeshioError::Interrupted,
        Some(UNREADABLE) => MeshioError::Unreadable { said },
        _ => MeshioError::Package { said },
    })
}

impl MeshioError {
    /// What to do.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::NoPackage | Self::NotRun(_) | Self::Package { .. } => {
                "pip install 'creepage[mesh]' installs both; .msh, .inp and .vtu files are read without them"
            }
            Self::Unreadable { .. } => {
                "write the file anew with the program that it comes from, or as a .msh, .inp or .vtu file"
            }
            Self::Interrupted => "there are no results yet",
        }
    }
}
