//! The uniform gradient of one hexahedron in plain scalar form, for set-up, output and tests of the vector kernel.

use mesh::{HEX_CORNERS as CORNERS, Mesh, Padded};

/// Volume V (m^3) and B_I = dV/dx_I (m^2; `[corner][axis]`) of a trilinear hexahedron, so that B_I/V is the mean
/// gradient of the shape function of corner I (Flanagan and Belytschko 1981, Eqs 15–18).
///
/// `x` are the corners (m) in `VTK_HEXAHEDRON` order; V is negative if they are inside out. With the coordinate
/// modes a_k = 1/8 sum xi_k x_I and g_1 = 1/8 sum eta zeta x_I (cyclic), the integral of the Jacobian is
/// V = 8 ([a1 a2 a3] + ([a1 g3 g2] + [a2 g1 g3] + [a3 g2 g1])/3).
pub fn mean_gradient(x: &[[f64; 3]; 8]) -> (f64, [[f64; 3]; 8]) {
    let mode = |weight: fn([f64; 3]) -> f64| {
        let mut m = [0.0; 3];
        for (corner, point) in CORNERS.iter().zip(x) {
            for i in 0..3 {
                m[i] += weight(*corner) * point[i] / 8.0;
            }
        }
        m
    };
    let a = [mode(|c| c[0]), mode(|c| c[1]), mode(|c| c[2])];
    let g = [mode(|c| c[1] * c[2]), mode(|c| c[2] * c[0]), mode(|c| c[0] * c[1])];
    let third = |v: [f64; 3]| v.map(|c| c / 3.0);
    // dV/da_k / 8 and dV/dg_k / 8
    let mut b = [[0.0; 3]; 3];
    let mut c = [[0.0; 3]; 3];
    for k in 0..3 {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        b[k] = add(cross(a[l], a[m]), third(cross(g[m], g[l])));
        c[k] = third(add(cross(a[m], g[l]), cross(g[m], a[l])));
    }
    let volume = 8.0 * (dot(a[0], b[0]) + dot(g[0], c[0]));
    let mut gradient = [[0.0; 3]; 8];
    for (corner, node) in CORNERS.iter().zip(&mut gradient) {
        let [xi, eta, zeta] = *corner;
        let weight = [xi, eta, zeta, eta * zeta, zeta * xi, xi * eta];
        for i in 0..3 {
            node[i] = (0..3).map(|k| weight[k] * b[k][i] + weight[k + 3] * c[k][i]).sum();
        }
    }
    (volume, gradient)
}

/// Mean displacement gradient H_ij = du_i/dX_j (dimensionless) of a one-point element, and its undeformed volume
/// (m^3), from its corners `x` (m) in `VTK_HEXAHEDRON` order and their displacements `u` (m).
pub fn displacement_gradient(x: &[[f64; 3]; 8], u: &[[f64; 3]; 8]) -> ([[f64; 3]; 3], f64) {
    let (volume, b) = mean_gradient(x);
    let mut h = [[0.0; 3]; 3];
    for node in 0..8 {
        for i in 0..3 {
            for j in 0..3 {
                h[i][j] += u[node][i] * b[node][j] / volume;
            }
        }
    }
    (h, volume)
}

/// Displacement gradient H_ij = du_i/dX_j (dimensionless) at each node: the mean of [`displacement_gradient`] over the
/// elements around it, weighted by their undeformed volumes. NaN at a node without elements.
///
/// # Panics
/// If there are fewer displacements (m) than nodes.
pub fn nodal_gradients(mesh: &Mesh, displacement: &[Padded]) -> Vec<[[f64; 3]; 3]> {
    let mut sum = vec![[[0.0; 3]; 3]; mesh.nodes.len()];
    let mut weight = vec![0.0; mesh.nodes.len()];
    for hex in &mesh.hexes {
        let x = hex.map(|n| mesh.nodes[n as usize]);
        let u = hex.map(|n| displacement[n as usize].xyz());
        let (h, volume) = displacement_gradient(&x, &u);
        for n in hex.map(|n| n as usize) {
            weight[n] += volume;
            for i in 0..3 {
                for j in 0..3 {
                    sum[n][i][j] += volume * h[i][j];
                }
            }
        }
    }
    for (h, w) in sum.iter_mut().zip(&weight) {
        h.iter_mut().flatten().for_each(|c| *c /= w);
    }
    sum
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A distorted hexahedron with positive Jacobian everywhere.
    pub(crate) fn distorted() -> [[f64; 3]; 8] {
        let mut x = CORNERS.map(|c| [c[0] * 0.5, c[1] * 0.4, c[2] * 0.6]);
        for (i, p) in x.iter_mut().enumerate() {
            let k = i as f64;
            p[0] += 0.07 * libm::sin(1.3 * k);
            p[1] += 0.06 * libm::sin(2.1 * k + 0.4);
            p[2] += 0.08 * libm::cos(0.7 * k + 1.1);
        }
        x
    }

    /// Volume by 2x2x2 Gauss quadrature of the Jacobian: exact for a trilinear map.
    fn quadrature_volume(x: &[[f64; 3]; 8]) -> f64 {
        let p = 1.0 / 3f64.sqrt();
        let mut volume = 0.0;
        for corner in CORNERS {
            let [r, s, t] = corner.map(|c| c * p);
            let mut j = [[0.0; 3]; 3];
            for (c, node) in CORNERS.iter().zip(x) {
                let d = [
                    c[0] * (1.0 + s * c[1]) * (1.0 + t * c[2]) / 8.0,
                    c[1] * (1.0 + r * c[0]) * (1.0 + t * c[2]) / 8.0,
                    c[2] * (1.0 + r * c[0]) * (1.0 + s * c[1]) / 8.0,
                ];
                for k in 0..3 {
                    for i in 0..3 {
                        j[k][i] += d[k] * node[i];
                    }
                }
            }
            volume += dot(j[0], cross(j[1], j[2]));
        }
        volume
    }

    #[test]
    fn volume_is_the_integral_of_the_jacobian() {
        let x = distorted();
        let (volume, _) = mean_gradient(&x);
        assert!((volume - quadrature_volume(&x)).abs() < 1e-14);
    }

    #[test]
    fn gradient_is_the_derivative_of_the_volume() {
        let x = distorted();
        let (_, b) = mean_gradient(&x);
        for node in 0..8 {
            for i in 0..3 {
                // The volume is linear in each coordinate: a difference is exact.
                let mut y = x;
                y[node][i] += 0.5;
                let difference = (mean_gradient(&y).0 - mean_gradient(&x).0) / 0.5;
                assert!((difference - b[node][i]).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn the_gradient_of_an_affine_field_is_exact_on_a_distorted_element() {
        let x = distorted();
        let h = [[0.1, -0.2, 0.3], [0.05, 0.4, -0.1], [-0.3, 0.2, 0.15]];
        let u = x.map(|p| [0, 1, 2].map(|i| 7.0 + dot(h[i], p)));
        let (computed, _) = displacement_gradient(&x, &u);
        for i in 0..3 {
            for j in 0..3 {
                assert!((computed[i][j] - h[i][j]).abs() < 1e-14);
            }
        }
    }
}
