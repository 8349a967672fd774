//! Layers of elements below a surface.

use crate::{Body, Face, HEX_FACES, Mesh};
use std::collections::HashSet;

/// The elements of `body` within `layers` layers below `faces`, as ascending indices in `mesh`. The first layer is
/// the elements that own the faces; the next is those behind the opposite faces, and so on until the body ends.
///
/// Layers follow the columns of the mesh; they do not widen at the border of the faces.
///
/// # Panics
/// If a node of a face lies outside `body`, or `body` is not one of `mesh`.
pub fn layers_below(mesh: &Mesh, body: &Body, faces: &[Face], layers: usize) -> Vec<u32> {
    let sorted = |mut nodes: [u32; 4]| {
        nodes.sort_unstable();
        nodes
    };
    let mut found = vec![false; body.hexes.len()];
    // The upper faces of a layer; its elements lie below them and have not been found yet.
    let mut upper: HashSet<[u32; 4]> = faces.iter().map(|f| sorted(f.nodes)).collect();
    let mut touched = vec![false; body.nodes.len()];
    for _ in 0..layers {
        touched.fill(false);
        upper.iter().flatten().for_each(|&n| touched[n as usize - body.nodes.start] = true);
        let mut lower = HashSet::new();
        for (index, hex) in mesh.hexes[body.hexes.clone()].iter().enumerate() {
            let near = hex.iter().filter(|&&n| touched[n as usize - body.nodes.start]).count();
            if found[index] || near < 4 {
                continue;
            }
            for (side, corners) in HEX_FACES.iter().enumerate() {
                if upper.contains(&sorted(corners.map(|c| hex[c]))) {
                    found[index] = true;
                    // Sides come in pairs of opposites.
                    lower.insert(sorted(HEX_FACES[side ^ 1].map(|c| hex[c])));
                }
            }
        }
        upper = lower;
    }
    let first = body.hexes.start as u32;
    (0..found.len() as u32).filter(|&e| found[e as usize]).map(|e| first + e).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bar, Disk, FineZone, Grading, bar, block, disk, join};

    #[test]
    fn two_layers_below_a_part_of_the_top_of_a_block_are_the_columns_below_it() {
        let mesh = block([3, 4, 5], [3.0, 4.0, 5.0]);
        let body = &mesh.bodies[0];
        let faces: Vec<_> = body.surfaces["z+"]
            .faces
            .iter()
            .filter(|f| f.nodes.iter().all(|&n| mesh.nodes[n as usize][1] <= 2.0))
            .copied()
            .collect();
        let expected: Vec<u32> = (0..mesh.hexes.len() as u32)
            .filter(|&e| {
                mesh.hexes[e as usize].iter().all(|&n| {
                    let x = mesh.nodes[n as usize];
                    x[2] >= 3.0 && x[1] <= 2.0
                })
            })
            .collect();
        assert_eq!(expected.len(), 3 * 2 * 2);
        assert_eq!(layers_below(&mesh, body, &faces, 2), expected);
        assert_eq!(layers_below(&mesh, body, &faces, 0), []);
        assert_eq!(layers_below(&mesh, body, &faces, 99).len(), 3 * 2 * 5, "the body ends");
    }

    #[test]
    fn layers_of_the_second_of_two_bodies_carry_its_own_indices() {
        let zone = FineZone {
            size: 2e-3,
            length: 20e-3,
            width: 8e-3,
            depth: 6e-3,
            start: -10e-3,
            growth: 1.35,
            coarsest: 50e-3,
            grading: Grading::Tensor,
        };
        let shape = Disk { radius: 0.1, hub_radius: 0.05, width: 20e-3, crown: None };
        let bed = Bar { length: 0.1, width: 20e-3, height: 20e-3, crown: None, start: -0.05 };
        let mesh = join(&[disk(&shape, &zone).unwrap(), bar(&bed, &zone).unwrap()]);
        for body in &mesh.bodies {
            let faces = &body.surfaces["zone"].faces;
            let one = layers_below(&mesh, body, faces, 1);
            let mut owners: Vec<u32> = faces.iter().map(|f| f.hex).collect();
            owners.sort_unstable();
            assert_eq!(one, owners);
            let two = layers_below(&mesh, body, faces, 2);
            assert_eq!(two.len(), 2 * one.len());
            assert!(two.iter().all(|&e| body.hexes.contains(&(e as usize))));
        }
    }
}
