//! The projection of a slave node on the master surface: projection on bilinear faces, the exact
//! surface beyond the facets, and the walk from face to face.

use crate::surface::{ContactSurface, Corner, NONE};
use crate::symmetry::{direction_in_plane, in_plane, tangent_in_plane};
use mesh::geometry::{adjugate, direction};
use mesh::{Padded, SmoothSurface};
use nalgebra::{Matrix2, UnitVector3, Vector2, Vector3};
use serde::{Deserialize, Serialize};

/// Newton's corrections below this (in face coordinates) end the iteration: the next would be
/// below round-off, since convergence is quadratic on a facet and gains the factor
/// |gap|/radius per round with the exact surface.
const CONVERGED: f64 = 1e-8;
const ROUNDS: usize = 12;
/// How far (in face coordinates) a projection may lie beyond an edge and still count as on the face.
pub(crate) const EDGE: f64 = 1e-9;
/// The same at the border of the surface.
const BORDER: f64 = 1e-2;
const HOPS: usize = 16;
/// Part of the determinant without the face's twist below which Newton's iteration leaves the twist out.
const FAR: f64 = 0.5;
/// How far (in face coordinates) Newton's iteration goes. A face that tapers folds over further out, where a node has other
/// projections on it that mean nothing.
const REACH: f64 = 1.5;
/// After so many steps beyond that the next face is looked at.
const STOPS: usize = 3;

/// Shape functions of the bilinear face, corners counter-clockwise from (-1, -1).
#[inline(always)]
pub(crate) fn shape(xi: f64, eta: f64) -> [f64; 4] {
    let (xm, xp, em, ep) = (0.5 - 0.5 * xi, 0.5 + 0.5 * xi, 0.5 - 0.5 * eta, 0.5 + 0.5 * eta);
    [xm * em, xp * em, xp * ep, xm * ep]
}

/// Derivatives of the shape functions with respect to `xi` and `eta`.
#[inline(always)]
pub(crate) fn shape_gradients(xi: f64, eta: f64) -> [[f64; 2]; 4] {
    let (xm, xp, em, ep) = (0.5 - 0.5 * xi, 0.5 + 0.5 * xi, 0.5 - 0.5 * eta, 0.5 + 0.5 * eta);
    [[-0.5 * em, -0.5 * xm], [0.5 * em, -0.5 * xp], [0.5 * ep, 0.5 * xp], [-0.5 * ep, 0.5 * xm]]
}

/// Positions of the nodes of the trace (m).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Positions<'a>(pub &'a [Padded]);

impl Positions<'_> {
    #[inline(always)]
    pub fn at(&self, node: u32) -> Vector3<f64> {
        self.0[node as usize].vector()
    }
}

/// `x = c + a xi + b eta + t xi eta`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bilinear {
    c: Vector3<f64>,
    a: Vector3<f64>,
    b: Vector3<f64>,
    t: Vector3<f64>,
}

impl Bilinear {
    #[inline(always)]
    pub fn through(x: [Vector3<f64>; 4]) -> Self {
        let (p, q) = (x[0] + x[2], x[1] + x[3]);
        let (d, e) = (x[2] - x[0], x[1] - x[3]);
        Self { c: 0.25 * (p + q), a: 0.25 * (d + e), b: 0.25 * (d - e), t: 0.25 * (p - q) }
    }

    #[inline(always)]
    fn point(&self, xi: f64, eta: f64) -> Vector3<f64> {
        self.c + xi * self.a + eta * (self.b + xi * self.t)
    }

    #[inline(always)]
    fn tangents(&self, xi: f64, eta: f64) -> [Vector3<f64>; 2] {
        [self.a + eta * self.t, self.b + xi * self.t]
    }
}

/// The surface at a point of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    /// The point on the facet (m).
    pub x: Vector3<f64>,
    /// Outward unit normal of the exact surface, or of the facet.
    pub normal: UnitVector3<f64>,
    /// First tangent of the facet (m).
    pub tangent: Vector3<f64>,
    /// Distance of the exact surface from the facet along `normal` (m).
    pub offset: f64,
}

/// The projection of a node on the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    pub face: u32,
    pub xi: f64,
    pub eta: f64,
    pub point: SurfacePoint,
    /// Gap (m), negative when the node has penetrated.
    pub gap: f64,
}

