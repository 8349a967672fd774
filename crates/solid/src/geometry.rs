//! The uniform gradient of one hexahedron in plain scalar form, for set-up, output and tests of the vector kernel.

#[cfg(test)]
pub(crate) mod tests;

use mesh::{Face, HEX_CORNERS as CORNERS, Mesh, Padded};
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use std::collections::BTreeMap;

/// Volume V (m^3) and B_I = dV/dx_I (m^2; `[corner][axis]`) of a trilinear hexahedron, so that B_I/V is the mean
/// gradient of the shape function of corner I (Flanagan and Belytschko 1981, Eqs 15–18).
///
/// `x` are the corners (m) in `VTK_HEXAHEDRON` order; V is negative if they are inside out. With the coordinate
/// modes a_k = 1/8 sum xi_k x_I and g_1 = 1/8 sum eta zeta x_I (cyclic), the integral of the Jacobian is
/// V = 8 ([a1 a2 a3] + ([a1 g3 g2] + [a2 g1 g3] + [a3 g2 g1])/3).
pub fn mean_gradient(x: &[Vector3<f64>; 8]) -> (f64, [Vector3<f64>; 8]) {
    let mode = |weight: fn([f64; 3]) -> f64| {
        CORNERS.iter().zip(x).map(|(corner, x)| weight(*corner) * x / 8.0).sum::<Vector3<f64>>()
    };
    let a = [mode(|c| c[0]), mode(|c| c[1]), mode(|c| c[2])];
    let g = [mode(|c| c[1] * c[2]), mode(|c| c[2] * c[0]), mode(|c| c[0] * c[1])];
    // dV/da_k / 8 and dV/dg_k / 8
    let cyclic = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
    let b = cyclic.map(|[_, l, m]| a[l].cross(&a[m]) + g[m].cross(&g[l]) / 3.0);
    let c = cyclic.map(|[_, l, m]| (a[m].cross(&g[l]) + g[m].cross(&a[l])) / 3.0);
    let volume = 8.0 * (a[0].dot(&b[0]) + g[0].dot(&c[0]));
    let gradient = CORNERS.map(|[xi, eta, zeta]| {
        (b[0] * xi + c[0] * (eta * zeta))
            + (b[1] * eta + c[1] * (zeta * xi))
            + (b[2] * zeta + c[2] * (xi * eta))
    });
    (volume, gradient)
}

/// Mean displacement gradient H_ij = du_i/dX_j (dimensionless) of a one-point element, and its undeformed volume
/// (m^3), from its corners `x` (m) in `VTK_HEXAHEDRON` order and their displacements `u` (m).
pub fn displacement_gradient(x: &[Vector3<f64>; 8], u: &[Vector3<f64>; 8]) -> (Matrix3<f64>, f64) {
    let (volume, b) = mean_gradient(x);
    (u.iter().zip(&b).map(|(u, b)| u * b.transpose() / volume).sum(), volume)
}

/// Displacement gradient H_ij = du_i/dX_j (dimensionless) at each node: the mean of [`displacement_gradient`] over the
/// elements around it, weighted by their undeformed volumes. NaN at a node without elements.
///
/// # Panics
/// If there are fewer displacements (m) than nodes.
pub fn nodal_gradients(mesh: &Mesh, displacement: &[Padded]) -> Vec<Matrix3<f64>> {
    let mut sums = vec![(Matrix3::zeros(), 0.0); mesh.nodes.len()];
    for hex in &mesh.hexes {
        let x = hex.map(|n| mesh.at(n));
        let u = hex.map(|n| displacement[n as usize].vector());
        let (h, volume) = displacement_gradient(&x, &u);
        for n in hex {
            let (sum, weight) = &mut sums[*n as usize];
            *sum += volume * h;
            *weight += volume;
        }
    }
    sums.into_iter().map(|(sum, weight)| sum / weight).collect()
}

/// Derivative of the displacement along `direction` (the unit of that; dimensionless along a unit vector) at each node of
/// `faces`: the mean of those within the faces around it, at its corner of each. What points out of a face is left out.
/// Unlike [`nodal_gradients`] it belongs to the surface itself, not to the elements below.
///
/// # Panics
/// If there are fewer displacements (m) than nodes.
pub fn surface_derivatives(
    mesh: &Mesh,
    faces: &[Face],
    displacement: &[Padded],
    direction: impl Fn(u32) -> Vector3<f64>,
) -> BTreeMap<u32, Vector3<f64>> {
    let mut sums = BTreeMap::new();
    for face in faces {
        let x = face.nodes.map(|n| mesh.at(n));
        let u = face.nodes.map(|n| displacement[n as usize].vector());
        for (k, &node) in face.nodes.iter().enumerate() {
            let [next, last] = [(k + 1) % 4, (k + 3) % 4];
            let edges = [x[next] - x[k], x[last] - x[k]];
            let along = direction(node);
            // the combination of the two edges that is nearest to the direction
            let products = Matrix2::from_fn(|i, j| edges[i].dot(&edges[j]));
            let parts = Vector2::new(edges[0].dot(&along), edges[1].dot(&along));
            let Some(parts) = products.lu().solve(&parts) else { continue };
            let derivative = (u[next] - u[k]) * parts[0] + (u[last] - u[k]) * parts[1];
            let (sum, count) = sums.entry(node).or_insert((Vector3::zeros(), 0.0));
            *sum += derivative;
            *count += 1.0;
        }
    }
    sums.into_iter().map(|(node, (sum, count))| (node, sum / count)).collect()
}
