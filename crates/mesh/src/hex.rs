//! The hexahedron: its corners, edges, faces and volume.

use nalgebra::{Matrix3, Vector3};

/// Corners of the six faces in the order x-, x+, y-, y+, z-, z+ of the reference cube, each
/// counter-clockwise seen from outside. Corners are indices in `VTK_HEXAHEDRON` order ([`HEX_CORNERS`]).
pub const HEX_FACES: [[usize; 4]; 6] =
    [[0, 4, 7, 3], [1, 2, 6, 5], [0, 1, 5, 4], [3, 7, 6, 2], [0, 3, 2, 1], [4, 5, 6, 7]];

/// Corners at the ends of the twelve edges, as indices in `VTK_HEXAHEDRON` order.
pub const HEX_EDGES: [[usize; 2]; 12] = [
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

/// Reference coordinates (xi, eta, zeta) of the corners in `VTK_HEXAHEDRON` order.
pub const HEX_CORNERS: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Volume (m^3) of the trilinear hexahedron with corners `p` (m) in `VTK_HEXAHEDRON` order, negative if it is inside
/// out: 2x2x2 Gauss points integrate its Jacobian exactly.
pub fn hex_volume(p: &[Vector3<f64>; 8]) -> f64 {
    let g = 1.0 / 3f64.sqrt();
    let mut volume = 0.0;
    for at in HEX_CORNERS {
        let mut jacobian = Matrix3::zeros();
        for (corner, x) in HEX_CORNERS.iter().zip(p) {
            let s = [0, 1, 2].map(|i: usize| 1.0 + corner[i] * at[i] * g);
            let gradient = Vector3::new(
                0.125 * corner[0] * s[1] * s[2],
                0.125 * corner[1] * s[0] * s[2],
                0.125 * corner[2] * s[0] * s[1],
            );
            jacobian += x * gradient.transpose();
        }
        volume += jacobian.column(0).dot(&jacobian.column(1).cross(&jacobian.column(2)));
    }
    volume
}

/// Integral of each corner's shape function over the bilinear face with corners `x` (m), in order around it (m^2).
///
/// By 2x2 Gauss points: exact for a plane, convex face.
pub fn quad_corner_areas(x: &[Vector3<f64>; 4]) -> [f64; 4] {
    const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let g = 1.0 / 3f64.sqrt();
    let mut areas = [0.0; 4];
    for [xi, eta] in CORNERS.map(|c| [c[0] * g, c[1] * g]) {
        let (mut a, mut b) = (Vector3::zeros(), Vector3::zeros());
        for (corner, x) in CORNERS.iter().zip(x) {
            a += 0.25 * corner[0] * (1.0 + corner[1] * eta) * x;
            b += 0.25 * corner[1] * (1.0 + corner[0] * xi) * x;
        }
        let jacobian = a.cross(&b).norm();
        for (area, corner) in areas.iter_mut().zip(CORNERS) {
            *area += 0.25 * (1.0 + corner[0] * xi) * (1.0 + corner[1] * eta) * jacobian;
        }
    }
    areas
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corner_areas_of_a_trapezium_have_its_area_and_its_first_moments() {
        let x =
            [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [3.0, 2.0, 1.0], [1.0, 2.0, 1.0]].map(Vector3::from);
        let areas = quad_corner_areas(&x);
        // area 6, centroid y = h/3 (a + 2b)/(a + b) = 8/9 with a = 4, b = 2, h = 2
        assert!((areas.iter().sum::<f64>() - 6.0).abs() < 1e-14);
        let moment: f64 = areas.iter().zip(x).map(|(a, x)| a * x[1]).sum();
        assert!((moment - 6.0 * 8.0 / 9.0).abs() < 1e-14);
    }
}
