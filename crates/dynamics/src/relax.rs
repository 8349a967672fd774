//! Dynamic relaxation to the preload: equilibrium under the load, before rolling.
//!
//! Central difference in a fictitious time with unit step (Underwood 1983): nodal masses M~ with
//! M~ >= K/4, from element and contact stiffness bounds, make the unit step stable and all
//! elements equally fast; the damping is the critical one of the slowest mode in motion,
//! c = 2 sqrt(v.K v/v.M~ v), with K v taken from the change of the force.
//!
//! The upper body moves relative to the hub, and the hub is a coordinate of its own with a mass that
//! fits the contact springs: else the slowest mode would be all the upper body's fictitious mass, far
//! above its true one, rocking on the contact.

use crate::hub::Hub;
use crate::nodal_state::{Chunk, NodalState};
use crate::partition::CHUNK;
use contact::PenaltyContact;
use mesh::Padded;
use rayon::prelude::*;
use solid::{Centrifugal, Solid};
use thiserror::Error;

/// What is held and what acts during relaxation.
#[derive(Clone, Debug)]
pub struct Relaxation<'a> {
    /// The hub; its nodes move together in z under the load.
    pub hub: &'a Hub,
    /// Load that presses the hub down (N).
    pub load: f64,
    /// Nodes that stay where they are.
    pub held: &'a [u32],
    /// Nodes of the upper body.
    pub upper: std::ops::Range<usize>,
    /// Angular velocity whose centrifugal force acts on the upper body (rad/s).
    pub omega: f64,
    /// True lumped masses (kg).
    pub mass: &'a [f64],
    /// Largest eigenvalue of the element stiffnesses summed at each node (N/m).
    pub stiffness: &'a [f64],
    /// Displacement of the upper body in z at the start (m), negative where it is pressed down.
    pub start: f64,
    /// Kinetic over internal energy at convergence; the force balance is held to its square root.
    pub tolerance: f64,
    /// Iterations after which it gives up.
    pub max_iterations: usize,
}

/// How relaxation went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RelaxationReport {
    /// Iterations used.
    pub iterations: usize,
    /// Kinetic (fictitious) over internal energy at the end.
    pub kinetic_ratio: f64,
    /// Contact normal force (N).
    pub normal_force: f64,
    /// |load, contact and centrifugal force on hub and upper body together|/load.
    pub force_error: f64,
    /// Displacement of the hub in z (m).
    pub hub: f64,
}

/// Why relaxation found no equilibrium.
#[derive(Debug, Error)]
pub enum RelaxationError {
    /// Too many iterations.
    #[error(
        "dynamic relaxation did not converge in {} iterations: kinetic/internal energy {:.1e} (tolerance {tolerance:.1e}), normal force {:.6e} N",
        report.iterations, report.kinetic_ratio, report.normal_force
    )]
    Slow {
        /// State when it gave up.
        report: RelaxationReport,
        /// What was asked for.
        tolerance: f64,
    },
    /// Energies are not numbers.
    #[error("dynamic relaxation blew up at iteration {iteration}")]
    BlowUp {
        /// Iteration of the first bad energy.
        iteration: usize,
    },
    /// The observer asked to stop.
    #[error("interrupted during dynamic relaxation")]
    Interrupted,
}

/// Iterations between convergence checks and updates of the contact's share of the mass.
const CHECK: usize = 20;

/// Fictitious masses over stiffness bounds. The eigenvalues of the two parts add up to at most
/// 1/0.3 + 1/2 < 4, the limit of a unit step.
const NODE_SHARE: f64 = 0.3;
const HUB_SHARE: f64 = 2.0;

/// Acceleration of a hub whose body does not touch yet (m per iteration squared).
const FALL: f64 = 1e-6;

/// Largest growth of the estimated slowest frequency from one check to the next.
const RISE: f64 = 1.005;