/// Geometry of one face in both configurations.
///
/// # The exact surface beyond the facet
/// In the reference configuration the exact surface lies at `X_m + c N_s`, with `X_m(xi)` on the
/// facet, `N_s` the exact normal and `c` the signed distance. Since `N_s = -grad c`, the distance
/// changes by `c,a = -N_s.A_a` along the facet's tangents `A_a`. On the deformed face the exact
/// surface is taken at the same distance; its tangents are then `a_b - (N_s.A_b) n_f` (to first
/// order in the slope), and the vector normal to both is `n_f + (N_s.A_a) g^a` with the dual
/// tangents `g^a . a_b = delta_ab`. With `nu = N_s.N_f` in front of `n_f` the vector is the exact
/// rotation of `N_s` when the face only rotates:
/// `n = normalise(nu n_f + (N_s.A_a) g^a)`.
///
/// The projection of a node is where `x_s - x_m` is parallel to `n`. Its normal part on the facet being
/// `lambda = n_f.(x_s - x_m)`, that is `a_b.(x_s - x_m) = (lambda/nu) N_s.A_b`, and the gap is
/// `n.(x_s - x_m) - c`. Neighbouring facets then meet without a kink: gap, normal and projection are
/// those of the smooth surface.
pub(crate) struct FaceGeometry<'a> {
    current: Bilinear,
    exact: Option<(&'a Bilinear, &'a SmoothSurface)>,
}

impl<'a> FaceGeometry<'a> {
    #[inline(always)]
    pub fn new(
        surface: &'a ContactSurface,
        face: u32,
        positions: &Positions<'_>,
        curvature: bool,
    ) -> Self {
        let face = &surface.faces[face as usize];
        let exact = match &surface.smooth {
            Some(smooth) if curvature => Some((&face.reference, smooth)),
            _ => None,
        };
        Self { current: face.facet(positions), exact }
    }

    /// The surface at `(xi, eta)`.
    pub fn at(&self, xi: f64, eta: f64) -> SurfacePoint {
        self.evaluate(self.current.point(xi, eta), xi, eta).0
    }

    /// The surface at `(xi, eta)` and Newton's correction towards the projection of `node`: `H^-1 r` with the residual
    /// `r_a = a_a . d - (n_f . d / nu) N_s . A_a` and its gradient `H_ab = a_a . a_b - d . a_a,b`, for `d = x_s - x_m`.
    #[inline(always)]
    fn evaluate(&self, node: Vector3<f64>, xi: f64, eta: f64) -> (SurfacePoint, Vector2<f64>) {
        let x = self.current.point(xi, eta);
        let plane = TangentPlane::of(&self.current, xi, eta);
        let TangentPlane { tangents: [a1, a2], area, normal: n_f, metric } = plane;
        let d = node - x;
        let mut residual = Vector2::new(a1.dot(&d), a2.dot(&d));
        let mut normal = n_f;
        let mut offset = 0.0;
        if let Some((reference, smooth)) = &self.exact {
            let inclination = Inclination::of(smooth, reference, xi, eta);
            offset = smooth.offset(reference.point(xi, eta));
            residual -= n_f.dot(&d) / inclination.nu * inclination.along;
            normal = plane.inclined(&inclination);
        }
        let twist = d.dot(&self.current.t);
        let mut gradient = metric - Matrix2::new(0.0, twist, twist, 0.0);
        let mut det = gradient.determinant();
        // far from the projection the second derivative can lead astray; then as if the face did not twist
        if det < FAR * (area * area) {
            (gradient, det) = (metric, area * area);
        }
        let correction = adjugate(&gradient) * residual * (1.0 / det);
        (SurfacePoint { x, normal, tangent: a1, offset }, correction)
    }
}

/// The tangents `a_a` of a facet at a point, its unit normal `n_f` and its metric `a_a . a_b`.
struct TangentPlane {
    tangents: [Vector3<f64>; 2],
    /// Of the parallelogram of the tangents (m^2).
    area: f64,
    normal: UnitVector3<f64>,
    /// `g_ab` (m^2).
    metric: Matrix2<f64>,
}

impl TangentPlane {
    #[inline(always)]
    fn of(facet: &Bilinear, xi: f64, eta: f64) -> Self {
        let [a1, a2] = facet.tangents(xi, eta);
        let facet = a1.cross(&a2);
        let area = facet.norm();
        let g12 = a1.dot(&a2);
        let metric = Matrix2::new(a1.dot(&a1), g12, g12, a2.dot(&a2));
        let normal = UnitVector3::new_unchecked(facet * (1.0 / area));
        Self { tangents: [a1, a2], area, normal, metric }
    }

