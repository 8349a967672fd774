//! The closest-point projection of nodes on the other surface and the slip velocity there, from positions
//! and velocities alone: nothing of a solver's contact algorithm is used.

use crate::check::surface::Surface;
use mesh::geometry::{adjugate, direction};
use nalgebra::{Matrix2, UnitVector3, Vector2, Vector3};
use std::collections::HashMap;

/// How far (in face coordinates, -1 to 1) a projection may lie beyond an edge and still count as on the face.
const EDGE_TOLERANCE: f64 = 1e-6;
/// The same for a node over a convex edge between two faces, which projects on neither of them.
const CONVEX_EDGE: f64 = 0.2;
const NONE: u32 = u32::MAX;
/// Face coordinates of the corners.
const SIGNS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Relative motion of the nodes of one body (the slaves) over the faces of the other.
pub(crate) struct Pair {
    /// The body whose nodes are projected.
    pub slave: u8,
    masters: Vec<u32>,
    /// Master faces around each node.
    around: Vec<Vec<u32>>,
    /// Face of each node's last projection and where it was there.
    last: Vec<(u32, [f64; 2])>,
    grid: HashMap<[i64; 2], Vec<u32>>,
    cell: f64,
    over_convex_edges: bool,
}

impl Pair {
    /// As [`new`](Self::new), where a node over a convex edge between two faces projects near that edge.
    pub fn over_convex_edges(surface: &Surface, slave: u8) -> Self {
        Self { over_convex_edges: true, ..Self::new(surface, slave) }
    }

    /// The pair with the nodes of `slave` as slaves.
    pub fn new(surface: &Surface, slave: u8) -> Self {
        let masters: Vec<u32> = (0..surface.faces.len() as u32)
            .filter(|&face| surface.face_body[face as usize] != slave)
            .collect();
        let edge = |&face: &u32| {
            let corners = surface.faces[face as usize].map(|n| surface.points[n as usize]);
            (corners[2] - corners[0]).norm().max((corners[3] - corners[1]).norm())
        };
        let cell = masters.iter().map(edge).fold(f64::MIN_POSITIVE, f64::max);
        let mut around = vec![Vec::new(); surface.points.len()];
        for &face in &masters {
            surface.faces[face as usize].iter().for_each(|&n| around[n as usize].push(face));
        }
        Self {
            slave,
            masters,
            around,
            last: vec![(NONE, [0.0; 2]); surface.points.len()],
            grid: HashMap::new(),
            cell,
            over_convex_edges: false,
        }
    }

    /// The slip velocity (m/s) of each of `nodes` relative to the other surface, from displacements (m) and velocities (m/s)
    /// of all nodes; `None` where the node has no projection. It lies in the plane of the averaged normal: faces of a dent
    /// meet at an angle, and the plane of one of them is off by half of it.
    pub fn slip(
        &mut self,
        surface: &Surface,
        [displacement, velocity]: &[Vec<Vector3<f64>>; 2],
        nodes: &[usize],
    ) -> Vec<Option<Vector3<f64>>> {
        let projections = self.projections(surface, displacement, nodes);
        let mut normals = vec![None; surface.points.len()];
        let slip = |(&node, projection): (&usize, Option<(u32, Projection)>)| {
            let (face, projection) = projection?;
            let mut relative = velocity[node];
            let corners = surface.faces[face as usize];
            for (i, corner) in corners.into_iter().enumerate() {
                let v = velocity[corner as usize];
                relative -= projection.weights[i] * v;
                relative += projection.normal.dot(&v) * projection.levers[i];
            }
            let mut mean = Vector3::zeros();
            for (weight, corner) in projection.weights.into_iter().zip(corners) {
                let normal = normals[corner as usize]
                    .get_or_insert_with(|| self.normal(surface, displacement, corner));
                mean += weight * **normal;
            }
            Some(relative - relative.dot(&mean) / mean.norm_squared() * mean)
        };
        nodes.iter().zip(projections).map(slip).collect()
    }

    /// The mean of the unit normals that the master faces around a node have there.
    pub fn normal(
        &self,
        surface: &Surface,
        displacement: &[Vector3<f64>],
        node: u32,
    ) -> UnitVector3<f64> {
        let at = |node: u32| surface.points[node as usize] + displacement[node as usize];
        let around = self.around[node as usize].iter();
        let directions = around.map(|&face| {
            let corners = surface.faces[face as usize];
            let corner = corners.iter().position(|&n| n == node).unwrap_or(0);
            let edge = |ahead: usize| at(corners[(corner + ahead) % 4]) - at(node);
            *direction(edge(1).cross(&edge(3)))
        });
        UnitVector3::new_normalize(directions.sum())
    }

