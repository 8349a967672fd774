//! The Gauss points of one hexahedron in plain scalar form, for set-up, output, the stiffness of the fully integrated
//! element, and tests of its vector kernel.

use crate::geometry::{cross, dot};
use mesh::HEX_CORNERS as CORNERS;

/// One of the 2x2x2 Gauss points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GaussPoint {
    /// Volume that the point represents (m^3): det(dX/dxi), as all weights are 1.
    pub(crate) volume: f64,
    /// `gradient[I][j]` = dN_I/dX_j (1/m).
    pub(crate) gradient: [[f64; 3]; 8],
}

/// The eight Gauss points of a hexahedron with corners `x` (m), in the order of the corners.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mean_gradient;
    use crate::geometry::tests::distorted;

    #[test]
    fn the_points_of_a_distorted_element_sum_to_its_volume_and_its_mean_gradient() {
        let x = distorted();
        let (volume, b) = mean_gradient(&x);
        let points = gauss_points(&x);
        assert!((points.iter().map(|p| p.volume).sum::<f64>() - volume).abs() < 1e-14);
        for node in 0..8 {
            for i in 0..3 {
                let sum: f64 = points.iter().map(|p| p.volume * p.gradient[node][i]).sum();
                assert!((sum - b[node][i]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn the_gradient_of_an_affine_field_is_exact_at_every_point() {
        let x = distorted();
        let h = [[0.1, -0.2, 0.3], [0.05, 0.4, -0.1], [-0.3, 0.2, 0.15]];
        let u = x.map(|p| [0, 1, 2].map(|i| 7.0 + dot(h[i], p)));
        for point in gauss_points(&x) {
            let computed = point.displacement_gradient(&u);
            for i in 0..3 {
                for j in 0..3 {
                    assert!((computed[i][j] - h[i][j]).abs() < 1e-13);
                }
            }
        }
    }
}
