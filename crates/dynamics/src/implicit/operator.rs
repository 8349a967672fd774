//! The matrix of an implicit step, `A = M/(theta dt) + C + (theta dt + eta) K`, as a product, and conjugate gradients with it.
//!
//! K is the stiffness of the undeformed state, that of the upper body turned with the hub, by the products of the element kernels; C are the
//! dashpots of quiet ends and of mass-proportional damping, eta is the Kelvin–Voigt time. Unknowns are the velocities of the free nodes and the velocity
//! of the hub along z and about its axle, where forces decide on them.

use crate::hub::Hub;
use crate::load::Fixed;
use crate::nodal_state::{CHUNK, NodalState};
use crate::paired;
use crate::system::System;
use mesh::Padded;
use rayon::prelude::*;

/// Largest displacement (m) that products start from: the force of the elements is linear to the strain, which stays far
/// below 1e-6.
const AMPLITUDE: f64 = 1e-13;

/// Curvature over the residual's square that counts as none.
const FLAT: f64 = 1e-14;

/// A velocity or a force: of the nodes, and of the hub along z and about its axle.
#[derive(Clone, Debug)]
pub(crate) struct Vectors {
    pub(crate) nodes: Vec<Padded>,
    pub(crate) hub: [f64; 2],
}

impl Vectors {
    pub(crate) fn new(nodes: usize) -> Self {
        Self { nodes: vec![Padded::ZERO; nodes], hub: [0.0; 2] }
    }

    /// `self += s other`.
    pub(crate) fn add(&mut self, s: f64, other: &Self) {
        self.nodes.par_chunks_mut(CHUNK).zip(other.nodes.par_chunks(CHUNK)).for_each(|(a, b)| {
            for (a, b) in a.iter_mut().zip(b) {
                for i in 0..3 {
                    a[i] += s * b[i];
                }
            }
        });
        for i in 0..2 {
            self.hub[i] += s * other.hub[i];
        }
    }

    /// `self = other + s self`.
    fn follow(&mut self, other: &Self, s: f64) {
        self.nodes.par_chunks_mut(CHUNK).zip(other.nodes.par_chunks(CHUNK)).for_each(|(a, b)| {
            for (a, b) in a.iter_mut().zip(b) {
                for i in 0..3 {
                    a[i] = b[i] + s * a[i];
                }
            }
        });
        for i in 0..2 {
            self.hub[i] = other.hub[i] + s * self.hub[i];
        }
    }

    fn copy(&mut self, other: &Self) {
        self.nodes.copy_from_slice(&other.nodes);
        self.hub = other.hub;
    }

    pub(crate) fn clear(&mut self) {
        self.nodes.fill(Padded::ZERO);
        self.hub = [0.0; 2];
    }
}

/// The step and the frame for which the matrix is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    /// theta dt (s).
    pub(crate) lead: f64,
    /// Time step (s), which the hub's mass goes with.
    pub(crate) dt: f64,
    /// Angle that the upper body has turned (rad).
    pub(crate) angle: f64,
    /// Whether the hub moves; else its nodes are held.
    pub(crate) with_hub: bool,
}

/// The matrix of a step.
pub(crate) struct Operator {
    frame: Frame,
    /// Kelvin–Voigt time (s).
    eta: f64,
    /// Coefficients of the dashpots of each node (N s/m).
    dashpots: Vec<Padded>,
    /// Diagonal of K (N/m).
    stiffness: Vec<Padded>,
    /// The inverse of the diagonal of A (m/(N s)), zero where nothing moves.
    inverse: Vec<Padded>,
    /// Of the hub's two velocities.
    hub_inverse: [f64; 2],
    mass: [[f64; 2]; 2],
    free: [bool; 2],
    /// What the elements see, and their answer.
    turned: Vec<Padded>,
    answer: Vec<Padded>,
    /// Partial sums over chunks.
    partial: Vec<f64>,
}

impl Operator {
    pub(crate) fn new(system: &System, nodes: &NodalState) -> Self {
        let n = nodes.inverse_mass.len();
        let mut dashpots = vec![Padded::ZERO; n];
        for (node, c) in system.quiet.dashpots() {
            dashpots[node as usize] = Padded::new(c);
        }
        for (c, w) in dashpots.iter_mut().zip(&nodes.inverse_mass) {
            if *w > 0.0 {
                (0..3).for_each(|i| c[i] += system.mass_damping / w);
            }
        }
        let diagonal = system.solid.stiffness_diagonal();
        let diagonal = diagonal.iter().map(|k| Padded::new([0, 1, 2].map(|i| k[i][i])));
        Self {
            frame: Frame { lead: 0.0, dt: 0.0, angle: 0.0, with_hub: false },
            eta: system.solid.kelvin_voigt(),
            dashpots,
            stiffness: diagonal.collect(),
            inverse: vec![Padded::ZERO; n],
            hub_inverse: [0.0; 2],
            mass: [[0.0; 2]; 2],
            free: [false; 2],
            turned: vec![Padded::ZERO; n],
            answer: vec![Padded::ZERO; n],
            partial: vec![0.0; n.div_ceil(CHUNK)],
        }
    }

