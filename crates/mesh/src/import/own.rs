//! A mesh of disk and bar as a mesh of another program would hold it: what [`bodies`](super::bodies()) reads again.

use super::SetNames;
use super::foreign::{Foreign, Set};
use crate::{Body, Mesh};

impl Foreign {
    /// The nodes and elements of a mesh of disk and bar, with the six sets of `names`: disk and bar are elements, hub and
    /// clamp nodes, tread and top faces.
    ///
    /// # Panics
    /// If the mesh is not one of a disk and a bar, generated or imported.
    pub fn of(mesh: &Mesh, names: &SetNames) -> Self {
        let [disk, bar] = [&mesh.bodies[0], &mesh.bodies[1]];
        let hexes = |body: &Body| {
            let hexes = body.hexes.clone().map(|hex| hex as u32).collect();
            Set { hexes, ..Set::default() }
        };
        let nodes = |body: &Body, set: &str| {
            let nodes = body.node_sets[set].clone();
            Set { nodes, ..Set::default() }
        };
        let faces = |body: &Body, surface: &str| {
            let faces = body.surfaces[surface].faces.iter().map(|face| face.nodes).collect();
            Set { faces, ..Set::default() }
        };
        let sets = [
            (&names.disk, hexes(disk)),
            (&names.bar, hexes(bar)),
            (&names.hub, nodes(disk, "hub")),
            (&names.tread, faces(disk, "tread")),
            (&names.top, faces(bar, "top")),
            (&names.clamp, nodes(bar, "bottom")),
        ];
        let sets = sets.into_iter().map(|(name, set)| (name.clone(), set)).collect();
        Self::from_arrays(mesh.nodes.clone(), mesh.hexes.clone(), sets)
    }
}

impl Set {
    /// Which of `count` nodes belong to the set, by themselves or as corners of its faces: 1 for each of them, 0 for others.
    pub fn node_flags(&self, count: usize) -> Vec<u8> {
        let mut flags = vec![0; count];
        let nodes = self.nodes.iter().chain(self.faces.as_flattened());
        nodes.for_each(|&node| flags[node as usize] = 1);
        flags
    }
}
