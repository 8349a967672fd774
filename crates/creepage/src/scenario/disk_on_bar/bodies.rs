//! The meshes of a disk and a bar, with their sets and masses.

use super::mesh_file;
use crate::case::irregularity::{Coordinate, SurfaceHeights};
use crate::case::schema::{Case, ContactLayers, Ends, Symmetry};
use crate::scenario::error::ScenarioError;
use crate::scenario::half_space::position;
use crate::scenario::memory::enough_for_mesh;
use crate::scenario::model::{BAR, DISK, Model};
use crate::scenario::wheel_on_rail::WheelOnRailError;
use mesh::profile::{profiled_bar, profiled_disk};
use mesh::{Along, FineZone, Irregularity, Mesh, Surface};
use nalgebra::Vector3;
use solid::{Element, Level, Material, Volumetric};
use std::sync::Arc;

/// The least scaled Jacobian of elements that follow profiles.
const LEAST_JACOBIAN: f64 = 0.3;

/// The model of a case: its mesh is generated, or read from its file.
///
/// # Errors
/// A mesh that cannot be made or read, or that this machine has no memory for.
pub fn model(case: &Case) -> Result<Model, ScenarioError> {
    if case.is_half_space() {
        return Err(ScenarioError::NoMesh);
    }
    enough_for_mesh(case)?;
    // refuses contact at two places, and a patch beyond the fine zone
    let position = position(case)?;
    let (mut mesh, notes) = match mesh_file::import(case)? {
        Some(imported) => imported,
        None => generated(case)?,
    };
    if case.mesh.symmetry == Symmetry::Half {
        mesh = mesh::half(&mesh)?;
    }
    let materials = [material(case.disk_material()), material(case.bar_material())];
    let paired = if case.mesh.plane_strain { align(&mut mesh)? } else { Vec::new() };
    let mut mass = solid::lumped_mass(&mesh, &materials.map(|m| m.density));
    for pair in &paired {
        let [a, b] = pair.map(|n| n as usize);
        mass[a] = 0.5 * (mass[a] + mass[b]);
        mass[b] = mass[a];
    }
    let surface =
        |body: usize, name: &str| mesh.bodies[body].surfaces.get(name).cloned().unwrap_or_default();
    let set = |body: usize, name: &str| {
        mesh.bodies[body].node_sets.get(name).cloned().unwrap_or_default()
    };
    let quiet = match case.bar.ends {
        Ends::Quiet => vec![surface(BAR, "rear"), surface(BAR, "front")],
        Ends::Free => Vec::new(),
    };
    Ok(Model {
        materials,
        element: Element { hourglass: case.element.hourglass },
        full: fully_integrated(case, &mesh),
        volumetric: match case.element.volumetric.unwrap_or_default() {
            crate::case::schema::Volumetric::Mean => Volumetric::Mean,
            crate::case::schema::Volumetric::Full => Volumetric::Full,
        },
        kernels: if case.deterministic { Level::pinned() } else { Level::detect() },
        law: None,
        multiplicity: case.mesh.symmetry.multiplicity(),
        sliding: sliding(case, &mesh),
        paired,
        mass,
        surfaces: irregular(case, [surface(DISK, "tread"), surface(BAR, "top")])?,
        zones: [surface(DISK, "zone").faces, surface(BAR, "zone").faces],
        hub: set(DISK, "hub"),
        clamped: set(BAR, "bottom"),
        quiet,
        mesh,
        position,
        notes,
    })
}

/// The running surfaces of disk and bar with the irregularities of the case.
fn irregular(
    case: &Case,
    [mut tread, mut top]: [Surface; 2],
) -> Result<[Surface; 2], ScenarioError> {
    let axis = Vector3::new(0.0, 0.0, case.axle_height());
    let with = |key, given: &Option<SurfaceHeights>, along, over| {
        let heights = given.as_ref().map(|given| given.heights(over)).transpose();
        let heights = heights.map_err(|problem| ScenarioError::Heights { key, problem })?;
        Ok::<_, ScenarioError>(heights.map(|heights| Irregularity { along, heights }))
    };
    let round = &case.disk.out_of_round;
    tread.irregularity = with("disk.out_of_round", round, Along::Around(axis), Coordinate::Angle)?;
    top.irregularity = with("bar.surface", &case.bar.surface, Along::X, Coordinate::X)?;
    Ok([tread, top])
}

/// Number of elements of the mesh of a case, which is made for it.
///
/// # Errors
/// As those of [`model`].
pub fn elements(case: &Case) -> Result<usize, ScenarioError> {
    Ok(model(case)?.mesh.hexes.len())
}

