//! Stiffness matrix of one element about the undeformed state, for assembled matrices.

use crate::formulation::{Element, Formulation};
use crate::full_stiffness::full_stiffness;
use crate::geometry::mean_gradient;
use crate::material::Material;
use mesh::HEX_CORNERS as CORNERS;
use nalgebra::Vector3;

/// Tangent stiffness (N/m) of a hexahedron in the undeformed state, from its corners `x` (m) in `VTK_HEXAHEDRON` order.
/// Row and column `3 I + i` belong to component i of corner I. An [`Element`] or a [`crate::Volumetric`] converts into
/// the formulation. The volume of the element must be positive.
pub fn element_stiffness(
    x: &[Vector3<f64>; 8],
    material: &Material,
    formulation: impl Into<Formulation>,
) -> [[f64; 24]; 24] {
    match formulation.into() {
        Formulation::OnePoint(element) => one_point_stiffness(x, material, element),
        Formulation::Full(volumetric) => full_stiffness(x, material, volumetric),
    }
}

/// Stiffness of the one-point hexahedron:
///
/// K_IiJj = 1/V (lambda B_Ii B_Jj + G (B_Ij B_Ji + delta_ij B_I.B_J))
/// + delta_ij K_h sum_a gamma_aI gamma_aJ
///
/// with B_I = dV/dx_I, the hourglass shapes gamma_aI = Gamma_aI - B_I.(X Gamma_a)/V and
/// K_h = kappa M B_iI B_iI/(24 V), M of [`Material::hourglass_modulus`]: the linear part of the force of [`crate::Solid`]
/// (Flanagan and Belytschko 1981).
fn one_point_stiffness(
    x: &[Vector3<f64>; 8],
    material: &Material,
    element: Element,
) -> [[f64; 24]; 24] {
    let (volume, b) = mean_gradient(x);
    let (lambda, shear) = (material.lame() / volume, material.shear() / volume);
    let squares: f64 = b.iter().map(|b| b.norm_squared()).sum();
    let hourglass = element.hourglass * material.hourglass_modulus() * squares / (24.0 * volume);
    let shapes = hourglass_shapes(x, volume, &b);
    let mut k = [[0.0; 24]; 24];
    for a in 0..8 {
        for c in 0..8 {
            let modes: f64 = shapes.iter().map(|gamma| gamma[a] * gamma[c]).sum();
            let isotropic = shear * b[a].dot(&b[c]) + hourglass * modes;
            for i in 0..3 {
                for j in 0..3 {
                    k[3 * a + i][3 * c + j] =
                        lambda * b[a][i] * b[c][j] + shear * b[a][j] * b[c][i];
                }
                k[3 * a + i][3 * c + i] += isotropic;
            }
        }
    }
    k
}

/// The shapes gamma_aI of the four hourglass modes (dimensionless), `[mode][corner]`; `b` is dV/dx_I (m^2).
pub(crate) fn hourglass_shapes(
    x: &[Vector3<f64>; 8],
    volume: f64,
    b: &[Vector3<f64>; 8],
) -> [[f64; 8]; 4] {
    let base = [
        CORNERS.map(|c| c[1] * c[2]),
        CORNERS.map(|c| c[2] * c[0]),
        CORNERS.map(|c| c[0] * c[1]),
        CORNERS.map(|c| c[0] * c[1] * c[2]),
    ];
    base.map(|mode| {
        let moment: Vector3<f64> = mode.iter().zip(x).map(|(sign, x)| *sign * x / volume).sum();
        let mut gamma = mode;
        for (gamma, b) in gamma.iter_mut().zip(b) {
            *gamma -= b.dot(&moment);
        }
        gamma
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::distorted;
    use crate::{Level, Solid, Viscosity};
    use mesh::{Body, Mesh, Padded};

    const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };

    #[test]
    fn the_matrix_is_the_linear_part_of_the_kernel_on_a_distorted_element() {
        let x = distorted();
        let element = Element { hourglass: 0.05 };
        let k = element_stiffness(&x, &STEEL, element);
        let body = Body {
            name: "one".to_owned(),
            nodes: 0..8,
            hexes: 0..1,
            node_sets: Default::default(),
            surfaces: Default::default(),
        };
        let hex = [0, 1, 2, 3, 4, 5, 6, 7];
        let mesh =
            Mesh { nodes: x.to_vec(), hexes: vec![hex], bodies: vec![body], symmetric: false };
        let mut solid =
            Solid::new(&mesh, &[STEEL], element, Viscosity::default(), Level::Portable).unwrap();
        let scale = k.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        for column in 0..24 {
            // So small that the quadratic part of the force lies below round-off.
            let step = 1e-13;
            let mut u = [Padded::ZERO; 8];
            u[column / 3][column % 3] = step;
            let mut force = [Padded::ZERO; 8];
            solid.add_stiffness_product(&u, &mut force);
            for row in 0..24 {
                let difference = force[row / 3][row % 3] / step - k[row][column];
                assert!(difference.abs() < 1e-12 * scale, "{row} {column}: {difference:e}");
            }
        }
    }

    #[test]
    fn rigid_motion_costs_nothing_and_the_matrix_is_symmetric() {
        let x = distorted();
        let k = element_stiffness(&x, &STEEL, Element { hourglass: 0.05 });
        let scale = k.iter().flatten().fold(0.0f64, |m, c| m.max(c.abs()));
        let turn = |p: Vector3<f64>| [-p.y, p.x, 0.0];
        for row in 0..24 {
            let shifted: f64 = (0..8).map(|n| k[row][3 * n + 1]).sum();
            let turned: f64 =
                (0..24).map(|column| k[row][column] * turn(x[column / 3])[column % 3]).sum();
            assert!(shifted.abs() < 1e-13 * scale && turned.abs() < 1e-13 * scale);
            for column in 0..24 {
                assert!((k[row][column] - k[column][row]).abs() < 1e-14 * scale);
            }
        }
    }
}
