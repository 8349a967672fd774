//! Several meshes joined into one.

use crate::{Body, Face, Mesh, Surface};

/// One mesh of all bodies of `parts`, in order, with their indices shifted. No nodes are merged, and bodies of
/// equal name stay apart.
pub fn join(parts: &[Mesh]) -> Mesh {
    let mut whole = Mesh {
        nodes: Vec::with_capacity(parts.iter().map(|p| p.nodes.len()).sum()),
        hexes: Vec::with_capacity(parts.iter().map(|p| p.hexes.len()).sum()),
        bodies: Vec::with_capacity(parts.iter().map(|p| p.bodies.len()).sum()),
        symmetric: !parts.is_empty() && parts.iter().all(|p| p.symmetric),
    };
    for part in parts {
        let (n, e) = (whole.nodes.len(), whole.hexes.len());
        whole.nodes.extend_from_slice(&part.nodes);
        whole.hexes.extend(part.hexes.iter().map(|h| h.map(|i| i + n as u32)));
        whole.bodies.extend(part.bodies.iter().map(|b| shifted(b, n, e)));
    }
    whole
}

fn shifted(body: &Body, n: usize, e: usize) -> Body {
    let set = |nodes: &Vec<u32>| nodes.iter().map(|i| i + n as u32).collect();
    let surface = |s: &Surface| Surface {
        faces: s
            .faces
            .iter()
            .map(|f| Face { nodes: f.nodes.map(|i| i + n as u32), hex: f.hex + e as u32 })
            .collect(),
        smooth: s.smooth.clone(),
        irregularity: s.irregularity.clone(),
    };
    Body {
        name: body.name.clone(),
        nodes: body.nodes.start + n..body.nodes.end + n,
        hexes: body.hexes.start + e..body.hexes.end + e,
        node_sets: body.node_sets.iter().map(|(k, v)| (k.clone(), set(v))).collect(),
        surfaces: body.surfaces.iter().map(|(k, v)| (k.clone(), surface(v))).collect(),
    }
}
