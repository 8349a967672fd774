//! Where the nodes of a body find the material that lies ahead of them: what a mesh needs to move along its body.
//!
//! A node whose place ahead is that of another node takes that node's values as they are. The others take those of the
//! quadratic polynomial that fits best, in the least squares weighted by distance, over the nodes of the element that holds
//! their place and of its neighbours (moving least squares, Lancaster and Salkauskas 1981). Trilinear interpolation would
//! flatten a field of positive curvature at every move, as if a force acted.

use crate::geometry::hull;
use crate::{Body, BoxTree, HEX_CORNERS, Mesh, Padded};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use std::f64::consts::PI;

/// Two places closer than this, over the shortest distance that matters, are one.
const COINCIDENT: f64 = 1e-6;

/// What a fit adds to the square of a distance over the extent of an element, before it weighs by the inverse.
const NEAR: f64 = 0.05;

/// Pivots of a fit below this part of the diagonal say that the points do not determine the polynomial.
const REGULAR: f64 = 1e-6;

/// Steps of Newton's method for the place of a point in an element.
const STEPS: usize = 20;

/// Coordinates of which the first runs along the body, which is the same at every value of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Chart {
    /// x, y, z of a straight body.
    Straight,
    /// Arc length, y and distance from the axis of a ring about an axis along y.
    Ring {
        /// Height of the axis, and the radius at which arc lengths are measured (m).
        radius: f64,
    },
}

impl Chart {
    /// The coordinates of a point (m).
    pub fn of(self, point: Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Straight => point,
            Self::Ring { radius } => {
                let (x, down) = (point.x, radius - point.z);
                Vector3::new(radius * libm::atan2(x, down), point.y, libm::hypot(x, down))
            }
        }
    }

    /// The unit vectors along the coordinates at a point: the columns.
    pub fn directions(self, point: Vector3<f64>) -> Matrix3<f64> {
        match self {
            Self::Straight => Matrix3::identity(),
            Self::Ring { radius } => {
                let (sin, cos) = libm::sincos(libm::atan2(point.x, radius - point.z));
                Matrix3::new(cos, 0.0, sin, 0.0, 1.0, 0.0, sin, 0.0, -cos)
            }
        }
    }

    /// The length after which a ring begins again (m).
    fn turn(self) -> Option<f64> {
        match self {
            Self::Straight => None,
            Self::Ring { radius } => Some(2.0 * PI * radius),
        }
    }
}

/// Where a node finds a value.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// At a node.
    Node(u32),
    /// Between nodes, as a weighted mean.
    Between {
        /// The nodes.
        nodes: Vec<u32>,
        /// Their weights, whose sum is one.
        weights: Vec<f64>,
    },
}

impl Source {
    /// The value that the source gives of a field over the nodes.
    pub fn of(&self, field: impl Fn(u32) -> Padded) -> Padded {
        match self {
            Self::Node(n) => field(*n),
            Self::Between { nodes, weights } => {
                let mut sum = Padded::ZERO;
                for (&n, w) in nodes.iter().zip(weights) {
                    let value = field(n);
                    (0..3).for_each(|i| sum[i] += w * value[i]);
                }
                sum
            }
        }
    }
}

