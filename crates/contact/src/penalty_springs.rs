//! The springs of penalty contact as solvers of equilibrium and of frequencies see them: stiffness and its bounds, over
//! the nodes of the mesh.

use crate::face::Positions;
use crate::penalty_point::{PenaltyPoint, scatter};
use crate::point::relative_velocity;
use crate::search::{Listed, neighbours};
use crate::{Gap, PenaltyContact};
use mesh::{Mesh, Padded};

impl PenaltyContact {
    /// `y += K_c x` with the stiffness of the points closed at the last call: for slave
    /// displacement relative to the projection `w`, the spring force `k_n n (n.w) + k_t (w - n (n.w))`.
    ///
    /// # Panics
    /// If a slice has fewer entries than the mesh has nodes.
    pub fn stiffness_product(&self, x: &[Padded], y: &mut [Padded]) {
        for (slave, list) in self.points.iter().enumerate() {
            for point in list.iter().filter(|p| p.is_closed()) {
                let [node, corners @ ..] = self.bearing_in_mesh(slave, point);
                let w = relative_velocity(x, node, corners, &point.enforcement.weights);
                let [normal, tangential] = point.enforcement.stiffness;
                let along = (normal - tangential) * point.normal.dot(&w);
                let on_slave = tangential * w + along * *point.normal;
                scatter(point, node, corners, on_slave, y);
            }
        }
    }

    /// Adds to each contact node an upper bound (N/m) of the contact stiffness acting on it, for
    /// any state of contact near the reference configuration.
    ///
    /// With `phi` the weights of the face's corners, a spring's matrix is bounded by a diagonal
    /// one: `k (x_s - sum phi x)^2 <= 2 k x_s^2 + 2 k sum phi x^2` (convexity; `sum phi = 1`).
    /// A node so bears twice its own spring and `2 sum phi k` of the slaves over its faces, where
    /// `sum phi A_s` is at most `9/8` per direction of the larger of the two tributary areas on
    /// rectangular grids. Hence `K_c <= diag(bound)`, and a mass `bound/4` added to a node makes
    /// contact stable at unit time step.
    pub fn nodal_stiffness_bound(&self, bound: &mut [f64]) {
        for (&node, value) in self.trace.nodes().iter().zip(self.bound.iter().flatten()) {
            bound[node as usize] += value;
        }
    }

    /// The bounds at the nodes of each side (N/m).
    pub(crate) fn stiffness_bounds(&self, mesh: &Mesh) -> [Vec<f64>; 2] {
        const SIZES: f64 = 4.0;
        const CORNERS: [[f64; 4]; 4] = [
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ];
        let nodes = self.trace.nodes().iter();
        let reference: Vec<Padded> = nodes.map(|&n| Padded::from(mesh.at(n))).collect();
        let positions = Positions(&reference);
        // Per node: largest own stiffness, areal stiffness of slaves above, their largest area.
        let mut own = [0, 1].map(|s: usize| vec![0.0_f64; self.sides[s].len()]);
        let mut over = own.clone();
        let mut area = own.clone();
        neighbours(&self.sides, &positions, SIZES, |f, g| {
            for (slave, its, master, face) in [(0, f, 1, g), (1, g, 0, f)] {
                let pass = self.pass(slave);
                let face = &self.sides[master].faces[face];
                for node in self.sides[slave].faces[its].local {
                    let node = node as usize;
                    // the largest over the face is that at a corner
                    let at_corners = CORNERS.iter().map(|it| pass.stiffness(node, face, it));
                    let k = at_corners.flatten().fold(0.0, f64::max);
                    own[slave][node] = own[slave][node].max(k);
                    let slave_area = self.sides[slave].area[node];
                    for corner in face.local {
                        let corner = corner as usize;
                        over[master][corner] = over[master][corner].max(k / slave_area);
                        area[master][corner] = area[master][corner].max(slave_area);
                    }
                }
            }
        });
        [0, 1].map(|side: usize| {
            (0..own[side].len())
                .map(|i| {
                    let covered = 81.0 / 64.0 * area[side][i].max(self.sides[side].area[i]);
                    2.0 * own[side][i] + 2.0 * over[side][i] * covered
                })
                .collect()
        })
    }

    /// The normal springs of both passes that were closed at the last call, each with its
    /// stiffness (N/m), in a fixed order.
    pub fn springs(&self) -> impl Iterator<Item = (Gap, f64)> + '_ {
        (0..2).flat_map(move |slave: usize| {
            let closed = self.points[slave].iter().filter(|p| p.is_closed());
            closed.map(move |point| (self.spring(slave, point), point.enforcement.stiffness[0]))
        })
    }

    fn spring(&self, slave: usize, point: &PenaltyPoint) -> Gap {
        let [node, corners @ ..] = self.bearing_in_mesh(slave, point);
        Gap {
            node,
            projection: corners.into_iter().zip(point.enforcement.weights).collect(),
            normal: point.normal,
            gap: point.gap,
            area: self.sides[slave].area[point.slave as usize],
            nodes: 1 + usize::from(self.sides[slave].has_image(point.slave as usize)),
        }
    }

    fn bearing_in_mesh(&self, slave: usize, point: &PenaltyPoint) -> [u32; 5] {
        self.bearing(slave, point).map(|node| self.trace.in_mesh(node))
    }

    /// Upper bound (1/s^2) of the largest eigenvalue of `M^-1 K_c` with the points closed at the
    /// last call, from the diagonal bound of
    /// [`nodal_stiffness_bound`](Self::nodal_stiffness_bound) with the actual weights.
    ///
    /// # Panics
    /// If `inverse_mass` has fewer entries than the mesh has nodes.
    pub fn rigorous_omega_squared(&self, inverse_mass: &[f64]) -> f64 {
        let mut diagonal = [0, 1].map(|s: usize| vec![0.0; self.sides[s].len()]);
        for (slave, list) in self.points.iter().enumerate() {
            for point in list.iter().filter(|p| p.is_closed()) {
                let twice =
                    2.0 * point.enforcement.stiffness[0].max(point.enforcement.stiffness[1]);
                diagonal[slave][point.slave as usize] += twice;
                let corners = self.sides[1 - slave].faces[point.face as usize].local;
                for (weight, corner) in point.enforcement.weights.iter().zip(corners) {
                    diagonal[1 - slave][corner as usize] += twice * weight;
                }
            }
        }
        let nodes = self.trace.nodes().iter().zip(diagonal.iter().flatten());
        nodes.fold(0.0, |largest, (&node, d)| largest.max(d * inverse_mass[node as usize]))
    }
}
