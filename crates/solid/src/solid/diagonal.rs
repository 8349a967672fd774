//! The diagonal of the stiffness, for preconditioning.

use super::Solid;
use crate::mean_gradient;
use mesh::HEX_CORNERS;

impl Solid {
    /// The 3x3 diagonal blocks of the stiffness of the undeformed state (N/m), one per node: what
    /// [`add_stiffness_product`](Self::add_stiffness_product) multiplies with, at a node.
    ///
    /// K_II = ((lambda + G) B_I B_I^T + G |B_I|^2 1)/V + K_h sum_a gamma_aI^2 1, summed over the
    /// elements around the node, in the notation of the element's force.
    pub fn stiffness_diagonal(&self) -> Vec<[[f64; 3]; 3]> {
        let mut diagonal = vec![[[0.0; 3]; 3]; self.reference.len()];
        for (body, (range, material)) in self.bodies.iter().enumerate() {
            let (lame, shear) = (material.lame(), material.shear());
            // The kernel keeps kappa (lambda + 2G)/192.
            let kappa = 8.0 * self.constants[body].hourglass;
            for element in range.clone() {
                let hex = self.blocks.hex(body, element);
                let x = hex.map(|n| self.reference[n as usize].xyz());
                let (volume, b) = mean_gradient(&x);
                let squares: f64 = b.iter().flatten().map(|c| c * c).sum();
                let hourglass = kappa * squares / volume;
                let shapes = hourglass_shapes(&x, &b, volume);
                for (corner, node) in hex.iter().enumerate() {
                    let b = b[corner];
                    let own: f64 = b.iter().map(|c| c * c).sum();
                    let gamma: f64 = shapes.iter().map(|g| g[corner] * g[corner]).sum();
                    let block = &mut diagonal[*node as usize];
                    for i in 0..3 {
                        for j in 0..3 {
                            block[i][j] += (lame + shear) * b[i] * b[j] / volume;
                        }
                        block[i][i] += shear * own / volume + hourglass * gamma;
                    }
                }
            }
        }
        diagonal
    }
}

/// gamma_aI = Gamma_aI - B_I . (X Gamma_a)/V.
fn hourglass_shapes(x: &[[f64; 3]; 8], b: &[[f64; 3]; 8], volume: f64) -> [[f64; 8]; 4] {
    let mut shapes = [[0.0; 8]; 4];
    for (a, shape) in shapes.iter_mut().enumerate() {
        let base = HEX_CORNERS.map(|[r, s, t]| [s * t, t * r, r * s, r * s * t][a]);
        let mut moment = [0.0; 3];
        for (g, x) in base.iter().zip(x) {
            for i in 0..3 {
                moment[i] += g * x[i];
            }
        }
        for corner in 0..8 {
            let affine: f64 = (0..3).map(|i| b[corner][i] * moment[i]).sum();
            shape[corner] = base[corner] - affine / volume;
        }
    }
    shapes
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::{Element, Level, Material, Solid, Viscosity};
    use mesh::Padded;

    #[test]
    fn the_diagonal_is_that_of_the_stiffness_product() {
        let mut mesh = mesh::block([2, 2, 2], [2.0, 1.7, 2.4]);
        for (i, x) in mesh.nodes.iter_mut().enumerate() {
            let k = i as f64;
            x[0] += 0.1 * (1.3 * k).sin();
            x[1] += 0.08 * (2.1 * k).sin();
            x[2] += 0.09 * (0.7 * k).cos();
        }
        let material = Material { young: 2.1e11, poisson: 0.3, density: 7800.0 };
        let element = Element { hourglass: 0.05 };
        let mut solid =
            Solid::new(&mesh, &[material], element, Viscosity::default(), Level::Portable).unwrap();
        let diagonal = solid.stiffness_diagonal();
        for node in 0..mesh.nodes.len() {
            for i in 0..3 {
                let mut x = vec![Padded::ZERO; mesh.nodes.len()];
                x[node][i] = 1e-13;
                let mut y = vec![Padded::ZERO; mesh.nodes.len()];
                solid.add_stiffness_product(&x, &mut y);
                for j in 0..3 {
                    let error = y[node][j] / 1e-13 - diagonal[node][j][i];
                    assert!(error.abs() < 1e-9 * diagonal[node][i][i], "{node} {i} {j} {error:e}");
                }
            }
        }
    }
}
