//! A slave node and its projection as three rows of constraints: the normal one and two tangential ones.
//!
//! The rows give the rate at which the gap opens, `n . w`, and the slip velocity, and their transpose
//! the forces. The projection is a weighted mean `sum w_J x_J` of nodes of the master: of the corners of one
//! face by their shape functions, or of all nodes that a dual mortar function meets (module `mortar`).
//! The slip velocity is measured against the point of the master that the node touches, carried along
//! with the master at the distance `d = n . (x_s - sum w_J x_J)` of the exact surface beyond the facet:
//!
//! `s = P (v_s - sum w_J v_J - d n')`, `n' = -sum b_J (n . v_J)`, `P = I - n n`,
//!
//! with `b_J` the surface gradients of the weights. The weights are moved by these gradients until the
//! projection lies under the node, `x_s - sum w_J x_J = d n`. A rotation common to both bodies then gives neither
//! opening nor slip; and since the transposed rows are the forces, the forces on slave and master have no
//! resultant moment.

use crate::face::{Positions, Projection, shape, shape_gradients};
use crate::point::{ContactPoint, Enforced};
use crate::surface::{ContactSurface, MasterFace};
use crate::symmetry::{in_plane, symmetric_tangents, tangent_in_plane};
use crate::vector::{Vec3, add, axpy, cross, dot, frame, scale, sub, tangential};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The rows of exact enforcement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Rows {
    /// A slave node and the face under it.
    #[default]
    NodeToFace,
    /// A slave node and the mean over the faces near it, by dual mortar functions.
    Mortar,
}

impl Rows {
    /// The words of a case file for them.
    pub const WORDS: &'static [&'static str] = &["node_to_face", "mortar"];
}

/// The part of a node of the master in a projection.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct Share {
    /// The node, in its surface.
    pub node: u32,
    pub weight: f64,
    /// Derivatives of the weight along two directions of the surface.
    pub gradient: [f64; 2],
}

/// The shares of the corners of a face at a point.
pub(crate) fn face_shares(face: &MasterFace, xi: f64, eta: f64) -> [Share; 4] {
    let (weights, gradients) = (shape(xi, eta), shape_gradients(xi, eta));
    [0, 1, 2, 3].map(|c| Share { node: face.local[c], weight: weights[c], gradient: gradients[c] })
}

/// The projection of shares in the present configuration, and the tangents along their two directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MasterPoint {
    pub x: Vec3,
    pub tangents: [Vec3; 2],
}

impl MasterPoint {
    #[inline]
    pub fn new(shares: &[Share], master: &ContactSurface, positions: &Positions<'_>) -> Self {
        let (mut x, mut a1, mut a2) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for share in shares {
            let node = positions.at(master.node(share.node));
            x = axpy(x, share.weight, node);
            a1 = axpy(a1, share.gradient[0], node);
            a2 = axpy(a2, share.gradient[1], node);
        }
        Self { x, tangents: [a1, a2] }
    }

    /// The same under a node at `node`: on a plane of symmetry with the mirror image of the shares.
    #[inline]
    pub fn under(
        node: Vec3,
        shares: &[Share],
        master: &ContactSurface,
        positions: &Positions<'_>,
    ) -> Self {
        let point = Self::new(shares, master, positions);
        if !master.is_on_plane(node) {
            return point;
        }
        Self { x: in_plane(point.x), tangents: symmetric_tangents(point.tangents) }
    }

    /// The frame in which the tangential force of a constraint with unit normal `n` is kept.
    #[inline]
    pub fn frame(&self, n: Vec3, on_plane: bool) -> [Vec3; 2] {
        frame(if on_plane { tangent_in_plane(n) } else { self.tangents[0] }, n)
    }

    /// The duals of the tangents in the plane with unit normal `n`.
    #[inline]
    pub fn duals(&self, n: Vec3) -> [Vec3; 2] {
        let [a1, a2] = self.tangents.map(|a| tangential(a, n));
        let per_area = 1.0 / dot(n, cross(a1, a2));
        [scale(per_area, cross(a2, n)), scale(per_area, cross(n, a1))]
    }
}

/// A node of the master in the rows of one step.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct MasterNode {
    /// The node, in its surface.
    pub node: u32,
    pub weight: f64,
    /// `d b_J`.
    pub rotation: Vec3,
}

/// A contact point at which the conditions of contact and friction hold by Lagrange multipliers.
pub(crate) type Constraint = ContactPoint<Multipliers>;

/// What exact contact keeps of a contact point.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Multipliers {
    /// Its master_nodes in the list of the step: the first, and how many.
    master_nodes: [u32; 2],
    /// `dt W_ii`: the velocity (m/s) that a force of 1 N on slave and master makes in the step.
    #[serde(skip)]
    pub delassus: f64,
    /// Whether the slave lies on a plane of symmetry, which no slip crosses.
    #[serde(skip)]
    on_plane: bool,
    /// Tangential frame that turns with the master.
    pub frame: [Vec3; 2],
    /// Whether it slipped in the step before.
    pub slipped: bool,
}

