//! Checks that a mesh is fit for the solver.

use crate::geometry::vector_area;
use crate::near::{COINCIDENT, duplicates, hanging};
use crate::quality::scaled_jacobian;
use crate::{Body, Face, HEX_FACES, Mesh, MeshError};
use nalgebra::{UnitVector3, Vector3};

/// Checks a mesh: ranges and indices, finite coordinates, positive Jacobians at all corners. Within each body,
/// every node belongs to an element, no two nodes coincide, every inner face is shared by exactly two elements on
/// opposite sides, and no node hangs on a face or edge.
///
/// # Errors
/// The first fault found: any [`MeshError`] but those of generators, [`MeshError::OutOfRange`] and
/// [`MeshError::TooManyElements`].
pub fn check(mesh: &Mesh) -> Result<(), MeshError> {
    let (mut nodes, mut hexes) = (0, 0);
    for body in &mesh.bodies {
        if body.nodes.start != nodes
            || body.hexes.start != hexes
            || body.nodes.end < nodes
            || body.hexes.end < hexes
            || body.nodes.end > mesh.nodes.len()
            || body.hexes.end > mesh.hexes.len()
        {
            return Err(MeshError::BodyRange { body: body.name.clone() });
        }
        (nodes, hexes) = (body.nodes.end, body.hexes.end);
        check_indices(mesh, body)?;
        check_shapes(mesh, body)?;
        let boundary = boundary(mesh, body)?;
        if let Some((first, second)) = duplicates(mesh, body, COINCIDENT) {
            return Err(MeshError::DuplicateNodes {
                first,
                second,
                point: mesh.nodes[first].into(),
            });
        }
        if let Some((node, face)) = hanging(mesh, &boundary) {
            let (node, element) = (node as usize, face.hex as usize);
            return Err(MeshError::HangingNode { node, face: face.nodes, element });
        }
    }
    if nodes != mesh.nodes.len() || hexes != mesh.hexes.len() {
        let body = mesh.bodies.last().map_or_else(String::new, |b| b.name.clone());
        return Err(MeshError::BodyRange { body });
    }
    Ok(())
}

fn check_indices(mesh: &Mesh, body: &Body) -> Result<(), MeshError> {
    let bad =
        |what: String, index: usize| MeshError::BadIndex { what, body: body.name.clone(), index };
    let mut used = vec![false; body.nodes.len()];
    for e in body.hexes.clone() {
        for n in mesh.hexes[e] {
            if !body.nodes.contains(&(n as usize)) {
                return Err(bad(format!("element {e}"), n as usize));
            }
            used[n as usize - body.nodes.start] = true;
        }
    }
    if let Some(loose) = used.iter().position(|u| !u) {
        return Err(MeshError::LooseNode { node: loose + body.nodes.start });
    }
    for (name, set) in &body.node_sets {
        if let Some(&n) = set.iter().find(|&&n| !body.nodes.contains(&(n as usize))) {
            return Err(bad(format!("node set `{name}`"), n as usize));
        }
        if !set.is_sorted_by(|a, b| a < b) {
            return Err(MeshError::UnsortedSet { set: name.clone(), body: body.name.clone() });
        }
    }
    for (name, surface) in &body.surfaces {
        for face in &surface.faces {
            if !body.hexes.contains(&(face.hex as usize)) {
                return Err(bad(format!("surface `{name}`"), face.hex as usize));
            }
            let corners = mesh.hexes[face.hex as usize];
            if !HEX_FACES.iter().any(|f| is_rotation(f.map(|c| corners[c]), face.nodes)) {
                return Err(MeshError::NotAFace {
                    surface: name.clone(),
                    body: body.name.clone(),
                    nodes: face.nodes,
                    hex: face.hex,
                });
            }
        }
    }
    Ok(())
}

/// Whether `b` names the corners of `a` in the same sense of rotation.
fn is_rotation(a: [u32; 4], b: [u32; 4]) -> bool {
    (0..4).any(|s| (0..4).all(|i| a[(i + s) % 4] == b[i]))
}

fn check_shapes(mesh: &Mesh, body: &Body) -> Result<(), MeshError> {
    for node in body.nodes.clone() {
        let point = mesh.nodes[node];
        if !point.iter().all(|x| x.is_finite()) {
            return Err(MeshError::NotFinite { node, point: point.into() });
        }
    }
    for element in body.hexes.clone() {
        let (corner, value) = scaled_jacobian(&mesh.hexes[element].map(|n| mesh.at(n)));
        // A scaled Jacobian below 1e-10 is round-off of a flat corner; NaN comes from an edge without length.
        if value.is_nan() || value <= 1e-10 {
            return Err(MeshError::NegativeJacobian { element, corner, value });
        }
    }
    Ok(())
}

/// The boundary faces of a body, which belong to one element only, in the order of the elements.
///
/// # Errors
/// [`MeshError::FaceShared`].
pub(crate) fn boundary(mesh: &Mesh, body: &Body) -> Result<Vec<Face>, MeshError> {
    let face = |e: usize, side: usize| HEX_FACES[side].map(|c| mesh.hexes[e][c]);
    let least = |f: [u32; 4]| f[0].min(f[1]).min(f[2]).min(f[3]) as usize - body.nodes.start;

    // Faces by their least node (counting sort), so that only a few need comparing.
    let mut start = vec![0u32; body.nodes.len() + 1];
    for e in body.hexes.clone() {
        for side in 0..6 {
            start[least(face(e, side)) + 1] += 1;
        }
    }
    for n in 1..start.len() {
        start[n] += start[n - 1];
    }
    let mut fill = start.clone();
    let mut by_node = vec![(0u32, 0u8); 6 * body.hexes.len()];
    for e in body.hexes.clone() {
        for side in 0..6 {
            let at = &mut fill[least(face(e, side))];
            by_node[*at as usize] = (e as u32, side as u8);
            *at += 1;
        }
    }
    let mut outside = Vec::new();
    for list in start.windows(2).map(|w| &by_node[w[0] as usize..w[1] as usize]) {
        for (i, &(e, side)) in list.iter().enumerate() {
            let nodes = face(e as usize, side as usize);
            let mut others = 0;
            for (k, &(e2, side2)) in list.iter().enumerate() {
                let other = face(e2 as usize, side2 as usize);
                if k == i || !nodes.iter().all(|n| other.contains(n)) {
                    continue;
                }
                others += 1;
                let [a, b, c, d] = other;
                if others > 1 || !is_rotation([d, c, b, a], nodes) {
                    return Err(MeshError::FaceShared { nodes, element: e as usize });
                }
            }
            if others == 0 {
                outside.push(Face { nodes, hex: e });
            }
        }
    }
    outside.sort_by_key(|f| f.hex);
    Ok(outside)
}

/// Whether `point` lies on the quadrilateral `corners`, within `tolerance` (m).
pub(crate) fn lies_on(point: Vector3<f64>, corners: [Vector3<f64>; 4], tolerance: f64) -> bool {
    let normal = UnitVector3::new_normalize(vector_area(corners));
    if (point - corners[0]).dot(&normal).abs() > tolerance {
        return false;
    }
    (0..4).all(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        let inward = normal.cross(&(b - a));
        (point - a).dot(&inward) >= -tolerance * inward.norm()
    })
}
