//! What the supports leave to contact: parts of the mesh that could move as a whole.

use crate::error::StaticsError;
use crate::supports::{Axis, Supports};
use mesh::Mesh;

/// A connected part of the mesh that no support stops along one axis.
#[derive(Clone, Debug)]
pub(crate) struct Drift {
    /// Label of the part.
    pub(crate) part: u32,
    pub(crate) axis: usize,
    /// Index of its body.
    pub(crate) body: usize,
}

/// The connected parts of a mesh.
pub(crate) struct Parts {
    /// The lowest node of the part that a node belongs to.
    pub(crate) label: Vec<u32>,
    pub(crate) drifts: Vec<Drift>,
}

impl Parts {
    /// Parts that share no element. A part that has neither a held nor a tied node floats; one
    /// without a held node and without an [`Axis::Moved`] along an axis may drift along it.
    pub(crate) fn new(mesh: &Mesh, supports: &Supports) -> Result<Self, StaticsError> {
        check(mesh, supports)?;
        let label = labels(mesh);
        let mut stopped = vec![[false; 3]; label.len()];
        let mut supported = vec![false; label.len()];
        for &n in &supports.held {
            let part = label[n as usize] as usize;
            (stopped[part], supported[part]) = ([true; 3], true);
        }
        for &n in &supports.sliding {
            stopped[label[n as usize] as usize][1] = true;
        }
        for tied in &supports.tied {
            for &n in &tied.nodes {
                let part = label[n as usize] as usize;
                supported[part] = true;
                for (stopped, axis) in stopped[part].iter_mut().zip(tied.axes) {
                    *stopped |= matches!(axis, Axis::Moved(_));
                }
            }
        }
        let mut drifts = Vec::new();
        for part in (0..label.len()).filter(|&n| label[n] as usize == n) {
            let body = body_of(mesh, part);
            if !supported[part] {
                let body = mesh.bodies[body].name.clone();
                return Err(StaticsError::Floating { body, node: part });
            }
            for axis in (0..3).filter(|&a| !stopped[part][a]) {
                drifts.push(Drift { part: part as u32, axis, body });
            }
        }
        Ok(Self { label, drifts })
    }

    pub(crate) fn contains(&self, drift: &Drift, node: usize) -> bool {
        self.label[node] == drift.part
    }
}

/// Index of the body of a node.
pub(crate) fn body_of(mesh: &Mesh, node: usize) -> usize {
    mesh.bodies.iter().position(|b| b.nodes.contains(&node)).unwrap_or(0)
}

fn check(mesh: &Mesh, supports: &Supports) -> Result<(), StaticsError> {
    let mut seen = vec![false; mesh.nodes.len()];
    let tied = supports.tied.iter().flat_map(|t| &t.nodes);
    if let Some(&node) = supports.sliding.iter().find(|&&n| n as usize >= seen.len()) {
        return Err(StaticsError::NoSuchNode { node });
    }
    for (&node, held) in supports.held.iter().map(|n| (n, true)).chain(tied.map(|n| (n, false))) {
        match seen.get_mut(node as usize) {
            None => return Err(StaticsError::NoSuchNode { node }),
            // Held twice is held.
            Some(seen) if *seen && !held => return Err(StaticsError::TwiceSupported { node }),
            Some(seen) => *seen = true,
        }
    }
    let numbers = supports.tied.iter().flat_map(|t| t.axes).map(|a| match a {
        Axis::Moved(value) | Axis::Loaded(value) => value,
    });
    for value in numbers {
        if !value.is_finite() {
            return Err(StaticsError::NotANumber { value });
        }
    }
    match supports.tied.iter().any(|t| t.nodes.is_empty()) {
        true => Err(StaticsError::EmptyGroup),
        false => Ok(()),
    }
}

/// The lowest node of each node's connected part, by union of the nodes of every element.
fn labels(mesh: &Mesh) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..mesh.nodes.len() as u32).collect();
    fn root(parent: &mut [u32], mut n: u32) -> u32 {
        while parent[n as usize] != n {
            parent[n as usize] = parent[parent[n as usize] as usize];
            n = parent[n as usize];
        }
        n
    }
    for hex in &mesh.hexes {
        let first = root(&mut parent, hex[0]);
        let least = hex.iter().fold(first, |least, &n| least.min(root(&mut parent, n)));
        for &n in hex {
            let top = root(&mut parent, n);
            parent[top as usize] = least;
        }
    }
    (0..mesh.nodes.len() as u32).map(|n| root(&mut parent, n)).collect()
}
