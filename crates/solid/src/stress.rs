//! Cauchy stress of an element, without viscous parts: sigma = F S F^T/det F, S = lambda tr(E) I + 2G E. Components are
//! in the order xx yy zz xy yz xz.

use crate::blocks::Batch;
use crate::formulation::Volumetric;
use crate::gauss::gauss_points;
use crate::kernel::{gradient, mean_gradient, modes};
use crate::material::Material;
use crate::tensor::Matrix;
use mesh::Padded;
use nalgebra::{Matrix3, Vector3};

/// Cauchy stress (Pa) of a one-point element, from the gradient that its force uses.
///
/// The bits do not depend on the level of the kernels: one element at a time, nothing is fused.
pub(crate) fn one_point_cauchy(
    reference: &[Padded],
    displacement: &[Padded],
    batch: &Batch,
    lane: usize,
    material: &Material,
) -> [f64; 6] {
    let nodes = batch.nodes.iter().all(|corner| {
        let node = corner[lane] as usize;
        node < reference.len() && node < displacement.len()
    });
    assert!(nodes);
    // SAFETY: plain Rust; the nodes of the element are within both arrays, as was just asserted.
    let [x, u] =
        [reference, displacement].map(|a| unsafe { modes::<f64>(a.as_ptr(), batch, lane) });
    let Matrix(h) = gradient(&u, &mean_gradient(&x));
    cauchy(&Matrix3::from_fn(|i, j| h[i].0[j]), material)
}

/// Cauchy stress (Pa) for the displacement gradient H.
pub(crate) fn cauchy(h: &Matrix3<f64>, material: &Material) -> [f64; 6] {
    let (e, f) = (green(h), deformation(h));
    six(kirchhoff(&f, &e, material, e.trace()) / f.determinant())
}

/// Components of a symmetric tensor in the order of the result files: xx yy zz xy yz xz.
fn six(tensor: Matrix3<f64>) -> [f64; 6] {
    [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].map(|at| tensor[at])
}

/// Deformation gradient F = I + H.
pub(crate) fn deformation(h: &Matrix3<f64>) -> Matrix3<f64> {
    h + Matrix3::identity()
}

/// Mean Cauchy stress (Pa) of a fully integrated element over its deformed volume: sum w F S F^T/sum w det F over the
/// Gauss points. With [`Volumetric::Mean`], S has the element's mean of tr(E).
pub(crate) fn mean_cauchy(
    x: &[Vector3<f64>; 8],
    u: &[Vector3<f64>; 8],
    material: &Material,
    volumetric: Volumetric,
) -> [f64; 6] {
    let points = gauss_points(x).map(|p| (p.volume, p.displacement_gradient(u)));
    let reference: f64 = points.iter().map(|(w, _)| w).sum();
    let mean = points.iter().map(|(w, h)| w * green(h).trace()).sum::<f64>() / reference;
    let (mut sum, mut volume) = (Matrix3::zeros(), 0.0);
    for (w, h) in &points {
        let (e, f) = (green(h), deformation(h));
        let dilatation = match volumetric {
            Volumetric::Full => e.trace(),
            Volumetric::Mean => mean,
        };
        sum += *w * kirchhoff(&f, &e, material, dilatation);
        volume += w * f.determinant();
    }
    six(sum / volume)
}

/// Kirchhoff stress F S F^T (Pa) with S = lambda theta I + 2G E, theta the `dilatation`.
fn kirchhoff(
    f: &Matrix3<f64>,
    e: &Matrix3<f64>,
    material: &Material,
    dilatation: f64,
) -> Matrix3<f64> {
    let isotropic = Matrix3::from_diagonal_element(material.lame() * dilatation);
    f * (2.0 * material.shear() * e + isotropic) * f.transpose()
}

/// E = (H + H^T + H^T H)/2.
pub(crate) fn green(h: &Matrix3<f64>) -> Matrix3<f64> {
    0.5 * (h + h.transpose() + h.transpose() * h)
}
