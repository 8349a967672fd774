//! Comparison of the imported bodies with the shapes of the case.

use super::bodies::Imported;
use super::error::{Fault, ImportError, SetRole};
use super::unit::Unit;
use crate::check::boundary;
use crate::error::digits;
use crate::geometry::hull;
use crate::grid::nodes_of;
use crate::{
    Bar, Disk, Face, FineZone, Mesh, Parameter, SmoothSurface, Surface, quad_corner_areas,
};
use nalgebra::Vector3;

/// Largest relative deviation of a size of the mesh from that of the case. It allows for polygons instead of
/// circles, and for coordinates of few digits.
const SIZE: f64 = 0.01;

/// Largest distance of a contact surface from its place in the case, over the edge of the zone's elements.
const PLACE: f64 = 0.05;

/// Largest distance of the nodes of the zone from the exact surface, over the edge of the zone's elements. At
/// 2 mm it is 0.2 um, small against the 0.1 mm by which the bodies of the reference model approach each other.
const EXACT: f64 = 1e-4;

/// Largest deviation of a plane end of the bar from its plane, over the bar's length.
const PLANE: f64 = 1e-6;

/// The shapes of the case, with which an imported mesh is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// The disk.
    pub disk: Disk,
    /// The bar.
    pub bar: Bar,
    /// The fine zone; its depth, growth and coarsest size are not compared.
    pub zone: FineZone,
    /// Whether contact uses the exact surfaces of the case, cylinder and crown; the nodes of the zone must then
    /// lie on them. If not, contact uses the facets.
    pub exact: bool,
    /// Whether the bar's ends must be plane, as the quiet boundary requires.
    pub ends: bool,
}

/// Compares the bodies with the shapes of the case, and adds what generated meshes have besides: surfaces and
/// node sets `"zone"` (the faces of tread and top whose middle lies in the zone), exact surfaces if
/// [`Shape::exact`], and, if [`Shape::ends`], surfaces `"rear"` and `"front"` and the node set `"ends"` of the bar.
///
/// # Errors
/// The first disagreement: [`Fault::Size`], [`Fault::Unit`], [`Fault::Place`], [`Fault::NoEnd`],
/// [`Fault::Uncovered`], [`Fault::OffSurface`] or [`Fault::ZoneSize`].
pub fn fit(mut imported: Imported, shape: &Shape) -> Result<Imported, ImportError> {
    sizes(&imported, shape)?;
    ends(&mut imported, shape)?;
    let Shape { disk, bar, zone, .. } = *shape;
    let centre = disk.radius * Vector3::z();
    let tread = SmoothSurface::Tread { centre, radius: disk.radius, crown: disk.crown };
    let top = SmoothSurface::Top { apex: 0.0, crown: bar.crown };
    let names = imported.names.clone();
    let mut edges = [0.0; 2];
    for (body, ours, role, name, smooth) in [
        (0, "tread", SetRole::Tread, &names.tread, tread),
        (1, "top", SetRole::Top, &names.top, top),
    ] {
        let mesh = &imported.mesh;
        let all = mesh.bodies[body].surfaces[ours].faces.clone();
        let inside = |f: &&Face| in_zone(middle(mesh, f), body, shape);
        let faces: Vec<Face> = all.iter().filter(inside).copied().collect();
        // an empty sum is -0.0, which would be printed
        let area = 0.0 + faces.iter().map(|f| face_area(mesh, f)).sum::<f64>();
        let covered = area / (zone.length * zone.width);
        edges[body] = (area / faces.len() as f64).sqrt();
        // one row of elements may be missing at each side of the zone
        let row = 2.0 * edges[body].max(zone.size) * (1.0 / zone.length + 1.0 / zone.width);
        if faces.is_empty() || covered < (1.0 - row).max(0.25) {
            let name = name.clone();
            let (covered, faces) = (100.0 * covered, faces.len());
            return Err(Fault::Uncovered { role, name, covered, faces }.nowhere());
        }
        let nodes = nodes_of(&faces);
        if shape.exact {
            let limit = EXACT * zone.size;
            let off = |&n: &u32| smooth.offset(mesh.at(n)).abs();
            let worst = nodes.iter().copied().max_by(|a, b| off(a).total_cmp(&off(b)));
            if let Some(n) = worst.filter(|n| off(n) > limit) {
                let (node, distance) = (imported.nodes.id(n as usize), off(&n));
                let fault = Fault::OffSurface { node, name: name.clone(), distance, role, limit };
                return Err(imported.nodes.fault(n as usize, fault));
            }
        }
        let smooth = shape.exact.then_some(smooth);
        let body = &mut imported.mesh.bodies[body];
        body.surfaces.insert(
            ours.into(),
            Surface { faces: all, smooth: smooth.clone(), irregularity: None },
        );
        body.surfaces.insert("zone".into(), Surface { faces, smooth, irregularity: None });
        body.node_sets.insert("zone".into(), nodes);
    }
    let [disk, bar] = edges;
    if zone.size < disk.min(bar) / 1.5 || zone.size > disk.max(bar) * 1.5 {
        return Err(Fault::ZoneSize { disk, bar, size: zone.size }.nowhere());
    }
    Ok(imported)
}

