//! A mesh in a file of its own.

use std::path::{Path, PathBuf};

use files::input;
use mesh::Mesh;
use mesh::import::{Format, ImportError, SetNames, Shape, Unit, bodies, fit};
use sha2::{Digest, Sha256};
use toml::Value;

use crate::error::CaseError;
use crate::layers::{Layers, get};
use crate::remedy::Remedy;
use crate::run_error::RunError;
use crate::schema::{Case, Ends, LengthUnit};
use output::hexadecimal;

const KEY: &str = "mesh.file";
const DIGEST: &str = "mesh.sha256";
const ENDINGS: &str = "give a Gmsh .msh, an Abaqus .inp or a .vtu file; meshio converts others";

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

fn read(path: &Path) -> Result<Vec<u8>, String> {
    input::bytes(path, input::MESH).map_err(|error| error.problem())
}

/// A mesh file that cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", place(path, *line))]
pub struct MeshFileError {
    /// The file.
    pub path: PathBuf,
    /// Line, counted from 1.
    pub line: Option<usize>,
    /// What is wrong.
    pub problem: String,
    /// What to do.
    pub remedy: String,
}

fn place(path: &Path, line: Option<usize>) -> String {
    let path = path.display();
    line.map_or(path.to_string(), |line| format!("{path}:{line}"))
}

/// The mesh of the file that a case names, if it names one, and what is to be said of it.
pub(crate) fn import(case: &Case) -> Result<Option<(Mesh, Vec<String>)>, RunError> {
    let Some(path) = case.mesh.file.as_ref().map(PathBuf::from) else { return Ok(None) };
    let refused = |problem: String, remedy: &str| {
        let (path, remedy) = (path.clone(), remedy.to_owned());
        RunError::MeshFile(MeshFileError { path, line: None, problem, remedy })
    };
    let format = Format::of(&path).ok_or_else(|| refused("is no mesh file".into(), ENDINGS))?;
    let bytes = read(&path).map_err(|problem| refused(problem, "bring the file back"))?;
    if case.mesh.sha256.as_ref().is_some_and(|s| *s != hexadecimal(&Sha256::digest(&bytes))) {
        return Err(refused("has changed since the case was read".into(), "begin anew"));
    }
    let imported = format
        .read(&bytes)
        .and_then(|foreign| bodies(&foreign, &names(case), unit(case)))
        .and_then(|imported| fit(imported, &shape(case)))
        .map_err(|ImportError { line, fault }| {
            let (problem, remedy) = (files::printable(&fault.to_string()), fault.remedy());
            RunError::MeshFile(MeshFileError { path: path.clone(), line, problem, remedy })
        })?;
    Ok(Some((imported.mesh, imported.notes)))
}

fn names(case: &Case) -> SetNames {
    let sets = &case.mesh.sets;
    let default = SetNames::default();
    let name = |set: &Option<String>, default: String| set.clone().unwrap_or(default);
    SetNames {
        disk: name(&sets.disk, default.disk),
        bar: name(&sets.bar, default.bar),
        hub: name(&sets.hub, default.hub),
        tread: name(&sets.tread, default.tread),
        top: name(&sets.top, default.top),
        clamp: name(&sets.clamp, default.clamp),
    }
}

fn unit(case: &Case) -> Unit {
    match case.mesh.unit.unwrap_or_default() {
        LengthUnit::Metre => Unit::Metre,
        LengthUnit::Centimetre => Unit::Centimetre,
        LengthUnit::Millimetre => Unit::Millimetre,
        LengthUnit::Inch => Unit::Inch,
    }
}

fn shape(case: &Case) -> Shape {
    Shape {
        disk: case.disk.shape(),
        bar: case.bar.shape(),
        zone: case.mesh.fine_zone(),
        exact: case.contact.curvature,
        ends: case.bar.ends == Ends::Quiet,
    }
}
