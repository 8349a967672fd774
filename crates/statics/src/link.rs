//! The normal motion of a slave node relative to its foot.

use contact::Gap;
use mesh::Padded;

/// The row of the gap's derivative: `w -> n . (w_s - sum phi_I w_I)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    pub(crate) slave: usize,
    pub(crate) corners: [usize; 4],
    pub(crate) weights: [f64; 4],
    pub(crate) normal: [f64; 3],
}

impl Link {
    pub(crate) fn new(gap: &Gap) -> Self {
        Self {
            slave: gap.node as usize,
            corners: gap.corners.map(|n| n as usize),
            weights: gap.weights,
            normal: gap.normal,
        }
    }

    /// Normal component of the motion `w` at the slave.
    pub(crate) fn slave_normal(&self, w: &[Padded]) -> f64 {
        dot(self.normal, w[self.slave])
    }

    /// Normal component of the motion `w` of the foot.
    pub(crate) fn foot_normal(&self, w: &[Padded]) -> f64 {
        let mut sum = 0.0;
        for (weight, corner) in self.weights.iter().zip(self.corners) {
            sum += weight * dot(self.normal, w[corner]);
        }
        sum
    }

    /// Change of the gap under the motion `w`.
    pub(crate) fn opening(&self, w: &[Padded]) -> f64 {
        self.slave_normal(w) - self.foot_normal(w)
    }

    /// Adds the force `f` along the normal to the slave and its reaction to the face.
    pub(crate) fn push(&self, f: f64, force: &mut [Padded]) {
        self.add(self.slave, f, force);
        for (weight, corner) in self.weights.iter().zip(self.corners) {
            self.add(corner, -weight * f, force);
        }
    }

    /// Adds `value` times the normal at a node.
    pub(crate) fn add(&self, node: usize, value: f64, to: &mut [Padded]) {
        for i in 0..3 {
            to[node][i] += value * self.normal[i];
        }
    }
}

fn dot(n: [f64; 3], w: Padded) -> f64 {
    n[0] * w[0] + n[1] * w[1] + n[2] * w[2]
}