    /// The normal `normalise(nu n_f + (N_s.A_a) g^a)` of the exact surface.
    #[inline(always)]
    fn inclined(&self, inclination: &Inclination) -> UnitVector3<f64> {
        let [a1, a2] = self.tangents;
        let per_area = 1.0 / self.area;
        // Dual components: t_a g^a = w^a a_a with w = g^-1 t, det g = area^2.
        let w = adjugate(&self.metric) * inclination.along * (per_area * per_area);
        direction(inclination.nu * *self.normal + w.x * a1 + w.y * a2)
    }
}

/// How the exact surface is inclined to a facet at a point, in the reference configuration.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Inclination {
    /// `N_s . N_f`.
    pub nu: f64,
    /// `N_s . A_a` (m).
    pub along: Vector2<f64>,
}

impl Inclination {
    #[inline(always)]
    fn of(smooth: &SmoothSurface, reference: &Bilinear, xi: f64, eta: f64) -> Self {
        let [b1, b2] = reference.tangents(xi, eta);
        let n_s = smooth.normal(reference.point(xi, eta));
        let facet = b1.cross(&b2);
        Self { nu: n_s.dot(&facet) / facet.norm(), along: Vector2::new(n_s.dot(&b1), n_s.dot(&b2)) }
    }

    /// That at a corner of a face, where the surface has an exact one.
    pub fn at_corner(surface: &ContactSurface, face: u32, corner: u8) -> Option<Self> {
        let [xi, eta] = CORNERS[usize::from(corner)];
        let reference = &surface.faces[face as usize].reference;
        surface.smooth.as_ref().map(|smooth| Self::of(smooth, reference, xi, eta))
    }
}

const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// The normal of a face at one of its corners, of the exact surface where it has one and `curvature` is set.
pub(crate) fn corner_normal(
    surface: &ContactSurface,
    corner: &Corner,
    positions: &Positions<'_>,
    curvature: bool,
) -> UnitVector3<f64> {
    let [xi, eta] = CORNERS[usize::from(corner.number)];
    let facet = surface.faces[corner.face as usize].facet(positions);
    let plane = TangentPlane::of(&facet, xi, eta);
    match &corner.inclination {
        Some(inclination) if curvature => plane.inclined(inclination),
        _ => plane.normal,
    }
}

/// A point of the master surface followed through one step: where the projection of the last step is
/// now, and the new projection.
pub(crate) struct Followed {
    /// The old projection, moved with the face.
    pub old: SurfacePoint,
    /// The new projection; `None` where the node projects off the surface.
    pub projection: Option<Projection>,
}

/// The point of the surface with its mirror image, for a point of its half on the plane. Its tangent lies in the plane.
fn symmetric_point(point: SurfacePoint) -> SurfacePoint {
    let normal = direction_in_plane(*point.normal);
    SurfacePoint {
        x: in_plane(point.x),
        normal,
        tangent: tangent_in_plane(normal),
        offset: point.offset,
    }
}

/// The projection of a `node` of the plane on a symmetric `surface`: on the edge of the face that lies in the plane.
fn symmetric_projection(
    surface: &ContactSurface,
    positions: &Positions<'_>,
    curvature: bool,
    node: Vector3<f64>,
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
    let gap = point.normal.dot(&(node - point.x)) - point.offset;
    Projection { face, xi, eta, point, gap }
}

/// Projects `node` on `surface`, starting on `face` at `(xi, eta)`. A node on the plane of a surface's symmetry stays
/// on it.
#[inline]
pub(crate) fn project(
    surface: &ContactSurface,
    positions: &Positions<'_>,
    curvature: bool,
    node: Vector3<f64>,
    face: u32,
    xi: f64,
    eta: f64,
) -> Followed {
    let Followed { old, projection } = walk(surface, positions, curvature, node, face, xi, eta);
    if !surface.is_on_plane(node) {
        return Followed { old, projection };
    }
    let on_plane = |p| symmetric_projection(surface, positions, curvature, node, p);
    Followed { old: symmetric_point(old), projection: projection.map(on_plane) }
}

