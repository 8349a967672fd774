//! The bodies and what holds them: residual, tangent and guards that both enforcements share.

use crate::components::{Drift, Parts, body_of};
use crate::error::StaticsError;
use crate::link::Link;
use crate::problem::{Iteration, Problem};
use crate::space::{CHUNK, Space};
use crate::springs::{Pressed, Springs};
use crate::supports::Axis;
use mesh::Padded;
use nalgebra::Vector3;
use rayon::prelude::*;
use solid::linear::{ConjugateGradients, LinearSystem, Outcome, Vector, inner, small};
use solid::{Centrifugal, Solid};

/// Conjugate-gradient iterations in one Newton step after which it gives up.
const MOST_CG: usize = 20_000;

/// The problem with everything that is set up once.
pub(crate) struct StaticSystem<'a> {
    pub(crate) solid: &'a mut Solid,
    pub(crate) problem: &'a Problem<'a>,
    pub(crate) space: Space,
    pub(crate) parts: Parts,
    /// Normal springs of the tangent.
    pub(crate) springs: Vec<(Link, f64)>,
    gradients: ConjugateGradients<Vec<Padded>>,
    pub(crate) reference: Vec<Padded>,
    /// Sum of the loads' magnitudes (N).
    load: f64,
    /// Largest norm of the forces so far, those at supports included (N).
    largest: f64,
}

impl<'a> StaticSystem<'a> {
    pub(crate) fn new(
        solid: &'a mut Solid,
        problem: &'a Problem<'a>,
    ) -> Result<Self, StaticsError> {
        let parts = Parts::new(problem.mesh, problem.supports)?;
        let blocks = solid.stiffness_diagonal();
        let reference = solid.reference().to_vec();
        let product = |x: &[Padded], y: &mut [Padded]| solid.add_stiffness_product(x, y);
        let space = Space::new(problem.mesh, &reference, problem.supports, &blocks, product);
        let n = blocks.len();
        let load = space.groups.iter().map(|g| g.load.abs()).sum();
        let gradients = ConjugateGradients::new(&vec![Padded::ZERO; n]);
        Ok(Self {
            solid,
            problem,
            space,
            parts,
            springs: Vec::new(),
            gradients,
            reference,
            load,
            largest: f64::MIN_POSITIVE,
        })
    }

    /// `start` with the supports' displacements over it.
    pub(crate) fn admissible(&self, start: &[Padded]) -> Result<Vec<Padded>, StaticsError> {
        let mut u = start[..self.reference.len()].to_vec();
        for &n in &self.problem.supports.held {
            u[n as usize] = Padded::ZERO;
        }
        for tied in &self.problem.supports.tied {
            for (axis, motion) in tied.axes.iter().enumerate() {
                let value = match *motion {
                    Axis::Moved(value) => value,
                    Axis::Loaded(_) => u[tied.nodes[0] as usize][axis],
                };
                tied.nodes.iter().for_each(|&n| u[n as usize][axis] = value);
            }
        }
        self.space.slide(&mut u);
        match u.iter().flat_map(|u| u.xyz()).find(|c| !c.is_finite()) {
            Some(value) => Err(StaticsError::NotANumber { value }),
            None => Ok(u),
        }
    }

