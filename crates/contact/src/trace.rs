//! The trace of the mesh on the two contact surfaces: their nodes, numbered anew, and the fields there.
//!
//! Contact works with the trace alone. What it tells others, such as tables of nodes and gaps, and what solvers
//! of equilibrium and of frequencies ask of it has the numbers of the mesh; [`Trace`] translates.

use crate::lift::Lifts;
use crate::{ContactError, Motion};
use mesh::{Mesh, Padded, Surface};
use std::ops::Range;

/// The nodes of both contact surfaces, numbered from zero: those of side 0, then those of side 1, each ascending
/// by their numbers in the mesh.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Numbers in the mesh.
    nodes: Vec<u32>,
    /// Where side 1 begins.
    second: usize,
    /// Those that irregularities of the surfaces move.
    lifts: Lifts,
}

impl Trace {
    /// Of sides with these nodes of the mesh, each ascending.
    pub(crate) fn new([first, second]: [Vec<u32>; 2]) -> Self {
        let begin = first.len();
        Self { nodes: [first, second].concat(), second: begin, lifts: Lifts::default() }
    }

    /// Moves the nodes by the irregularities of their surfaces.
    pub(crate) fn lift(
        &mut self,
        mesh: &Mesh,
        surfaces: [&Surface; 2],
    ) -> Result<(), ContactError> {
        let local = |side: usize, node: u32| {
            let range = self.range(side);
            (range.start + self.nodes[range].partition_point(|&n| n < node)) as u32
        };
        self.lifts = Lifts::new(mesh, surfaces, local)?;
        Ok(())
    }

    /// Numbers of its nodes in the mesh.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Numbers in the mesh of the nodes whose positions it reads: its own, and those across from nodes that irregularities move.
    pub fn read(&self) -> impl Iterator<Item = u32> + '_ {
        self.nodes.iter().copied().chain(self.lifts.inward())
    }

    /// Numbers in the mesh of the nodes of side 0 or 1, ascending.
    pub fn side(&self, side: usize) -> &[u32] {
        &self.nodes[self.range(side)]
    }

    /// The nodes of side 0 or 1.
    pub(crate) fn range(&self, side: usize) -> Range<usize> {
        if side == 0 { 0..self.second } else { self.second..self.nodes.len() }
    }

    /// The number in the mesh of a node of the trace.
    #[inline]
    pub fn in_mesh(&self, node: u32) -> u32 {
        self.nodes[node as usize]
    }

    /// The values of a field of the mesh on the trace.
    ///
    /// # Panics
    /// If `field` has fewer entries than the mesh has nodes.
    pub fn gather<T: Copy>(&self, field: &[T]) -> Vec<T> {
        self.nodes.iter().map(|&n| field[n as usize]).collect()
    }

    /// Hands values on the trace to a field of the mesh.
    ///
    /// # Panics
    /// If `field` has fewer entries than the mesh has nodes.
    pub fn scatter<T: Copy>(&self, values: &[T], field: &mut [T]) {
        self.nodes.iter().zip(values).for_each(|(&n, value)| field[n as usize] = *value);
    }

    /// The positions `X + u` (m) on the trace, of reference positions and displacements of the nodes of the mesh (m), moved by
    /// the heights of irregular surfaces (module `lift`).
    ///
    /// # Panics
    /// If a slice has fewer entries than the mesh has nodes.
    pub fn positions(&self, reference: &[Padded], displacement: &[Padded]) -> Vec<Padded> {
        let position = |&n: &u32| moved(&reference[n as usize], &displacement[n as usize]);
        let mut positions: Vec<Padded> = self.nodes.iter().map(position).collect();
        self.lifts.apply(self.lifts.inward().map(|n| position(&n)), &mut positions);
        positions
    }
}

/// The fields on the trace that contact reads, and the forces that it adds to: one entry per node of a [`Trace`].
///
/// Who owns the arrays of the mesh gathers from them before a call of contact, and scatters the forces to them after it.
#[derive(Clone, Debug)]
pub struct TraceFields {
    trace: Trace,
    /// Reference positions (m).
    reference: Vec<Padded>,
    /// Those of the nodes across from nodes that irregularities move (m).
    inward: Vec<Padded>,
    /// Positions (m).
    position: Vec<Padded>,
    /// Velocities (m/s).
    velocity: Vec<Padded>,
    /// Inverse lumped masses (1/kg), zero for nodes that are held.
    inverse_mass: Vec<f64>,
    /// Forces (N).
    force: Vec<Padded>,
}

