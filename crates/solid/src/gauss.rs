//! The Gauss points of one hexahedron in plain scalar form, for set-up, output, the stiffness of the fully integrated
//! element, and tests of its vector kernel.

use mesh::HEX_CORNERS as CORNERS;
use nalgebra::{Matrix3, Vector3};

/// One of the 2x2x2 Gauss points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GaussPoint {
    /// Volume that the point represents (m^3): det(dX/dxi), as all weights are 1.
    pub(crate) volume: f64,
    /// `gradient[I][j]` = dN_I/dX_j (1/m).
    pub(crate) gradient: [Vector3<f64>; 8],
}

/// The eight Gauss points of a hexahedron with corners `x` (m), in the order of the corners.
pub(crate) fn gauss_points(x: &[Vector3<f64>; 8]) -> [GaussPoint; 8] {
    let p = 1.0 / 3f64.sqrt();
    CORNERS.map(|corner| {
        let [r, s, t] = corner.map(|c| c * p);
        let local = CORNERS.map(|c| {
            let [a, b, d] = [1.0 + r * c[0], 1.0 + s * c[1], 1.0 + t * c[2]];
            Vector3::new(c[0] * b * d, c[1] * a * d, c[2] * a * b) / 8.0
        });
        let jacobian: Matrix3<f64> = local.iter().zip(x).map(|(d, x)| x * d.transpose()).sum();
        let [a, b, c] = [0, 1, 2].map(|k| jacobian.column(k));
        let cofactor = Matrix3::from_columns(&[b.cross(&c), c.cross(&a), a.cross(&b)]);
        let volume = a.dot(&cofactor.column(0));
        let gradient = local.map(|d| cofactor * d / volume);
        GaussPoint { volume, gradient }
    })
}

impl GaussPoint {
    /// Displacement gradient H_ij = du_i/dX_j.
    pub(crate) fn displacement_gradient(&self, u: &[Vector3<f64>; 8]) -> Matrix3<f64> {
        u.iter().zip(&self.gradient).map(|(u, b)| u * b.transpose()).sum()
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
        let h = Matrix3::new(0.1, -0.2, 0.3, 0.05, 0.4, -0.1, -0.3, 0.2, 0.15);
        let u = x.map(|p| Vector3::repeat(7.0) + h * p);
        for point in gauss_points(&x) {
            assert!((point.displacement_gradient(&u) - h).abs().max() < 1e-13);
        }
    }
}