/// Where each node of `body` finds the material that lies `ahead` of it (m) along the first coordinate of `chart`. Places
/// beyond the end of a straight body are moved back to it. `size` is the shortest distance that matters (m).
pub fn sources_ahead(mesh: &Mesh, body: &Body, chart: Chart, ahead: f64, size: f64) -> Vec<Source> {
    let nodes = mesh.nodes[body.nodes.clone()].iter();
    let at: Vec<Vector3<f64>> = nodes.map(|&x| chart.of(x)).collect();
    let first = body.nodes.start as u32;
    let elements: Vec<[Vector3<f64>; 8]> = mesh.hexes[body.hexes.clone()]
        .iter()
        .map(|hex| unwrapped(hex.map(|n| at[(n - first) as usize]), chart))
        .collect();
    let slack = COINCIDENT * size;
    let tree = BoxTree::new(elements.iter().map(|corners| around(corners, slack)));
    let mut near = Vec::new();
    let around_element = Neighbours::new(mesh, body);
    let end = at.iter().fold(f64::NEG_INFINITY, |end, q| end.max(q.x));
    let source = |q: &Vector3<f64>| {
        let place = Vector3::new(q.x + ahead, q.y, q.z);
        let places = match chart.turn() {
            None => vec![Vector3::new(place.x.min(end), q.y, q.z)],
            Some(turn) => [0.0, -turn, turn].map(|t| Vector3::new(place.x + t, q.y, q.z)).to_vec(),
        };
        let mut best: Option<(f64, u32, Vector3<f64>)> = None;
        for place in places {
            // a place may lie beyond a curved side by the sag of an edge
            tree.near([place, place], 0.5 * size, &mut near);
            for &element in &near {
                let corners = &elements[element as usize];
                let hex = mesh.hexes[body.hexes.start + element as usize];
                if let Some(corner) = corners.iter().position(|c| (c - place).norm() < slack) {
                    return Source::Node(hex[corner]);
                }
                let inner = coordinates(corners, place);
                let beyond = inner.iter().fold(0.0, |most: f64, c| most.max(c.abs() - 1.0));
                if best.is_none_or(|(least, ..)| beyond < least) {
                    best = Some((beyond, element, inner));
                }
            }
        }
        match best {
            Some((_, element, inner)) => {
                let corners = &elements[element as usize];
                let weights = shape(inner.map(|c| c.clamp(-1.0, 1.0)));
                let place = mean(corners, weights);
                let nodes = around_element.nodes(element as usize);
                let stencil: Vec<_> = nodes
                    .iter()
                    .map(|&n| unwrapped_to(at[(n - first) as usize], place, chart))
                    .collect();
                match least_squares(&stencil, place, extent(corners)) {
                    Some(weights) => Source::Between { nodes, weights },
                    None => Source::Between {
                        nodes: mesh.hexes[body.hexes.start + element as usize].to_vec(),
                        weights: weights.to_vec(),
                    },
                }
            }
            None => Source::Node(nearest(&at, place) + first),
        }
    };
    at.iter().map(source).collect()
}

/// The elements around each node of a body.
struct Neighbours<'a> {
    hexes: &'a [[u32; 8]],
    first: u32,
    /// Where the elements of each node begin in the list, and the list.
    begin: Vec<u32>,
    list: Vec<u32>,
}

impl<'a> Neighbours<'a> {
    fn new(mesh: &'a Mesh, body: &Body) -> Self {
        let (hexes, first) = (&mesh.hexes[body.hexes.clone()], body.nodes.start as u32);
        let mut begin = vec![0; body.nodes.len() + 1];
        hexes.iter().flatten().for_each(|n| begin[(n - first) as usize + 1] += 1);
        (1..begin.len()).for_each(|n| begin[n] += begin[n - 1]);
        let mut next = begin.clone();
        let mut list = vec![0; 8 * hexes.len()];
        for (element, hex) in (0..).zip(hexes) {
            for n in hex.map(|n| (n - first) as usize) {
                list[next[n] as usize] = element;
                next[n] += 1;
            }
        }
        Self { hexes, first, begin, list }
    }

