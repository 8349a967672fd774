//! Lysmer's quiet boundary at the ends of the lower body.

use crate::load::Fixed;
use exact_sum::ExactSum;
use mesh::{Mesh, Padded, Surface, quad_corner_areas};
use nalgebra::Vector3;
use solid::Material;

/// Dashpots t = -rho c_p v_n n - rho c_s v_t (Lysmer and Kuhlemeyer 1969) on the nodes of an end,
/// over the reaction that held the end during the preload.
#[derive(Clone, Debug, Default)]
pub struct QuietEnd {
    nodes: Vec<QuietNode>,
}

#[derive(Clone, Copy, Debug)]
struct QuietNode {
    node: u32,
    /// Dashpot coefficient per direction (N s/m); the end's normal is along x.
    dashpot: Vector3<f64>,
    /// Force (N) that balances the preload.
    reaction: Vector3<f64>,
}

/// Energies of a step at the quiet ends, split at the full step (J): rounded, or exact (`T` is [`ExactSum`]).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct QuietWork<T = f64> {
    pub(crate) dissipated_before: T,
    pub(crate) dissipated_after: T,
    pub(crate) external_before: T,
    pub(crate) external_after: T,
}

impl QuietWork<ExactSum> {
    pub(crate) fn value(&self) -> QuietWork {
        QuietWork {
            dissipated_before: self.dissipated_before.value(),
            dissipated_after: self.dissipated_after.value(),
            external_before: self.external_before.value(),
            external_after: self.external_after.value(),
        }
    }
}

impl QuietEnd {
    /// The nodes of `faces`, whose normal must be along x, except those in `held`.
    pub fn new(mesh: &Mesh, ends: &[&Surface], material: &Material, held: &[u32]) -> Self {
        let mut area = std::collections::BTreeMap::<u32, f64>::new();
        for face in ends.iter().flat_map(|s| &s.faces) {
            for (n, a) in face.nodes.iter().zip(quad_corner_areas(&face.nodes.map(|n| mesh.at(n))))
            {
                *area.entry(*n).or_default() += a;
            }
        }
        let nodes = area
            .into_iter()
            .filter(|(n, _)| held.binary_search(n).is_err())
            .map(|(node, a)| {
                let normal = material.density * material.c_p() * a;
                let shear = material.density * material.c_s() * a;
                let dashpot = Vector3::new(normal, shear, shear);
                QuietNode { node, dashpot, reaction: Vector3::zeros() }
            })
            .collect();
        Self { nodes }
    }

    /// The nodes, in ascending order.
    pub fn nodes(&self) -> impl Iterator<Item = u32> + '_ {
        self.nodes.iter().map(|n| n.node)
    }

    /// Takes over the reactions that held the nodes in equilibrium under `force` (N).
    pub fn keep_reactions(&mut self, force: &[Padded]) {
        for n in &mut self.nodes {
            n.reaction = -force[n.node as usize].vector();
        }
    }

    /// The forces (N) that balance the preload, node after node.
    pub(crate) fn reactions(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.nodes.iter().map(|n| n.reaction.into())
    }

    /// Takes over what [`Self::reactions`] gave.
    pub(crate) fn set_reactions(&mut self, reactions: &[[f64; 3]]) {
        self.nodes.iter_mut().zip(reactions).for_each(|(n, r)| n.reaction = (*r).into());
    }

    /// Leaves fixed directions to their supports.
    pub(crate) fn release(&mut self, fixed: &[Fixed]) {
        for f in fixed {
            // nodes ascend, as `new` makes them
            if let Ok(at) = self.nodes.binary_search_by_key(&f.node, |n| n.node) {
                for i in (0..3).filter(|&i| f.axes[i]) {
                    self.nodes[at].reaction[i] = 0.0;
                    self.nodes[at].dashpot[i] = 0.0;
                }
            }
        }
    }

    /// The coefficients of the dashpots (N s/m), node after node.
    pub(crate) fn dashpots(&self) -> impl Iterator<Item = (u32, Vector3<f64>)> + '_ {
        self.nodes.iter().map(|n| (n.node, n.dashpot))
    }

    /// Adds the reactions alone to `force`; returns their power (W) at `velocity`.
    pub(crate) fn add_reactions(&self, velocity: &[Padded], force: &mut [Padded]) -> f64 {
        let mut power = ExactSum::ZERO;
        for n in &self.nodes {
            force[n.node as usize] += n.reaction;
            let v = velocity[n.node as usize];
            (0..3).for_each(|i| power.add(n.reaction[i] * v[i]));
        }
        power.value()
    }

    /// Adds reaction and dashpot to `force`, the dashpot acting on the mean of the velocities
    /// before and after the step, so that it is stable at any step. The work is that of the nodes that `counts`.
    pub(crate) fn apply(
        &self,
        velocity: &[Padded],
        inverse_mass: &[f64],
        dt: f64,
        force: &mut [Padded],
        counts: impl Fn(u32) -> bool,
    ) -> QuietWork<ExactSum> {
        let mut work = [ExactSum::ZERO; 4];
        let half = 0.5 * dt;
        for n in &self.nodes {
            let (f, v) = (&mut force[n.node as usize], velocity[n.node as usize]);
            let w = inverse_mass[n.node as usize];
            let mut of_node = [0.0; 4];
            for i in 0..3 {
                let free = f.0[i] + n.reaction[i];
                let beta = 0.5 * dt * n.dashpot[i] * w;
                let after = ((1.0 - beta) * v.0[i] + dt * w * free) / (1.0 + beta);
                let dashpot = -n.dashpot[i] * 0.5 * (v.0[i] + after);
                f.0[i] = free + dashpot;
                of_node[0] -= half * dashpot * v.0[i];
                of_node[1] -= half * dashpot * after;
                of_node[2] += half * n.reaction[i] * v.0[i];
                of_node[3] += half * n.reaction[i] * after;
            }
            if counts(n.node) {
                work.iter_mut().zip(of_node).for_each(|(sum, w)| sum.add(w));
            }
        }
        let [dissipated_before, dissipated_after, external_before, external_after] = work;
        QuietWork { dissipated_before, dissipated_after, external_before, external_after }
    }
}
