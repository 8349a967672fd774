//! The bar: fine under the contact, a tensor product or shells about the fine zone.

use crate::error::{MAX_ELEMENTS, finite, positive, within};
use crate::grading::{Axis, cells, divided, joined, whole};
use crate::grid::{Grid, nodes_of};
use crate::shells::{BOTTOM, Extent, FRONT, REAR, TOP, ZONE, down, shells};
use crate::zone::{check_crown, sag};
use crate::{Allowed, FineZone, Grading, Mesh, MeshError, Parameter, SmoothSurface, Surface};
use nalgebra::Vector3;

/// The shape of a straight bar along `x`; the apex of its top is at `z = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Extent along `x` (m).
    pub length: f64,
    /// Extent along `y` (m), from `-width/2` to `width/2`.
    pub width: f64,
    /// Extent below the apex (m).
    pub height: f64,
    /// Transverse radius of the top (m); `None` for a flat top.
    pub crown: Option<f64>,
    /// `x` of the rear end (m).
    pub start: f64,
}

/// The mesh of a bar: body `"bar"`, node sets `"top"`, `"bottom"`, `"ends"` and `"zone"` (the nodes
/// of the surface of that name), surfaces `"top"`, `"zone"` (the part of the top with elements of the fine
/// size), `"rear"` (the end at the smaller `x`) and `"front"`.
///
/// A crown of radius `c` lowers the nodes of the top by `c - sqrt(c^2 - y^2)`; this falls linearly to zero at
/// the bottom, which stays flat.
///
/// # Errors
/// [`MeshError::OutOfRange`] for a size that is not positive and finite, a crown too sharp for the width, or a
/// zone that does not fit into the bar; [`MeshError::TooManyElements`].
pub fn bar(shape: &Bar, zone: &FineZone) -> Result<Mesh, MeshError> {
    check(shape, zone)?;
    match zone.grading {
        Grading::Tensor => tensor(shape, zone),
        Grading::TwoToOne => graded(shape, zone),
    }
}

/// Both ends of the bar, and those of the zone on it (m).
fn spans(shape: &Bar, zone: &FineZone) -> [[f64; 2]; 2] {
    let span = [shape.start, shape.start + shape.length];
    [span, [zone.start.max(span[0]), (zone.start + zone.length).min(span[1])]]
}

/// Shells about the zone.
fn graded(shape: &Bar, zone: &FineZone) -> Result<Mesh, MeshError> {
    let Bar { width, height, crown, .. } = *shape;
    let [span, fine] = spans(shape, zone);
    let [from, to] = joined(span, fine, zone.size);
    let extent = Extent {
        name: "bar",
        along: span,
        lines: [&divided([from, to], cells(to - from, zone.size)), &down(zone, height)],
        width,
        depth: height,
        radius: None,
        widest: zone.coarsest,
    };
    let made = shells(&extent, zone, |[x, y, depth]| {
        let z = -depth;
        Vector3::new(x, y, z - sag(crown, y) * (z + height) / height)
    })?;
    let smooth = Some(SmoothSurface::Top { apex: 0.0, crown });
    Ok(made.named(
        &[("top", TOP), ("bottom", BOTTOM), ("ends", REAR | FRONT), ("zone", ZONE)],
        &[
            ("top", TOP, smooth.clone()),
            ("zone", ZONE, smooth),
            ("rear", REAR, None),
            ("front", FRONT, None),
        ],
    ))
}

/// A tensor product of three divisions.
fn tensor(shape: &Bar, zone: &FineZone) -> Result<Mesh, MeshError> {
    let Bar { width, height, crown, .. } = *shape;
    let FineZone { size, growth, coarsest, .. } = *zone;

    let [span, fine] = spans(shape, zone);
    let x = Axis::new(span, fine, size, growth, coarsest);
    let (half, fine) = (0.5 * width, 0.5 * whole(zone.width, size).min(width));
    let y = Axis::new([-half, half], [-fine, fine], size, growth, coarsest);
    let z = Axis::new([-height, 0.0], [-zone.depth.min(height), 0.0], size, growth, coarsest);

    let grid = Grid { cells: [x.cells(), y.cells(), z.cells()] };
    let elements = grid.cells.iter().map(|&n| n as f64).product::<f64>();
    if elements > MAX_ELEMENTS {
        return Err(MeshError::TooManyElements { body: "bar", size, estimate: elements });
    }
    let mut mesh = grid.mesh("bar", &x.points, &y.points, &z.points);
    if crown.is_some() {
        for p in &mut mesh.nodes {
            p[2] -= sag(crown, p[1]) * (p[2] + height) / height;
        }
    }

    let top = grid.side(&mesh, 5);
    let last = z.cells() - 1;
    let zone = grid.faces(&mesh, [x.fine, y.fine, last..last + 1], 5);
    let (rear, front) = (grid.side(&mesh, 0), grid.side(&mesh, 1));
    let bottom = nodes_of(&grid.side(&mesh, 4));
    let mut ends = nodes_of(&rear);
    ends.extend(nodes_of(&front));

    let body = &mut mesh.bodies[0];
    for (name, nodes) in
        [("top", nodes_of(&top)), ("bottom", bottom), ("ends", ends), ("zone", nodes_of(&zone))]
    {
        body.node_sets.insert(name.to_owned(), nodes);
    }
    let smooth = Some(SmoothSurface::Top { apex: 0.0, crown });
    for (name, faces, smooth) in [
        ("top", top, smooth.clone()),
        ("zone", zone, smooth),
        ("rear", rear, None),
        ("front", front, None),
    ] {
        body.surfaces.insert(name.to_owned(), Surface { faces, smooth, irregularity: None });
    }
    Ok(mesh)
}

fn check(shape: &Bar, zone: &FineZone) -> Result<(), MeshError> {
    let Bar { length, width, height, crown, start } = *shape;
    positive(Parameter::BarLength, length)?;
    positive(Parameter::BarWidth, width)?;
    positive(Parameter::BarHeight, height)?;
    finite(Parameter::BarStart, start)?;
    check_crown(Parameter::BarCrown, crown, width, height)?;
    zone.check()?;
    FineZone::fits(Parameter::ZoneLength, zone.length, length, "the length of the bar")?;
    FineZone::fits(Parameter::ZoneWidth, zone.width, width, "the width of the bar")?;
    FineZone::fits(Parameter::ZoneDepth, zone.depth, height, "the height of the bar")?;
    let slack = 1e-9 * length;
    let range = [start, start + length - zone.length];
    let on_the_bar = zone.start >= range[0] - slack && zone.start <= range[1] + slack;
    let allowed = Allowed::Between(range[0], range[1], "for the zone to lie on the bar");
    within(on_the_bar, Parameter::ZoneStart, zone.start, allowed)?;
    let count =
        |span, fine| Axis::estimate(span, fine, zone.size, zone.growth, zone.coarsest).max(1.0);
    let tensor = count(length, zone.length) * count(width, zone.width) * count(height, zone.depth);
    let estimate = zone.estimate(tensor);
    if estimate > MAX_ELEMENTS {
        return Err(MeshError::TooManyElements { body: "bar", size: zone.size, estimate });
    }
    Ok(())
}