    /// The face under each of `nodes` and its projection there; `None` where the node has no projection.
    pub fn projections(
        &mut self,
        surface: &Surface,
        displacement: &[Vector3<f64>],
        nodes: &[usize],
    ) -> Vec<Option<(u32, Projection)>> {
        let at = |node: usize| surface.points[node] + displacement[node];
        let corners = |face: u32| surface.faces[face as usize].map(|n| at(n as usize));
        let on = |face: u32, x: Vector3<f64>, start: [f64; 2]| {
            project(corners(face), x, start, EDGE_TOLERANCE)
        };
        let nearest = |faces: &mut dyn Iterator<Item = u32>, x: Vector3<f64>| {
            faces
                .filter_map(|face| Some((face, on(face, x, [0.0; 2]).on_face()?)))
                .min_by(|a, b| a.1.gap.abs().total_cmp(&b.1.gap.abs()))
        };
        let mut sorted = false;
        let mut found = Vec::with_capacity(nodes.len());
        for &node in nodes {
            let x = at(node);
            let mut best = None;
            let (last, start) = self.last[node];
            if last != NONE {
                let corners = surface.faces[last as usize];
                match on(last, x, start) {
                    Projected::On(projection) => best = Some((last, projection)),
                    // where nodes face nodes they often pass a corner: its faces are tried first
                    Projected::Beside([xi, eta]) => {
                        let corner = match (xi > 0.0, eta > 0.0) {
                            (false, false) => corners[0],
                            (true, false) => corners[1],
                            (true, true) => corners[2],
                            (false, true) => corners[3],
                        };
                        let around = self.around[corner as usize].iter().copied();
                        best = nearest(&mut around.filter(|face| *face != last), x);
                    }
                    Projected::Nowhere => {}
                }
                if best.is_none() {
                    let beside = corners.iter().flat_map(|&n| &self.around[n as usize]);
                    best = nearest(&mut beside.copied(), x);
                }
            }
            if best.is_none() {
                if !sorted {
                    self.sort_faces(surface, displacement);
                    sorted = true;
                }
                best = nearest(&mut self.near(x), x);
            }
            // the faces are sorted: none of those near was found
            if best.is_none() && self.over_convex_edges {
                let beyond =
                    |projection: &Projection| projection.at[0].abs().max(projection.at[1].abs());
                let on_edge = |face| project(corners(face), x, [0.0; 2], CONVEX_EDGE).on_face();
                best = (self.near(x))
                    .filter_map(|face| Some((face, on_edge(face)?)))
                    .min_by(|a, b| beyond(&a.1).total_cmp(&beyond(&b.1)));
            }
            self.last[node] =
                best.as_ref().map_or((NONE, [0.0; 2]), |(face, projection)| (*face, projection.at));
            found.push(best);
        }
        found
    }

    /// Sorts the faces by their present position into square columns over the x-y plane.
    fn sort_faces(&mut self, surface: &Surface, displacement: &[Vector3<f64>]) {
        self.grid.clear();
        for &face in &self.masters {
            let corners = surface.faces[face as usize].map(|node| node as usize);
            let centre =
                corners.iter().map(|&n| 0.25 * (surface.points[n] + displacement[n])).sum();
            self.grid.entry(self.column(centre)).or_default().push(face);
        }
    }

    fn column(&self, x: Vector3<f64>) -> [i64; 2] {
        [(x[0] / self.cell).floor() as i64, (x[1] / self.cell).floor() as i64]
    }

    fn near(&self, x: Vector3<f64>) -> impl Iterator<Item = u32> {
        let [i, j] = self.column(x);
        (-1..=1)
            .flat_map(move |di| (-1..=1).map(move |dj| [i + di, j + dj]))
            .filter_map(|column| self.grid.get(&column))
            .flatten()
            .copied()
    }
}

/// The closest-point projection of a node on a face.
pub(crate) struct Projection {
    /// Face coordinates.
    at: [f64; 2],
    /// Bilinear shape functions of the corners there.
    weights: [f64; 4],
    normal: UnitVector3<f64>,
    /// Distance of the node along the normal (m), negative where it penetrates.
    gap: f64,
    /// Surface gradients of the weights times the gap. The point of the other body at the node moves rigidly with
    /// the face at the distance of the gap, `-sum levers (normal . v)` faster than the projection: so a rotation
    /// common to both bodies gives no slip.
    levers: [Vector3<f64>; 4],
}

