//! Tests of the gradient, and the element on which others are tried as well.

use super::*;

/// A distorted hexahedron with positive Jacobian everywhere.
pub(crate) fn distorted() -> [Vector3<f64>; 8] {
    let mut x = CORNERS.map(|c| Vector3::new(c[0] * 0.5, c[1] * 0.4, c[2] * 0.6));
    for (i, p) in x.iter_mut().enumerate() {
        let k = i as f64;
        p[0] += 0.07 * libm::sin(1.3 * k);
        p[1] += 0.06 * libm::sin(2.1 * k + 0.4);
        p[2] += 0.08 * libm::cos(0.7 * k + 1.1);
    }
    x
}

/// Volume by 2x2x2 Gauss quadrature of the Jacobian: exact for a trilinear map.
fn quadrature_volume(x: &[Vector3<f64>; 8]) -> f64 {
    let p = 1.0 / 3f64.sqrt();
    let mut volume = 0.0;
    for corner in CORNERS {
        let [r, s, t] = corner.map(|c| c * p);
        let mut jacobian = Matrix3::zeros();
        for (c, node) in CORNERS.iter().zip(x) {
            let d = Vector3::new(
                c[0] * (1.0 + s * c[1]) * (1.0 + t * c[2]) / 8.0,
                c[1] * (1.0 + r * c[0]) * (1.0 + t * c[2]) / 8.0,
                c[2] * (1.0 + r * c[0]) * (1.0 + s * c[1]) / 8.0,
            );
            jacobian += d * node.transpose();
        }
        volume += jacobian.determinant();
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
    let h = Matrix3::new(0.1, -0.2, 0.3, 0.05, 0.4, -0.1, -0.3, 0.2, 0.15);
    let u = x.map(|p| Vector3::repeat(7.0) + h * p);
    let (computed, _) = displacement_gradient(&x, &u);
    assert!((computed - h).abs().max() < 1e-14);
}

#[test]
fn derivatives_along_a_surface_are_its_own_where_those_of_elements_are_half_an_element_deep() {
    let mesh = mesh::block([6, 1, 4], [6e-3, 1e-3, 4e-3]);
    let top = &mesh.bodies[0].surfaces["z+"].faces;
    // u_x = x^2 + 3 x (z - L) strains the top, z = L, by 2 x, and what lies below by less
    let displacement: Vec<Padded> = mesh
        .nodes
        .iter()
        .map(|x| Vector3::new(x[0] * (x[0] + 3.0 * (x[2] - 4e-3)), 0.0, 0.0).into())
        .collect();
    let along = Vector3::new(2.0, 0.0, 5.0);
    let of_surface = surface_derivatives(&mesh, top, &displacement, |_| along);
    let of_elements = nodal_gradients(&mesh, &displacement);
    assert_eq!(of_surface.len(), 14);
    for (n, derivative) in of_surface {
        let x = mesh.nodes[n as usize][0];
        if x > 0.5e-3 && x < 5.5e-3 {
            assert!((derivative[0] - 4.0 * x).abs() < 1e-12, "{x} {derivative}");
            let deep = 2.0 * of_elements[n as usize][(0, 0)];
            assert!((deep - 4.0 * x + 3e-3).abs() < 1e-12, "{x} {deep}");
        }
    }
}