impl Enforced for Multipliers {
    fn follow(&mut self, other: &Self) {
        *self = Self { master_nodes: self.master_nodes, on_plane: self.on_plane, ..*other };
    }
}

impl Constraint {
    /// Its master_nodes in the list of the step.
    #[inline]
    pub fn master_nodes(&self) -> Range<usize> {
        let [first, count] = self.enforcement.master_nodes.map(|n| n as usize);
        first..first + count
    }

    /// Sets up the rows of a node at `x`, maybe `on_plane` of symmetry, over a projection with unit normal `n`, and adds
    /// their master_nodes to the list of the step.
    #[inline]
    pub fn set_up(
        &mut self,
        shares: &[Share],
        master_point: &MasterPoint,
        n: Vec3,
        x: Vec3,
        on_plane: bool,
        master_nodes: &mut Vec<MasterNode>,
    ) {
        self.normal = n;
        self.enforcement.on_plane = on_plane;
        self.enforcement.frame = master_point.frame(n, on_plane);
        self.enforcement.master_nodes = [master_nodes.len() as u32, shares.len() as u32];
        let [g1, g2] = master_point.duals(n);
        let to_node = sub(x, master_point.x);
        let beside = [dot(g1, to_node), dot(g2, to_node)];
        let [a1, a2] = master_point.tangents;
        let under = axpy(scale(beside[0], a1), beside[1], a2);
        let distance = dot(n, sub(to_node, under));
        master_nodes.extend(shares.iter().map(|share| {
            let [d1, d2] = share.gradient;
            let rotation = axpy(scale(distance * d1, g1), distance * d2, g2);
            MasterNode {
                node: share.node,
                weight: share.weight + d1 * beside[0] + d2 * beside[1],
                // with its mirror image a master that turns about x does not turn on the plane
                rotation: if on_plane { in_plane(rotation) } else { rotation },
            }
        }));
    }

    /// Takes the master_nodes, the last in the list, from it again.
    pub fn withdraw(&mut self, master_nodes: &mut Vec<MasterNode>) {
        master_nodes.truncate(self.enforcement.master_nodes[0] as usize);
        self.enforcement.master_nodes = [0; 2];
    }

    /// Rate of the gap (m/s) and slip velocity (m/s) from the velocities of slave and master.
    #[inline]
    pub fn rates(
        &self,
        slave: Vec3,
        master_nodes: &[MasterNode],
        velocity: impl Fn(u32) -> Vec3,
    ) -> (f64, Vec3) {
        let mut w = slave;
        let mut turn = [0.0; 3];
        for master_node in master_nodes {
            let v = velocity(master_node.node);
            w = axpy(w, -master_node.weight, v);
            turn = axpy(turn, dot(self.normal, v), master_node.rotation);
        }
        if self.enforcement.on_plane {
            // with its mirror image the master does not move across the plane
            w = in_plane(w);
        }
        let opening = dot(self.normal, w);
        (opening, add(axpy(w, -opening, self.normal), turn))
    }

    /// Force on the node of a master_node where `normal` and `friction` act on the slave (N).
    #[inline]
    pub fn reaction(&self, master_node: &MasterNode, normal: f64, friction: Vec3) -> Vec3 {
        let along = dot(master_node.rotation, friction) - master_node.weight * normal;
        axpy(scale(-master_node.weight, friction), along, self.normal)
    }
}

impl Constraint {
    /// The matrix `-weight + rotation n^T` that takes the velocity of the node of a master_node to its part of the relative velocity; its transpose takes
    /// a force on the slave to that on the node.
    pub fn on_leg(&self, master_node: &MasterNode) -> [[f64; 3]; 3] {
        let [n, rotation] = [self.normal, master_node.rotation];
        [0, 1, 2].map(|i| {
            [0, 1, 2]
                .map(|j: usize| rotation[i] * n[j] - if i == j { master_node.weight } else { 0.0 })
        })
    }

    /// A block between the forces of `on` and the relative velocity of this one, without what planes of symmetry hold.
    pub fn within_plane(&self, on: &Self, mut block: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        if self.enforcement.on_plane {
            block[1] = [0.0; 3];
        }
        if on.enforcement.on_plane {
            block.iter_mut().for_each(|row| row[1] = 0.0);
        }
        block
    }
}

/// Where a projection on a face may be placed: not beyond its edges.
pub(crate) fn within(projection: &Projection) -> [f64; 2] {
    [projection.xi.clamp(-1.0, 1.0), projection.eta.clamp(-1.0, 1.0)]
}