    /// The dashpots of each node (N s/m).
    pub(crate) fn dashpots(&self) -> &[Padded] {
        &self.dashpots
    }

    /// Which velocities of the hub are unknown.
    pub(crate) fn free(&self) -> [bool; 2] {
        self.free
    }

    /// The mass of the hub's two velocities (kg, kg m, kg m^2).
    pub(crate) fn hub_mass(&self) -> [[f64; 2]; 2] {
        self.mass
    }

    /// Takes the matrix for a frame.
    pub(crate) fn set(&mut self, system: &System, nodes: &NodalState, frame: Frame) {
        let stiff = frame.lead + self.eta;
        let same = self.frame.lead == frame.lead;
        self.frame = frame;
        if !same {
            let arrays = self.inverse.iter_mut().zip(&self.stiffness).zip(&self.dashpots);
            for (((inverse, k), c), w) in arrays.zip(&nodes.inverse_mass) {
                for i in 0..3 {
                    let diagonal = 1.0 / (w * frame.lead) + c[i] + stiff * k[i];
                    inverse[i] = if *w > 0.0 { 1.0 / diagonal } else { 0.0 };
                }
            }
            Fixed::clear(&system.fixed, &mut self.inverse);
        }
        self.free = [false; 2];
        if let Some(hub) = system.hub.as_ref().filter(|_| frame.with_hub) {
            self.free = hub.free();
            self.mass = hub.mass_matrix();
            let stiffness = hub.stiffness(|node| stiff * self.stiffness[node][0]);
            self.hub_inverse = [0, 1].map(|i| 1.0 / (self.mass[i][i] / frame.dt + stiffness[i]));
        }
    }

    /// The square of the norm of a force.
    pub(crate) fn square(&mut self, force: &[Padded]) -> f64 {
        inner(&mut self.partial, force, force)
    }

    /// Leaves of a force what the unknowns answer: nothing on nodes that are held or carried, the mean on pairs.
    pub(crate) fn reduce(&self, system: &System, nodes: &NodalState, force: &mut [Padded]) {
        for (f, w) in force.iter_mut().zip(&nodes.inverse_mass) {
            if *w == 0.0 {
                *f = Padded::ZERO;
            }
        }
        Fixed::clear(&system.fixed, force);
        paired::share(&system.paired, force);
    }

    /// `y = K x` with `x` small enough by the factor `small`, both over all nodes; in `answer`.
    fn stiffness_product(&mut self, system: &mut System, x: &[Padded], small: f64) {
        let upper = system.upper.clone();
        let (sin, cos) = libm::sincos(self.frame.angle);
        let turned = &mut self.turned;
        turned.par_chunks_mut(CHUNK).zip(x.par_chunks(CHUNK)).for_each(|(to, x)| {
            for (to, x) in to.iter_mut().zip(x) {
                *to = Padded([small * x[0], small * x[1], small * x[2], 0.0]);
            }
        });
        if sin != 0.0 {
            // back by the turn about +y
            for x in &mut turned[upper.clone()] {
                (x[0], x[2]) = (cos * x[0] - sin * x[2], cos * x[2] + sin * x[0]);
            }
        }
        self.answer.par_chunks_mut(CHUNK).for_each(|answer| answer.fill(Padded::ZERO));
        system.solid.subtract_elastic_force(&self.turned, &mut self.answer, false);
        let large = -1.0 / small;
        self.answer.par_chunks_mut(CHUNK).for_each(|answer| {
            for y in answer {
                *y = Padded(y.0.map(|c| large * c));
            }
        });
        if sin != 0.0 {
            for y in &mut self.answer[upper] {
                (y[0], y[2]) = (cos * y[0] + sin * y[2], cos * y[2] - sin * y[0]);
            }
        }
    }

    /// `x . K x` of velocities of all nodes (W/s).
    pub(crate) fn stiffness_energy(&mut self, system: &mut System, x: &[Padded]) -> f64 {
        let small = AMPLITUDE / largest(x).max(f64::MIN_POSITIVE);
        self.stiffness_product(system, x, small);
        let Self { answer, partial, .. } = self;
        inner(partial, x, answer)
    }

