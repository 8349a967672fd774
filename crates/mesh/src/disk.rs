//! The disk: a plane mesh of a ring, coarsened towards the hub, extruded along `y`; or shells about the fine zone.

use crate::error::{MAX_ELEMENTS, positive, within};
use crate::grading::{Axis, LEAST_GAP, cells, divided, joined, outward, whole};
use crate::grid::nodes_of;
use crate::ring::Ring;
use crate::shells::{BOTTOM, Extent, TOP, ZONE, down, shells};
use crate::zone::{check_crown, sag};
use crate::{
    Allowed, Body, Face, FineZone, Grading, Mesh, MeshError, Parameter, SmoothSurface, Surface,
};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::ops::Range;

/// Largest angle of an element of the tread (rad).
const WIDEST_ELEMENT: f64 = 0.25;

/// Height of the first row under the fine zone, over the zone's element size: high enough for a row that coarsens.
const FIRST_ROW: f64 = 3.0;

/// The shape of a disk, an annulus about a rigid hub. It touches the origin from above: its centre is
/// `(0, 0, radius)`, its axis along `y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// Rolling radius at the apex of the tread (m).
    pub radius: f64,
    /// Radius of the rigid hub (m).
    pub hub_radius: f64,
    /// Extent along `y` (m), from `-width/2` to `width/2`.
    pub width: f64,
    /// Transverse radius of the tread (m); `None` for a straight tread.
    pub crown: Option<f64>,
}

/// The mesh of a disk: body `"disk"`, node sets `"hub"`, `"tread"` and `"zone"` (the nodes of the
/// surface of that name), surfaces `"tread"` and `"zone"` (the part of the tread with elements of the fine
/// size).
///
/// The point of the tread at the arc length `s` from the first contact lies at
/// `(R sin(s/R), y, R - R cos(s/R))`: in rolling it meets the bar at `x = s`. Columns of elements
/// are counted from the point opposite to the zone. A crown of radius `c` lowers the tread by
/// `c - sqrt(c^2 - y^2)`; this falls linearly to zero at the hub.
///
/// # Errors
/// [`MeshError::OutOfRange`] for a size that is not positive and finite, a hub as large as the disk, a crown too
/// sharp for the width, or a zone that does not fit; [`MeshError::TooManyElements`].
pub fn disk(shape: &Disk, zone: &FineZone) -> Result<Mesh, MeshError> {
    check(shape, zone)?;
    match zone.grading {
        Grading::Tensor => extruded(shape, zone),
        Grading::TwoToOne => graded(shape, zone),
    }
}

/// The two ends of the turn, half a turn from the middle of the zone, and those of the zone, as arc lengths (m).
fn spans(shape: &Disk, zone: &FineZone) -> [[f64; 2]; 2] {
    let length = whole(zone.length, zone.size);
    let (middle, turn) = (zone.start + 0.5 * length, PI * shape.radius);
    [[middle - turn, middle + turn], [zone.start, zone.start + length]]
}

/// Shells about the zone.
fn graded(shape: &Disk, zone: &FineZone) -> Result<Mesh, MeshError> {
    let Disk { radius, hub_radius, width, crown } = *shape;
    let [turn, fine] = spans(shape, zone);
    let [from, to] = joined(turn, fine, zone.size);
    let thickness = radius - hub_radius;
    // the logarithm of the radius makes shells that keep their angles towards the hub
    let inwards = |depth: f64| -radius * libm::log1p(-depth / radius);
    let hub = inwards(thickness);
    let rows: Vec<f64> = down(zone, thickness).into_iter().map(inwards).collect();
    let extent = Extent {
        name: "disk",
        along: turn,
        lines: [&divided([from, to], cells(to - from, zone.size)), &rows],
        width,
        depth: hub,
        radius: Some(radius),
        widest: WIDEST_ELEMENT * radius,
    };
    let made = shells(&extent, zone, |[s, y, z]| {
        let (sin, cos) = libm::sincos(s / radius);
        // the hub exactly, whatever round-off says
        let r = if z == hub { hub_radius } else { radius * libm::exp(-z / radius) };
        let r = r - sag(crown, y) * ((r - hub_radius) / thickness);
        Vector3::new(r * sin, y, radius - r * cos)
    })?;
    let smooth = Some(SmoothSurface::Tread { centre: radius * Vector3::z(), radius, crown });
    Ok(made.named(
        &[("hub", BOTTOM), ("tread", TOP), ("zone", ZONE)],
        &[("tread", TOP, smooth.clone()), ("zone", ZONE, smooth)],
    ))
}

