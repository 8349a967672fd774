//! Contact of bodies of which the half y >= 0 is modelled, y = 0 being a plane of symmetry.
//!
//! A node on the plane stays there, with half its mass, area and forces; the other half is its mirror image's. What it
//! meets is symmetric: its normal has no component along y, the tangents of the master at its projection lie in the
//! plane or are normal to it, and neither slip nor friction crosses the plane. Off the plane nothing changes: of the
//! forces on nodes of the plane the components along y cancel with those of the mirror image, so that these nodes
//! answer in x and z alone.

use mesh::geometry::direction;
use nalgebra::{Matrix3x2, UnitVector3, Vector3};

/// A vector in the plane of symmetry.
pub(crate) fn in_plane(a: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(a.x, 0.0, a.z)
}

/// The direction of a vector in the plane of symmetry.
pub(crate) fn direction_in_plane(a: Vector3<f64>) -> UnitVector3<f64> {
    direction(in_plane(a))
}

/// The tangent in the plane of symmetry of a surface with unit normal `n` there.
pub(crate) fn tangent_in_plane(n: UnitVector3<f64>) -> Vector3<f64> {
    Vector3::new(n.z, 0.0, -n.x)
}

/// The tangents of the surface with its mirror image, for the tangents of its half: the one that leaves the plane more
/// is normal to it, the other lies in it.
pub(crate) fn symmetric_tangents(tangents: &Matrix3x2<f64>) -> Matrix3x2<f64> {
    let [a, b] = [0, 1].map(|i| Vector3::from(tangents.column(i)));
    let across = |t: Vector3<f64>| Vector3::new(0.0, t.y, 0.0);
    let leaves = |t: Vector3<f64>| t.y.abs() / t.norm();
    Matrix3x2::from_columns(&if leaves(a) > leaves(b) {
        [across(a), in_plane(b)]
    } else {
        [in_plane(a), across(b)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    #[test]
    fn tangents_of_a_symmetric_surface_lie_in_the_plane_and_across_it_whichever_comes_first() {
        let tangents = Matrix3x2::new(1.0, 0.2, 0.0, 0.8, 0.1, -0.3);
        let mut expected = Matrix3x2::new(1.0, 0.0, 0.0, 0.8, 0.1, 0.0);
        assert_eq!(symmetric_tangents(&tangents), expected);
        let mut swapped = tangents;
        swapped.swap_columns(0, 1);
        expected.swap_columns(0, 1);
        assert_eq!(symmetric_tangents(&swapped), expected);
        // of two that leave the plane little, still one is across: the frame does not degenerate
        let little = symmetric_tangents(&Matrix3x2::new(1.0, 1.0, 0.3, 0.1, 0.0, 0.0));
        assert!(little.column(0).cross(&little.column(1)).norm() > 0.0);
    }
}
