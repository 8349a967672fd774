//! The half of bodies that y = 0 is a plane of symmetry of.

use crate::hex::HEX_EDGES;
use crate::near::COINCIDENT;
use crate::{Body, Face, Mesh, Surface};
use nalgebra::Vector3;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::ops::Range;
use thiserror::Error;

/// Name of the node set of the nodes on the plane.
const PLANE: &str = "symmetry";

/// No node, element or set that has no place in the half.
const NONE: u32 = u32::MAX;

/// Why the plane y = 0 is no plane of symmetry of a mesh.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NotSymmetric {
    /// An element lies on both sides.
    #[error("element {element} at ({:.6}, {:.6}, {:.6}) m lies on both sides of y = 0", centre[0], centre[1], centre[2])]
    Across {
        /// Index in the mesh.
        element: usize,
        /// Mean of its corners (m).
        centre: Vector3<f64>,
    },
    /// A node has no mirror image.
    #[error("node {node} at ({:.6}, {:.6}, {:.6}) m has no mirror image", at[0], at[1], at[2])]
    Node {
        /// Index in the mesh.
        node: usize,
        /// Where it is (m).
        at: Vector3<f64>,
    },
    /// An element has no mirror image, although its nodes have theirs.
    #[error("element {element} has no mirror image, although its nodes have theirs")]
    Element {
        /// Index in the mesh.
        element: usize,
    },
    /// The mesh ends at the plane.
    #[error("the body \"{body}\" has no part y < 0: it is a half already")]
    Half {
        /// Its name.
        body: String,
    },
    /// A face of a surface lies in the plane.
    #[error("the set \"{set}\" of the body \"{body}\" has a face in the plane y = 0")]
    InPlane {
        /// Its body.
        body: String,
        /// Its name.
        set: String,
    },
    /// A set is not symmetric.
    #[error(
        "the set \"{set}\" of the body \"{body}\" holds one of two mirror images and not the other"
    )]
    Set {
        /// Its body.
        body: String,
        /// Its name.
        set: String,
    },
}

/// The half y >= 0 of a mesh that y = 0 is a plane of symmetry of. Elements and nodes keep their order, the nodes on the
/// plane get y = 0 exactly and are the node set `"symmetry"` of each body, and [`Mesh::symmetric`] is set.
///
/// Mirror images may differ by a millionth of the body's shortest edge: the round-off of coordinates in a file.
///
/// # Errors
/// The first element, node or set that shows that the mesh is not symmetric, or has no plane of nodes at y = 0.
pub fn half(mesh: &Mesh) -> Result<Mesh, NotSymmetric> {
    let mut half = Mesh { symmetric: true, ..Mesh::default() };
    for body in &mesh.bodies {
        let mirror = Mirror::new(mesh, body)?;
        mirror.check_sets(mesh, body)?;
        mirror.cut(mesh, body, &mut half);
    }
    Ok(half)
}

/// The mirror images of the nodes of a body.
struct Mirror {
    /// The body's nodes in the mesh.
    nodes: Range<usize>,
    /// The mirror image of each node, itself on the plane.
    image: Vec<u32>,
    /// Distance below which a node lies on the plane (m).
    near: f64,
}

impl Mirror {
    fn new(mesh: &Mesh, body: &Body) -> Result<Self, NotSymmetric> {
        let near = COINCIDENT * shortest_edge(mesh, body);
        let nodes = body.nodes.clone();
        let mut mirror = Self { image: vec![NONE; nodes.len()], nodes, near };
        mirror.check_sides(mesh, body)?;
        mirror.find_nodes(mesh)?;
        mirror.check_elements(mesh, body)?;
        Ok(mirror)
    }

    /// Whether a node lies behind the plane, on it or in front of it: the sign of its y.
    fn side(&self, mesh: &Mesh, node: u32) -> i8 {
        let y = mesh.nodes[node as usize][1];
        i8::from(y > self.near) - i8::from(y < -self.near)
    }

    fn image(&self, node: u32) -> u32 {
        self.image[node as usize - self.nodes.start]
    }

    fn check_sides(&self, mesh: &Mesh, body: &Body) -> Result<(), NotSymmetric> {
        if body.nodes.clone().all(|node| self.side(mesh, node as u32) >= 0) {
            return Err(NotSymmetric::Half { body: body.name.clone() });
        }
        for element in body.hexes.clone() {
            let hex = &mesh.hexes[element];
            let on = |side: i8| hex.iter().any(|&n| self.side(mesh, n) == side);
            if on(-1) && on(1) {
                let centre = hex.iter().map(|&corner| mesh.at(corner) / 8.0).sum::<Vector3<f64>>();
                return Err(NotSymmetric::Across { element, centre });
            }
        }
        Ok(())
    }

