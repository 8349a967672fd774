//! Geometric faults: coinciding nodes, and nodes on faces of which they are no corner.

use crate::check::lies_on;
use crate::{Body, Face, Mesh};

/// Distance below which two nodes coincide, over the shortest edge of the body.
pub(crate) const COINCIDENT: f64 = 1e-6;

/// Distance of a hanging node from the face, over the face's longest edge. Hanging nodes lie on an
/// edge or in the plane of a face up to round-off or the sag of a curved side.
const ON_FACE: f64 = 1e-3;

/// Two nodes of the body that are closer than `fraction` of its shortest edge, if any.
pub(crate) fn duplicates(mesh: &Mesh, body: &Body, fraction: f64) -> Option<(usize, usize)> {
    let mut shortest = f64::INFINITY;
    for hex in &mesh.hexes[body.hexes.clone()] {
        for [a, b] in crate::hex::HEX_EDGES {
            shortest = shortest.min((mesh.at(hex[b]) - mesh.at(hex[a])).norm());
        }
    }
    let near = fraction * shortest;
    // A cell of no simple fraction of the edge: regular meshes then rarely have nodes on borders of cells.
    // Where an edge is close to zero, cells stay so large that their numbers fit an i64.
    let points = &mesh.nodes[body.nodes.clone()];
    let reach = points.iter().flatten().fold(0f64, |reach, x| reach.max(x.abs()));
    let cell = (0.3137 * shortest).max(1e-12 * reach);
    let mut places: Vec<([i64; 3], u32)> = Vec::with_capacity(body.nodes.len() * 9 / 8);
    for node in body.nodes.clone() {
        let p = mesh.nodes[node];
        let low = p.map(|x| ((x - near) / cell).floor() as i64);
        let high = p.map(|x| ((x + near) / cell).floor() as i64);
        for i in low[0]..=high[0] {
            for j in low[1]..=high[1] {
                for k in low[2]..=high[2] {
                    places.push(([i, j, k], node as u32));
                }
            }
        }
    }
    places.sort_unstable();
    for group in places.chunk_by(|a, b| a.0 == b.0) {
        for (i, a) in group.iter().enumerate() {
            for b in &group[i + 1..] {
                if (mesh.at(a.1) - mesh.at(b.1)).norm() < near {
                    return Some((a.1 as usize, b.1 as usize));
                }
            }
        }
    }
    None
}

/// A node of `boundary` that lies on one of its faces without being a corner of it, if any; and that face.
pub(crate) fn hanging(mesh: &Mesh, boundary: &[Face]) -> Option<(u32, Face)> {
    let mut nodes = crate::grid::nodes_of(boundary);
    // Strips across x, each sorted by z: a face then meets few nodes that are far from it.
    let at = |n: u32| mesh.at(n);
    nodes.sort_by(|&a, &b| at(a)[0].total_cmp(&at(b)[0]));
    let strip = (nodes.len() as f64).sqrt().ceil().max(1.0) as usize;
    let mut ends = Vec::with_capacity(strip);
    for nodes in nodes.chunks_mut(strip) {
        ends.push([at(nodes[0])[0], at(nodes[nodes.len() - 1])[0]]);
        nodes.sort_by(|&a, &b| at(a)[2].total_cmp(&at(b)[2]));
    }
    for &face in boundary {
        let p = face.nodes.map(at);
        let mut longest = 0f64;
        for i in 0..4 {
            longest = longest.max((p[(i + 1) % 4] - p[i]).norm());
        }
        let near = ON_FACE * longest;
        let low = [0, 1, 2].map(|a| p[0][a].min(p[1][a]).min(p[2][a]).min(p[3][a]) - near);
        let high = [0, 1, 2].map(|a| p[0][a].max(p[1][a]).max(p[2][a]).max(p[3][a]) + near);
        let first = ends.partition_point(|e| e[1] < low[0]);
        for s in first..ends.len() {
            if ends[s][0] > high[0] {
                break;
            }
            let nodes = &nodes[s * strip..((s + 1) * strip).min(nodes.len())];
            let from = nodes.partition_point(|&n| at(n)[2] < low[2]);
            for &n in &nodes[from..] {
                let x = at(n);
                if x[2] > high[2] {
                    break;
                }
                if x[0] < low[0] || x[0] > high[0] || x[1] < low[1] || x[1] > high[1] {
                    continue;
                }
                if !face.nodes.contains(&n) && lies_on(x, p, near) {
                    return Some((n, face));
                }
            }
        }
    }
    None
}
