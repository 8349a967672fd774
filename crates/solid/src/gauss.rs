//! The Gauss points of one hexahedron in plain scalar form: what set-up, output and the stiffness of
//! the fully integrated element use, and the reference for its vector kernel.

use crate::geometry::{cross, dot};
use mesh::HEX_CORNERS as CORNERS;

/// One of the 2x2x2 Gauss points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GaussPoint {
    /// Volume that the point stands for, det(dX/dxi) (m^3).
    pub(crate) volume: f64,
    /// dN_I/dX_j (1/m).
    pub(crate) gradient: [[f64; 3]; 8],
}

/// The eight Gauss points of a hexahedron with corners `x` (m).
pub(crate) fn gauss_points(x: &[[f64; 3]; 8]) -> [GaussPoint; 8] {
    let p = 1.0 / 3f64.sqrt();
    CORNERS.map(|corner| {
        let [r, s, t] = corner.map(|c| c * p);
        let local = CORNERS.map(|c| {
            let [a, b, d] = [1.0 + r * c[0], 1.0 + s * c[1], 1.0 + t * c[2]];
            [c[0] * b * d / 8.0, c[1] * a * d / 8.0, c[2] * a * b / 8.0]
        });
        let mut j = [[0.0; 3]; 3];
        for (d, x) in local.iter().zip(x) {
            for k in 0..3 {
                for i in 0..3 {
                    j[k][i] += d[k] * x[i];
                }
            }
        }
        let cofactor = [cross(j[1], j[2]), cross(j[2], j[0]), cross(j[0], j[1])];
        let volume = dot(j[0], cofactor[0]);
        let gradient = local.map(|d| {
            [0, 1, 2].map(|i| (0..3).map(|k| d[k] * cofactor[k][i]).sum::<f64>() / volume)
        });
        GaussPoint { volume, gradient }
    })
}

impl GaussPoint {
    /// Displacement gradient H_ij = du_i/dX_j.
    pub(crate) fn displacement_gradient(&self, u: &[[f64; 3]; 8]) -> [[f64; 3]; 3] {
        let mut h = [[0.0; 3]; 3];
        for (u, b) in u.iter().zip(&self.gradient) {
            for i in 0..3 {
                for j in 0..3 {
                    h[i][j] += u[i] * b[j];
                }
            }
        }
        h
    }
}