impl Projection {
    /// Weights of the corners at the projection, moved to the edge of the face where it lies beyond.
    pub fn within(&self) -> [f64; 4] {
        let [xi, eta] = self.at.map(|c| c.clamp(-1.0, 1.0));
        shape(xi, eta)
    }
}

/// Where the projection of a node on the surface that continues a face lies.
enum Projected {
    On(Projection),
    /// Beyond an edge, at these coordinates of the face.
    Beside([f64; 2]),
    /// So far away that there is no projection.
    Nowhere,
}

impl Projected {
    fn on_face(self) -> Option<Projection> {
        match self {
            Self::On(projection) => Some(projection),
            _ => None,
        }
    }
}

/// Newton's iteration for the closest-point projection of `node` on the bilinear face with the corners `x`, from
/// the face coordinates `[xi, eta]`; up to `edge` beyond the edges it counts as on the face.
fn project(
    x: [Vector3<f64>; 4],
    node: Vector3<f64>,
    [mut xi, mut eta]: [f64; 2],
    edge: f64,
) -> Projected {
    // The face as centre + xi a + eta b + xi eta twist, measured from the node.
    let mixed = |[p, q, r, s]: [f64; 4]| 0.25 * (p * x[0] + q * x[1] + r * x[2] + s * x[3]);
    let centre = mixed([1.0, 1.0, 1.0, 1.0]) - node;
    let (a, b) = (mixed([-1.0, 1.0, 1.0, -1.0]), mixed([-1.0, -1.0, 1.0, 1.0]));
    let twist = mixed([1.0, -1.0, 1.0, -1.0]);
    for _ in 0..20 {
        let (along, across) = (a + eta * twist, b + xi * twist);
        // from the point on the face to the node
        let away = -(centre + xi * along + eta * b);
        let residual = Vector2::new(along.dot(&away), across.dot(&away));
        let mixed = along.dot(&across) - away.dot(&twist);
        let matrix = Matrix2::new(along.norm_squared(), mixed, mixed, across.norm_squared());
        let step = 1.0 / matrix.determinant() * (adjugate(&matrix) * residual);
        xi += step[0];
        eta += step[1];
        // NaN fails this test too
        if !(xi.abs() < 10.0 && eta.abs() < 10.0) {
            return Projected::Nowhere;
        }
        // convergence is quadratic: the remaining error is far below round-off of the weights
        if step[0].abs() < 1e-8 && step[1].abs() < 1e-8 {
            if xi.abs() > 1.0 + edge || eta.abs() > 1.0 + edge {
                return Projected::Beside([xi, eta]);
            }
            let (normal, size) = UnitVector3::new_and_get(along.cross(&across));
            let gap = normal.dot(&away);
            // contravariant base vectors
            let duals = [across.cross(&normal) / size, normal.cross(&along) / size];
            let levers = SIGNS.map(|[sx, se]| {
                let by_xi = 0.25 * sx * (1.0 + se * eta) * gap;
                let by_eta = 0.25 * se * (1.0 + sx * xi) * gap;
                by_xi * duals[0] + by_eta * duals[1]
            });
            return Projected::On(Projection {
                at: [xi, eta],
                weights: shape(xi, eta),
                normal,
                gap,
                levers,
            });
        }
    }
    Projected::Nowhere
}

