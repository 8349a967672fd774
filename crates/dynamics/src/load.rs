//! Given forces and directions in which nodes do not move.

use crate::ramp::smoothstep;
use exact_sum::ExactSum;
use mesh::Padded;
use nalgebra::Vector3;

/// Forces on nodes that keep their direction, rising together by a smoothstep.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Load {
    /// Nodes and the forces on them after the ramp (N).
    pub forces: Vec<(u32, Vector3<f64>)>,
    /// Duration of the ramp (s); zero for a load that acts at once.
    pub ramp: f64,
}

impl Load {
    /// The weight of nodes of these masses (kg) under a uniform acceleration (m/s^2).
    pub fn weight(mass: &[f64], nodes: std::ops::Range<usize>, acceleration: Vector3<f64>) -> Self {
        let forces = nodes.map(|n| (n as u32, mass[n] * acceleration)).collect();
        Self { forces, ramp: 0.0 }
    }

    /// Adds the forces at `time` to `force`.
    pub(crate) fn apply(&self, time: f64, force: &mut [Padded]) {
        let part = self.fraction(time);
        for (n, f) in &self.forces {
            force[*n as usize] += part * f;
        }
    }

    /// Power of the forces at `time` on nodes that move at `velocity` (W).
    pub(crate) fn power(&self, time: f64, velocity: &[Padded]) -> f64 {
        self.fraction(time) * self.full_power(velocity, |_| true).value()
    }

    /// The part of the forces that acts at `time`.
    pub(crate) fn fraction(&self, time: f64) -> f64 {
        smoothstep(time, self.ramp)
    }

    /// Power of the forces after the ramp on the nodes that `counts`, which move at `velocity` (W).
    pub(crate) fn full_power(&self, velocity: &[Padded], counts: impl Fn(u32) -> bool) -> ExactSum {
        let power = |(n, f): &(u32, Vector3<f64>)| f.dot(&velocity[*n as usize].vector());
        self.forces.iter().filter(|(n, _)| counts(*n)).map(power).collect()
    }
}

/// Directions in which a node does not move; its support does no work.
///
/// The support bears the forces of the elements; a [`Load`] in such a direction still reaches contact, as
/// on a plane of antisymmetry that meets a contact under initial stress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fixed {
    /// The node.
    pub node: u32,
    /// Whether it is fixed in x, y, z.
    pub axes: [bool; 3],
}

impl Fixed {
    /// Sets the fixed components of a nodal field to zero.
    pub(crate) fn clear(fixed: &[Self], field: &mut [Padded]) {
        for f in fixed {
            for i in 0..3 {
                if f.axes[i] {
                    field[f.node as usize].0[i] = 0.0;
                }
            }
        }
    }
}
