//! The mesh of a case that names a mesh file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::case::mesh_file::{self, MeshFormat};
use crate::case::schema::{Case, Ends, LengthUnit, Symmetry};
use mesh::Mesh;
use mesh::import::{Fault, Foreign, Format, ImportError, Set, SetNames, Shape, Unit, bodies, fit};
use output::layout::{CONSTANT, MESH_SETS};
use output::{GridFile, OutputError, hexadecimal};
use sha2::{Digest, Sha256};

use super::through_meshio::{self, MeshioError};
use crate::scenario::error::{MeshFileError, ScenarioError};
use crate::scenario::remedy::Remedy;

/// The mesh of the file that a case names, if it names one, in metres, with remarks for the user.
///
/// # Errors
/// A file that cannot be read, has changed since the case was read, or is no mesh of the case's disk and bar.
pub fn import(case: &Case) -> Result<Option<(Mesh, Vec<String>)>, ScenarioError> {
    let Some(path) = case.mesh.file.as_ref().map(PathBuf::from) else { return Ok(None) };
    let refused = |problem: String, remedy: &str| {
        let (path, remedy) = (path.clone(), remedy.to_owned());
        ScenarioError::MeshFile(MeshFileError { path, place: None, problem, remedy })
    };
    let format = MeshFormat::of(&path)
        .ok_or_else(|| refused("is no mesh file".into(), mesh_file::ENDINGS))?;
    let bytes =
        mesh_file::read(&path).map_err(|problem| refused(problem, "bring the file back"))?;
    if case.mesh.sha256.as_ref().is_some_and(|s| *s != hexadecimal(&Sha256::digest(&bytes))) {
        return Err(refused("has changed since the case was read".into(), "begin anew"));
    }
    let foreign = match format {
        MeshFormat::Foreign(format) => format.read(&bytes),
        MeshFormat::ThroughMeshio => {
            let vtu = through_meshio::as_vtu(&path).map_err(|error| match error {
                MeshioError::Interrupted => ScenarioError::Interrupted,
                error => refused(error.to_string(), error.remedy()),
            })?;
            // a place in it is none of the user's file
            Format::Vtu.read(&vtu).map_err(|fault| ImportError { place: None, ..fault })
        }
        MeshFormat::Own => Ok(own(&path, &names(case)).map_err(|error| {
            refused(error.to_string(), "write it again with creepage mesh CASE --out FILE.vtkhdf")
        })?),
    };
    let imported = foreign
        .and_then(|foreign| whole(foreign, case))
        .and_then(|foreign| bodies(&foreign, &names(case), unit(case)))
        .and_then(|imported| fit(imported, &shape(case)))
        .map_err(|ImportError { place, fault }| {
            let (problem, remedy) = (output::files::printable(&fault.to_string()), fault.remedy());
            ScenarioError::MeshFile(MeshFileError { path: path.clone(), place, problem, remedy })
        })?;
    Ok(Some((imported.mesh, imported.notes)))
}

/// A grid that `creepage mesh` wrote: `body` tells the elements of disk and bar apart, and each field of
/// [`MESH_SETS`] is a set of nodes.
fn own(path: &Path, names: &SetNames) -> Result<Foreign, OutputError> {
    let file = GridFile::open(path)?;
    let (hexes, rest) = (file.connectivity()?.as_chunks::<8>().0.to_vec(), file.cells());
    let damaged = |reason: &str| OutputError::Read { path: path.to_owned(), reason: reason.into() };
    if hexes.len() != rest {
        return Err(damaged("its cells are no hexahedra"));
    }
    let points = file.points()?;
    if hexes.as_flattened().iter().any(|&node| node as usize >= points.len()) {
        return Err(damaged("a cell has a point that the file does not have"));
    }
    let chosen = |values: Vec<f64>, label: f64| -> Vec<u32> {
        (0..).zip(values).filter(|(_, value)| *value == label).map(|(index, _)| index).collect()
    };
    let mut sets = BTreeMap::new();
    for (label, name) in [(0.0, &names.disk), (1.0, &names.bar)] {
        let hexes = chosen(file.read(&CONSTANT.body.name, true, 0)?, label);
        sets.insert(name.clone(), Set { hexes, ..Set::default() });
    }
    let named = [&names.hub, &names.tread, &names.top, &names.clamp];
    for (spec, name) in MESH_SETS.each().into_iter().zip(named) {
        let nodes = chosen(file.read(&spec.name, false, 0)?, 1.0);
        sets.insert(name.clone(), Set { nodes, ..Set::default() });
    }
    Ok(Foreign::from_arrays(points, hexes, sets))
}

/// The whole mesh of a file that holds the half y >= 0 of the bodies of the case, as `creepage mesh` writes it of half
/// a model; any other mesh as it is.
fn whole(mut foreign: Foreign, case: &Case) -> Result<Foreign, ImportError> {
    // what separates half the width of the bodies from the whole
    const BETWEEN: f64 = 0.75;
    // the round-off of coordinates in a file, over the width
    const NEAR: f64 = 1e-6;
    let y = || foreign.points.iter().map(|point| unit(case).metres(point[1]));
    let low = y().fold(f64::INFINITY, f64::min);
    let high = y().fold(f64::NEG_INFINITY, f64::max);
    let width = case.disk.width.max(case.bar.width);
    let apart = low.abs() > NEAR * width || high > BETWEEN * width;
    if apart || case.mesh.plane_strain {
        return Ok(foreign);
    }
    if case.mesh.symmetry != Symmetry::Half {
        return Err(ImportError { place: None, fault: Fault::HalfOfBodies });
    }
    foreign.mirror(NEAR * high / unit(case).metres(1.0));
    Ok(foreign)
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