/// Relaxes from the undeformed state, the upper body moved by `setup.start`; returns the displacements.
///
/// `observe` sees a report every few iterations and returns false to stop.
pub fn relax(
    solid: &mut Solid,
    contact: &mut PenaltyContact,
    setup: &Relaxation<'_>,
    mut observe: impl FnMut(&RelaxationReport) -> bool,
) -> Result<(Vec<Padded>, RelaxationReport), RelaxationError> {
    let reference = solid.reference().to_vec();
    let n = reference.len();
    let mut nodes = nodes_at_start(setup, n);
    nodes.trace_of(contact, &reference);
    let mut fictitious = vec![Fictitious::default(); n];
    let mut hub = HubMotion { z: setup.start, v: 0.0, mass: 0.0, force_before: 0.0 };
    let (mut contact_bound, mut spring) = (vec![0.0; n], 0.0);
    let mut report = RelaxationReport::default();
    let (mut slowest, mut damping) = (1.0f64, 0.0);
    let mut window = Quotient::default();
    for iteration in 0..setup.max_iterations {
        let check = iteration % CHECK == 0;
        let pull = centrifugal(&mut nodes, setup, &reference, hub.z);
        let sums = solid.subtract_elastic_force(&nodes.displacement, &mut nodes.force, check);
        let touching = nodes.add_spring_force(contact);
        if check {
            // Pairs close while the bodies settle: the bounds only grow.
            let mut bound = vec![0.0; n];
            contact.nodal_stiffness_bound(&mut bound);
            for (i, node) in fictitious.iter_mut().enumerate() {
                contact_bound[i] = f64::max(contact_bound[i], bound[i]);
                node.mass = NODE_SHARE * (setup.stiffness[i] + contact_bound[i]);
            }
            // Until bodies touch, the load moves the hub by FALL per iteration squared.
            spring = f64::max(spring, contact_stiffness(contact, &setup.upper, n));
            hub.mass = if spring > 0.0 { HUB_SHARE * spring } else { setup.load / FALL };
        }
        // The upper body's internal forces cancel: what moves the hub is load, contact and spin.
        let hub_force = touching.force[0][2] + pull - setup.load;
        let mut motion = Quotient {
            stiffness: hub.v * (hub.force_before - hub_force),
            mass: hub.mass * hub.v * hub.v,
            pull: 0.0,
        };
        let damped =
            Damped { keep: (2.0 - damping) / (2.0 + damping), kick: 2.0 / (2.0 + damping) };
        hub.v = damped.keep * hub.v + damped.kick * hub_force / hub.mass;
        hub.z += hub.v;
        hub.force_before = hub_force;
        advance(&mut nodes, &mut fictitious, damped, &setup.upper, hub.v);
        motion.stiffness += nodes.sum(|p| p.stiffness).value();
        motion.mass += nodes.sum(|p| p.mass).value();
        if check {
            report = RelaxationReport {
                iterations: iteration,
                kinetic_ratio: 0.5 * motion.mass / sums.internal,
                normal_force: touching.normal_force,
                force_error: (hub_force / setup.load).abs(),
                hub: hub.z,
            };
            if iteration > 0 && !report.kinetic_ratio.is_finite() {
                return Err(RelaxationError::BlowUp { iteration });
            }
            if iteration > 0
                && report.kinetic_ratio <= setup.tolerance
                && report.force_error <= setup.tolerance.sqrt()
            {
                return Ok((nodes.displacement, report));
            }
            if !observe(&report) {
                return Err(RelaxationError::Interrupted);
            }
        }
        window.stiffness += motion.stiffness;
        window.mass += motion.mass;
        if check {
            // The slow modes are what is left to damp: the estimate follows the quotient down at
            // once and up slowly, so that a tremor of fast modes does not stall the slow ones.
            if window.stiffness > 0.0 && iteration > 0 {
                slowest = (window.stiffness / window.mass).sqrt().min(RISE * slowest);
                damping = 2.0 * slowest;
            }
            window = Quotient::default();
        }
    }
    Err(RelaxationError::Slow { report, tolerance: setup.tolerance })
}

/// What a node has in fictitious time besides its motion relative to the hub.
#[derive(Clone, Copy, Debug, Default)]
struct Fictitious {
    force_before: [f64; 3],
    mass: f64,
}