    /// Finds the image of each node among nodes sorted into cells much larger than the tolerance.
    fn find_nodes(&mut self, mesh: &Mesh) -> Result<(), NotSymmetric> {
        let size = self.near / COINCIDENT;
        let cell = |x: Vector3<f64>| <[i64; 3]>::from(x.map(|c| (c / size).floor() as i64));
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::with_capacity(self.nodes.len());
        for node in self.nodes.clone() {
            cells.entry(cell(mesh.nodes[node])).or_default().push(node as u32);
        }
        for node in self.nodes.clone() {
            let at = mesh.nodes[node];
            let wanted = Vector3::new(at.x, -at.y, at.z);
            let low = cell(wanted.add_scalar(-2.0 * self.near));
            let high = cell(wanted.add_scalar(2.0 * self.near));
            let is_image = |&n: &u32| (mesh.at(n) - wanted).norm() <= 2.0 * self.near;
            let found =
                boxes(low, high).find_map(|c| cells.get(&c)?.iter().copied().find(is_image));
            self.image[node - self.nodes.start] = match self.side(mesh, node as u32) {
                0 => node as u32,
                _ => found.ok_or(NotSymmetric::Node { node, at })?,
            };
        }
        Ok(())
    }

    fn check_elements(&self, mesh: &Mesh, body: &Body) -> Result<(), NotSymmetric> {
        let all: HashSet<[u32; 8]> =
            mesh.hexes[body.hexes.clone()].iter().map(|hex| sorted(*hex)).collect();
        let has_image = |e: &usize| all.contains(&sorted(mesh.hexes[*e].map(|n| self.image(n))));
        match body.hexes.clone().find(|e| !has_image(e)) {
            Some(element) => Err(NotSymmetric::Element { element }),
            None => Ok(()),
        }
    }

    fn check_sets(&self, mesh: &Mesh, body: &Body) -> Result<(), NotSymmetric> {
        let refused =
            |set: &String| Err(NotSymmetric::Set { body: body.name.clone(), set: set.clone() });
        for (name, set) in &body.node_sets {
            if set.iter().any(|&n| set.binary_search(&self.image(n)).is_err()) {
                return refused(name);
            }
        }
        for (name, surface) in &body.surfaces {
            let faces: HashSet<[u32; 4]> = surface.faces.iter().map(|f| sorted(f.nodes)).collect();
            let flat = |f: &Face| f.nodes.iter().all(|&n| self.side(mesh, n) == 0);
            let has_image = |f: &Face| faces.contains(&sorted(f.nodes.map(|n| self.image(n))));
            if surface.faces.iter().any(flat) {
                let (body, set) = (body.name.clone(), name.clone());
                return Err(NotSymmetric::InPlane { body, set });
            }
            if !surface.faces.iter().all(has_image) {
                return refused(name);
            }
        }
        Ok(())
    }

    /// Adds the half of the body to `half`.
    fn cut(&self, mesh: &Mesh, body: &Body, half: &mut Mesh) {
        let first = half.nodes.len();
        let mut number = vec![NONE; self.nodes.len()];
        let mut plane = Vec::new();
        for node in self.nodes.clone() {
            let mut at = mesh.nodes[node];
            let side = self.side(mesh, node as u32);
            if side < 0 {
                continue;
            }
            let new = half.nodes.len() as u32;
            number[node - self.nodes.start] = new;
            if side == 0 {
                plane.push(new);
                at.y = 0.0;
            }
            half.nodes.push(at);
        }
        let renumbered = |node: u32| number[node as usize - self.nodes.start];
        let first_hex = half.hexes.len();
        let mut kept = vec![NONE; body.hexes.len()];
        for element in body.hexes.clone() {
            let hex = mesh.hexes[element].map(renumbered);
            if !hex.contains(&NONE) {
                kept[element - body.hexes.start] = half.hexes.len() as u32;
                half.hexes.push(hex);
            }
        }
        let set = |nodes: &Vec<u32>| -> Vec<u32> {
            nodes.iter().map(|&n| renumbered(n)).filter(|&n| n != NONE).collect()
        };
        let face = |f: &Face| {
            let hex = kept[f.hex as usize - body.hexes.start];
            (hex != NONE).then(|| Face { nodes: f.nodes.map(renumbered), hex })
        };
        let surface = |s: &Surface| Surface {
            faces: s.faces.iter().filter_map(face).collect(),
            smooth: s.smooth.clone(),
            irregularity: s.irregularity.clone(),
        };
        let mut node_sets: BTreeMap<_, _> =
            body.node_sets.iter().map(|(name, nodes)| (name.clone(), set(nodes))).collect();
        node_sets.insert(PLANE.to_owned(), plane);
        half.bodies.push(Body {
            name: body.name.clone(),
            nodes: first..half.nodes.len(),
            hexes: first_hex..half.hexes.len(),
            node_sets,
            surfaces: body.surfaces.iter().map(|(name, s)| (name.clone(), surface(s))).collect(),
        });
    }
}

