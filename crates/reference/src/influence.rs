//! Relative displacement of two surfaces per force between them: W = G K^-1 G^T.

use crate::SurfaceCompliance;
use faer::Mat;
use mesh::{Mesh, Surface};
use std::collections::BTreeMap;
use thiserror::Error;

/// A point of potential contact: a node of the slave surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Its node (mesh index).
    pub node: u32,
    /// Its reference position (m).
    pub at: [f64; 3],
    /// The area whose traction it stands for (m^2).
    pub area: f64,
    /// Distance of the undeformed surfaces along the normal (m).
    pub gap: f64,
}

impl Point {
    /// The nodes of `surface` that lie `within` the potential contact, by node, with `gap` of
    /// their position; areas are those of the whole surface, so that a point inside it has its
    /// full share whatever the choice.
    pub fn on_surface(
        mesh: &Mesh,
        surface: &Surface,
        within: impl Fn([f64; 3]) -> bool,
        gap: impl Fn([f64; 3]) -> f64,
    ) -> Vec<Self> {
        let mut areas = BTreeMap::new();
        for face in &surface.faces {
            let shares = mesh::quad_corner_areas(&face.nodes.map(|n| mesh.nodes[n as usize]));
            for (node, share) in face.nodes.iter().zip(shares) {
                *areas.entry(*node).or_insert(0.0) += share;
            }
        }
        let point = |(node, area): (u32, f64)| {
            let at = mesh.nodes[node as usize];
            within(at).then(|| Self { node, at, area, gap: gap(at) })
        };
        areas.into_iter().filter_map(point).collect()
    }
}

/// Why an influence matrix cannot be set up.
#[derive(Debug, Error, PartialEq)]
pub enum InfluenceError {
    /// A point's node is not one of the compliance.
    #[error("node {node} is a contact point, but the compliance does not hold it")]
    Unknown {
        /// The node.
        node: u32,
    },
    /// A slave node has no master face before it.
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
    /// There is no point at all.
    #[error("the potential contact area holds no node")]
    Empty,
}

/// Potential contact points with the relative displacement that forces between them cause.
///
/// Relative means slave minus master; a force acts on the slave, its opposite on the master. The
/// normal n points from the master to the slave; tangents are t1, nearest to x, and
/// t2 = n x t1, so that for n = z they are x and y.
pub struct Influence {
    pub(crate) points: Vec<Point>,
    /// Component of the normal along z: a rigid approach by d along -z closes the gap by d times
    /// this.
    pub(crate) closing: Vec<f64>,
    /// Normal displacement per normal force (m/N), n x n.
    pub(crate) normal: Mat<f64>,
    /// Tangential displacement per tangential force (m/N), 2n x 2n, by point, then t1, t2.
    pub(crate) shear: Mat<f64>,
    /// Tangential displacement per normal force (m/N), 2n x n; `None` where it vanishes.
    pub(crate) coupling: Option<Mat<f64>>,
}