impl TraceFields {
    /// From reference positions (m) and inverse masses (1/kg) of the nodes of the mesh; at rest there.
    ///
    /// # Panics
    /// If a slice has fewer entries than the mesh has nodes.
    pub fn new(trace: &Trace, reference: &[Padded], inverse_mass: &[f64]) -> Self {
        let inward = trace.lifts.inward().map(|n| reference[n as usize]).collect();
        let reference = trace.gather(reference);
        let zeros = vec![Padded::ZERO; reference.len()];
        Self {
            trace: trace.clone(),
            inward,
            position: reference.clone(),
            velocity: zeros.clone(),
            inverse_mass: trace.gather(inverse_mass),
            force: zeros,
            reference,
        }
    }

    /// The numbers of its nodes in the trace: all of them.
    pub fn all(&self) -> Range<u32> {
        0..self.trace.nodes.len() as u32
    }

    /// The nodes.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Sets all forces to zero.
    pub fn clear_forces(&mut self) {
        self.force.fill(Padded::ZERO);
    }

    /// Takes the heights of irregular surfaces anew: the meshes of both sides have moved along the material by `moved` since the
    /// start, in x (m) or about the axis (rad).
    pub fn of_material(&mut self, moved: [f64; 2]) {
        self.trace.lifts.of_material(moved);
    }

    /// Takes positions `X + u` from displacements of the nodes of the mesh (m), moved by the heights of irregular surfaces.
    ///
    /// # Panics
    /// If `displacement` has fewer entries than the mesh has nodes.
    pub fn gather_positions(&mut self, displacement: &[Padded]) {
        let places = self.position.iter_mut().zip(&self.reference).zip(&self.trace.nodes);
        for ((position, x), &node) in places {
            *position = moved(x, &displacement[node as usize]);
        }
        let lifts = &self.trace.lifts;
        let across = self.inward.iter().zip(lifts.inward());
        let across = across.map(|(x, n)| moved(x, &displacement[n as usize]));
        lifts.apply(across, &mut self.position);
    }

    /// Takes velocities of the nodes of the mesh (m/s).
    ///
    /// # Panics
    /// If `velocity` has fewer entries than the mesh has nodes.
    pub fn gather_velocities(&mut self, velocity: &[Padded]) {
        for (v, &node) in self.velocity.iter_mut().zip(&self.trace.nodes) {
            *v = velocity[node as usize];
        }
    }

    /// Takes the forces (N) on the nodes `at` of the trace from those on the nodes of the mesh.
    ///
    /// # Panics
    /// If `force` has fewer entries than the mesh has nodes.
    pub fn gather_forces(&mut self, at: impl Iterator<Item = u32>, force: &[Padded]) {
        for node in at {
            self.force[node as usize] = force[self.trace.in_mesh(node) as usize];
        }
    }

    /// Hands the forces (N) on the nodes `at` of the trace to the nodes of the mesh.
    ///
    /// # Panics
    /// If `force` has fewer entries than the mesh has nodes.
    pub fn scatter_forces(&self, at: impl Iterator<Item = u32>, force: &mut [Padded]) {
        for node in at {
            force[self.trace.in_mesh(node) as usize] = self.force[node as usize];
        }
    }

    /// The motion at `time` (s) with the time step `dt` (s).
    pub fn motion(&self, time: f64, dt: f64) -> Motion<'_> {
        let Self { position, velocity, inverse_mass, .. } = self;
        Motion { position, velocity, inverse_mass, time, dt }
    }

    /// The same with the forces, for contact to add to.
    pub fn step(&mut self, time: f64, dt: f64) -> TraceStep<'_> {
        let Self { trace, reference, position, velocity, inverse_mass, force, .. } = self;
        let motion = Motion { position, velocity, inverse_mass, time, dt };
        TraceStep { trace, reference, motion, force }
    }
}

/// [`TraceFields`] in a step, one beside the other.
#[derive(Debug)]
pub struct TraceStep<'a> {
    /// The nodes.
    pub trace: &'a Trace,
    /// Reference positions (m).
    pub reference: &'a [Padded],
    /// Positions, velocities and inverse masses.
    pub motion: Motion<'a>,
    /// Forces (N).
    pub force: &'a mut [Padded],
}

/// `X + u` (m), with the padding: four lanes are one instruction.
#[inline(always)]
fn moved(x: &Padded, u: &Padded) -> Padded {
    Padded([x[0] + u[0], x[1] + u[1], x[2] + u[2], x[3] + u[3]])
}