fn shape(xi: f64, eta: f64) -> [f64; 4] {
    let part = |a: f64, b: f64| 0.25 * (1.0 + a * xi) * (1.0 + b * eta);
    [part(-1.0, -1.0), part(1.0, -1.0), part(1.0, 1.0), part(-1.0, 1.0)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn the_projection_on_a_twisted_face_is_where_the_way_to_the_node_is_normal() {
        let x = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.05], [1.1, 0.9, -0.1], [-0.1, 1.0, 0.1]];
        let (x, node) = (x.map(Vector3::from), Vector3::new(0.3, 0.6, 0.2));
        let projection = project(x, node, [0.0; 2], EDGE_TOLERANCE).on_face().unwrap();
        let point: Vector3<f64> = projection.weights.into_iter().zip(x).map(|(w, x)| w * x).sum();
        let away = node - point;
        assert!(away.cross(&projection.normal).norm() < 1e-9 * away.norm());
        assert!((projection.gap - away.norm()).abs() < 1e-12);
        assert!((projection.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_node_beside_the_face_has_no_projection() {
        let x =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(Vector3::from);
        let beside = project(x, Vector3::new(1.01, 0.5, 0.0), [0.0; 2], EDGE_TOLERANCE);
        assert!(matches!(beside, Projected::Beside([xi, eta]) if xi > 1.0 && eta.abs() < 1e-12));
        assert!(
            project(x, Vector3::repeat(f64::NAN), [0.0; 2], EDGE_TOLERANCE).on_face().is_none()
        );
        assert!(
            project([Vector3::zeros(); 4], Vector3::zeros(), [0.0; 2], EDGE_TOLERANCE)
                .on_face()
                .is_none()
        );
    }

    #[test]
    fn a_common_rotation_gives_no_slip_across_a_gap() {
        let points = vec![
            [0.0, 0.0, 0.0],
            [1.0, 0.1, 0.0],
            [1.1, 1.0, 0.0],
            [-0.1, 1.0, 0.0],
            [0.4, 0.5, 0.2],
        ];
        let points: Vec<Vector3<f64>> = points.into_iter().map(Vector3::from).collect();
        let turn = Vector3::new(3.0, -2.0, 5.0);
        let velocity = points.iter().map(|x| turn.cross(x)).collect();
        let surface = Surface {
            faces: vec![[0, 1, 2, 3]],
            face_body: vec![1],
            body: vec![1, 1, 1, 1, 0],
            area: vec![1.0; 5],
            points,
        };
        let motion = [vec![Vector3::zeros(); 5], velocity];
        let slip = Pair::new(&surface, 0).slip(&surface, &motion, &[4])[0].unwrap();
        assert!(slip.norm() < 1e-14, "{slip:?}");
    }

    /// Two faces in a row along x that meet at x = 0, their other edges at the height `sides`, and a `node` of another body.
    fn two_faces(sides: f64, node: Vector3<f64>) -> Surface {
        let across = |y: f64| [[-1.0, y, sides], [0.0, y, 0.0], [1.0, y, sides]].map(Vector3::from);
        let points = [&across(0.0)[..], &across(1.0), &[node]].concat();
        Surface {
            faces: vec![[0, 1, 4, 3], [1, 2, 5, 4]],
            face_body: vec![1, 1],
            body: vec![1, 1, 1, 1, 1, 1, 0],
            area: vec![1.0; 7],
            points,
        }
    }

    #[test]
    fn slip_over_the_edge_between_two_faces_lies_in_the_plane_of_their_mean_normal() {
        // a ridge of slope 0.1, with the node on it
        let surface = two_faces(-0.1, Vector3::new(0.0, 0.5, 0.0));
        let mut velocity = vec![Vector3::zeros(); 7];
        velocity[6] = Vector3::new(2.0, 1.0, 3.0);
        let slip =
            Pair::new(&surface, 0).slip(&surface, &[vec![Vector3::zeros(); 7], velocity], &[6]);
        assert!((slip[0].unwrap() - Vector3::new(2.0, 1.0, 0.0)).norm() < 1e-15, "{slip:?}");
    }

    #[test]
    fn slip_over_a_moving_master_that_deforms_is_taken_at_the_projection() {
        let surface = two_faces(0.0, Vector3::new(-0.75, 0.5, 0.0));
        // v_x of the master grows with x; the node rolls from the first face to the second
        let velocity = |x: f64| Vector3::new(2.0 * x, 1.0, 5.0);
        let mut velocities: Vec<Vector3<f64>> =
            surface.points[..6].iter().map(|x| velocity(x[0])).collect();
        velocities.push(7.0 * Vector3::x());
        let mut pair = Pair::new(&surface, 0);
        for moved in [0.0, 1.3, 0.2] {
            let mut displacement = vec![Vector3::zeros(); 7];
            displacement[6].x = moved;
            let motion = [displacement, velocities.clone()];
            let slip = pair.slip(&surface, &motion, &[6])[0].unwrap();
            let expected = Vector3::new(7.0 - 2.0 * (moved - 0.75), -1.0, 0.0);
            assert!((slip - expected).norm() < 1e-12, "{slip:?}");
        }
        let mut displacement = vec![Vector3::zeros(); 7];
        displacement[6].x = 9.0;
        assert_eq!(pair.slip(&surface, &[displacement, velocities], &[6]), [None]);
    }
}