    /// Loads, centrifugal and elastic force at `u` (N); returns the strain energy if asked for.
    pub(crate) fn force(&mut self, u: &[Padded], force: &mut [Padded], energy: bool) -> f64 {
        let reference = &self.reference;
        let spin = self.problem.spin.as_ref().map(|spin| {
            let hub = u[self.problem.supports.tied[spin.hub].nodes[0] as usize];
            let axis = [spin.centre[0] + hub[0], spin.centre[2] + hub[2]];
            (spin, Centrifugal { axis, omega: spin.omega })
        });
        force.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, force)| {
            for (k, f) in force.iter_mut().enumerate() {
                let i = chunk * CHUNK + k;
                *f = match spin {
                    Some((spin, force)) if spin.nodes.contains(&i) => {
                        force.force(spin.mass[i], reference[i], u[i])
                    }
                    _ => Padded::ZERO,
                };
            }
        });
        for group in &self.space.groups {
            force[group.nodes[0] as usize][group.axis] += group.load;
        }
        let sums = self.solid.subtract_elastic_force(u, force, energy);
        self.space.slide(force);
        sums.internal + sums.hourglass
    }

    /// Adds the forces of `springs` at `u` (N).
    pub(crate) fn add_spring_force(
        &self,
        springs: &mut Springs<'_>,
        u: &[Padded],
        force: &mut [Padded],
    ) -> Pressed {
        let pressed = springs.add_force(&self.reference, u, force);
        self.space.slide(force);
        pressed
    }

    /// Takes the normal springs `springs` into the tangent.
    pub(crate) fn set_springs(&mut self, springs: Vec<(Link, f64)>) {
        self.springs = springs;
        self.space.set_springs(&self.springs);
    }

    /// What a residual is measured by (N): the loads, or without them the largest forces so far.
    pub(crate) fn scale(&mut self, force: &[Padded]) -> f64 {
        if self.load > 0.0 {
            return self.load;
        }
        self.largest = self.largest.max(inner(force, force).sqrt());
        self.largest
    }

    /// `y -= K x` with the stiffness of the undeformed state.
    pub(crate) fn subtract_stiffness_product(&mut self, x: &[Padded], y: &mut Vec<Padded>) {
        let mut scaled = x.to_vec();
        let largest = scaled.largest();
        if largest == 0.0 {
            return;
        }
        scaled.scale(small(largest));
        let mut product = vec![Padded::ZERO; x.len()];
        self.solid.subtract_elastic_force(&scaled, &mut product, false);
        y.add(1.0 / small(largest), &product);
    }

    /// The linear step under the reduced residual `r`, which is used up.
    pub(crate) fn step(
        &mut self,
        r: &mut Vec<Padded>,
        x: &mut Vec<Padded>,
        tolerance: f64,
        at: &Iteration,
    ) -> Result<usize, StaticsError> {
        let Self { gradients, solid, space, springs, .. } = self;
        space.slide(r);
        let mut tangent = Tangent { solid, space, springs };
        let (outcome, iterations) = gradients.solve(&mut tangent, r, x, tolerance, MOST_CG);
        match outcome {
            Outcome::Converged => Ok(iterations),
            Outcome::Slow | Outcome::NotANumber => {
                Err(StaticsError::Linear { iterations, at: *at })
            }
            Outcome::Flat => {
                let node = farthest(self.gradients.direction());
                Err(StaticsError::Flat { node, body: self.body(node), position: self.at(node) })
            }
        }
    }

    /// A drift that none of `links` resists.
    pub(crate) fn unresisted(&self, links: &[Link]) -> Option<Drift> {
        self.parts.drifts.iter().find(|drift| !self.resisted(drift, links)).cloned()
    }

    fn resisted(&self, drift: &Drift, links: &[Link]) -> bool {
        // Normals that are upright but for round-off hold nothing sideways.
        const UPRIGHT: f64 = 1e-9;
        let inside = |n: usize| f64::from(u8::from(self.parts.contains(drift, n)));
        links.iter().any(|link| {
            let projection: f64 = link.projection.iter().map(|&(n, w)| w * inside(n)).sum();
            link.normal[drift.axis].abs() * (inside(link.slave) - projection).abs() > UPRIGHT
        })
    }

    /// Moves a part under the force on it until contact resists: `closed` gives the closed links.
    pub(crate) fn close(
        &mut self,
        drift: &Drift,
        u: &mut [Padded],
        force: &[Padded],
        mut closed: impl FnMut(&mut Self, &[Padded]) -> Vec<Link>,
    ) -> Result<(), StaticsError> {
        const FIRST: f64 = 1e-9;
        let nodes: Vec<usize> = (0..u.len()).filter(|&n| self.parts.contains(drift, n)).collect();
        let pull = exact_sum::sum(nodes.iter().map(|&n| force[n][drift.axis]));
        let start: Vec<f64> = nodes.iter().map(|&n| u[n][drift.axis]).collect();
        let reach = self.extent();
        let mut shift = FIRST;
        while pull != 0.0 && shift < reach {
            for (&n, start) in nodes.iter().zip(&start) {
                u[n][drift.axis] = start + shift.copysign(pull);
            }
            let links = closed(self, u);
            if self.resisted(drift, &links) {
                return Ok(());
            }
            shift *= 2.0;
        }
        Err(self.open(drift, pull))
    }

    fn open(&self, drift: &Drift, force: f64) -> StaticsError {
        let body = self.problem.mesh.bodies[drift.body].name.clone();
        StaticsError::Open { body, axis: ['x', 'y', 'z'][drift.axis], force }
    }

    /// Refuses an equilibrium in which contact that has to hold a body carries no more than the
    /// residual.
    pub(crate) fn is_pressed(
        &mut self,
        at: &Iteration,
        force: &[Padded],
    ) -> Result<(), StaticsError> {
        let least = 10.0 * at.residual.max(self.problem.tolerance) * self.scale(force);
        match self.parts.drifts.first() {
            Some(drift) if at.normal_force <= least => Err(self.open(drift, 0.0)),
            _ => Ok(()),
        }
    }

    /// Largest extent of the mesh along an axis (m).
    fn extent(&self) -> f64 {
        (0..3).fold(0.0, |extent: f64, i| {
            let all = || self.reference.iter().map(|x| x[i]);
            extent.max(all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min))
        })
    }

    /// Refuses a state with an element turned inside out.
    pub(crate) fn not_inverted(&self, u: &[Padded]) -> Result<(), StaticsError> {
        let (element, body, jacobian) = self.solid.smallest_jacobian(u);
        if jacobian > 0.0 {
            return Ok(());
        }
        let body = self.problem.mesh.bodies[body].name.clone();
        Err(StaticsError::Inverted { element, body, centre: self.solid.centre(element), jacobian })
    }

    /// Newton gave up in the state `at` with the reduced residual `r`.
    pub(crate) fn slow(&self, at: Iteration, r: &[Padded]) -> StaticsError {
        let (node, _) = self.space.worst(r);
        let (body, position) = (self.body(node), self.at(node));
        StaticsError::Slow { at, tolerance: self.problem.tolerance, node, body, position }
    }

    fn body(&self, node: usize) -> String {
        self.problem.mesh.bodies[body_of(self.problem.mesh, node)].name.clone()
    }

    fn at(&self, node: usize) -> Vector3<f64> {
        self.reference[node].vector()
    }
}

/// The tangent `T^T (K + K_springs) T` with the stiffness K of the undeformed state.
struct Tangent<'a> {
    solid: &'a mut Solid,
    space: &'a mut Space,
    springs: &'a [(Link, f64)],
}

impl LinearSystem<Vec<Padded>> for Tangent<'_> {
    fn answer(&mut self, p: &mut Vec<Padded>, q: &mut Vec<Padded>) {
        q.set_zero();
        self.solid.subtract_elastic_force(p, q, false);
        for (link, k) in self.springs {
            link.push(-k * link.opening(p), q);
        }
        self.space.reduce(q);
    }

    fn precondition(&mut self, r: &Vec<Padded>, z: &mut Vec<Padded>) -> f64 {
        self.space.precondition(r, z)
    }
}

/// The node that moves most.
fn farthest(motion: &[Padded]) -> usize {
    let square = |v: &Padded| v.vector().norm_squared();
    (0..motion.len())
        .max_by(|&i, &j| square(&motion[i]).total_cmp(&square(&motion[j])))
        .unwrap_or(0)
}