/// v . K v and v . M~ v of the last step's motion (the Rayleigh quotient), and the centrifugal
/// force in z, of a chunk.
#[derive(Clone, Copy, Debug, Default)]
struct Quotient {
    stiffness: f64,
    mass: f64,
    pull: f64,
}

/// The coefficients of a damped step.
#[derive(Clone, Copy)]
struct Damped {
    keep: f64,
    kick: f64,
}

/// The `n` nodes at rest relative to the hub, the upper body moved by the start.
fn nodes_at_start(setup: &Relaxation<'_>, n: usize) -> NodalState<Quotient> {
    let mut u = vec![Padded::ZERO; n];
    u[setup.upper.clone()].iter_mut().for_each(|u| u.0[2] = setup.start);
    let mut inverse_mass: Vec<f64> = setup.mass[..n].iter().map(|m| 1.0 / m).collect();
    let still = setup.held.iter().chain(&setup.hub.nodes);
    still.for_each(|&i| inverse_mass[i as usize] = 0.0);
    NodalState::new(u, vec![Padded::ZERO; n], inverse_mass)
}

/// Sets the forces to the centrifugal force of the upper body's masses and to zero elsewhere (N); returns
/// its resultant in z, that of the counterweight with it.
fn centrifugal(
    nodes: &mut NodalState<Quotient>,
    setup: &Relaxation<'_>,
    reference: &[Padded],
    hub: f64,
) -> f64 {
    let centre = setup.hub.centre;
    let spin = Centrifugal { axis: [centre.x, centre.z + hub], omega: setup.omega };
    nodes.chunks().for_each(|Chunk { u, f, first, sums, .. }| {
        sums.pull = 0.0;
        for (i, (f, u)) in (first..).zip(f.iter_mut().zip(u)) {
            *f = Padded::ZERO;
            if setup.upper.contains(&i) {
                *f = spin.force(setup.mass[i], reference[i], *u);
                sums.pull += f.0[2];
            }
        }
    });
    setup.omega * setup.omega * setup.hub.counterweight[1] + nodes.sum(|p| p.pull).value()
}

/// One damped step of all nodes; the upper body moves with the hub by `shift` besides.
fn advance(
    nodes: &mut NodalState<Quotient>,
    fictitious: &mut [Fictitious],
    damped: Damped,
    upper: &std::ops::Range<usize>,
    shift: f64,
) {
    let Damped { keep, kick } = damped;
    nodes.chunks().zip(fictitious.par_chunks_mut(CHUNK)).for_each(|(chunk, fictitious)| {
        let Chunk { u, v, f, inverse_mass, first, sums } = chunk;
        *sums = Quotient::default();
        let moved = u.iter_mut().zip(v).zip(f.iter().zip(inverse_mass));
        for (i, (((u, v), (f, w)), node)) in (first..).zip(moved.zip(fictitious)) {
            // others are held or go with the hub
            if *w > 0.0 {
                let push = kick / node.mass;
                for k in 0..3 {
                    let before = v.0[k];
                    sums.stiffness += before * (node.force_before[k] - f.0[k]);
                    sums.mass += node.mass * before * before;
                    node.force_before[k] = f.0[k];
                    v.0[k] = keep * before + push * f.0[k];
                    u.0[k] += v.0[k];
                }
            }
            if upper.contains(&i) {
                u.0[2] += shift;
            }
        }
    });
}

/// Stiffness (N/m) of the closed contact against moving the upper body as a whole in z.
fn contact_stiffness(contact: &PenaltyContact, upper: &std::ops::Range<usize>, n: usize) -> f64 {
    let mut lift = vec![Padded::ZERO; n];
    lift[upper.clone()].fill(Padded::new([0.0, 0.0, 1.0]));
    let mut force = vec![Padded::ZERO; n];
    contact.stiffness_product(&lift, &mut force);
    exact_sum::sum(force[upper.clone()].iter().map(|f| f.0[2]))
}

/// The hub's vertical motion in fictitious time.
struct HubMotion {
    z: f64,
    v: f64,
    mass: f64,
    force_before: f64,
}
