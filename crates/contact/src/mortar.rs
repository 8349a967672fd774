//! Dual mortar rows: the gap of a slave node is the mean over the slave faces around it, weighted with a
//! function that meets no other slave node.
//!
//! On every slave face the dual functions are `psi_a = sum_b q_ab N_b` with `q = D M^-1`,
//! `M_ab = int N_a N_b`, `D_a = int N_a`: then `int psi_a N_b = D_a delta_ab` (Wohlmuth 2000). For the node
//! `i`, with the sums over the faces around it,
//!
//! - `A_i = sum int psi_i = sum int N_i`, its tributary area;
//! - `w_J = (1/A_i) sum int psi_i N_J`, the weights of the master's nodes; they add up to one;
//! - `g_i = (1/A_i) sum int psi_i g`, the gap.
//!
//! Since the `psi_i` add up to one on a face, a uniform pressure `p` on the slaves, `r_i = p A_i`, reaches the
//! master as `sum_i w_J r_i = p int N_J`, what a uniform pressure on its own faces would be: the patch test of
//! the interface.
//!
//! The integrals are taken over segments, the parts that slave and master faces have in common in the
//! plane of the slave face (Puso and Laursen 2004; module `segment`). The gap at a point is that of node to
//! face: from the exact surface of the slave, where it has one, to that of the master (module `face`).
//!
//! # Between integrations
//! A constraint keeps its weights, their gradients `(1/A_i) sum int psi_i grad N_J` and the distance of the surfaces from
//! their facets, and follows the nodes: `g = n . (x_i - sum w_J x_J) - c`, with a normal `n` that turns with the
//! master. Weights move with the slave to first order (module `constraint`). Integrals are taken anew once the slave has
//! moved along the master, or turned or stretched on it, by [`STALE`] of the smaller face; what this leaves out is of
//! second order in it. In rolling, where contact sticks or creeps, that is rare.
//!
//! # Borders
//! On a slave face that lies partly beside the master, `psi_a` is `N_a` over the part in common, and the
//! gradients move the weights on to the node. A node that has lost more than [`LOST`] of its area is open.

use crate::constraint::{MasterPoint, Share, face_shares, within};
use crate::face::{FaceGeometry, Inclination, Positions, Projection, project, shape};
use crate::segment::{Polygon, coordinates};
use crate::snapshot::StateError;
use crate::surface::{ContactSurface, NONE};
use crate::symmetry::direction_in_plane;
use mesh::geometry::{direction, frame, tangential};
use nalgebra::{Matrix3x2, Matrix4, UnitVector3, Vector2, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// Motion along the master, over the size of the smaller face, after which integrals are taken anew.
const STALE: f64 = 0.01;
/// Part of a slave face that must lie on the master for dual functions.
const WHOLE: f64 = 0.99;
/// Part of its area that a node may have lost over the border of the master.
const LOST: f64 = 0.75;
/// Segments below this part of the slave face are round-off.
const SLIVER: f64 = 1e-12;

/// Nodes of the master that a constraint meets where pitches are alike; room for more is made when needed.
const NODES: usize = 16;

/// What the integrals over the faces around a slave node gave, and the constraint follows.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Mean {
    /// Empty before the first integration.
    pub shares: Vec<Share>,
    /// Of the master's normal to the tangents of the shares.
    inclination: Inclination,
    /// Distance of the surfaces from their facets (m).
    beyond: f64,
    /// The far corner of a slave face (a node of the trace), and where it was in the frame of the master (m).
    far: u32,
    seen: Vector2<f64>,
    /// Motion along the master (m) after which integrals are taken anew.
    reach: f64,
}

/// A mean in the present configuration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeanKinematics {
    pub master_point: MasterPoint,
    pub normal: UnitVector3<f64>,
    pub gap: f64,
    /// How far the slave has moved along the master since the integration, over what is allowed.
    pub stale: f64,
}

