//! The normal motion of a slave node relative to its projection.

use contact::Gap;
use mesh::Padded;
use nalgebra::UnitVector3;

/// The row of the gap's derivative: `u -> n . (u_s - sum w_J u_J)`.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub(crate) slave: usize,
    /// Nodes of the master and their weights.
    pub(crate) projection: Vec<(usize, f64)>,
    pub(crate) normal: UnitVector3<f64>,
}

impl Link {
    pub(crate) fn new(gap: &Gap) -> Self {
        Self {
            slave: gap.node as usize,
            projection: gap.projection.iter().map(|&(n, weight)| (n as usize, weight)).collect(),
            normal: gap.normal,
        }
    }

    /// Normal component of the motion `w` at the slave.
    pub(crate) fn slave_normal(&self, w: &[Padded]) -> f64 {
        self.normal.dot(&w[self.slave].vector())
    }

    /// Normal component of the motion `w` of the projection.
    pub(crate) fn projection_normal(&self, w: &[Padded]) -> f64 {
        let mut sum = 0.0;
        for &(node, weight) in &self.projection {
            sum += weight * self.normal.dot(&w[node].vector());
        }
        sum
    }

    /// Change of the gap under the motion `w`.
    pub(crate) fn opening(&self, w: &[Padded]) -> f64 {
        self.slave_normal(w) - self.projection_normal(w)
    }

    /// Adds the force `f` along the normal to the slave and its reaction to the face.
    pub(crate) fn push(&self, f: f64, force: &mut [Padded]) {
        self.add(self.slave, f, force);
        for &(node, weight) in &self.projection {
            self.add(node, -weight * f, force);
        }
    }

    /// Adds `value` times the normal at a node.
    pub(crate) fn add(&self, node: usize, value: f64, to: &mut [Padded]) {
        to[node] += value * *self.normal;
    }
}
