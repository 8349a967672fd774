//! The mesh of the patch test.

use crate::{Body, HEX_CORNERS, Mesh};
use nalgebra::Vector3;

/// The unit cube (1 m) with a skewed hexahedron inside, seven elements in all, for patch tests. Nodes 0 to 7 are
/// the corners of the cube, 8 to 15 those of the inner element, which is element 0. One body, `"patch"`.
///
/// Source: MacNeal and Harder (1985), "A proposed standard set of problems to test finite element
/// accuracy", Finite Elem. Anal. Des. 1: 3–20, Fig. 2.
pub fn seven_hex_patch() -> Mesh {
    const INNER: [[f64; 3]; 8] = [
        [0.249, 0.342, 0.192],
        [0.826, 0.288, 0.288],
        [0.850, 0.649, 0.263],
        [0.273, 0.750, 0.230],
        [0.320, 0.186, 0.643],
        [0.677, 0.305, 0.683],
        [0.788, 0.693, 0.644],
        [0.165, 0.745, 0.702],
    ];
    const FACES: [[u32; 4]; 6] =
        [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    let outer = HEX_CORNERS.map(|c| c.map(|v| 0.5 + 0.5 * v));
    let mut hexes = vec![[8, 9, 10, 11, 12, 13, 14, 15]];
    for [a, b, c, d] in FACES {
        // outer face seen from outside, inner face behind it
        hexes.push([a + 8, b + 8, c + 8, d + 8, a, b, c, d]);
    }
    Mesh {
        bodies: vec![Body {
            name: "patch".to_owned(),
            nodes: 0..16,
            hexes: 0..7,
            node_sets: Default::default(),
            surfaces: Default::default(),
        }],
        symmetric: false,
        nodes: outer.into_iter().chain(INNER).map(Vector3::from).collect(),
        hexes,
    }
}