impl Influence {
    /// A body pressed on its own mirror image in a plane z = constant: the normal is z.
    ///
    /// The image has the compliance R F R with R = diag(1, 1, -1), hence W = F + R F R: twice the
    /// body's own within the normal and within the tangential directions, and no coupling between
    /// them. This is exact for two bodies of equal material and equal shape, the half-spaces of
    /// Hertz and Carter among them; the curvature enters by `gap` alone.
    ///
    /// # Errors
    /// [`InfluenceError::Unknown`], [`InfluenceError::Empty`].
    pub fn mirrored(
        compliance: &SurfaceCompliance,
        points: Vec<Point>,
    ) -> Result<Self, InfluenceError> {
        let at = places(compliance, &points)?;
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

    /// The slave nodes `points` against the faces of a master surface: `master` holds the nodes of
    /// the faces under the points, `surface` the faces and `mesh` their coordinates.
    ///
    /// Kinematics are those of the reference configuration: the projection of a node on its face and
    /// the normal stay. The normal is that of the exact master surface where there is one.
    ///
    /// # Errors
    /// [`InfluenceError`].
    pub fn between(
        slave: &SurfaceCompliance,
        points: Vec<Point>,
        master: &SurfaceCompliance,
        surface: &Surface,
        mesh: &Mesh,
    ) -> Result<Self, InfluenceError> {
        let at = places(slave, &points)?;
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

    /// The same contact through penalty springs of the given areal stiffness (N/m^3), normal and
    /// tangential; `None` leaves a direction as it is.
    ///
    /// A spring k A in series with the bodies adds 1/(k A) to its point's own displacement: the
    /// bias of a penalty method against exact enforcement, without its dynamics.
    pub fn with_springs(&self, normal: Option<f64>, tangential: Option<f64>) -> Self {
        let mut sprung = Self {
            points: self.points.clone(),
            closing: self.closing.clone(),
            normal: self.normal.clone(),
            shear: self.shear.clone(),
            coupling: self.coupling.clone(),
        };
        for (i, p) in self.points.iter().enumerate() {
            if let Some(k) = normal {
                sprung.normal[(i, i)] += 1.0 / (k * p.area);
            }
            if let Some(k) = tangential {
                for a in [2 * i, 2 * i + 1] {
                    sprung.shear[(a, a)] += 1.0 / (k * p.area);
                }
            }
        }
        sprung
    }

    /// The same bodies with other gaps (m), those of the points at x and y: another shape, or the
    /// same shape elsewhere on the grid.
    pub fn with_gaps(&self, gap: impl Fn(f64, f64) -> f64) -> Self {
        let mut other = self.with_springs(None, None);
        other.points.iter_mut().for_each(|p| p.gap = gap(p.at[0], p.at[1]));
        other
    }

    /// The same contact of bodies that yield as a whole besides: every point moves tangentially by
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

    /// Normal displacement of point `i` per normal force on point `j` (m/N).
    pub fn normal(&self, i: usize, j: usize) -> f64 {
        self.normal[(i, j)]
    }

    /// Tangential displacement of point `i` per tangential force on point `j` (m/N).
    pub fn shear(&self, i: usize, j: usize) -> [[f64; 2]; 2] {
        [0, 1].map(|a| [0, 1].map(|b| self.shear[(2 * i + a, 2 * j + b)]))
    }
}

/// A direction in which a point cannot move (on a plane of symmetry) takes no force: a compliance
/// of its own, coupled to nothing, keeps the matrix regular and that force zero.
fn regularise(shear: &mut Mat<f64>) {
    for k in 0..shear.nrows() {
        if shear[(k, k)] == 0.0 {
            shear[(k, k)] = shear[(k ^ 1, k ^ 1)];
        }
    }
}

/// Where the nodes of the points stand in the compliance.
fn places(compliance: &SurfaceCompliance, points: &[Point]) -> Result<Vec<usize>, InfluenceError> {
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

/// Where a slave node meets the master surface.
struct Projection {
    /// Nodes of the face (places in the master's compliance) and their shape functions.
    weights: [(usize, f64); 4],
    /// t1, t2, n.
    frame: [[f64; 3]; 3],
}

impl Projection {
    fn find(
        point: &Point,
        master: &SurfaceCompliance,
        surface: &Surface,
        mesh: &Mesh,
    ) -> Result<Self, InfluenceError> {
        let n = surface.smooth.map_or([0.0, 0.0, 1.0], |s| s.normal(point.at));
        let n = if n[2] < 0.0 { n.map(|c| -c) } else { n };
        let t1 = unit([1.0 - n[0] * n[0], -n[0] * n[1], -n[0] * n[2]]);
        let t2 =
            [n[1] * t1[2] - n[2] * t1[1], n[2] * t1[0] - n[0] * t1[2], n[0] * t1[1] - n[1] * t1[0]];
        let frame = [t1, t2, n];
        // The projection lies where the normal through the node meets the face: in the plane of the
        // tangents both have the same coordinates.
        let place = |x: [f64; 3]| [dot(t1, x), dot(t2, x)];
        let target = place(point.at);
        for face in &surface.faces {
            let corners = face.nodes.map(|m| place(mesh.nodes[m as usize]));
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
        let [x, y, _] = point.at;
        Err(InfluenceError::NoFace { node: point.node, x, y })
    }
}

/// Shape functions of the bilinear quadrilateral at `target`, if it lies inside.
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

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|c| c / length)
}