/// The cells of a box, which are few.
fn boxes(low: [i64; 3], high: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (low[0]..=high[0]).flat_map(move |i| {
        (low[1]..=high[1]).flat_map(move |j| (low[2]..=high[2]).map(move |k| [i, j, k]))
    })
}

/// Length of the shortest edge of a body (m).
fn shortest_edge(mesh: &Mesh, body: &Body) -> f64 {
    let edges = mesh.hexes[body.hexes.clone()]
        .iter()
        .flat_map(|hex| HEX_EDGES.map(|[a, b]| (mesh.at(hex[b]) - mesh.at(hex[a])).norm()));
    edges.fold(f64::INFINITY, f64::min)
}

fn sorted<const N: usize>(mut nodes: [u32; N]) -> [u32; N] {
    nodes.sort_unstable();
    nodes
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{Bar, Disk, FineZone, Grading, bar, block, disk, hex_volume, join, layers_below};

    fn rolling(width: f64, grading: Grading) -> Mesh {
        let zone = FineZone {
            size: 2e-3,
            length: 20e-3,
            width,
            depth: 6e-3,
            start: -10e-3,
            growth: 1.35,
            coarsest: 50e-3,
            grading,
        };
        let shape = Disk { radius: 0.1, hub_radius: 0.05, width: 20e-3, crown: None };
        let bed = Bar { length: 0.1, width: 20e-3, height: 20e-3, crown: Some(0.3), start: -0.05 };
        join(&[disk(&shape, &zone).unwrap(), bar(&bed, &zone).unwrap()])
    }

    fn volume(mesh: &Mesh) -> f64 {
        mesh.hexes.iter().map(|h| hex_volume(&h.map(|n| mesh.at(n)))).sum()
    }

    #[test]
    fn the_half_of_disk_and_bar_has_half_their_elements_volume_and_faces() {
        for grading in [Grading::Tensor, Grading::TwoToOne] {
            check_halves(&rolling(8e-3, grading));
        }
    }

    fn check_halves(whole: &Mesh) {
        let half = half(whole).unwrap();
        assert!(half.symmetric && 2 * half.hexes.len() == whole.hexes.len());
        assert!((volume(&half) / volume(whole) - 0.5).abs() < 1e-14);
        for (part, body) in half.bodies.iter().zip(&whole.bodies) {
            for (name, surface) in &body.surfaces {
                assert_eq!(2 * part.surfaces[name].faces.len(), surface.faces.len(), "{name}");
            }
            let plane = &part.node_sets["symmetry"];
            for (name, set) in &body.node_sets {
                let on_plane = part.node_sets[name].iter().filter(|n| plane.contains(n)).count();
                assert_eq!(2 * part.node_sets[name].len() - on_plane, set.len(), "{name}");
            }
            let faces = &part.surfaces["zone"].faces;
            assert_eq!(layers_below(&half, part, faces, 2).len(), 2 * faces.len());
        }
        assert!(half.nodes.iter().all(|x| x[1] >= 0.0));
        crate::check(&half).unwrap();
    }

    #[test]
    fn an_odd_number_of_columns_has_no_plane_of_nodes() {
        assert!(matches!(half(&rolling(9e-3, Grading::Tensor)), Err(NotSymmetric::Across { .. })));
    }

    #[test]
    fn a_node_an_element_or_a_set_without_its_mirror_image_is_found() {
        let centred = || {
            let mut mesh = block([3, 4, 2], [3.0, 4.0, 2.0]);
            mesh.nodes.iter_mut().for_each(|x| x[1] -= 2.0);
            mesh
        };
        assert!(half(&centred()).is_err(), "the sides y- and y+ are no symmetric sets");
        let sound = || {
            let mut mesh = centred();
            for side in ["y-", "y+"] {
                mesh.bodies[0].node_sets.remove(side);
                mesh.bodies[0].surfaces.remove(side);
            }
            mesh
        };
        assert_eq!(half(&sound()).unwrap().hexes.len(), 12);
        let mut moved = sound();
        moved.nodes[1][2] += 1e-3;
        assert!(matches!(half(&moved), Err(NotSymmetric::Node { .. })));
        let mut printed = sound();
        printed.nodes[1][2] += 1e-8;
        assert!(half(&printed).is_ok());
        let mut marked = sound();
        if let Some(set) = marked.bodies[0].node_sets.get_mut("z+") {
            set.pop();
        }
        assert!(matches!(half(&marked), Err(NotSymmetric::Set { .. })));
    }
}