impl Mean {
    /// Is integrated anew when it is needed next.
    pub fn forget(&mut self) {
        self.shares.clear();
    }

    /// Follows the nodes of the mean; the slave is at `x`.
    pub fn kinematics(
        &self,
        master: &ContactSurface,
        positions: &Positions<'_>,
        x: Vector3<f64>,
    ) -> MeanKinematics {
        let master_point = MasterPoint::under(x, &self.shares, master, positions);
        let normal = self.turned(&master_point);
        let to_node = x - master_point.x;
        let distance = normal.dot(&to_node);
        let moved = tangential(to_node, normal).norm();
        let turned = seen(&master_point, normal, positions.at(self.far) - x) - self.seen;
        let stale = (moved + libm::hypot(turned.x, turned.y)) / self.reach;
        MeanKinematics { master_point, normal, gap: distance - self.beyond, stale }
    }

    /// The normal, turned with the tangents: as the exact surface's over a facet in `FaceGeometry`.
    fn turned(&self, master_point: &MasterPoint) -> UnitVector3<f64> {
        let n_f = direction(master_point.facet());
        let duals = master_point.duals(n_f);
        let Inclination { nu, along } = self.inclination;
        direction(nu * *n_f + along.x * duals.column(0) + along.y * duals.column(1))
    }
}

fn seen(master_point: &MasterPoint, normal: UnitVector3<f64>, far: Vector3<f64>) -> Vector2<f64> {
    master_point.frame(normal, false).tr_mul(&far)
}

/// A point of integration on a slave face.
#[derive(Clone, Copy, Debug)]
struct Sample {
    /// Shape functions of the slave face.
    shape: Vector4<f64>,
    /// (m^2)
    weight: f64,
    projection: Projection,
}

/// Integration of the rows of one pass.
#[derive(Clone, Debug)]
pub(crate) struct Mortar {
    curvature: bool,
    /// Points of the slave face at hand.
    samples: Vec<Sample>,
    /// Master faces met from the slave face at hand.
    met: Vec<u32>,
}

/// A slave face in its plane.
struct Plane {
    centre: Vector3<f64>,
    outward: UnitVector3<f64>,
    frame: Matrix3x2<f64>,
    corners: [Vector2<f64>; 4],
}

impl Plane {
    fn new(surface: &ContactSurface, face: u32, positions: &Positions<'_>) -> Self {
        let x = surface.faces[face as usize].nodes.map(|n| positions.at(n));
        let centre = 0.25 * x.iter().sum::<Vector3<f64>>();
        let outward = direction((x[2] - x[0]).cross(&(x[3] - x[1])));
        let frame = frame(x[1] - x[0], outward);
        let corners = x.map(|x| frame.tr_mul(&(x - centre)));
        Self { centre, outward, frame, corners }
    }

    /// A point along the normal into the plane.
    fn put(&self, x: Vector3<f64>) -> Vector2<f64> {
        self.frame.tr_mul(&(x - self.centre))
    }
}

impl Mortar {
    pub fn new(curvature: bool) -> Self {
        Self { curvature, samples: Vec::new(), met: Vec::new() }
    }

    /// Room of the lists that an integration fills.
    #[cfg(test)]
    pub fn room(&self) -> usize {
        self.samples.capacity() + self.met.capacity()
    }

    /// Integrates over the faces around the slave node `slave` into `mean`; `sides` are those of slaves and
    /// masters, and the master lies near its face `near`. Returns the face under the node and whether the
    /// node lies on the master; where not, `mean` is empty.
    pub fn integrate(
        &mut self,
        sides: [&ContactSurface; 2],
        positions: &Positions<'_>,
        slave: u32,
        near: u32,
        mean: &mut Mean,
    ) -> (u32, bool) {
        let [own, master] = sides;
        mean.shares.clear();
        mean.shares.reserve(NODES);
        let node = own.node(slave);
        let x = positions.at(node);
        let projection = project(master, positions, self.curvature, x, near, 0.0, 0.0).projection;
        let near = projection.map_or(near, |projection| projection.face);

        // two directions for the gradients, whichever
        let faces = own.around(slave).iter().map(|corner| Plane::new(own, corner.face, positions));
        let inward = faces.fold(Vector3::zeros(), |sum, face| sum - *face.outward);
        let on_plane = own.is_on_plane(x);
        let unit = |a| if on_plane { direction_in_plane(a) } else { direction(a) };
        let n = unit(inward);
        let directions = frame(if n.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() }, n);

