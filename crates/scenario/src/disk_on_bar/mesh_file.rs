//! The mesh of a case that names a mesh file.

use std::path::PathBuf;

use case::mesh_file;
use case::schema::{Case, Ends, LengthUnit};
use mesh::Mesh;
use mesh::import::{Format, ImportError, SetNames, Shape, Unit, bodies, fit};
use output::hexadecimal;
use sha2::{Digest, Sha256};

use crate::error::{MeshFileError, ScenarioError};
use crate::remedy::Remedy;

/// The mesh of the file that a case names, if it names one, in metres, with remarks for the user.
///
/// # Errors
/// A file that cannot be read, has changed since the case was read, or is no mesh of the case's disk and bar.
pub fn import(case: &Case) -> Result<Option<(Mesh, Vec<String>)>, ScenarioError> {
    let Some(path) = case.mesh.file.as_ref().map(PathBuf::from) else { return Ok(None) };
    let refused = |problem: String, remedy: &str| {
        let (path, remedy) = (path.clone(), remedy.to_owned());
        ScenarioError::MeshFile(MeshFileError { path, line: None, problem, remedy })
    };
    let format =
        Format::of(&path).ok_or_else(|| refused("is no mesh file".into(), mesh_file::ENDINGS))?;
    let bytes =
        mesh_file::read(&path).map_err(|problem| refused(problem, "bring the file back"))?;
    if case.mesh.sha256.as_ref().is_some_and(|s| *s != hexadecimal(&Sha256::digest(&bytes))) {
        return Err(refused("has changed since the case was read".into(), "begin anew"));
    }
    let imported = format
        .read(&bytes)
        .and_then(|foreign| bodies(&foreign, &names(case), unit(case)))
        .and_then(|imported| fit(imported, &shape(case)))
        .map_err(|ImportError { line, fault }| {
            let (problem, remedy) = (files::printable(&fault.to_string()), fault.remedy());
            ScenarioError::MeshFile(MeshFileError { path: path.clone(), line, problem, remedy })
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
