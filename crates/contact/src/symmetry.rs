//! Contact of bodies of which the half y >= 0 is modelled, y = 0 being a plane of symmetry.
//!
//! A node on the plane stays there, with half its mass, area and forces; the other half is its mirror image's. What it
//! meets is symmetric: its normal has no component along y, the tangents of the master at its projection lie in the
//! plane or are normal to it, and neither slip nor friction crosses the plane. Off the plane nothing changes: of the
//! forces on nodes of the plane the components along y cancel with those of the mirror image, so that these nodes
//! answer in x and z alone.

use crate::vector::{Vec3, norm, scale};

/// A vector in the plane of symmetry.
pub(crate) fn in_plane(a: Vec3) -> Vec3 {
    [a[0], 0.0, a[2]]
}

/// A unit vector in the plane of symmetry.
pub(crate) fn unit_in_plane(a: Vec3) -> Vec3 {
    let a = in_plane(a);
    scale(1.0 / norm(a), a)
}

/// The tangent in the plane of symmetry of a surface with unit normal `n` there.
pub(crate) fn tangent_in_plane(n: Vec3) -> Vec3 {
    [n[2], 0.0, -n[0]]
}

/// The tangents of the surface with its mirror image, for the tangents of its half: the one that leaves the plane more
/// is normal to it, the other lies in it.
pub(crate) fn symmetric_tangents([a, b]: [Vec3; 2]) -> [Vec3; 2] {
    let across = |t: Vec3| [0.0, t[1], 0.0];
    let leaves = |t: Vec3| t[1].abs() / norm(t);
    if leaves(a) > leaves(b) { [across(a), in_plane(b)] } else { [in_plane(a), across(b)] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::cross;

    #[test]
    fn tangents_of_a_symmetric_surface_lie_in_the_plane_and_across_it_whichever_comes_first() {
        let (along, across) = ([1.0, 0.0, 0.1], [0.2, 0.8, -0.3]);
        let expected = ([1.0, 0.0, 0.1], [0.0, 0.8, 0.0]);
        assert_eq!(symmetric_tangents([along, across]), [expected.0, expected.1]);
        assert_eq!(symmetric_tangents([across, along]), [expected.1, expected.0]);
        // of two that leave the plane little, still one is across: the frame does not degenerate
        let [a, b] = symmetric_tangents([[1.0, 0.3, 0.0], [1.0, 0.1, 0.0]]);
        assert!(norm(cross(a, b)) > 0.0);
    }
}
