//! Contact of bodies of which the half y >= 0 is modelled, y = 0 being a plane of symmetry.
//!
//! A node on the plane stays there, with half its mass, area and forces; the other half is its mirror image's. What it
//! meets is symmetric: its normal has no component along y, the tangents of the master at its projection lie in the
//! plane or are normal to it, and neither slip nor friction crosses the plane. Off the plane nothing changes: of the
//! forces on nodes of the plane the components along y cancel with those of the mirror image, so that these nodes
//! answer in x and z alone.

use crate::face::{FaceGeometry, Positions, Projection, SurfacePoint};
use crate::surface::ContactSurface;
use crate::vector::{Vec3, dot, norm, scale, sub};

impl ContactSurface {
    /// Whether a node at `x` (m) lies on the plane of symmetry of the surface.
    #[inline(always)]
    pub fn is_on_plane(&self, x: Vec3) -> bool {
        self.symmetric && x[1] == 0.0
    }

    /// How many nodes of the whole surface a node at `x` (m) stands for: itself, and its mirror image where it has one.
    pub fn nodes_of_whole(&self, x: Vec3) -> usize {
        if self.symmetric && x[1] != 0.0 { 2 } else { 1 }
    }
}

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

/// The point of the surface with its mirror image, for a point of its half on the plane. Its tangent lies in the plane.
pub(crate) fn symmetric_point(point: SurfacePoint) -> SurfacePoint {
    let normal = unit_in_plane(point.normal);
    SurfacePoint {
        x: in_plane(point.x),
        normal,
        tangent: tangent_in_plane(normal),
        offset: point.offset,
    }
}

/// The projection of a `node` of the plane on a symmetric `surface`: on the edge of the face that lies in the plane.
pub(crate) fn symmetric_projection(
    surface: &ContactSurface,
    positions: &Positions<'_>,
    curvature: bool,
    node: Vec3,
    projection: Projection,
) -> Projection {
    let Projection { face, mut xi, mut eta, .. } = projection;
    let on_plane = surface.faces[face as usize].nodes.map(|n| positions.at(n)[1] == 0.0);
    for edge in 0..4 {
        if on_plane[edge] && on_plane[(edge + 1) % 4] {
            match edge {
                0 => eta = -1.0,
                1 => xi = 1.0,
                2 => eta = 1.0,
                _ => xi = -1.0,
            }
        }
    }
    let point = FaceGeometry::new(surface, face, positions, curvature).at(xi, eta);
    let point = symmetric_point(point);
    let gap = dot(point.normal, sub(node, point.x)) - point.offset;
    Projection { face, xi, eta, point, gap }
}
