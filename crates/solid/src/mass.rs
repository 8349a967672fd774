//! Lumped mass.

use mesh::{HEX_CORNERS as CORNERS, Mesh};
use nalgebra::{Matrix3, Vector3};

/// Lumped mass of each node by row sums, m_I = integral of rho N_I (kg), exact by 2x2x2 Gauss points.
///
/// `density` holds one value per body, in order (kg/m^3); bodies beyond its end get no mass.
pub fn lumped_mass(mesh: &Mesh, density: &[f64]) -> Vec<f64> {
    let mut mass = vec![0.0; mesh.nodes.len()];
    for (body, rho) in mesh.bodies.iter().zip(density) {
        for hex in &mesh.hexes[body.hexes.clone()] {
            let x = hex.map(|n| mesh.at(n));
            for (n, v) in hex.iter().zip(nodal_volumes(&x)) {
                mass[*n as usize] += rho * v;
            }
        }
    }
    mass
}

/// Integral of each corner's shape function over the element with corners `x` (m) (m^3).
pub(crate) fn nodal_volumes(x: &[Vector3<f64>; 8]) -> [f64; 8] {
    let p = 1.0 / 3f64.sqrt();
    let mut volumes = [0.0; 8];
    for point in CORNERS {
        let [r, s, t] = point.map(|c| c * p);
        let mut jacobian = Matrix3::zeros();
        let mut shape = [0.0; 8];
        for (node, c) in CORNERS.iter().enumerate() {
            let f = [1.0 + r * c[0], 1.0 + s * c[1], 1.0 + t * c[2]];
            shape[node] = f[0] * f[1] * f[2] / 8.0;
            let d = Vector3::new(c[0] * f[1] * f[2], c[1] * f[0] * f[2], c[2] * f[0] * f[1]) / 8.0;
            jacobian += d * x[node].transpose();
        }
        let det = jacobian.determinant();
        for (volume, n) in volumes.iter_mut().zip(shape) {
            *volume += n * det;
        }
    }
    volumes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::mean_gradient;
    use crate::geometry::tests::distorted;

    #[test]
    fn nodal_volumes_sum_to_the_volume_of_a_distorted_element() {
        let x = distorted();
        let sum: f64 = nodal_volumes(&x).iter().sum();
        assert!((sum - mean_gradient(&x).0).abs() < 1e-14);
        assert!(nodal_volumes(&x).iter().all(|v| *v > 0.0));
    }

    #[test]
    fn a_cube_lumps_an_eighth_to_each_corner() {
        let x = CORNERS.map(|c| 0.5 * Vector3::from(c));
        for v in nodal_volumes(&x) {
            assert!((v - 0.125).abs() < 1e-15);
        }
    }
}