/// Checks the sizes and places of the bodies.
fn sizes(imported: &Imported, shape: &Shape) -> Result<(), ImportError> {
    let Shape { disk, bar, zone, .. } = *shape;
    let mesh = &imported.mesh;
    let of_set = |body: usize, set: &str| {
        hull(mesh.bodies[body].node_sets[set].iter().map(|&n| &mesh.nodes[n as usize]))
    };
    let (tread, top) = (of_set(0, "tread"), of_set(1, "top"));
    let whole = [0, 1].map(|b: usize| hull(&mesh.nodes[mesh.bodies[b].nodes.clone()]));
    let span = |[low, high]: &[Vector3<f64>; 2], a: usize| high[a] - low[a];
    let close = |x: f64, y: f64| (x - y).abs() <= SIZE * y.abs();

    let radius = 0.5 * span(&tread, 0);
    if !close(radius, disk.radius) {
        let expected = disk.radius;
        let written = radius / imported.unit.metres(1.0);
        let unit = Unit::ALL.into_iter().filter(|u| *u != imported.unit);
        let mut unit = unit.filter(|u| close(u.metres(written), expected));
        return Err(match unit.next() {
            Some(unit) => Fault::Unit { found: digits(radius), expected, unit },
            None => size(Parameter::DiskRadius, radius, expected),
        }
        .nowhere());
    }
    let axis = 0.5 * (tread[0] + tread[1]);
    let hub = mesh.bodies[0].node_sets["hub"].iter().map(|&n| {
        let p = mesh.at(n) - axis;
        libm::hypot(p.x, p.z)
    });
    let hub = hub.fold(0.0, f64::max);
    let nearly = |what, found: f64, expected: f64, tolerance: f64| {
        if (found - expected).abs() <= tolerance {
            return Ok(());
        }
        Err(Fault::Place { what, found: digits(found), expected }.nowhere())
    };
    nearly("x of the disk's axis", axis.x, 0.0, SIZE * disk.radius)?;
    for (parameter, found, expected) in [
        (Parameter::DiskWidth, span(&whole[0], 1), disk.width),
        (Parameter::HubRadius, hub, disk.hub_radius),
        (Parameter::BarLength, span(&whole[1], 0), bar.length),
        (Parameter::BarWidth, span(&whole[1], 1), bar.width),
        (Parameter::BarHeight, span(&whole[1], 2), bar.height),
    ] {
        if !close(found, expected) {
            return Err(size(parameter, found, expected).nowhere());
        }
    }
    nearly("rear end of the bar (x)", whole[1][0].x, bar.start, SIZE * bar.length)?;
    for (what, [low, high], width) in [
        ("middle of the disk's width (y)", &whole[0], disk.width),
        ("middle of the bar's width (y)", &whole[1], bar.width),
    ] {
        nearly(what, 0.5 * (low.y + high.y), 0.0, SIZE * width)?;
    }
    // An apex between two nodes lies the sag of half an element beyond them.
    let sag = |curvature: f64| 0.125 * zone.size * zone.size * curvature;
    let across = |crown: Option<f64>| crown.map_or(0.0, f64::recip);
    let place = PLACE * zone.size;
    let apex = |crown| place + 4.0 * (sag(1.0 / disk.radius) + sag(across(crown)));
    nearly("lowest point of the tread (z)", tread[0].z, 0.0, apex(disk.crown))?;
    nearly("apex of the bar's top (z)", top[1].z, 0.0, apex(bar.crown))
}

fn size(parameter: Parameter, found: f64, expected: f64) -> Fault {
    Fault::Size { parameter, found: digits(found), expected }
}

/// Adds the faces and nodes of the bar's plane ends, if they are asked for.
fn ends(imported: &mut Imported, shape: &Shape) -> Result<(), ImportError> {
    if !shape.ends {
        return Ok(());
    }
    let mesh = &imported.mesh;
    let bar = &mesh.bodies[1];
    let outside = boundary(mesh, bar).map_err(|fault| Fault::Mesh(fault).nowhere())?;
    let [low, high] = hull(&mesh.nodes[bar.nodes.clone()]);
    let mut ends = Vec::new();
    for (which, at) in [("rear", low.x), ("front", high.x)] {
        let plane = |n: &u32| (mesh.nodes[*n as usize][0] - at).abs() <= PLANE * shape.bar.length;
        let faces: Vec<Face> =
            outside.iter().filter(|f| f.nodes.iter().all(plane)).copied().collect();
        if faces.is_empty() {
            return Err(Fault::NoEnd { which, at: digits(at) }.nowhere());
        }
        ends.push((which, Surface { faces, smooth: None, irregularity: None }));
    }
    let nodes = nodes_of(&ends.iter().flat_map(|e| &e.1.faces).copied().collect::<Vec<_>>());
    let bar = &mut imported.mesh.bodies[1];
    bar.node_sets.insert("ends".into(), nodes);
    ends.into_iter().for_each(|(which, surface)| {
        bar.surfaces.insert(which.into(), surface);
    });
    Ok(())
}

fn middle(mesh: &Mesh, face: &Face) -> Vector3<f64> {
    0.25 * face.nodes.iter().map(|&n| mesh.at(n)).sum::<Vector3<f64>>()
}

fn face_area(mesh: &Mesh, face: &Face) -> f64 {
    quad_corner_areas(&face.nodes.map(|n| mesh.at(n))).iter().sum()
}

/// Whether a point of a contact surface lies in the zone; on the disk its arc length from the first contact
/// takes the place of x, as in the generated mesh.
fn in_zone(p: Vector3<f64>, body: usize, shape: &Shape) -> bool {
    let Shape { disk, zone, .. } = *shape;
    let along = if body == 0 { disk.radius * libm::atan2(p.x, disk.radius - p.z) } else { p.x };
    let slack = 1e-6 * zone.size;
    along >= zone.start - slack
        && along <= zone.start + zone.length + slack
        && p.y.abs() <= 0.5 * zone.width + slack
}