/// A plane mesh of the ring, extruded.
fn extruded(shape: &Disk, zone: &FineZone) -> Result<Mesh, MeshError> {
    let Disk { radius, hub_radius, width, crown } = *shape;
    let FineZone { size, growth, coarsest, .. } = *zone;

    let [turn, fine] = spans(shape, zone);
    let arc = Axis::new(turn, fine, size, growth, coarsest.min(WIDEST_ELEMENT * radius));
    let angles: Vec<f64> = arc.points[..arc.cells()].iter().map(|s| s / radius).collect();
    let (half, fine) = (0.5 * width, 0.5 * whole(zone.width, size).min(width));
    let y = Axis::new([-half, half], [-fine, fine], size, growth, coarsest);
    let (radii, regular) = rows(shape, zone);
    let ny = y.cells();
    let ring = Ring::new(&angles, &radii, regular, MAX_ELEMENTS / ny as f64).map_err(|quads| {
        MeshError::TooManyElements { body: "disk", size, estimate: quads * ny as f64 }
    })?;

    let mut nodes = Vec::with_capacity(ring.nodes.len() * (ny + 1));
    for &[angle, r] in &ring.nodes {
        let (sin, cos) = libm::sincos(angle);
        let fade = (r - hub_radius) / (radius - hub_radius);
        nodes.extend(y.points.iter().map(|&y| {
            let r = r - sag(crown, y) * fade;
            Vector3::new(r * sin, y, radius - r * cos)
        }));
    }
    let at = |plane: u32, j: usize| plane * (ny as u32 + 1) + j as u32;
    let mut hexes = Vec::with_capacity(ring.quads.len() * ny);
    for [a, b, c, d] in &ring.quads {
        for j in 0..ny {
            let k = j + 1;
            let [a, b, c, d] = [*a, *b, *c, *d];
            hexes.push([
                at(a, j),
                at(b, j),
                at(c, j),
                at(d, j),
                at(a, k),
                at(b, k),
                at(c, k),
                at(d, k),
            ]);
        }
    }

    let columns = ring.outer.len();
    let outside = |columns_of: Range<usize>, ys: Range<usize>| -> Vec<Face> {
        let mut faces = Vec::with_capacity(columns_of.len() * ys.len());
        for c in columns_of {
            let (rear, front) = (ring.outer[c], ring.outer[(c + 1) % columns]);
            faces.extend(ys.clone().map(|j| Face {
                nodes: [at(rear, j), at(rear, j + 1), at(front, j + 1), at(front, j)],
                hex: ring.rim[c] * ny as u32 + j as u32,
            }));
        }
        faces
    };
    let tread = outside(0..columns, 0..ny);
    let zone = outside(arc.fine.clone(), y.fine.clone());
    let mut hub: Vec<u32> =
        ring.inner.iter().flat_map(|&n| (0..=ny).map(move |j| at(n, j))).collect();
    hub.sort_unstable();

    let smooth = Some(SmoothSurface::Tread { centre: radius * Vector3::z(), radius, crown });
    let body = Body {
        name: "disk".to_owned(),
        nodes: 0..nodes.len(),
        hexes: 0..hexes.len(),
        node_sets: BTreeMap::from([
            ("hub".to_owned(), hub),
            ("tread".to_owned(), nodes_of(&tread)),
            ("zone".to_owned(), nodes_of(&zone)),
        ]),
        surfaces: BTreeMap::from([
            (
                "tread".to_owned(),
                Surface { faces: tread, smooth: smooth.clone(), irregularity: None },
            ),
            ("zone".to_owned(), Surface { faces: zone, smooth, irregularity: None }),
        ]),
    };
    Ok(Mesh { nodes, hexes, bodies: vec![body], symmetric: false })
}

/// Radii of the rows, from the tread inwards, and the number of rows of the fine zone.
fn rows(shape: &Disk, zone: &FineZone) -> (Vec<f64>, usize) {
    let thickness = shape.radius - shape.hub_radius;
    let FineZone { size, depth, growth, coarsest, .. } = *zone;
    let depth = whole(depth, size);
    let depth = if thickness - depth < LEAST_GAP * size { thickness } else { depth };
    let n = cells(depth, size);
    let mut radii: Vec<f64> = (0..=n).map(|i| shape.radius - depth * i as f64 / n as f64).collect();
    let rest = thickness - depth;
    let first = (FIRST_ROW * size).min(coarsest);
    let previous = if rest > 2.0 * first { first / growth } else { size };
    radii
        .extend(outward(previous, growth, coarsest, rest).iter().map(|d| shape.radius - depth - d));
    if let Some(last) = radii.last_mut() {
        *last = shape.hub_radius;
    }
    (radii, n)
}

fn check(shape: &Disk, zone: &FineZone) -> Result<(), MeshError> {
    let Disk { radius, hub_radius, width, crown } = *shape;
    positive(Parameter::DiskRadius, radius)?;
    positive(Parameter::HubRadius, hub_radius)?;
    positive(Parameter::DiskWidth, width)?;
    let allowed = Allowed::Below(radius, "the radius of the disk");
    within(hub_radius < radius, Parameter::HubRadius, hub_radius, allowed)?;
    let thickness = radius - hub_radius;
    check_crown(Parameter::DiskCrown, crown, width, thickness)?;
    zone.check()?;
    let turn = PI * radius;
    FineZone::fits(Parameter::ZoneLength, zone.length, turn, "half the turn of the disk")?;
    FineZone::fits(Parameter::ZoneWidth, zone.width, width, "the width of the disk")?;
    FineZone::fits(Parameter::ZoneDepth, zone.depth, thickness, "the disk from hub to tread")?;
    let widest = 0.5 * WIDEST_ELEMENT * radius;
    let allowed = Allowed::AtMost(widest, "an eighth of the disk's radius");
    within(zone.size <= widest, Parameter::ZoneSize, zone.size, allowed)?;
    let allowed = Allowed::Between(-turn, turn, "half a turn of the disk either way");
    within(zone.start.abs() <= turn, Parameter::ZoneStart, zone.start, allowed)?;
    // With the rows of the fine zone alone this is a lower bound.
    let count =
        |span, fine| Axis::estimate(span, fine, zone.size, zone.growth, zone.coarsest).max(1.0);
    let extruded = count(2.0 * PI * radius, zone.length)
        * count(width, zone.width)
        * (zone.depth / zone.size).max(1.0);
    let estimate = zone.estimate(extruded);
    if estimate > MAX_ELEMENTS {
        return Err(MeshError::TooManyElements { body: "disk", size: zone.size, estimate });
    }
    Ok(())
}
