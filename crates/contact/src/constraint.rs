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
use mesh::geometry::{frame, tangential};
use nalgebra::{Matrix3, Matrix3x2, UnitVector3, Vector2, Vector3};
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
    pub gradient: Vector2<f64>,
}

/// The shares of the corners of a face at a point.
pub(crate) fn face_shares(face: &MasterFace, xi: f64, eta: f64) -> [Share; 4] {
    let (weights, gradients) = (shape(xi, eta), shape_gradients(xi, eta));
    [0, 1, 2, 3].map(|c| Share {
        node: face.local[c],
        weight: weights[c],
        gradient: gradients[c].into(),
    })
}

/// The projection of shares in the present configuration, and as columns the tangents along their two directions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MasterPoint {
    pub x: Vector3<f64>,
    pub tangents: Matrix3x2<f64>,
}

impl MasterPoint {
    #[inline]
    pub fn new(shares: &[Share], master: &ContactSurface, positions: &Positions<'_>) -> Self {
        let mut point = Self { x: Vector3::zeros(), tangents: Matrix3x2::zeros() };
        for share in shares {
            let node = positions.at(master.node(share.node));
            point.x += share.weight * node;
            point.tangents += node * share.gradient.transpose();
        }
        point
    }

    /// The same under a node at `node`: on a plane of symmetry with the mirror image of the shares.
    #[inline]
    pub fn under(
        node: Vector3<f64>,
        shares: &[Share],
        master: &ContactSurface,
        positions: &Positions<'_>,
    ) -> Self {
        let point = Self::new(shares, master, positions);
        if !master.is_on_plane(node) {
            return point;
        }
        Self { x: in_plane(point.x), tangents: symmetric_tangents(&point.tangents) }
    }

    /// The normal of its facet, as long as the area of the parallelogram of its tangents (m^2).
    #[inline]
    pub fn facet(&self) -> Vector3<f64> {
        self.tangents.column(0).cross(&self.tangents.column(1))
    }

    /// The frame in which the tangential force of a constraint with unit normal `n` is kept.
    #[inline]
    pub fn frame(&self, n: UnitVector3<f64>, on_plane: bool) -> Matrix3x2<f64> {
        frame(if on_plane { tangent_in_plane(n) } else { self.tangents.column(0).into() }, n)
    }

    /// The tangents `a_a` and their duals `g^a`, `g^a . a_b = delta_ab`, in the plane with unit normal `n`:
    /// `g^1 = a_2 x n / n . (a_1 x a_2)`, `g^2 = n x a_1 / n . (a_1 x a_2)`.
    #[inline]
    pub fn duals(&self, n: UnitVector3<f64>) -> Matrix3x2<f64> {
        let [a1, a2] = [0, 1].map(|a| tangential(self.tangents.column(a).into(), n));
        let per_area = 1.0 / n.dot(&a1.cross(&a2));
        Matrix3x2::from_columns(&[per_area * a2.cross(&n), per_area * n.cross(&a1)])
    }
}

/// A node of the master in the rows of one step.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct MasterNode {
    /// The node, in its surface.
    pub node: u32,
    pub weight: f64,
    /// `d b_J`.
    pub rotation: Vector3<f64>,
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
    pub frame: Matrix3x2<f64>,
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
        n: UnitVector3<f64>,
        x: Vector3<f64>,
        on_plane: bool,
        master_nodes: &mut Vec<MasterNode>,
    ) {
        self.normal = n;
        self.enforcement.on_plane = on_plane;
        self.enforcement.frame = master_point.frame(n, on_plane);
        self.enforcement.master_nodes = [master_nodes.len() as u32, shares.len() as u32];
        let duals = master_point.duals(n);
        let to_node = x - master_point.x;
        let beside = duals.tr_mul(&to_node);
        let distance = n.dot(&(to_node - master_point.tangents * beside));
        master_nodes.extend(shares.iter().map(|share| {
            let along = share.gradient.component_mul(&beside);
            let rotation = duals * (distance * share.gradient);
            MasterNode {
                node: share.node,
                weight: share.weight + along.x + along.y,
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
        slave: Vector3<f64>,
        master_nodes: &[MasterNode],
        velocity: impl Fn(u32) -> Vector3<f64>,
    ) -> (f64, Vector3<f64>) {
        let mut w = slave;
        let mut turn = Vector3::zeros();
        for master_node in master_nodes {
            let v = velocity(master_node.node);
            w -= master_node.weight * v;
            turn += self.normal.dot(&v) * master_node.rotation;
        }
        if self.enforcement.on_plane {
            // with its mirror image the master does not move across the plane
            w = in_plane(w);
        }
        let opening = self.normal.dot(&w);
        (opening, w - opening * *self.normal + turn)
    }

    /// Force on the node of a master_node where `normal` and `friction` act on the slave (N).
    #[inline]
    pub fn reaction(
        &self,
        master_node: &MasterNode,
        normal: f64,
        friction: Vector3<f64>,
    ) -> Vector3<f64> {
        let along = master_node.rotation.dot(&friction) - master_node.weight * normal;
        along * *self.normal - master_node.weight * friction
    }
}

impl Constraint {
    /// The matrix `-weight + rotation n^T` that takes the velocity of the node of a master_node to its part of the relative velocity; its transpose takes
    /// a force on the slave to that on the node.
    pub fn on_leg(&self, master_node: &MasterNode) -> Matrix3<f64> {
        let weight = Matrix3::from_diagonal_element(master_node.weight);
        master_node.rotation * self.normal.transpose() - weight
    }

    /// A block between the forces of `on` and the relative velocity of this one, without what planes of symmetry hold.
    pub fn within_plane(&self, on: &Self, mut block: Matrix3<f64>) -> Matrix3<f64> {
        if self.enforcement.on_plane {
            block.row_mut(1).fill(0.0);
        }
        if on.enforcement.on_plane {
            block.column_mut(1).fill(0.0);
        }
        block
    }
}

/// Where a projection on a face may be placed: not beyond its edges.
pub(crate) fn within(projection: &Projection) -> [f64; 2] {
    [projection.xi.clamp(-1.0, 1.0), projection.eta.clamp(-1.0, 1.0)]
}
