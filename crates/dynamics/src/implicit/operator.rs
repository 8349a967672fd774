//! The matrix of an implicit step, `A = M/(theta dt) + C + (theta dt + eta) K`, as a product.
//!
//! K is the stiffness of the undeformed state, that of the upper body turned with the hub, by the products of the element kernels; C are the
//! dashpots of quiet ends and of mass-proportional damping, eta is the Kelvin–Voigt time. Unknowns are the velocities of the free nodes and the velocity
//! of the hub along z and about its axle, where forces decide on them.

use crate::load::Fixed;
use crate::nodal_state::{NodalState, TASK};
use crate::paired;
use crate::system::System;
use mesh::Padded;
use rayon::prelude::*;
use solid::linear::{LinearSystem, Vector, inner, small};

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
}

impl Vector for Vectors {
    fn set_zero(&mut self) {
        self.nodes.set_zero();
        self.hub = [0.0; 2];
    }

    fn scale(&mut self, s: f64) {
        self.nodes.scale(s);
        self.hub = self.hub.map(|c| s * c);
    }

    fn add(&mut self, s: f64, other: &Self) {
        self.nodes.add(s, &other.nodes);
        (0..2).for_each(|i| self.hub[i] += s * other.hub[i]);
    }

    fn follow(&mut self, other: &Self, s: f64) {
        self.nodes.follow(&other.nodes, s);
        self.hub = [0, 1].map(|i| other.hub[i] + s * self.hub[i]);
    }

    fn inner(&self, other: &Self) -> f64 {
        let [a, b] = [self.hub, other.hub];
        inner(&self.nodes, &other.nodes) + a[0] * b[0] + a[1] * b[1]
    }

    /// That of the nodes and of the hub along z (m/s).
    fn largest(&self) -> f64 {
        self.nodes.largest().max(self.hub[0].abs())
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
}

impl Operator {
    pub(crate) fn new(system: &System, nodes: &NodalState) -> Self {
        let n = nodes.inverse_mass.len();
        let mut dashpots = vec![Padded::ZERO; n];
        for (node, c) in system.quiet.dashpots() {
            dashpots[node as usize] = Padded::from(c);
        }
        for (c, w) in dashpots.iter_mut().zip(&nodes.inverse_mass) {
            if *w > 0.0 {
                (0..3).for_each(|i| c[i] += system.mass_damping / w);
            }
        }
        let diagonal = system.solid.stiffness_diagonal();
        let diagonal = diagonal.iter().map(|k| Padded::from(k.diagonal()));
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

    /// `-K x` of small motions of all nodes, in `answer`.
    fn elastic_answer(&mut self, system: &mut System, x: &[Padded]) {
        let upper = system.upper.clone();
        let (sin, cos) = libm::sincos(self.frame.angle);
        let seen: &[Padded] = if sin != 0.0 {
            self.turned.copy_from_slice(x);
            // back by the turn about +y
            for x in &mut self.turned[upper.clone()] {
                (x[0], x[2]) = (cos * x[0] - sin * x[2], cos * x[2] + sin * x[0]);
            }
            &self.turned
        } else {
            x
        };
        self.answer.set_zero();
        system.solid.subtract_elastic_force(seen, &mut self.answer, false);
        if sin != 0.0 {
            for y in &mut self.answer[upper] {
                (y[0], y[2]) = (cos * y[0] + sin * y[2], cos * y[2] - sin * y[0]);
            }
        }
    }

    /// `x . K x` of velocities of all nodes (W/s), which are used on the way and restored.
    pub(crate) fn stiffness_energy(&mut self, system: &mut System, x: &mut Vec<Padded>) -> f64 {
        let small = small(x.largest().max(f64::MIN_POSITIVE));
        x.scale(small);
        self.elastic_answer(system, x);
        let energy = -inner(x, &self.answer) / (small * small);
        x.scale(1.0 / small);
        energy
    }
}

/// The matrix of a step with what its product needs.
pub(crate) struct StepMatrix<'a> {
    pub(crate) operator: &'a mut Operator,
    pub(crate) system: &'a mut System,
    pub(crate) nodes: &'a NodalState,
}

impl LinearSystem<Vectors> for StepMatrix<'_> {
    /// Gives the nodes of the hub in `x` the velocities of the hub for the product, and clears them again.
    fn answer(&mut self, x: &mut Vectors, y: &mut Vectors) {
        let Self { operator, system, nodes } = self;
        if let Some(hub) = system.hub.as_ref().filter(|_| operator.frame.with_hub) {
            hub.add_motion(x.hub, &nodes.displacement, &mut x.nodes);
        }
        operator.elastic_answer(system, &x.nodes);
        let Operator { frame, eta, answer, dashpots, free, mass, .. } = &**operator;
        let stiff = frame.lead + eta;
        let per_lead = 1.0 / frame.lead;
        let arrays = y.nodes.par_chunks_mut(TASK).zip(x.nodes.par_chunks(TASK));
        let arrays = arrays.zip(answer.par_chunks(TASK).zip(dashpots.par_chunks(TASK)));
        arrays.zip(nodes.inverse_mass.par_chunks(TASK)).for_each(|(((y, x), (f, c)), w)| {
            for ((((y, x), f), c), w) in y.iter_mut().zip(x).zip(f).zip(c).zip(w) {
                let mass = if *w > 0.0 { per_lead / w } else { 0.0 };
                for i in 0..3 {
                    y[i] = stiff * f[i] - (mass + c[i]) * x[i];
                }
            }
        });
        y.hub = [0.0; 2];
        if let Some(hub) = system.hub.as_ref().filter(|_| frame.with_hub) {
            let load = hub.resultant(&nodes.displacement, &y.nodes);
            let [z, turn] = x.hub;
            let elastic = [load.force[2], load.moment[1]];
            for i in (0..2).filter(|&i| free[i]) {
                let momentum = mass[i][0] * z + mass[i][1] * turn;
                y.hub[i] = elastic[i] - momentum / frame.dt;
            }
            hub.nodes.iter().for_each(|&n| x.nodes[n as usize] = Padded::ZERO);
        }
        operator.reduce(system, nodes, &mut y.nodes);
    }

    fn precondition(&mut self, r: &Vectors, z: &mut Vectors) -> f64 {
        let Operator { inverse, hub_inverse, free, .. } = &*self.operator;
        z.nodes
            .par_chunks_mut(TASK)
            .zip(r.nodes.par_chunks(TASK).zip(inverse.par_chunks(TASK)))
            .for_each(|(z, (r, d))| {
                for (z, (r, d)) in z.iter_mut().zip(r.iter().zip(d)) {
                    *z = Padded([r[0] * d[0], r[1] * d[1], r[2] * d[2], 0.0]);
                }
            });
        z.hub = [0, 1].map(|i| if free[i] { r.hub[i] * hub_inverse[i] } else { 0.0 });
        r.inner(z)
    }
}
