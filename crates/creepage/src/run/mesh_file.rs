//! The mesh of a case as a file, which other programs and `mesh.file` read.

use std::path::Path;
use std::time::SystemTime;

use crate::case::schema::Case;
use crate::run::error::RunError;
use crate::scenario::Model;
use mesh::import::{Foreign, SetNames, write_gmsh};
use output::layout::MESH_SETS;
use output::{Cells, GridSpec, NotWritten, Provenance, StaticField, TransientGrid};

/// Writes nodes, elements and the six sets of a mesh: by the ending of `path` as `.msh` (format 2.2), `.vtu`, or VTKHDF.
pub(crate) fn write_mesh(path: &Path, case: &Case, model: &Model) -> Result<(), RunError> {
    let mesh = &model.mesh;
    let names = SetNames::default();
    let foreign = Foreign::of(mesh, &names);
    let ends = |ending: &str| path.extension().is_some_and(|e| e == ending);
    if ends("msh") {
        let written = std::fs::write(path, write_gmsh(&foreign));
        return Ok(written.map_err(|cause| NotWritten { path: path.to_owned(), cause })?);
    }
    let bodies = mesh.bodies.iter().enumerate();
    let body: Vec<u8> =
        bodies.flat_map(|(k, b)| std::iter::repeat_n(k as u8, b.hexes.len())).collect();
    let sets = [names.hub, names.tread, names.top, names.clamp]
        .map(|name| foreign.sets[&name].node_flags(mesh.nodes.len()));
    let mut constant = vec![StaticField::body(&body)];
    let specs = MESH_SETS.each().into_iter().zip(&sets);
    constant.extend(specs.map(|(spec, members)| StaticField::set(spec, members)));
    let points: Vec<[f64; 3]> = mesh.nodes.iter().map(|&x| x.into()).collect();
    let grid =
        GridSpec { points: &points, cells: Cells::Hexahedra(&mesh.hexes), constant: &constant };
    if ends("vtu") {
        return Ok(output::write_vtu(path, &grid)?);
    }
    let provenance = Provenance {
        creepage_version: env!("CARGO_PKG_VERSION").into(),
        case_hash: case.hash(),
        created: humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        attributes: crate::run::execute::kinds(case),
    };
    Ok(TransientGrid::create(path, &grid, &[], &provenance)?.append(0.0, &[])?)
}
