//! Slices: meshes one element wide along y, whose nodes lie opposite each other.

use crate::{HEX_EDGES, Mesh};
use nalgebra::Vector3;
use thiserror::Error;

/// Largest distance in the plane (x, z) between two opposite nodes, over their distance along y: the round-off of
/// coordinates printed in a mesh file.
const SLACK: f64 = 1e-6;

/// The element because of which a mesh is no slice.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "element {element} at ({:.6}, {:.6}, {:.6}) m does not reach across the mesh with two like faces, as \
     those of a slice one element wide do", centre[0], centre[1], centre[2]
)]
pub struct NoSlice {
    /// Index in the mesh.
    pub element: usize,
    /// Mean of its corners (m).
    pub centre: Vector3<f64>,
}

/// The pairs of nodes that lie opposite each other across a slice one element wide along y. The first node of each
/// pair has the smaller y; pairs ascend by it.
///
/// # Errors
/// The first element that does not have four edges across the slice, or one of whose edges is not along y.
pub fn across(mesh: &Mesh) -> Result<Vec<[u32; 2]>, NoSlice> {
    const NONE: u32 = u32::MAX;
    let mut partner = vec![NONE; mesh.nodes.len()];
    let mut pairs = Vec::with_capacity(mesh.nodes.len() / 2);
    for (element, hex) in mesh.hexes.iter().enumerate() {
        let corners = hex.map(|n| mesh.at(n));
        let centre = corners.iter().sum::<Vector3<f64>>() / 8.0;
        let mut edges = 0;
        for ends in HEX_EDGES {
            let [mut a, mut b] = ends;
            if (corners[a][1] < centre[1]) == (corners[b][1] < centre[1]) {
                continue;
            }
            if corners[b][1] < corners[a][1] {
                (a, b) = (b, a);
            }
            let across = corners[b] - corners[a];
            let [first, second] = [hex[a], hex[b]];
            let known = [partner[first as usize], partner[second as usize]];
            let like = known == [NONE; 2] || known == [second, first];
            if !like || libm::hypot(across.x, across.z) > SLACK * across.y {
                return Err(NoSlice { element, centre });
            }
            if known == [NONE; 2] {
                (partner[first as usize], partner[second as usize]) = (second, first);
                pairs.push([first, second]);
            }
            edges += 1;
        }
        if edges != 4 {
            return Err(NoSlice { element, centre });
        }
    }
    pairs.sort_unstable();
    Ok(pairs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{block, seven_hex_patch};

    #[test]
    fn every_node_of_a_block_one_element_wide_has_its_partner_across() {
        let mesh = block([3, 1, 2], [3.0, 2.0, 2.0]);
        let pairs = across(&mesh).unwrap();
        assert_eq!(2 * pairs.len(), mesh.nodes.len());
        for [a, b] in pairs {
            let [a, b] = [a, b].map(|n| mesh.at(n));
            assert_eq!((a[0], a[2], a[1] + 2.0), (b[0], b[2], b[1]));
        }
    }

    #[test]
    fn a_block_two_elements_wide_and_one_that_is_skewed_are_no_slices() {
        let wide = block([3, 2, 2], [3.0, 2.0, 2.0]);
        assert!(across(&wide).is_err());
        let mut skewed = block([3, 1, 2], [3.0, 1.0, 2.0]);
        skewed.nodes[5][0] += 1e-3;
        assert!(across(&skewed).is_err());
        assert!(across(&seven_hex_patch()).is_err());
    }
}
