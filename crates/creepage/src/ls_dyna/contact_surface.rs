//! The two surfaces of the contact: segments of a set, or outer faces of parts.

use std::collections::{BTreeSet, HashMap};

use mesh::geometry::{hull, vector_area};
use mesh::import::{Foreign, Set};
use nalgebra::Vector3;

use crate::ls_dyna::deck::Side;
use crate::ls_dyna::error::{DeckError, DeckLine, lacks, syntax, unknown};
use crate::ls_dyna::model::Bodies;

/// Cosine of the largest angle (60 degrees) at which an outer face may stand to the direction in which the other body
/// lies: side faces of disk and bar stand at 90.
const FACING: f64 = 0.5;

/// Makes the sides of the contact the sets `tread` of the disk and `top` of the bar.
///
/// # Errors
/// Sets, parts and nodes that are not there; sides without faces, or both on one body.
pub(crate) fn take(bodies: &Bodies, foreign: &mut Foreign) -> Result<(), DeckError> {
    let contact =
        bodies.deck.contact.as_ref().ok_or_else(|| lacks("*CONTACT_SURFACE_TO_SURFACE"))?;
    for side in &contact.sides {
        let faces = match side {
            Side::Segments(set) => bodies.segments("the contact", *set, &contact.place)?,
            Side::Part(part) => outer_faces(bodies, foreign, &[*part], &contact.place)?,
            Side::PartSet(set) => {
                let parts = bodies.deck.part_sets.get(set);
                let missing = || unknown(&contact.place, "the contact", format!("part set {set}"));
                outer_faces(bodies, foreign, parts.ok_or_else(missing)?, &contact.place)?
            }
        };
        let Some(first) = faces.first() else {
            let what = match side {
                Side::Segments(set) => format!("segment set {set} has no segments"),
                Side::Part(part) => {
                    format!("part {part} has no outer faces that face the other body")
                }
                Side::PartSet(set) => {
                    format!("the parts of set {set} have no outer faces that face the other body")
                }
            };
            return Err(syntax(&contact.place, what));
        };
        let name = if bodies.nodes[0].contains(&first[0]) { "tread" } else { "top" };
        if foreign.sets.insert(name.into(), Set { faces, ..Set::default() }).is_some() {
            let what = "the two surfaces of the contact lie on one body";
            return Err(syntax(&contact.place, what));
        }
    }
    Ok(())
}

/// The connected outer faces of parts of one body that face the other body: of the disk those that look away from its
/// axle, of the bar those that look up.
fn outer_faces(
    bodies: &Bodies,
    foreign: &Foreign,
    parts: &[u64],
    at: &DeckLine,
) -> Result<Vec<[u32; 4]>, DeckError> {
    let body = |part: &u64| {
        let body = bodies.parts.iter().position(|of_body| of_body.contains(part));
        body.ok_or_else(|| unknown(at, "the contact", format!("solids of part {part}")))
    };
    let of: BTreeSet<usize> = parts.iter().map(body).collect::<Result<_, _>>()?;
    let (Some(&body), true) = (of.first(), of.len() == 1) else {
        return Err(syntax(at, "a side of the contact needs parts of one body"));
    };
    let axle = axle(foreign);
    let mut facing = Vec::new();
    let of_body = |element: usize| bodies.parts[body].contains(&bodies.deck.solids[element].part);
    for (element, face) in mesh::outer_faces(&foreign.hexes, of_body) {
        if !parts.contains(&bodies.deck.solids[element].part) {
            continue;
        }
        let corners = face.map(|n| foreign.points[n as usize]);
        let centre = mean(&corners);
        // the deck may number elements inside out
        let inside = mean(&foreign.hexes[element].map(|n| foreign.points[n as usize]));
        let normal = vector_area(corners);
        let outward = if normal.dot(&(centre - inside)) < 0.0 { -1.0 } else { 1.0 };
        let (towards, height) = match body {
            0 => {
                let radius = Vector3::new(centre.x - axle.x, 0.0, centre.z - axle.z);
                (radius, radius.norm())
            }
            _ => (Vector3::z(), centre.z),
        };
        if outward * normal.dot(&towards) > FACING * normal.norm() * towards.norm() {
            facing.push((face, height));
        }
    }
    Ok(connected(facing))
}

/// Of faces with their heights those connected by edges with the highest: not the upper side of a foot.
fn connected(faces: Vec<([u32; 4], f64)>) -> Vec<[u32; 4]> {
    let edges = |[a, b, c, d]: [u32; 4]| {
        [[a, b], [b, c], [c, d], [d, a]].map(|[a, b]| [a.min(b), a.max(b)])
    };
    let mut at_edge: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (i, (face, _)) in faces.iter().enumerate() {
        edges(*face).into_iter().for_each(|edge| at_edge.entry(edge).or_default().push(i));
    }
    let highest = (0..faces.len()).max_by(|a, b| faces[*a].1.total_cmp(&faces[*b].1));
    let mut reached: BTreeSet<usize> = highest.into_iter().collect();
    let mut front: Vec<usize> = highest.into_iter().collect();
    while let Some(face) = front.pop() {
        for next in edges(faces[face].0).iter().flat_map(|edge| &at_edge[edge]) {
            if reached.insert(*next) {
                front.push(*next);
            }
        }
    }
    reached.into_iter().map(|face| faces[face].0).collect()
}

/// The middle of the hub, where the axle crosses y = 0.
fn axle(foreign: &Foreign) -> Vector3<f64> {
    let hub = foreign.sets.get("hub").map_or(&[][..], |hub| &hub.nodes);
    let [low, high] = hull(hub.iter().map(|n| &foreign.points[*n as usize]));
    0.5 * (low + high)
}

fn mean(points: &[Vector3<f64>]) -> Vector3<f64> {
    points.iter().sum::<Vector3<f64>>() / points.len() as f64
}
