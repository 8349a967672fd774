//! The mesh file of a case: its path, its checksum, its bytes.

use std::path::Path;

use mesh::import::Format;
use output::files::input;
use sha2::{Digest, Sha256};
use toml::Value;

use crate::case::error::CaseError;
use crate::case::layers::Layers;
use crate::case::value::get;
use output::hexadecimal;

const KEY: &str = "mesh.file";
const DIGEST: &str = "mesh.sha256";
/// What to do about a name that ends in none of the endings of a mesh file.
pub const ENDINGS: &str =
    "give a Gmsh .msh, an Abaqus .inp, a .vtu or a .vtkhdf file, or one that meshio reads";

/// The endings of further formats from which meshio reads hexahedra and what may tell the bodies apart.
const THROUGH_MESHIO: [&str; 21] = [
    "avs", "bdf", "dat", "e", "ex2", "exo", "f3grid", "fem", "hmf", "mdpa", "med", "mesh", "meshb",
    "nas", "su2", "tec", "ugrid", "vol", "vtk", "xdmf", "xmf",
];

/// The format of a mesh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// One that other programs write.
    Foreign(Format),
    /// The VTKHDF grid of `creepage mesh --out`.
    Own,
    /// One that meshio reads.
    ThroughMeshio,
}

impl MeshFormat {
    /// The format by the ending of a file's name; `None` for one that is not read.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "vtkhdf" => Some(Self::Own),
            ending if THROUGH_MESHIO.contains(&ending) => Some(Self::ThroughMeshio),
            _ => Format::of(path).map(Self::Foreign),
        }
    }
}

/// Replaces `mesh.file` by the full path of the file, and sets `mesh.sha256`. The path is relative to the case
/// file that holds it; of an option, to the working directory.
///
/// # Errors
/// A file that cannot be read, has another ending than those of mesh files, or is not that of `mesh.sha256`.
pub fn resolve(layers: &mut Layers) -> Result<(), CaseError> {
    let Some(path) = layers.file_at(KEY) else { return Ok(()) };
    let refused = |problem: &str, remedy: &str| {
        let shown = get(&layers.table, KEY).and_then(Value::as_str).unwrap_or_default();
        Err(layers.error(KEY, &format!("\"{shown}\": {problem}"), remedy).into())
    };
    if MeshFormat::of(&path).is_none() {
        let problem = format!(
            "the name ends in none of .msh, .inp, .vtu and .vtkhdf, nor, for meshio, in one of .{}",
            THROUGH_MESHIO.join(", .")
        );
        return refused(&problem, ENDINGS);
    }
    let bytes = match read(&path) {
        Ok(bytes) => bytes,
        Err(problem) => {
            let problem = format!("{}: {problem}", path.display());
            let (_, relative) = layers.places.folder_of(KEY);
            return refused(&problem, &format!("give the path of a mesh file, {relative}"));
        }
    };
    let found = hexadecimal(&Sha256::digest(bytes));
    if let Some(expected) = get(&layers.table, DIGEST).and_then(Value::as_str)
        && expected != found
    {
        let problem = format!("\"{expected}\" is not that of {}, {found}", path.display());
        let remedy = "the mesh file has changed: restore the earlier one, or leave mesh.sha256 out";
        return Err(layers.error(DIGEST, &problem, remedy).into());
    }
    let path = std::path::absolute(&path).unwrap_or(path);
    if let Some(Value::Table(mesh)) = layers.table.get_mut("mesh") {
        mesh.insert("file".into(), Value::String(path.display().to_string()));
        mesh.insert("sha256".into(), Value::String(found));
    }
    Ok(())
}

/// The bytes of a mesh file.
///
/// # Errors
/// What is wrong with a file that is missing, too large or no file.
pub fn read(path: &Path) -> Result<Vec<u8>, String> {
    input::bytes(path, input::MESH).map_err(|error| error.problem())
}