/// The walk from face to face to the projection of `node`. It crosses the edge that the projection has left furthest behind;
/// where that is a border and the projection lies beyond another edge as well, that one. Where the walk would turn back at
/// once, the node lies over a ridge and belongs to the face of lowest index.
#[inline]
fn walk(
    surface: &ContactSurface,
    positions: &Positions<'_>,
    curvature: bool,
    node: Vector3<f64>,
    face: u32,
    xi: f64,
    eta: f64,
) -> Followed {
    let geometry = FaceGeometry::new(surface, face, positions, curvature);
    let (old, first) = geometry.evaluate(node, xi, eta);
    let mut projection = on_face(&geometry, node, face, [xi, eta], Some((old, first)));
    let mut previous = NONE;
    for _ in 0..HOPS {
        let Some(here) = projection else {
            return Followed { old, projection: None };
        };
        let [(edge, beyond), (other, less)] = exits(here.xi, here.eta);
        if beyond <= EDGE {
            return Followed { old, projection };
        }
        let neighbours = &surface.faces[here.face as usize].neighbours;
        let aside = neighbours[edge].0 == NONE && less > EDGE && neighbours[other].0 != NONE;
        let edge = if aside { other } else { edge };
        let (next, its_edge) = neighbours[edge];
        if next == NONE || (next == previous && here.face < next) {
            // over a ridge, not where the iteration was stopped
            let ridge = next != NONE && beyond < REACH - 1.0;
            let accepted = ridge || beyond <= BORDER;
            return Followed { old, projection: projection.filter(|_| accepted) };
        }
        let [xi, eta] = enter(edge, here.xi, here.eta, its_edge);
        let geometry = FaceGeometry::new(surface, next, positions, curvature);
        previous = here.face;
        projection = on_face(&geometry, node, next, [xi, eta], None);
    }
    // Either the wedge at a vertex, where any of its faces serves, or a walk from too far.
    Followed { old, projection: projection.filter(|f| exits(f.xi, f.eta)[0].1 <= BORDER) }
}

/// The edges that `(xi, eta)` lies furthest beyond in either coordinate, and how far, the furthest first.
#[inline(always)]
fn exits(xi: f64, eta: f64) -> [(usize, f64); 2] {
    let (edge_x, out_x) = if xi < 0.0 { (3, -xi) } else { (1, xi) };
    let (edge_y, out_y) = if eta < 0.0 { (0, -eta) } else { (2, eta) };
    let (x, y) = ((edge_x, out_x - 1.0), (edge_y, out_y - 1.0));
    if out_x > out_y { [x, y] } else { [y, x] }
}

/// Coordinates on the neighbour of the point where edge `edge` is crossed; the neighbour runs
/// through the edge, its own number `its_edge`, the other way.
fn enter(edge: usize, xi: f64, eta: f64, its_edge: u8) -> [f64; 2] {
    let along = match edge {
        0 => xi,
        1 => eta,
        2 => -xi,
        _ => -eta,
    };
    let s = (-along).clamp(-1.0, 1.0);
    match its_edge {
        0 => [s, -1.0],
        1 => [1.0, s],
        2 => [-s, 1.0],
        _ => [-1.0, -s],
    }
}

