//! Influence matrix: relative displacement of two surfaces per force between them, W = G K^-1 G^T.

use crate::reference::SurfaceCompliance;
use faer::Mat;
use mesh::geometry::tangential;
use mesh::{Mesh, Surface};
use nalgebra::{UnitVector3, Vector3};
use std::collections::BTreeMap;
use thiserror::Error;

/// A point of potential contact: a node of the slave surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Its node (mesh index).
    pub node: u32,
    /// Its reference position, x, y, z (m).
    pub at: Vector3<f64>,
    /// Nodal area: a force over it is a traction (m^2).
    pub area: f64,
    /// Distance of the undeformed surfaces along the normal (m).
    pub gap: f64,
}

impl Point {
    /// The nodes of `surface` whose reference position is `within` the potential contact, in the order of their
    /// numbers, with `gap` (m) of that position. Nodal areas are those of the whole surface and do not depend on
    /// `within`.
    ///
    /// # Panics
    /// If `surface` is not one of `mesh`.
    pub fn on_surface(
        mesh: &Mesh,
        surface: &Surface,
        within: impl Fn(Vector3<f64>) -> bool,
        gap: impl Fn(Vector3<f64>) -> f64,
    ) -> Vec<Self> {
        let mut areas = BTreeMap::new();
        for face in &surface.faces {
            let shares = mesh::quad_corner_areas(&face.nodes.map(|n| mesh.at(n)));
            for (node, share) in face.nodes.iter().zip(shares) {
                *areas.entry(*node).or_insert(0.0) += share;
            }
        }
        let point = |(node, area): (u32, f64)| {
            let at = mesh.at(node);
            within(at).then(|| Self { node, at, area, gap: gap(at) })
        };
        areas.into_iter().filter_map(point).collect()
    }
}

/// Why an influence matrix cannot be computed.
#[derive(Debug, Error, PartialEq)]
pub enum InfluenceError {
    /// The node of a point, or of a master face below it, is not one of the compliance.
    #[error("node {node} is a contact point, but the compliance does not hold it")]
    Unknown {
        /// The node.
        node: u32,
    },
    /// A slave node has no closest-point projection on a master face.
    #[error(
        "node {node} at x = {x} m, y = {y} m has no face of the other surface before it; \
         shrink the potential contact area or extend that surface"
    )]
    NoFace {
        /// The node.
        node: u32,
        /// Its coordinate along x (m).
        x: f64,
        /// Its coordinate along y (m).
        y: f64,
    },
    /// There are no points.
    #[error("the potential contact area holds no node")]
    Empty,
}

/// Points of potential contact and their influence matrix: the relative displacements that forces between the bodies
/// cause.
///
/// Relative means slave minus master; a force acts on the slave, its opposite on the master. The
/// normal n points from the master to the slave. Tangents are t1, the tangent nearest to x, and
/// t2 = n x t1; for n = z they are x and y.
pub struct Influence {
    pub(crate) points: Vec<Point>,
    /// Component of each point's normal along z: a rigid approach by d along -z closes the gap by d times it.
    pub(crate) closing: Vec<f64>,
    /// Normal displacement per normal force (m/N), n x n.
    pub(crate) normal: Mat<f64>,
    /// Tangential displacement per tangential force (m/N), 2n x 2n, by point, then t1, t2.
    pub(crate) shear: Mat<f64>,
    /// Tangential displacement per normal force (m/N), 2n x n; `None` where it vanishes.
    pub(crate) coupling: Option<Mat<f64>>,
}

impl Influence {
    /// A body with the compliance F pressed on its own mirror image in a plane z = constant; the normal is z.
    ///
    /// The image has the compliance R F R with R = diag(1, 1, -1), hence W = F + R F R: twice the
    /// body's own compliance within the normal and within the tangential directions, and no coupling between
    /// them. This is exact for two bodies of equal material and equal shape, such as the half-spaces of
    /// Hertz and Carter. Curvature enters by the gap of the points alone.
    ///
    /// # Errors
    /// [`InfluenceError::Unknown`], [`InfluenceError::Empty`].
    pub fn mirrored(
        compliance: &SurfaceCompliance,
        points: Vec<Point>,
    ) -> Result<Self, InfluenceError> {
        let at = compliance_indices(compliance, &points)?;
        let n = points.len();
        let mut normal = Mat::zeros(n, n);
        let mut shear = Mat::zeros(2 * n, 2 * n);
        for j in 0..n {
            for i in 0..n {
                let f = compliance.block(at[i], at[j]);
                normal[(i, j)] = 2.0 * f[2][2];
                for a in 0..2 {
                    for b in 0..2 {
                        shear[(2 * i + a, 2 * j + b)] = 2.0 * f[a][b];
                    }
                }
            }
        }
        regularise(&mut shear);
        Ok(Self { points, closing: vec![1.0; n], normal, shear, coupling: None })
    }