    /// The nodes of an element and of those around it, ascending.
    fn nodes(&self, element: usize) -> Vec<u32> {
        let around = self.hexes[element].iter().flat_map(|n| {
            let n = (n - self.first) as usize;
            &self.list[self.begin[n] as usize..self.begin[n + 1] as usize]
        });
        let mut nodes: Vec<u32> = around.flat_map(|&e| self.hexes[e as usize]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes.shrink_to_fit();
        nodes
    }
}

/// Weights of `points` with which they give the value at `place` of the quadratic polynomial that fits best there; of the
/// linear one where the points do not determine a quadratic one. Distances count in terms of `extent` in each direction.
fn least_squares(
    points: &[Vector3<f64>],
    place: Vector3<f64>,
    extent: Vector3<f64>,
) -> Option<Vec<f64>> {
    let scaled: Vec<_> = points.iter().map(|p| (p - place).component_div(&extent)).collect();
    weights_of_fit::<10>(&scaled).or_else(|| weights_of_fit::<4>(&scaled))
}

/// The weights of a fit with the first `N` of the terms 1, x, y, z, xx, yy, zz, xy, yz, zx, at the origin.
fn weights_of_fit<const N: usize>(points: &[Vector3<f64>]) -> Option<Vec<f64>> {
    let terms = |p: &Vector3<f64>| {
        let [x, y, z] = (*p).into();
        let all = [1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x];
        SVector::<f64, N>::from_fn(|i, _| all[i])
    };
    let closeness = |p: &Vector3<f64>| 1.0 / (NEAR + p.norm_squared());
    let mut normal = SMatrix::zeros();
    for p in points {
        let t = terms(p);
        normal += closeness(p) * t * t.transpose();
    }
    let solution = first_unit_solution(normal)?;
    let weight = |p: &Vector3<f64>| {
        let fit: f64 = terms(p).iter().zip(&solution).map(|(t, c)| t * c).sum();
        closeness(p) * fit
    };
    Some(points.iter().map(weight).collect())
}

/// x of a x = (1, 0, 0 ...) by Cholesky's factors, if `a` is safely positive definite.
fn first_unit_solution<const N: usize>(mut a: SMatrix<f64, N, N>) -> Option<SVector<f64, N>> {
    for k in 0..N {
        let diagonal = a[(k, k)];
        let pivot = diagonal - (0..k).map(|j| a[(k, j)] * a[(k, j)]).sum::<f64>();
        if pivot.is_nan() || pivot < REGULAR * diagonal {
            return None;
        }
        let root = pivot.sqrt();
        a[(k, k)] = root;
        for i in k + 1..N {
            let dot: f64 = (0..k).map(|j| a[(i, j)] * a[(k, j)]).sum();
            a[(i, k)] = (a[(i, k)] - dot) / root;
        }
    }
    let mut x = SVector::zeros();
    for i in 0..N {
        let dot: f64 = (0..i).map(|j| a[(i, j)] * x[j]).sum();
        x[i] = (f64::from(u8::from(i == 0)) - dot) / a[(i, i)];
    }
    for i in (0..N).rev() {
        let dot: f64 = (i + 1..N).map(|j| a[(j, i)] * x[j]).sum();
        x[i] = (x[i] - dot) / a[(i, i)];
    }
    Some(x)
}

/// The extent of an element along the coordinates (m).
fn extent(corners: &[Vector3<f64>; 8]) -> Vector3<f64> {
    let [low, high] = hull(corners);
    high - low
}

fn mean(corners: &[Vector3<f64>; 8], weights: [f64; 8]) -> Vector3<f64> {
    corners.iter().zip(weights).map(|(c, w)| w * c).sum()
}

/// A place of a ring, no more than half a turn from another.
fn unwrapped_to(mut q: Vector3<f64>, other: Vector3<f64>, chart: Chart) -> Vector3<f64> {
    if let Some(turn) = chart.turn() {
        q.x -= turn * ((q.x - other.x) / turn).round();
    }
    q
}

/// The node nearest to a place that is near no element.
fn nearest(at: &[Vector3<f64>], place: Vector3<f64>) -> u32 {
    let mut best = (f64::INFINITY, 0);
    for (node, q) in (0..).zip(at) {
        let d = (q - place).norm();
        if d < best.0 {
            best = (d, node);
        }
    }
    best.1
}

/// The corners of an element, none more than half a turn from the first.
fn unwrapped(mut corners: [Vector3<f64>; 8], chart: Chart) -> [Vector3<f64>; 8] {
    let first = corners[0];
    corners.iter_mut().for_each(|c| *c = unwrapped_to(*c, first, chart));
    corners
}

fn around(points: &[Vector3<f64>], slack: f64) -> [Vector3<f64>; 2] {
    let [low, high] = hull(points);
    [low.add_scalar(-slack), high.add_scalar(slack)]
}

/// The trilinear shape functions at coordinates from -1 to 1.
fn shape(inner: Vector3<f64>) -> [f64; 8] {
    HEX_CORNERS.map(|c| (0..3).map(|i| 0.5 * (1.0 + c[i] * inner[i])).product())
}

/// Coordinates from -1 to 1 of a point in an element, by Newton's method; infinite where it finds none.
fn coordinates(corners: &[Vector3<f64>; 8], point: Vector3<f64>) -> Vector3<f64> {
    let mut inner = Vector3::zeros();
    for _ in 0..STEPS {
        let weights = shape(inner);
        let (mut rest, mut jacobian) = (point, Matrix3::zeros());
        for (corner, (c, w)) in HEX_CORNERS.iter().zip(corners.iter().zip(weights)) {
            rest -= w * c;
            jacobian += c * slopes(corner, inner).transpose();
        }
        let Some(step) = solved(jacobian, rest) else { return Vector3::repeat(f64::INFINITY) };
        // a step is at most the element: far points shall not leave for good
        inner += step.map(|s| s.clamp(-1.0, 1.0));
        if step.iter().all(|s| s.abs() < 1e-13) {
            break;
        }
    }
    inner
}

/// Derivatives of the shape function of a corner.
fn slopes(corner: &[f64; 3], inner: Vector3<f64>) -> Vector3<f64> {
    let factor = [0, 1, 2].map(|i| 0.5 * (1.0 + corner[i] * inner[i]));
    Vector3::new(
        0.5 * corner[0] * factor[1] * factor[2],
        0.5 * corner[1] * factor[2] * factor[0],
        0.5 * corner[2] * factor[0] * factor[1],
    )
}

/// x of a x = b by Cramer's rule, if `a` is regular.
fn solved(a: Matrix3<f64>, b: Vector3<f64>) -> Option<Vector3<f64>> {
    let with_column = |j: usize| {
        let mut m = a;
        m.set_column(j, &b);
        m.determinant()
    };
    let d = a.determinant();
    let x = Vector3::from_fn(|j, _| with_column(j) / d);
    x.iter().all(|c| c.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::{Bar, Disk, FineZone, Grading, bar, disk};

    fn zone() -> FineZone {
        FineZone {
            size: 4e-3,
            length: 0.064,
            width: 0.016,
            depth: 0.008,
            start: -0.032,
            growth: 1.35,
            coarsest: 0.05,
            grading: Grading::TwoToOne,
        }
    }

    /// The value that a source gives of a field over the nodes.
    fn value(source: &Source, field: &dyn Fn(u32) -> f64) -> f64 {
        match source {
            Source::Node(n) => field(*n),
            Source::Between { nodes, weights } => {
                nodes.iter().zip(weights).map(|(&n, w)| w * field(n)).sum()
            }
        }
    }

    #[test]
    fn nodes_of_the_zone_take_over_nodes_and_linear_fields_are_carried_as_they_are() {
        let shape = Bar { length: 0.24, width: 0.06, height: 0.07, crown: Some(0.3), start: -0.12 };
        let (mesh, ahead) = (bar(&shape, &zone()).unwrap(), 16e-3);
        let sources = sources_ahead(&mesh, &mesh.bodies[0], Chart::Straight, ahead, 4e-3);
        let mut taken = 0;
        for (x, source) in mesh.nodes.iter().zip(&sources) {
            taken += usize::from(matches!(source, Source::Node(_)));
            let in_zone = x[0].abs() < 0.0321 && x[1].abs() < 0.008_1 && x[2] > -0.008_1;
            if in_zone && x[0] + ahead < 0.0321 {
                assert!(matches!(source, Source::Node(_)), "{x:?}");
            }
            let there = (x[0] + ahead).min(0.12);
            let found = value(source, &|n| mesh.nodes[n as usize][0]);
            assert!((found - there).abs() < 1e-9, "{x:?}: {found} {there}");
            let found = value(source, &|n| mesh.nodes[n as usize][1]);
            assert!((found - x[1]).abs() < 1e-9, "{x:?}: {found}");
            let found = value(source, &|n| mesh.nodes[n as usize][2]);
            assert!((found - x[2]).abs() < 2e-4, "the crown sags by no more: {x:?}: {found}");
        }
        assert!(taken > sources.len() / 3, "{taken} of {}", sources.len());
    }

    #[test]
    fn a_ring_closes_and_its_radius_and_width_are_kept() {
        let shape = Disk { radius: 0.46, hub_radius: 0.1, width: 0.06, crown: None };
        let mesh = disk(&shape, &zone()).unwrap();
        let chart = Chart::Ring { radius: shape.radius };
        let ahead = 16e-3;
        let sources = sources_ahead(&mesh, &mesh.bodies[0], chart, ahead, 4e-3);
        let q: Vec<_> = mesh.nodes.iter().map(|&x| chart.of(x)).collect();
        let turn = chart.turn().unwrap();
        for (q_node, source) in q.iter().zip(&sources) {
            let there = q_node[0] + ahead;
            let near = |n: u32| {
                let s = q[n as usize][0];
                s + turn * ((there - s) / turn).round()
            };
            assert!((value(source, &near) - there).abs() < 1e-9, "{q_node:?}");
            for i in [1, 2] {
                let found = value(source, &|n| q[n as usize][i]);
                assert!((found - q_node[i]).abs() < 1e-9, "{q_node:?}: {found}");
            }
        }
    }
}