/// Newton's iteration on one face, extended beyond its edges up to [`REACH`], where it stops for the next face.
#[inline(always)]
fn on_face(
    geometry: &FaceGeometry<'_>,
    node: Vector3<f64>,
    face: u32,
    [mut xi, mut eta]: [f64; 2],
    first: Option<(SurfacePoint, Vector2<f64>)>,
) -> Option<Projection> {
    let mut evaluated = match first {
        Some(known) => known,
        None => geometry.evaluate(node, xi, eta),
    };
    let mut stopped = 0;
    for _ in 0..ROUNDS {
        let (point, correction) = evaluated;
        let to = [xi + correction.x, eta + correction.y];
        if !to.iter().all(|c| c.is_finite()) {
            return None;
        }
        [xi, eta] = to.map(|c| c.clamp(-REACH, REACH));
        stopped += usize::from([xi, eta] != to);
        if stopped == STOPS || correction.amax() < CONVERGED {
            let gap = point.normal.dot(&(node - point.x)) - point.offset;
            return Some(Projection { face, xi, eta, point, gap });
        }
        evaluated = geometry.evaluate(node, xi, eta);
    }
    None
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::tests::plates::{STEEL, plate};

    /// The half y >= 0 of a roof whose ridge lies in the plane of symmetry, as a surface and its nodes.
    fn roof(symmetric: bool) -> (ContactSurface, Vec<Padded>) {
        let (mut mesh, top) = plate([0.0, 0.0], [4.0, 3.0], [4, 3], 0.0, 0.5, true);
        mesh.symmetric = symmetric;
        mesh.nodes.iter_mut().for_each(|x| x[2] -= 0.2 * x[1]);
        let (trace, surface) = ContactSurface::alone(&mesh, &top, STEEL).unwrap();
        let nodes = trace.nodes().iter().map(|&n| Padded::from(mesh.at(n))).collect();
        (surface, nodes)
    }

    #[test]
    fn over_tapering_faces_a_node_is_found_from_either_and_under_its_place() {
        // two faces that meet in x = 0 and are twice as long at the top, as where columns of elements merge
        let (mut mesh, top) = plate([0.0, 0.0], [2.0, 1.0], [2, 1], 0.0, 0.5, true);
        mesh.nodes.iter_mut().for_each(|x| x[0] = (x[0] - 1.0) * (0.9 + 1.1 * x[1]));
        let (trace, surface) = ContactSurface::alone(&mesh, &top, STEEL).unwrap();
        let nodes: Vec<Padded> = trace.nodes().iter().map(|&n| Padded::from(mesh.at(n))).collect();
        let positions = Positions(&nodes);
        let height = mesh.nodes.iter().fold(f64::MIN, |top, x| top.max(x[2]));
        for (i, j) in (0..40).flat_map(|i| (0..20).map(move |j| (i, j))) {
            let y = (f64::from(j) + 0.5) / 20.0;
            let x = (f64::from(i) / 20.0 - 0.975) * (0.9 + 1.1 * y);
            for (face, xi) in [(0, -0.9), (0, 0.9), (1, -0.9), (1, 0.9)] {
                for eta in [-0.9, 0.9] {
                    let node = Vector3::new(x, y, height + 0.01);
                    let found = project(&surface, &positions, false, node, face, xi, eta);
                    let found = found.projection.unwrap();
                    assert!((found.gap - 0.01).abs() < 1e-12, "{node:?} from {face}: {found:?}");
                    assert!(
                        (found.point.x - Vector3::new(x, y, height)).norm() < 1e-8,
                        "{found:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn over_the_ridge_of_a_symmetric_roof_the_normal_is_upright_and_no_lever_crosses_the_plane() {
        let node = Vector3::new(1.3, 0.0, 0.01);
        for (symmetric, normal_y) in [(true, 0.0), (false, 0.2 / libm::hypot(1.0, 0.2))] {
            let (surface, nodes) = roof(symmetric);
            let positions = Positions(&nodes);
            let found = project(&surface, &positions, false, node, 1, 0.0, 0.0).projection.unwrap();
            assert!((found.point.normal[1] - normal_y).abs() < 1e-12, "{symmetric}: {found:?}");
            if symmetric {
                assert_eq!([found.point.x.y, found.point.tangent.y], [0.0; 2]);
                assert!((found.gap - 0.01).abs() < 1e-15 && (found.point.x[0] - 1.3).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn whichever_edge_of_the_faces_lies_in_the_plane_of_symmetry_the_projection_lies_on_it() {
        let (mut mesh, top) = plate([0.0, 0.0], [4.0, 3.0], [4, 3], 0.0, 0.5, true);
        mesh.symmetric = true;
        mesh.nodes.iter_mut().for_each(|x| x[2] -= 0.2 * x[1]);
        for turn in 0..4 {
            let mut top = top.clone();
            top.faces.iter_mut().for_each(|face| face.nodes.rotate_left(turn));
            let (trace, surface) = ContactSurface::alone(&mesh, &top, STEEL).unwrap();
            let nodes = trace.nodes().iter().map(|&n| Padded::from(mesh.at(n)));
            let nodes: Vec<Padded> = nodes.collect();
            let node = Vector3::new(1.3, 0.0, 0.01);
            let found = project(&surface, &Positions(&nodes), false, node, 1, 0.0, 0.0);
            let found = found.projection.unwrap();
            assert!((found.gap - 0.01).abs() < 1e-15, "{turn}: {found:?}");
            let off = [found.point.x[0] - 1.3, found.point.x[1], found.point.x[2]];
            assert!(off.iter().all(|c| c.abs() < 1e-12), "{turn}: {found:?}");
        }
    }
}