/// Width of a fine zone (m) with an even number of elements across it, so that nodes lie on y = 0; at most `widest` (m).
fn even_width(zone: &FineZone, widest: f64) -> f64 {
    let pair = 2.0 * zone.size;
    // a width that is even up to round-off stays
    let pairs = (zone.width / pair - 1e-9).ceil().max(1.0);
    if pairs * pair <= widest { pairs * pair } else { zone.width }
}

/// The meshes of the shapes that a case gives, with remarks for the user.
fn generated(case: &Case) -> Result<(Mesh, Vec<String>), ScenarioError> {
    let (mut disk, mut bar) = (case.disk.shape(), case.bar.shape());
    let mut zone = case.mesh.fine_zone();
    if case.mesh.symmetry == Symmetry::Half {
        zone.width = even_width(&zone, disk.width.min(bar.width));
    }
    let stretch = zone.width / zone.size;
    if case.mesh.plane_strain {
        // a slice is made one cube wide and stretched to its width
        (disk.width, bar.width, zone.width) = (zone.size, zone.size, zone.size);
    }
    let mut mesh = mesh::join(&of_shapes(case, &disk, &bar, &zone)?);
    if case.mesh.plane_strain {
        mesh.nodes.iter_mut().for_each(|x| x[1] *= stretch);
    }
    let widened = zone.width > case.mesh.zone.width * (1.0 + 1e-9);
    let note = || {
        format!(
            "the fine zone is {} mm wide, an even number of elements, so that nodes lie on y = 0",
            (1e7 * zone.width).round() / 1e4
        )
    };
    let notes = (widened && !case.mesh.plane_strain).then(note);
    Ok((mesh, notes.into_iter().collect()))
}

/// The meshes of disk and bar, whose running surfaces follow their profiles, if they have any.
fn of_shapes(
    case: &Case,
    disk: &mesh::Disk,
    bar: &mesh::Bar,
    zone: &FineZone,
) -> Result<[Mesh; 2], ScenarioError> {
    let Some((pair, point)) = case.first_contact().map_err(WheelOnRailError::from)? else {
        return Ok([mesh::disk(disk, zone)?, mesh::bar(bar, zone)?]);
    };
    let [wheel_mm, rail_mm] = point.profile_y.map(|y| 1e3 * y);
    let sections = pair.sections(&point, 0.5 * zone.width);
    let sections = sections.ok_or(WheelOnRailError::Beyond { wheel_mm, rail_mm })?;
    let [of_disk, of_bar] = sections.map(Arc::new);
    let disk = mesh::Disk { radius: case.axle_height(), ..*disk };
    let meshes = [profiled_disk(&disk, zone, &of_disk)?, profiled_bar(bar, zone, &of_bar)?];
    let least = |mesh: &Mesh| mesh::quality(mesh).min_scaled_jacobian;
    let least = least(&meshes[DISK]).min(least(&meshes[BAR]));
    if least < LEAST_JACOBIAN {
        return Err(ScenarioError::Lean { least, angle: point.angle });
    }
    Ok(meshes)
}

/// The nodes that do not move along y.
fn sliding(case: &Case, mesh: &Mesh) -> Vec<u32> {
    let on_plane = |n: &u32| case.mesh.plane_strain || mesh.nodes[*n as usize][1] == 0.0;
    let some = case.mesh.plane_strain || mesh.symmetric;
    (0..mesh.nodes.len() as u32).filter(|n| some && on_plane(n)).collect()
}

/// The pairs of nodes across a slice, whose second nodes are put exactly across from the first.
fn align(mesh: &mut Mesh) -> Result<Vec<[u32; 2]>, mesh::NoSlice> {
    let pairs = mesh::across(mesh)?;
    for &[first, second] in &pairs {
        let (from, to) = (mesh.at(first), &mut mesh.nodes[second as usize]);
        (to.x, to.z) = (from.x, from.z);
    }
    Ok(pairs)
}

/// Whether each element is fully integrated, as those in the contact layers of the fine zones are; empty where
/// none is.
fn fully_integrated(case: &Case, mesh: &Mesh) -> Vec<bool> {
    if case.element.contact_layers == ContactLayers::OnePoint {
        return Vec::new();
    }
    let layers = case.contact_layers() as usize;
    let mut full = vec![false; mesh.hexes.len()];
    for body in &mesh.bodies {
        let faces = body.surfaces.get("zone").map_or(&[][..], |zone| &zone.faces);
        let below = mesh::layers_below(mesh, body, faces, layers);
        below.into_iter().for_each(|e| full[e as usize] = true);
    }
    full
}

fn material(m: crate::case::schema::Material) -> Material {
    Material { young: m.young, poisson: m.poisson, density: m.density }
}
