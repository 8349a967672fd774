//! Cauchy stress of an element, without viscous parts: sigma = F S F^T/det F, S = lambda tr(E) I + 2G E. Components are
//! in the order xx yy zz xy yz xz.

use crate::blocks::Batch;
use crate::formulation::Volumetric;
use crate::gauss::gauss_points;
use crate::geometry::{cross, dot};
use crate::kernel::{gradient, mean_gradient, modes};
use crate::material::Material;
use crate::tensor::Matrix;
use mesh::Padded;

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
    cauchy(&h.map(|row| row.0), material)
}

/// Cauchy stress (Pa) for the displacement gradient H.
pub(crate) fn cauchy(h: &[[f64; 3]; 3], material: &Material) -> [f64; 6] {
    let e = green(h);
    let f = deformation(h);
    let det = determinant(&f);
    kirchhoff(&f, &e, material, trace(&e)).map(|c| c / det)
}

/// Components of a symmetric tensor in the order of the result files: xx yy zz xy yz xz.
const SIX: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];

/// Deformation gradient F = I + H.
pub(crate) fn deformation(h: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut f = *h;
    for i in 0..3 {
        f[i][i] += 1.0;
    }
    f
}

pub(crate) fn determinant(f: &[[f64; 3]; 3]) -> f64 {
    dot(f[0], cross(f[1], f[2]))
}

/// Mean Cauchy stress (Pa) of a fully integrated element over its deformed volume: sum w F S F^T/sum w det F over the
/// Gauss points. With [`Volumetric::Mean`], S has the element's mean of tr(E).
pub(crate) fn mean_cauchy(
    x: &[[f64; 3]; 8],
    u: &[[f64; 3]; 8],
    material: &Material,
    volumetric: Volumetric,
) -> [f64; 6] {
    let points = gauss_points(x).map(|p| (p.volume, p.displacement_gradient(u)));
    let reference: f64 = points.iter().map(|(w, _)| w).sum();
    let mean = points.iter().map(|(w, h)| w * trace(&green(h))).sum::<f64>() / reference;
    let mut sum = [0.0; 6];
    let mut volume = 0.0;
    for (w, h) in &points {
        let (e, f) = (green(h), deformation(h));
        let dilatation = match volumetric {
            Volumetric::Full => trace(&e),
            Volumetric::Mean => mean,
        };
        for (sum, c) in sum.iter_mut().zip(kirchhoff(&f, &e, material, dilatation)) {
            *sum += w * c;
        }
        volume += w * determinant(&f);
    }
    sum.map(|c| c / volume)
}

/// Kirchhoff stress F S F^T (Pa) with S = lambda theta I + 2G E, theta the `dilatation`.
fn kirchhoff(
    f: &[[f64; 3]; 3],
    e: &[[f64; 3]; 3],
    material: &Material,
    dilatation: f64,
) -> [f64; 6] {
    let mut s = e.map(|row| row.map(|c| 2.0 * material.shear() * c));
    for i in 0..3 {
        s[i][i] += material.lame() * dilatation;
    }
    // P = F S with symmetric S
    let p = f.map(|row| s.map(|column| dot(row, column)));
    SIX.map(|(i, j)| dot(p[i], f[j]))
}

/// E = (H + H^T + H^T H)/2.
pub(crate) fn green(h: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut e = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            let quadratic: f64 = (0..3).map(|k| h[k][i] * h[k][j]).sum();
            e[i][j] = 0.5 * (h[i][j] + h[j][i] + quadratic);
        }
    }
    e
}

pub(crate) fn trace(e: &[[f64; 3]; 3]) -> f64 {
    e[0][0] + e[1][1] + e[2][2]
}
