//! The diagonal of the stiffness, for preconditioning.

use super::Solid;
use crate::element_stiffness;
use nalgebra::Matrix3;

impl Solid {
    /// The 3x3 diagonal blocks of the stiffness K of the undeformed state (N/m), one per node; K is that of
    /// [`add_stiffness_product`](Self::add_stiffness_product).
    pub fn stiffness_diagonal(&self) -> Vec<Matrix3<f64>> {
        let mut diagonal = vec![Matrix3::zeros(); self.reference.len()];
        for (body, (range, material)) in self.bodies.iter().enumerate() {
            for element in range.clone() {
                let hex = self.blocks.hex(body, element);
                let x = hex.map(|n| self.reference[n as usize].vector());
                let k = element_stiffness(&x, material, self.formulation(body, element));
                for (corner, node) in hex.iter().enumerate() {
                    let block = Matrix3::from_fn(|i, j| k[3 * corner + i][3 * corner + j]);
                    diagonal[*node as usize] += block;
                }
            }
        }
        diagonal
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric};
    use mesh::Padded;

    #[test]
    fn the_diagonal_is_that_of_the_stiffness_product() {
        let mut mesh = mesh::block([2, 2, 2], [2.0, 1.7, 2.4]);
        for (i, x) in mesh.nodes.iter_mut().enumerate() {
            let k = i as f64;
            x[0] += 0.1 * libm::sin(1.3 * k);
            x[1] += 0.08 * libm::sin(2.1 * k);
            x[2] += 0.09 * libm::cos(0.7 * k);
        }
        let material = Material { young: 2.1e11, poisson: 0.3, density: 7800.0 };
        let elements =
            Elements::mixed(Element { hourglass: 0.05 }, &[true, false, true], Volumetric::Mean);
        let mut solid =
            Solid::new(&mesh, &[material], elements, Viscosity::default(), Level::Portable)
                .unwrap();
        let diagonal = solid.stiffness_diagonal();
        for node in 0..mesh.nodes.len() {
            for i in 0..3 {
                let mut x = vec![Padded::ZERO; mesh.nodes.len()];
                x[node][i] = 1e-13;
                let mut y = vec![Padded::ZERO; mesh.nodes.len()];
                solid.add_stiffness_product(&x, &mut y);
                for j in 0..3 {
                    let error = y[node][j] / 1e-13 - diagonal[node][(j, i)];
                    assert!(
                        error.abs() < 1e-9 * diagonal[node][(i, i)],
                        "{node} {i} {j} {error:e}"
                    );
                }
            }
        }
    }
}
