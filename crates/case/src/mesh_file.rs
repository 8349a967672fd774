//! Where the mesh file of a case is, and that it is the one meant.

use std::path::Path;

use files::input;
use mesh::import::Format;
use sha2::{Digest, Sha256};
use toml::Value;

use crate::error::CaseError;
use crate::layers::{Layers, get};
use output::hexadecimal;

const KEY: &str = "mesh.file";
const DIGEST: &str = "mesh.sha256";
/// Which endings a mesh file may have.
pub const ENDINGS: &str = "give a Gmsh .msh, an Abaqus .inp or a .vtu file; meshio converts others";

/// Puts the full path of the file that `mesh.file` names in its place, and the file's digest beside
/// it. The path is taken relative to the case file that holds it; of an option, to the working
/// directory.
pub fn resolve(layers: &mut Layers) -> Result<(), CaseError> {
    let Some(file) = get(&layers.table, KEY).and_then(Value::as_str).map(str::to_owned) else {
        return Ok(());
    };
    let origin = layers.origins.get(KEY);
    let (folder, relative) = layers.paths_from(origin);
    let path = folder.join(&file);
    let refused = |problem: &str, remedy: &str| {
        Err(layers.error(origin, KEY, &format!("\"{file}\": {problem}"), remedy))
    };
    if Format::of(&path).is_none() {
        return refused("the name ends in none of .msh, .inp and .vtu", ENDINGS);
    }
    let bytes = match read(&path) {
        Ok(bytes) => bytes,
        Err(problem) => {
            let problem = format!("{}: {problem}", path.display());
            return refused(&problem, &format!("give the path of a mesh file, {relative}"));
        }
    };
    let found = hexadecimal(&Sha256::digest(bytes));
    if let Some(expected) = get(&layers.table, DIGEST).and_then(Value::as_str)
        && expected != found
    {
        let problem = format!("\"{expected}\" is not that of {}, {found}", path.display());
        let remedy = "the mesh has changed: bring the file of then back, or leave mesh.sha256 out";
        return Err(layers.error(layers.origins.get(DIGEST), DIGEST, &problem, remedy));
    }
    let path = std::path::absolute(&path).unwrap_or(path);
    if let Some(Value::Table(mesh)) = layers.table.get_mut("mesh") {
        mesh.insert("file".into(), Value::String(path.display().to_string()));
        mesh.insert("sha256".into(), Value::String(found));
    }
    Ok(())
}

/// The bytes of a mesh file; what is wrong where it cannot be read.
///
/// # Errors
/// A file that is missing, too large or no file.
pub fn read(path: &Path) -> Result<Vec<u8>, String> {
    input::bytes(path, input::MESH).map_err(|error| error.problem())
}