        let (mut area, mut normal, mut gap) = (0.0, Vector3::zeros(), 0.0);
        for corner in own.around(slave) {
            let whole = self.sample(sides, positions, corner.face, near);
            let q = dual(&self.samples, usize::from(corner.number), whole);
            for sample in &self.samples {
                let psi: f64 = q.iter().zip(&sample.shape).map(|(q, n)| q * n).sum();
                let psi = psi * sample.weight;
                area += psi;
                normal += psi * *sample.projection.point.normal;
                gap += psi * sample.projection.gap;
                gather(&mut mean.shares, &sample.projection, master, positions, &directions, psi);
            }
        }
        // what is no number is not on the master
        let on_master = area > (1.0 - LOST) * own.area[slave as usize];
        if !on_master {
            mean.shares.clear();
            return (near, false);
        }
        for share in &mut mean.shares {
            share.weight /= area;
            share.gradient /= area;
        }
        self.complete(mean, sides, positions, slave, unit(normal), gap / area);
        mean.reach = STALE * f64::min(area.sqrt(), master.faces[near as usize].size);
        (near, true)
    }

    /// Moves the weights under the node and keeps what the constraint follows.
    fn complete(
        &self,
        mean: &mut Mean,
        [own, master]: [&ContactSurface; 2],
        positions: &Positions<'_>,
        slave: u32,
        n: UnitVector3<f64>,
        gap: f64,
    ) {
        let x = positions.at(own.node(slave));
        let master_point = MasterPoint::under(x, &mean.shares, master, positions);
        let beside = master_point.duals(n).tr_mul(&(x - master_point.x));
        for share in &mut mean.shares {
            share.weight += share.gradient.dot(&beside);
        }
        let master_point = MasterPoint::under(x, &mean.shares, master, positions);
        mean.beyond = n.dot(&(x - master_point.x)) - gap;
        let facet = master_point.facet();
        let along = master_point.tangents.tr_mul(&n);
        mean.inclination = Inclination { nu: n.dot(&facet) / facet.norm(), along };
        mean.far = Self::far(own, slave);
        mean.seen = seen(&master_point, n, positions.at(mean.far) - x);
    }

    /// The corner of a face around a slave node that lies across from it, a node of the trace.
    fn far(own: &ContactSurface, slave: u32) -> u32 {
        let corner = &own.around(slave)[0];
        own.faces[corner.face as usize].nodes[(usize::from(corner.number) + 2) % 4]
    }

    /// That `means` are of the slaves and masters of these sides.
    pub fn check_means(
        &self,
        means: &[Mean],
        [own, master]: [&ContactSurface; 2],
    ) -> Result<(), StateError> {
        let known = |(slave, mean): (usize, &Mean)| {
            mean.shares.is_empty()
                || mean.far == Self::far(own, slave as u32)
                    && mean.shares.iter().all(|share| (share.node as usize) < master.len())
        };
        let fits = means.len() == own.len() && means.iter().enumerate().all(known);
        if fits { Ok(()) } else { Err(StateError::Range { name: "means" }) }
    }

    /// Points of integration on the slave face over the master. Returns whether all of it lies there.
    fn sample(
        &mut self,
        [own, master]: [&ContactSurface; 2],
        positions: &Positions<'_>,
        face: u32,
        near: u32,
    ) -> bool {
        let plane = Plane::new(own, face, positions);
        let geometry = FaceGeometry::new(own, face, positions, self.curvature);
        let whole = Polygon::quad(plane.corners).area();
        self.samples.clear();
        self.met.clear();
        self.met.push(self.first(own, master, positions, face, near));
        let mut covered = 0.0;
        let mut next = 0;
        while let Some(&other) = self.met.get(next) {
            let x = master.faces[other as usize].nodes.map(|n| plane.put(positions.at(n)));
            // seen from the slave, the master runs the other way round
            let segment = Polygon::quad([x[3], x[2], x[1], x[0]]).clipped(&plane.corners);
            let meets = segment.area() > SLIVER * whole;
            if meets {
                let (samples, curvature) = (&mut self.samples, self.curvature);
                segment.integrate(|p, weight| {
                    let xi = coordinates(&plane.corners, p);
                    let at = geometry.at(xi.x, xi.y);
                    let exact = at.x + at.offset * *at.normal;
                    let start = coordinates(&x, p);
                    let faces = |to: &Projection| to.point.normal.dot(&plane.outward) < 0.0;
                    let projection =
                        project(master, positions, curvature, exact, other, start.x, start.y);
                    if let Some(projection) = projection.projection.filter(faces) {
                        covered += weight;
                        let shape = shape(xi.x, xi.y).into();
                        samples.push(Sample { shape, weight, projection });
                    }
                });
            }
            if meets || next == 0 {
                for (neighbour, _) in master.faces[other as usize].neighbours {
                    if neighbour != NONE && !self.met.contains(&neighbour) {
                        self.met.push(neighbour);
                    }
                }
            }
            next += 1;
        }
        covered >= WHOLE * whole
    }

    /// A master face under the slave face, or else `near`.
    fn first(
        &self,
        own: &ContactSurface,
        master: &ContactSurface,
        positions: &Positions<'_>,
        face: u32,
        near: u32,
    ) -> u32 {
        let corners = own.faces[face as usize].nodes.map(|n| positions.at(n));
        let centre = 0.25 * corners.iter().sum::<Vector3<f64>>();
        [centre]
            .into_iter()
            .chain(corners)
            .find_map(|x| project(master, positions, self.curvature, x, near, 0.0, 0.0).projection)
            .map_or(near, |projection| projection.face)
    }
}

