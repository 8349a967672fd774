//! Stiffness of the fully integrated element.

use crate::formulation::Volumetric;
use crate::gauss::gauss_points;
use crate::material::Material;
use nalgebra::Vector3;

/// Tangent stiffness (N/m) of the fully integrated element in the undeformed state; rows and columns run over the
/// corners, and over x, y, z of each.
///
/// `corners` (m) are in `VTK_HEXAHEDRON` order; the Jacobian must be positive at all Gauss points. With B_I the
/// gradient of corner I's shape function at a Gauss point of volume w, the 3x3 blocks are
///
/// K_IJ = sum w (lambda B_I B_J^T + G B_J B_I^T + G (B_I . B_J) 1);
///
/// with mean dilatation the first term is lambda `V <B_I> <B_J>^T`, `<.>` the mean over the element.
pub(crate) fn full_stiffness(
    corners: &[Vector3<f64>; 8],
    material: &Material,
    volumetric: Volumetric,
) -> [[f64; 24]; 24] {
    let (lambda, shear) = (material.lame(), material.shear());
    let mut k = [[0.0; 24]; 24];
    let mut add = |volumetric: f64, shear: f64, b: &[Vector3<f64>; 8]| {
        for (row, bi) in b.iter().enumerate() {
            for (column, bj) in b.iter().enumerate() {
                let isotropic = shear * bi.dot(bj);
                for i in 0..3 {
                    for j in 0..3 {
                        k[3 * row + i][3 * column + j] +=
                            volumetric * bi[i] * bj[j] + shear * bj[i] * bi[j];
                    }
                    k[3 * row + i][3 * column + i] += isotropic;
                }
            }
        }
    };
    let points = gauss_points(corners);
    let mut volume = 0.0;
    let mut integral = [Vector3::zeros(); 8];
    for point in &points {
        let at_point = match volumetric {
            Volumetric::Full => lambda,
            Volumetric::Mean => 0.0,
        };
        add(at_point * point.volume, shear * point.volume, &point.gradient);
        volume += point.volume;
        for (sum, b) in integral.iter_mut().zip(point.gradient) {
            *sum += point.volume * b;
        }
    }
    if volumetric == Volumetric::Mean {
        add(lambda / volume, 0.0, &integral);
    }
    k
}

/// (tr K^16)^(1/16), an upper bound of the largest eigenvalue of a symmetric positive semi-definite matrix. At the
/// rank 18 of an element, the bound is at most 18^(1/16) = 1.2 times the eigenvalue. NaN for a zero matrix.
pub(crate) fn largest_eigenvalue_bound(matrix: [[f64; 24]; 24]) -> f64 {
    let norm = |m: &[[f64; 24]; 24]| m.iter().flatten().map(|c| c * c).sum::<f64>().sqrt();
    let scale = norm(&matrix);
    let mut power = matrix.map(|row| row.map(|c| c / scale));
    for _ in 0..3 {
        let mut square = [[0.0; 24]; 24];
        for i in 0..24 {
            for k in 0..24 {
                let factor = power[i][k];
                for j in 0..24 {
                    square[i][j] += factor * power[k][j];
                }
            }
        }
        power = square;
    }
    // tr K^16 is the squared norm of K^8.
    scale * libm::pow(norm(&power), 0.125)
}