    /// Two different bodies: the slave nodes `points` against the faces of the master's `surface`. `slave` must contain
    /// the nodes of the points, `master` those of the faces below them; `mesh` is the mesh of `surface`.
    ///
    /// Kinematics are those of the reference configuration: the projection of a node and its normal do not change. The
    /// normal is that of the smooth master surface if it has one, and z otherwise.
    ///
    /// # Errors
    /// [`InfluenceError`], in all its variants.
    pub fn between(
        slave: &SurfaceCompliance,
        points: Vec<Point>,
        master: &SurfaceCompliance,
        surface: &Surface,
        mesh: &Mesh,
    ) -> Result<Self, InfluenceError> {
        let at = compliance_indices(slave, &points)?;
        let projections = points
            .iter()
            .map(|p| Projection::find(p, master, surface, mesh))
            .collect::<Result<Vec<_>, _>>()?;
        let n = points.len();
        let mut normal = Mat::zeros(n, n);
        let mut shear = Mat::zeros(2 * n, 2 * n);
        let mut coupling = Mat::zeros(2 * n, n);
        for j in 0..n {
            for i in 0..n {
                let mut f = slave.block(at[i], at[j]);
                for (k, phi) in projections[i].weights {
                    for (l, psi) in projections[j].weights {
                        let g = master.block(k, l);
                        for a in 0..3 {
                            for b in 0..3 {
                                f[a][b] += phi * psi * g[a][b];
                            }
                        }
                    }
                }
                let local = |a: usize, b: usize| {
                    let (row, column) = (projections[i].frame[a], projections[j].frame[b]);
                    (0..9).map(|k| row[k / 3] * f[k / 3][k % 3] * column[k % 3]).sum::<f64>()
                };
                normal[(i, j)] = local(2, 2);
                for a in 0..2 {
                    coupling[(2 * i + a, j)] = local(a, 2);
                    for b in 0..2 {
                        shear[(2 * i + a, 2 * j + b)] = local(a, b);
                    }
                }
            }
        }
        regularise(&mut shear);
        let closing = projections.iter().map(|f| f.frame[2][2]).collect();
        Ok(Self { points, closing, normal, shear, coupling: Some(coupling) })
    }

    /// The same contact with penalty springs of the given areal stiffness (N/m^3), normal and
    /// tangential; `None` adds no spring in a direction.
    ///
    /// A spring k A in series with the bodies adds 1/(k A) to its point's own compliance. This shows the
    /// bias of a penalty method without its dynamics.
    pub fn with_springs(&self, normal: Option<f64>, tangential: Option<f64>) -> Self {
        let mut other = Self {
            points: self.points.clone(),
            closing: self.closing.clone(),
            normal: self.normal.clone(),
            shear: self.shear.clone(),
            coupling: self.coupling.clone(),
        };
        for (i, p) in self.points.iter().enumerate() {
            if let Some(k) = normal {
                other.normal[(i, i)] += 1.0 / (k * p.area);
            }
            if let Some(k) = tangential {
                for a in [2 * i, 2 * i + 1] {
                    other.shear[(a, a)] += 1.0 / (k * p.area);
                }
            }
        }
        other
    }

    /// The same bodies with another `gap` (m) of the points as a function of x and y (m): another shape, or the
    /// same shape at another place on the grid.
    pub fn with_gaps(&self, gap: impl Fn(f64, f64) -> f64) -> Self {
        let mut other = self.with_springs(None, None);
        other.points.iter_mut().for_each(|p| p.gap = gap(p.at[0], p.at[1]));
        other
    }

    /// The same contact with a compliance common to all points: every point also moves tangentially by
    /// `compliance` (m/N) times the sum of the tangential forces.
    pub fn with_bulk(&self, compliance: f64) -> Self {
        let mut bulk = self.with_springs(None, None);
        let n = 2 * self.points.len();
        for k in 0..n * n {
            let (i, j) = (k / n, k % n);
            if i % 2 == j % 2 {
                bulk.shear[(i, j)] += compliance;
            }
        }
        bulk
    }

    /// The points of potential contact.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// Normal displacement of point `i` per normal force on point `j` (m/N); indices into [`points`](Self::points).
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn normal(&self, i: usize, j: usize) -> f64 {
        self.normal[(i, j)]
    }

    /// Tangential displacement of point `i` per tangential force on point `j` (m/N), `[tangent of i][tangent of j]`;
    /// indices into [`points`](Self::points).
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn shear(&self, i: usize, j: usize) -> [[f64; 2]; 2] {
        [0, 1].map(|a| [0, 1].map(|b| self.shear[(2 * i + a, 2 * j + b)]))
    }
}

