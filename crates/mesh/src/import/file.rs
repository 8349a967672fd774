//! The format of a mesh file.

use super::error::ImportError;
use super::foreign::Foreign;
use super::{read_abaqus, read_gmsh, read_vtu};
use std::path::Path;

/// A format of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Gmsh's MSH 2.2 or 4.1, as text or binary.
    Gmsh,
    /// Abaqus input file.
    Abaqus,
    /// VTK XML unstructured grid.
    Vtu,
}

impl Format {
    /// The format by the extension of a file's name, in either letter case: `.msh`, `.inp` or `.vtu`; `None` for
    /// any other.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "msh" => Some(Self::Gmsh),
            "inp" => Some(Self::Abaqus),
            "vtu" => Some(Self::Vtu),
            _ => None,
        }
    }

    /// Reads the bytes of a file of this format.
    ///
    /// # Errors
    /// As [`read_gmsh`], [`read_abaqus`] and [`read_vtu`].
    pub fn read(self, bytes: &[u8]) -> Result<Foreign, ImportError> {
        match self {
            Self::Gmsh => read_gmsh(bytes),
            Self::Abaqus => read_abaqus(bytes),
            Self::Vtu => read_vtu(bytes),
        }
    }
}