/// Coefficients `q_b` of the function `psi = sum q_b N_b` of a corner: dual on a `whole` face, else `N`.
fn dual(samples: &[Sample], corner: usize, whole: bool) -> Vector4<f64> {
    let mut q = Vector4::zeros();
    if !whole {
        q[corner] = 1.0;
        return q;
    }
    let mut m = Matrix4::zeros();
    for s in samples {
        q[corner] += s.weight * s.shape[corner];
        m += s.weight * s.shape * s.shape.transpose();
    }
    // M q = D e_corner; M is positive definite
    for i in 0..4 {
        for j in i + 1..4 {
            let factor = m[(j, i)] / m[(i, i)];
            for k in i..4 {
                m[(j, k)] -= factor * m[(i, k)];
            }
            q[j] -= factor * q[i];
        }
    }
    for i in (0..4).rev() {
        for k in i + 1..4 {
            q[i] -= m[(i, k)] * q[k];
        }
        q[i] /= m[(i, i)];
    }
    q
}

/// Adds `psi` times the shape functions at a projection, and their gradients along two directions.
fn gather(
    shares: &mut Vec<Share>,
    projection: &Projection,
    master: &ContactSurface,
    positions: &Positions<'_>,
    directions: &Matrix3x2<f64>,
    psi: f64,
) {
    let [xi, eta] = within(projection);
    let corners = face_shares(&master.faces[projection.face as usize], xi, eta);
    let duals = MasterPoint::new(&corners, master, positions).duals(projection.point.normal);
    let along = directions.tr_mul(&duals);
    for corner in corners {
        let gradient = psi * (along * corner.gradient);
        let weight = psi * corner.weight;
        match shares.iter_mut().find(|share| share.node == corner.node) {
            Some(share) => {
                share.weight += weight;
                share.gradient += gradient;
            }
            None => shares.push(Share { node: corner.node, weight, gradient }),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::Trace;
    use crate::tests::plates::{STEEL, plate, together, tread};
    use mesh::{Mesh, Padded, Surface};
    use nalgebra::Rotation3;

    struct Rig {
        trace: Trace,
        sides: [ContactSurface; 2],
        reference: Vec<Padded>,
        displacement: Vec<Padded>,
        upper: usize,
    }

    impl Rig {
        /// Slaves above masters.
        fn new(upper: (Mesh, Surface), lower: (Mesh, Surface)) -> Self {
            let count = upper.0.nodes.len();
            let (mesh, second) = together(upper.0, lower.0, lower.1);
            let reference: Vec<Padded> = mesh.nodes.iter().copied().map(Padded::from).collect();
            let surfaces = [(&upper.1, STEEL), (&second, STEEL)];
            let (trace, sides) = ContactSurface::both(&mesh, surfaces).unwrap();
            Self {
                trace,
                sides,
                displacement: vec![Padded::ZERO; reference.len()],
                reference,
                upper: count,
            }
        }

        /// Plates of 8 mm with 5 cells on 4 an edge.
        fn plates() -> Self {
            Self::turned(0.0, 1.0, 4)
        }

        /// 5 cells on 8 mm, on a master turned by `angle`, larger by `factor` and with `cells` an edge.
        fn turned(angle: f64, factor: f64, cells: usize) -> Self {
            let low = [4e-3 - 4e-3 * factor; 2];
            let high = [4e-3 + 4e-3 * factor; 2];
            let mut rig = Self::new(
                plate([0.0, 0.0], [8e-3, 8e-3], [5, 5], 0.0, 1e-3, false),
                plate(low, high, [cells; 2], 0.0, 1e-3, true),
            );
            let (sin, cos) = libm::sincos(angle);
            for x in &mut rig.reference[rig.upper..] {
                let [a, b, z] = x.xyz();
                let (a, b) = (a - 4e-3, b - 4e-3);
                *x = Padded::new([4e-3 + cos * a - sin * b, 4e-3 + sin * a + cos * b, z]);
            }
            rig
        }

        fn positions(&self) -> Vec<Padded> {
            self.trace.positions(&self.reference, &self.displacement)
        }

        /// The position of a slave (m).
        fn slave(&self, slave: usize) -> Vector3<f64> {
            let node = self.trace.side(0)[slave] as usize;
            self.reference[node].vector() + self.displacement[node].vector()
        }

        /// Moves a body by `to(x)`.
        fn put(&mut self, body: usize, to: impl Fn(Vector3<f64>) -> Vector3<f64>) {
            let range = if body == 0 { 0..self.upper } else { self.upper..self.reference.len() };
            for i in range {
                let x = self.reference[i].vector();
                self.displacement[i] = (to(x) - x).into();
            }
        }

        fn means(&self, curvature: bool) -> Vec<Option<Mean>> {
            let sides = [&self.sides[0], &self.sides[1]];
            let mut mortar = Mortar::new(curvature);
            let middle = sides[1].faces.len() as u32 / 2;
            let positions = self.positions();
            let positions = Positions(&positions);
            let integrate = |slave| {
                let mut mean = Mean::default();
                let (_, on) = mortar.integrate(sides, &positions, slave, middle, &mut mean);
                on.then_some(mean)
            };
            (0..sides[0].len() as u32).map(integrate).collect()
        }

        fn kinematics(&self, slave: usize, mean: &Mean) -> MeanKinematics {
            mean.kinematics(&self.sides[1], &Positions(&self.positions()), self.slave(slave))
        }
    }

    #[test]
    fn a_uniform_pressure_reaches_the_nodes_of_a_mesh_that_does_not_match_as_one() {
        let received = |rig: &Rig| {
            let mut received = vec![0.0; rig.sides[1].len()];
            for (mean, area) in rig.means(false).into_iter().zip(&rig.sides[0].area) {
                for share in mean.unwrap().shares {
                    received[share.node as usize] += area * share.weight;
                }
            }
            received
        };
        let rig = Rig::plates();
        for (r, area) in received(&rig).iter().zip(&rig.sides[1].area) {
            assert!((r / area - 1.0).abs() < 1e-12, "{r:e} {area:e}");
        }
        // a master turned and larger: nodes of faces that lie wholly under the slaves
        let rig = Rig::turned(0.3, 1.6, 7);
        let under = |face: &crate::surface::MasterFace| {
            let corners = face.nodes.map(|n| rig.trace.in_mesh(n));
            let mut corners = corners.iter().map(|&n| rig.reference[n as usize]);
            corners.all(|x| (0..2).all(|i| x[i] > 0.0 && x[i] < 8e-3))
        };
        let found = received(&rig);
        assert!((found.iter().sum::<f64>() / 64e-6 - 1.0).abs() < 1e-12);
        let mut whole = 0;
        for (node, r) in found.iter().enumerate() {
            let faces = rig.sides[1].faces.iter();
            let around: Vec<_> = faces.filter(|f| f.local.contains(&(node as u32))).collect();
            if around.len() == 4 && around.into_iter().all(under) {
                assert!((r / rig.sides[1].area[node] - 1.0).abs() < 1e-12, "{r:e}");
                whole += 1;
            }
        }
        assert!(whole >= 4, "{whole}");
    }

    #[test]
    fn the_projection_lies_under_the_node_and_weights_add_up_to_one() {
        let mut rig = Rig::new(
            tread(0.5, 8e-3, 8e-3, [7, 5], 1e-3),
            plate([-9e-3, -6e-3], [9e-3, 6e-3], [8, 6], 0.0, 1e-3, true),
        );
        rig.put(0, |x| x + Vector3::new(3e-4, -2e-4, -5e-6));
        for (slave, mean) in rig.means(true).into_iter().enumerate() {
            let mean = mean.unwrap();
            let sum: f64 = mean.shares.iter().map(|s| s.weight).sum();
            assert!((sum - 1.0).abs() < 1e-13, "{sum}");
            let x = rig.slave(slave);
            let kinematics = rig.kinematics(slave, &mean);
            let beside = tangential(x - kinematics.master_point.x, kinematics.normal);
            assert!(beside.norm() < 1e-15, "{beside:?}");
            assert!(kinematics.stale < 1e-9, "{}", kinematics.stale);
        }
    }

    #[test]
    fn on_a_flat_the_gap_of_a_tread_is_its_height_less_that_of_a_mean_parabola() {
        // int psi s^2/(2R) over both cells of a node, less s^2/(2R) there, is -h^2/(12 R)
        let (radius, h) = (0.5, 1e-3);
        let rig = Rig::new(
            tread(radius, 4e-3 / radius, 8e-3, [8, 8], 1e-3),
            plate([-9e-3, -6e-3], [9e-3, 6e-3], [18, 12], 0.0, 1e-3, true),
        );
        for (slave, mean) in rig.means(true).into_iter().enumerate() {
            let x = rig.slave(slave);
            if x[0].abs() > 3.5e-3 || (x[1].abs() - 4e-3).abs() < 1e-9 {
                continue;
            }
            let gap = rig.kinematics(slave, &mean.unwrap()).gap;
            let expected = x[2] - h * h / (12.0 * radius);
            assert!(
                (gap - expected).abs() < 2e-4 * h * h / (12.0 * radius),
                "{gap:e} {expected:e}"
            );
        }
    }

    #[test]
    fn a_rotation_common_to_both_bodies_changes_neither_gap_nor_age() {
        let mut rig = Rig::turned(0.3, 1.6, 7);
        rig.put(0, |x| x + 1e-5 * Vector3::z());
        let means = rig.means(false);
        let slaves: Vec<usize> = (0..means.len()).step_by(5).collect();
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), 0.7);
        rig.put(1, |x| turn * x);
        rig.put(0, |x| turn * (x + 1e-5 * Vector3::z()));
        for slave in slaves {
            let kinematics = rig.kinematics(slave, means[slave].as_ref().unwrap());
            assert!((kinematics.gap - 1e-5).abs() < 1e-16, "{:e}", kinematics.gap);
            assert!(
                kinematics.stale < 1e-9
                    && (*kinematics.normal - turn * Vector3::z()).norm() < 1e-14
            );
        }
    }

    #[test]
    fn weights_age_with_motion_along_the_master_and_with_turning_on_it() {
        let mut rig = Rig::turned(0.3, 1.6, 7);
        let means = rig.means(false);
        let slave = 2 * 6 + 2;
        let mean = means[slave].as_ref().unwrap();
        let stale = |rig: &Rig| rig.kinematics(slave, mean).stale;
        // the smaller face is that of the slaves, 1.6 mm
        rig.put(0, |x| x + 0.9 * STALE * 1.6e-3 * Vector3::x());
        assert!((stale(&rig) - 0.9).abs() < 1e-6, "{}", stale(&rig));
        let centre = rig.reference[rig.trace.side(0)[slave] as usize].vector();
        rig.put(0, |x| x + 0.02 * Vector3::z().cross(&(x - centre)));
        assert!(stale(&rig) > 2.0, "{}", stale(&rig));
        // away from the master is no motion along it
        rig.put(0, |x| x + 1e-4 * Vector3::z());
        assert!(stale(&rig) < 1e-9);
    }

    #[test]
    fn what_weights_moved_to_first_order_leave_out_is_of_second_order() {
        let mut rig = Rig::turned(0.3, 1.6, 7);
        let slave = 2 * 6 + 2;
        let old = rig.means(false)[slave].clone().unwrap();
        let mut differ = |shift: f64| {
            rig.put(0, |x| x + shift * Vector3::x());
            let new = rig.means(false)[slave].clone().unwrap();
            let mut constraint = crate::search::Listed::near(slave as u32, 0);
            let x = rig.slave(slave);
            let kinematics = rig.kinematics(slave, &old);
            let mut master_nodes = Vec::new();
            crate::constraint::Constraint::set_up(
                &mut constraint,
                &old.shares,
                &kinematics.master_point,
                kinematics.normal,
                x,
                false,
                &mut master_nodes,
            );
            let weight =
                |node| new.shares.iter().find(|s| s.node == node).map_or(0.0, |s| s.weight);
            master_nodes.iter().map(|l| (l.weight - weight(l.node)).abs()).fold(0.0, f64::max)
        };
        let [small, large] = [0.005, 0.01].map(|s| differ(s * 1.6e-3));
        assert!(large < 2e-4, "{large:e}");
        assert!((large / small - 4.0).abs() < 0.4, "{large:e} {small:e}");
    }

    #[test]
    fn nodes_over_the_border_are_open_once_most_of_their_area_is_beside_the_master() {
        let mut rig = Rig::plates();
        rig.put(0, |x| x + 0.6e-3 * Vector3::x());
        let last = |rig: &Rig| rig.means(false)[2 * 6 + 5].clone();
        let mean = last(&rig).unwrap();
        let sum: f64 = mean.shares.iter().map(|s| s.weight).sum();
        assert!((sum - 1.0).abs() < 1e-13);
        rig.put(0, |x| x + 1.2e-3 * Vector3::x());
        assert!(last(&rig).is_none());
        rig.put(0, |x| x + 20e-3 * Vector3::x());
        assert!(rig.means(false).iter().all(Option::is_none));
        rig.put(0, |x| x + f64::NAN * Vector3::x());
        assert!(rig.means(false).iter().all(Option::is_none));
    }
}