/// In a direction in which a point cannot move (on a plane of symmetry) its row and column of the matrix are zero. A
/// diagonal entry keeps the matrix regular; the force of that direction is then zero.
fn regularise(shear: &mut Mat<f64>) {
    for k in 0..shear.nrows() {
        if shear[(k, k)] == 0.0 {
            shear[(k, k)] = shear[(k ^ 1, k ^ 1)];
        }
    }
}

/// Indices of the nodes of the points in the compliance.
fn compliance_indices(
    compliance: &SurfaceCompliance,
    points: &[Point],
) -> Result<Vec<usize>, InfluenceError> {
    if points.is_empty() {
        return Err(InfluenceError::Empty);
    }
    let slots: BTreeMap<u32, usize> =
        compliance.nodes().iter().enumerate().map(|(i, &n)| (n, i)).collect();
    points
        .iter()
        .map(|p| slots.get(&p.node).copied().ok_or(InfluenceError::Unknown { node: p.node }))
        .collect()
}

/// The projection of a slave node on the master surface.
struct Projection {
    /// Nodes of the face (indices in the master's compliance) and their shape functions.
    weights: [(usize, f64); 4],
    /// t1, t2, n.
    frame: [UnitVector3<f64>; 3],
}

impl Projection {
    fn find(
        point: &Point,
        master: &SurfaceCompliance,
        surface: &Surface,
        mesh: &Mesh,
    ) -> Result<Self, InfluenceError> {
        let n = surface.smooth.as_ref().map_or(Vector3::z_axis(), |s| s.normal(point.at));
        let n = if n.z < 0.0 { -n } else { n };
        let t1 = UnitVector3::new_normalize(tangential(Vector3::x(), n));
        let t2 = UnitVector3::new_unchecked(n.cross(&t1));
        let frame = [t1, t2, n];
        // The projection lies where the normal through the node meets the face: node and projection have the same
        // coordinates along the tangents.
        let along_tangents = |x: Vector3<f64>| [t1.dot(&x), t2.dot(&x)];
        let target = along_tangents(point.at);
        for face in &surface.faces {
            let corners = face.nodes.map(|m| along_tangents(mesh.at(m)));
            let Some(shape) = inside(corners, target) else { continue };
            let mut weights = [(0, 0.0); 4];
            for (k, node) in face.nodes.iter().enumerate() {
                // A projection on an edge of the face does not load the corners off that edge.
                if shape[k].abs() < 1e-9 {
                    continue;
                }
                let Some(slot) = master.nodes().iter().position(|m| m == node) else {
                    return Err(InfluenceError::Unknown { node: *node });
                };
                weights[k] = (slot, shape[k]);
            }
            return Ok(Self { weights, frame });
        }
        let [x, y, _] = point.at.into();
        Err(InfluenceError::NoFace { node: point.node, x, y })
    }
}

/// Shape functions of the bilinear quadrilateral at `target`, if it lies inside; by Newton's method.
fn inside(corners: [[f64; 2]; 4], target: [f64; 2]) -> Option<[f64; 4]> {
    const EDGE: f64 = 1.0 + 1e-7;
    for axis in 0..2 {
        let low = corners.iter().fold(f64::INFINITY, |m, c| m.min(c[axis]));
        let high = corners.iter().fold(f64::NEG_INFINITY, |m, c| m.max(c[axis]));
        let slack = 1e-6 * (high - low);
        if target[axis] < low - slack || target[axis] > high + slack {
            return None;
        }
    }
    const SIGNS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let mut xi = [0.0f64; 2];
    for _ in 0..20 {
        let mut rest = target;
        let mut jacobian = [[0.0; 2]; 2];
        for (c, s) in corners.iter().zip(SIGNS) {
            let (p, q) = (1.0 + s[0] * xi[0], 1.0 + s[1] * xi[1]);
            for i in 0..2 {
                rest[i] -= 0.25 * p * q * c[i];
                jacobian[i][0] += 0.25 * s[0] * q * c[i];
                jacobian[i][1] += 0.25 * s[1] * p * c[i];
            }
        }
        let det = jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0];
        let step = [
            (jacobian[1][1] * rest[0] - jacobian[0][1] * rest[1]) / det,
            (jacobian[0][0] * rest[1] - jacobian[1][0] * rest[0]) / det,
        ];
        xi = [xi[0] + step[0], xi[1] + step[1]];
        if step[0].abs() + step[1].abs() < 1e-13 {
            break;
        }
    }
    let within = xi[0].abs() <= EDGE && xi[1].abs() <= EDGE;
    within.then(|| SIGNS.map(|s| 0.25 * (1.0 + s[0] * xi[0]) * (1.0 + s[1] * xi[1])))
}
