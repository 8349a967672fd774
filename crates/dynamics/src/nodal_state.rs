//! The arrays of the nodes and the loops over them.
//!
//! They are split into chunks, which threads take in any order; what is summed up over the nodes is summed exactly.
//! Contact sees the nodes of its surfaces alone, the trace: the loops to it and from it are here too.

use crate::partition::CHUNK;
use crate::step_sums::NodeSums;
use contact::{ContactStep, ContactSums, FreeMotion, PenaltyContact, TraceFields, TraceStep};
use exact_sum::ExactSum;
use mesh::Padded;
use nalgebra::Vector3;
use rayon::prelude::*;

/// Nodes that a thread takes at a time, at least.
pub(crate) const TASK: usize = 4096;

/// Displacements, velocities and forces of all nodes, and what `S` sums up over each chunk of them.
pub(crate) struct NodalState<S = NodeSums> {
    /// Displacements (m).
    pub(crate) displacement: Vec<Padded>,
    /// Velocities (m/s).
    pub(crate) velocity: Vec<Padded>,
    /// Forces (N).
    pub(crate) force: Vec<Padded>,
    /// Inverse lumped masses (1/kg), zero for nodes that are held or carried by the hub.
    pub(crate) inverse_mass: Vec<f64>,
    /// What contact sees of them, if there is contact.
    pub(crate) trace: Option<TraceFields>,
    partial: Vec<S>,
}

/// The nodes of a chunk, from node `first` on.
pub(crate) struct Chunk<'a, S = NodeSums> {
    pub(crate) u: &'a mut [Padded],
    pub(crate) v: &'a mut [Padded],
    pub(crate) f: &'a mut [Padded],
    pub(crate) inverse_mass: &'a [f64],
    pub(crate) first: usize,
    pub(crate) sums: &'a mut S,
}

/// A node of the trace before the step under way.
#[derive(Clone, Copy)]
pub(crate) struct TraceNode {
    /// Its number in the mesh.
    pub(crate) number: usize,
    /// Reference position (m).
    pub(crate) reference: Padded,
    /// Velocity (m/s).
    pub(crate) velocity: Vector3<f64>,
    /// Inverse mass (1/kg).
    pub(crate) inverse_mass: f64,
}

impl<S: Clone + Default + Send + Sync> NodalState<S> {
    /// Nodes with these displacements (m), velocities (m/s) and inverse masses (1/kg), under no force.
    pub(crate) fn new(
        displacement: Vec<Padded>,
        velocity: Vec<Padded>,
        inverse_mass: Vec<f64>,
    ) -> Self {
        let n = inverse_mass.len();
        Self {
            displacement,
            velocity,
            force: vec![Padded::ZERO; n],
            inverse_mass,
            trace: None,
            partial: vec![S::default(); n.div_ceil(CHUNK)],
        }
    }

    /// Shows the nodes of its surfaces, of reference positions `reference` (m) over the mesh, to `contact`.
    pub(crate) fn trace_of(&mut self, contact: &dyn ContactStep, reference: &[Padded]) {
        self.trace = Some(TraceFields::new(contact.trace(), reference, &self.inverse_mass));
    }

    /// The chunks, for threads to take.
    pub(crate) fn chunks(&mut self) -> impl IndexedParallelIterator<Item = Chunk<'_, S>> {
        self.displacement
            .par_chunks_mut(CHUNK)
            .zip(self.velocity.par_chunks_mut(CHUNK))
            .zip(self.force.par_chunks_mut(CHUNK).zip(self.inverse_mass.par_chunks(CHUNK)))
            .zip(self.partial.par_iter_mut())
            .enumerate()
            .with_min_len(TASK / CHUNK)
            .map(|(chunk, (((u, v), (f, inverse_mass)), sums))| Chunk {
                u,
                v,
                f,
                inverse_mass,
                first: chunk * CHUNK,
                sums,
            })
    }

    /// The sum over the chunks, in whatever order they came.
    pub(crate) fn sum(&self, of: impl Fn(&S) -> f64) -> ExactSum {
        self.partial.iter().map(of).collect()
    }

    /// Bytes of the arrays over all nodes.
    pub(crate) fn bytes(&self) -> usize {
        self.displacement.len() * (3 * size_of::<Padded>() + size_of::<f64>())
    }

    /// Adds the forces (N) of `contact` in the step from `time` with `dt` (s) to those on the nodes that it loads. `free`
    /// gives the velocity (m/s) of a node after the step under a force (N).
    pub(crate) fn add_contact_force(
        &mut self,
        contact: &mut dyn ContactStep,
        [time, dt]: [f64; 2],
        free: impl Fn(&TraceNode, Vector3<f64>) -> Vector3<f64> + Sync,
    ) -> ContactSums {
        let Some(fields) = &mut self.trace else { return ContactSums::default() };
        fields.gather_forces(contact.loaded().iter().copied(), &self.force);
        let TraceStep { trace, reference, motion, force } = fields.step(time, dt);
        let velocity = |node: u32, force: Vector3<f64>| {
            let i = node as usize;
            let node = TraceNode {
                number: trace.in_mesh(node) as usize,
                reference: reference[i],
                velocity: motion.velocity[i].vector(),
                inverse_mass: motion.inverse_mass[i],
            };
            free(&node, force)
        };
        let sums = contact.apply(&motion, &FreeMotion { velocity: &velocity }, force);
        fields.scatter_forces(contact.loaded().iter().copied(), &mut self.force);
        sums
    }

    /// Adds the forces (N) of the normal springs of `contact` alone.
    pub(crate) fn add_spring_force(&mut self, contact: &mut PenaltyContact) -> ContactSums {
        let Some(fields) = &mut self.trace else { return ContactSums::default() };
        fields.gather_positions(&self.displacement);
        fields.gather_forces(fields.all(), &self.force);
        let step = fields.step(0.0, 0.0);
        let sums = contact.apply_frictionless(step.motion.position, step.force);
        fields.scatter_forces(fields.all(), &mut self.force);
        sums
    }
}
