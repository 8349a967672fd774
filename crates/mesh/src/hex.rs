//! The hexahedron: its corners, edges, faces and volume.

/// Corners of the six faces in the order x-, x+, y-, y+, z-, z+ of the reference cube, each
/// counter-clockwise seen from outside (`VTK_HEXAHEDRON` corner order).
pub const HEX_FACES: [[usize; 4]; 6] =
    [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]];

/// Ends of the twelve edges.
pub(crate) const EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [5, 6],
    [6, 7],
    [7, 4],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

/// The three neighbours of each corner, so ordered that their triple product is positive.
pub(crate) const NEIGHBOURS: [[usize; 3]; 8] =
    [[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]];

/// Reference coordinates of the corners.
const CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// Vector area of a quadrilateral: half the product of its diagonals (m^2).
pub(crate) fn area(p: [[f64; 3]; 4]) -> [f64; 3] {
    let a = cross(sub(p[2], p[0]), sub(p[3], p[1]));
    [0.5 * a[0], 0.5 * a[1], 0.5 * a[2]]
}

/// Volume of the trilinear hexahedron (m^3): 2x2x2 Gauss points integrate its Jacobian exactly.
pub(crate) fn volume(p: &[[f64; 3]; 8]) -> f64 {
    let g = 1.0 / 3f64.sqrt();
    let mut volume = 0.0;
    for at in CORNERS {
        let mut jacobian = [[0.0; 3]; 3];
        for (corner, x) in CORNERS.iter().zip(p) {
            let s = [
                1.0 + corner[0] * at[0] * g,
                1.0 + corner[1] * at[1] * g,
                1.0 + corner[2] * at[2] * g,
            ];
            let gradient = [
                0.125 * corner[0] * s[1] * s[2],
                0.125 * corner[1] * s[0] * s[2],
                0.125 * corner[2] * s[0] * s[1],
            ];
            for i in 0..3 {
                for j in 0..3 {
                    jacobian[i][j] += gradient[i] * x[j];
                }
            }
        }
        volume += dot(jacobian[0], cross(jacobian[1], jacobian[2]));
    }
    volume
}