    /// `y = A x`. Gives the nodes of the hub in `x` the velocities of the hub for the product, and clears them again.
    fn product(
        &mut self,
        system: &mut System,
        nodes: &NodalState,
        x: &mut Vectors,
        y: &mut Vectors,
        small: f64,
    ) {
        if let Some(hub) = system.hub.as_ref().filter(|_| self.frame.with_hub) {
            hub.add_motion(x.hub, &nodes.displacement, &mut x.nodes);
        }
        self.stiffness_product(system, &x.nodes, small);
        let stiff = self.frame.lead + self.eta;
        let per_lead = 1.0 / self.frame.lead;
        let arrays = y.nodes.par_chunks_mut(CHUNK).zip(x.nodes.par_chunks(CHUNK));
        let arrays = arrays.zip(self.answer.par_chunks(CHUNK).zip(self.dashpots.par_chunks(CHUNK)));
        arrays.zip(nodes.inverse_mass.par_chunks(CHUNK)).for_each(|(((y, x), (k, c)), w)| {
            for ((((y, x), k), c), w) in y.iter_mut().zip(x).zip(k).zip(c).zip(w) {
                let mass = if *w > 0.0 { per_lead / w } else { 0.0 };
                for i in 0..3 {
                    y[i] = stiff * k[i] + (mass + c[i]) * x[i];
                }
            }
        });
        y.hub = [0.0; 2];
        if let Some(hub) = system.hub.as_ref().filter(|_| self.frame.with_hub) {
            let load = hub.resultant(&nodes.displacement, &y.nodes);
            let [z, turn] = x.hub;
            let answer = [load.force[2], load.moment[1]];
            for i in (0..2).filter(|&i| self.free[i]) {
                let momentum = self.mass[i][0] * z + self.mass[i][1] * turn;
                y.hub[i] = momentum / self.frame.dt + answer[i];
            }
            clear(hub, &mut x.nodes);
        }
        self.reduce(system, nodes, &mut y.nodes);
    }

    fn precondition(&mut self, r: &Vectors, z: &mut Vectors) -> f64 {
        let Self { inverse, partial, hub_inverse, free, .. } = self;
        z.nodes
            .par_chunks_mut(CHUNK)
            .zip(r.nodes.par_chunks(CHUNK).zip(inverse.par_chunks(CHUNK)))
            .for_each(|(z, (r, d))| {
                for (z, (r, d)) in z.iter_mut().zip(r.iter().zip(d)) {
                    *z = Padded([r[0] * d[0], r[1] * d[1], r[2] * d[2], 0.0]);
                }
            });
        z.hub = [0, 1].map(|i| if free[i] { r.hub[i] * hub_inverse[i] } else { 0.0 });
        inner(partial, &r.nodes, &z.nodes) + r.hub[0] * z.hub[0] + r.hub[1] * z.hub[1]
    }
}

/// Work vectors of conjugate gradients.
pub(crate) struct ConjugateGradients {
    z: Vectors,
    p: Vectors,
    q: Vectors,
}

impl ConjugateGradients {
    pub(crate) fn new(nodes: usize) -> Self {
        let [z, p, q] = [0; 3].map(|_| Vectors::new(nodes));
        Self { z, p, q }
    }

    /// Solves `A x = r`; `r`, reduced, is used up. Ends where `sqrt(r . D^-1 r)` has fallen by `tolerance`, or after `most` products;
    /// returns how many there were.
    pub(crate) fn solve(
        &mut self,
        operator: &mut Operator,
        (system, nodes): (&mut System, &NodalState),
        r: &mut Vectors,
        x: &mut Vectors,
        (tolerance, most): (f64, usize),
    ) -> usize {
        let Self { z, p, q } = self;
        x.clear();
        let mut rz = operator.precondition(r, z);
        let size = largest(&z.nodes).max(z.hub[0].abs());
        if !(rz > 0.0 && size > 0.0) {
            return 0;
        }
        let small = AMPLITUDE / size;
        p.copy(z);
        let enough = rz * tolerance * tolerance;
        for product in 1..=most {
            operator.product(system, nodes, p, q, small);
            let curvature = inner(&mut operator.partial, &p.nodes, &q.nodes)
                + p.hub[0] * q.hub[0]
                + p.hub[1] * q.hub[1];
            let stiff = curvature > FLAT * rz;
            if !stiff {
                return product;
            }
            let alpha = rz / curvature;
            x.add(alpha, p);
            r.add(-alpha, q);
            let before = rz;
            rz = operator.precondition(r, z);
            if rz <= enough {
                return product;
            }
            p.follow(z, rz / before);
        }
        most
    }
}

/// Clears the nodes of the hub.
fn clear(hub: &Hub, field: &mut [Padded]) {
    hub.nodes.iter().for_each(|&n| field[n as usize] = Padded::ZERO);
}

fn largest(v: &[Padded]) -> f64 {
    v.iter().flat_map(|v| v.xyz()).fold(0.0, |m: f64, c| m.max(c.abs()))
}

/// a . b, in an order that does not depend on the threads.
fn inner(partial: &mut [f64], a: &[Padded], b: &[Padded]) -> f64 {
    partial.par_iter_mut().zip(a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK))).for_each(
        |(sum, (a, b))| {
            let dot = |a: &Padded, b: &Padded| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            *sum = a.iter().zip(b).map(|(a, b)| dot(a, b)).sum();
        },
    );
    partial.iter().sum()
}
