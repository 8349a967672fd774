//! Hexahedra that grow 2:1 in all directions away from the zone, without hanging nodes.
//!
//! The zone is a box of small cubes. The rest of the body lies about it in layers, like shells: each covers the bottom,
//! the lateral sides and the ends of the box, as far as these have not yet arrived at the sides of the body. A shell
//! meets the surface at right angles, and its own parts meet at mitres. Each layer is plain, or makes two columns of
//! four along one of three directions: along the rolling direction, across, or down. The size thus doubles in three
//! layers, in all directions.
//!
//! Next to the mitres columns widen with the distance by themselves, as many as make them grow by the ratio asked for.
//! They need not be merged, and columns that are merged stand straight. In the middle the lines of the
//! rolling direction stay straight all the way down.

mod build;
mod fan;
mod plan;
mod row;

use crate::check::boundary;
use crate::error::MAX_ELEMENTS;
use crate::grading::{LEAST_GAP, cells, divided, whole};
use crate::{Body, Face, FineZone, Mesh, MeshError, Surface};
use build::Draft;
pub(crate) use build::{BOTTOM, FRONT, REAR, TOP, ZONE};
use fan::{Fan, HIGH, LOW, Sizes};
use nalgebra::Vector3;
use plan::{Bulk, S};
use std::collections::BTreeMap;

/// Distances to two sides of the body whose ratio is at most this are reached by the same shell.
const TOGETHER: f64 = 1.1;

/// What is to be meshed about the zone.
pub(crate) struct Extent<'a> {
    /// Name of the body.
    pub name: &'static str,
    /// Ends of the body along the rolling direction (m).
    pub along: [f64; 2],
    /// Lines of the zone along the rolling direction, and downwards from 0 (m).
    pub lines: [&'a [f64]; 2],
    /// Width of the body, and its extent downwards (m).
    pub width: f64,
    pub depth: f64,
    /// Radius of the surface of a ring (m), whose two ends are joined.
    pub radius: Option<f64>,
    /// Largest size along the rolling direction (m).
    pub widest: f64,
}

/// A body of the zone and its shells, without sets and surfaces.
pub(crate) struct Shells {
    pub mesh: Mesh,
    /// Where each node lies: a sum of [`TOP`] and the others.
    flags: Vec<u8>,
    /// Faces of one element only.
    outside: Vec<Face>,
}

/// Meshes a body; `point` gives the place (m) of the coordinates s, y and z. Of a ring of radius R, z is R log(R/r).
///
/// # Errors
/// [`MeshError::TooManyElements`].
pub(crate) fn shells(
    extent: &Extent<'_>,
    zone: &FineZone,
    point: impl Fn([f64; 3]) -> Vector3<f64>,
) -> Result<Shells, MeshError> {
    let FineZone { size, .. } = *zone;
    let many = |estimate| MeshError::TooManyElements { body: extent.name, size, estimate };
    let bulk = bulk(extent, zone);
    let layers = bulk.layers(MAX_ELEMENTS).map_err(many)?;
    let mut draft = Draft::new(&bulk);
    draft.zone();
    for (index, layer) in layers.iter().enumerate() {
        draft.layer(layer, index);
    }
    let (nodes, hexes) = draft.sorted();
    let body = Body {
        name: extent.name.to_owned(),
        nodes: 0..nodes.len(),
        hexes: 0..hexes.len(),
        node_sets: BTreeMap::new(),
        surfaces: BTreeMap::new(),
    };
    let flags = nodes.iter().map(|n| n.flags).collect();
    let nodes = nodes.iter().map(|n| point(n.x)).collect();
    let mesh = Mesh { nodes, hexes, bodies: vec![body], symmetric: false };
    let outside = boundary(&mesh, &mesh.bodies[0])?;
    Ok(Shells { mesh, flags, outside })
}

/// Lines of the zone across the body: an even number of columns, symmetrical about y = 0.
fn across(zone: &FineZone, width: f64) -> Vec<f64> {
    let even = |length: f64| cells(length, zone.size).next_multiple_of(2);
    let half = 0.5 * width;
    let n = even(whole(zone.width, zone.size));
    let fine = 0.5 * (n as f64 * zone.size);
    let (fine, n) =
        if half - fine < LEAST_GAP * zone.size { (half, even(width)) } else { (fine, n) };
    divided([-fine, fine], n)
}

/// Lines of the zone from the surface downwards, as depths (m).
pub(crate) fn down(zone: &FineZone, depth: f64) -> Vec<f64> {
    let fine = whole(zone.depth, zone.size);
    let fine = if depth - fine < LEAST_GAP * zone.size { depth } else { fine };
    divided([0.0, fine], cells(fine, zone.size))
}

fn bulk(extent: &Extent<'_>, zone: &FineZone) -> Bulk {
    let half = 0.5 * extent.width;
    let sizes = Sizes { fine: zone.size, growth: zone.growth, coarsest: zone.coarsest };
    let mut fans = [
        Fan::new(extent.lines[0].to_vec(), extent.along, sizes),
        Fan::new(across(zone, extent.width), [-half, half], sizes),
        Fan::new(extent.lines[1].to_vec(), [0.0, extent.depth], sizes),
    ];
    let mut gaps: Vec<f64> = fans.iter().flat_map(|f| f.sides.map(|side| side.gap)).collect();
    gaps.sort_by(f64::total_cmp);
    let mut stages: Vec<f64> = Vec::new();
    for gap in gaps {
        let together = |start: &f64| gap <= (TOGETHER * start).max(start + zone.size);
        if gap > 0.0 && !stages.last().is_some_and(together) {
            stages.push(gap);
        }
    }
    let stage = |gap: f64| stages.iter().rev().find(|s| **s <= gap).copied().unwrap_or(0.0);
    for side in fans.iter_mut().flat_map(|f| &mut f.sides) {
        side.until = stage(side.gap);
    }
    if extent.radius.is_some() {
        // the two ends meet, whatever round-off says
        fans[S].sides[HIGH] = fans[S].sides[LOW];
    }
    let coarsest = [zone.coarsest.min(extent.widest), zone.coarsest, zone.coarsest];
    Bulk { fans, size: zone.size, growth: zone.growth, coarsest, radius: extent.radius }
}

impl Shells {
    /// Nodes that lie at any of the places `flags`, ascending.
    pub fn nodes(&self, flags: u8) -> Vec<u32> {
        let at = |n: &u32| self.flags[*n as usize] & flags != 0;
        (0..self.flags.len() as u32).filter(at).collect()
    }

    /// Faces of the outside whose nodes all lie at the place `flag`, in the order of the elements.
    pub fn faces(&self, flag: u8) -> Vec<Face> {
        let at = |n: u32| self.flags[n as usize] & flag != 0;
        self.outside.iter().filter(|f| f.nodes.into_iter().all(at)).copied().collect()
    }

    /// The mesh with these sets of nodes and these surfaces.
    pub fn named(
        mut self,
        sets: &[(&str, u8)],
        surfaces: &[(&str, u8, Option<crate::SmoothSurface>)],
    ) -> Mesh {
        let sets = sets.iter().map(|(name, flags)| ((*name).to_owned(), self.nodes(*flags)));
        let node_sets = sets.collect();
        let surfaces = surfaces.iter().map(|(name, flag, smooth)| {
            (
                (*name).to_owned(),
                Surface { faces: self.faces(*flag), smooth: smooth.clone(), irregularity: None },
            )
        });
        let surfaces = surfaces.collect();
        let body = &mut self.mesh.bodies[0];
        (body.node_sets, body.surfaces) = (node_sets, surfaces);
        self.mesh
    }
}
