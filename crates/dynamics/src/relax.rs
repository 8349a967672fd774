//! Dynamic relaxation to the preload: equilibrium under the load, before rolling.
//!
//! Central difference in a fictitious time with unit step (Underwood 1983): nodal masses M~ with
//! M~ >= K/4, from element and contact stiffness bounds, make the unit step stable and all
//! elements equally fast; the damping is the critical one of the slowest mode in motion,
//! c = 2 sqrt(v.K v/v.M~ v), with K v taken from the change of the force.
//!
//! The disk moves relative to the hub, and the hub is a coordinate of its own with a mass that
//! fits the contact springs: else the slowest mode would be all the disk's fictitious mass, far
//! above its true one, rocking on the contact.

use crate::hub::Hub;
use contact::{ContactSums, PenaltyContact};
use mesh::Padded;
use rayon::prelude::*;
use solid::Solid;
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
    /// Nodes of the disk.
    pub disk: std::ops::Range<usize>,
    /// Angular velocity whose centrifugal force acts on the disk (rad/s).
    pub omega: f64,
    /// True lumped masses (kg).
    pub mass: &'a [f64],
    /// Largest eigenvalue of the element stiffnesses summed at each node (N/m).
    pub stiffness: &'a [f64],
    /// Displacement of the disk in z at the start (m), negative where it is pressed down.
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
    /// |load, contact and centrifugal force on hub and disk together|/load.
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

/// Acceleration of a hub whose disk does not touch yet (m per iteration squared).
const FALL: f64 = 1e-6;

/// Largest growth of the estimated slowest frequency from one check to the next.
const RISE: f64 = 1.005;

/// Nodes per parallel chunk; fixed, so that partial sums do not depend on the threads.
const CHUNK: usize = 4096;

/// Relaxes from the undeformed state, the disk moved by `setup.start`; returns the displacements.
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
    // The hub with its nodes is a rigid body whose centre of mass lies on the axis.
    let mut spun = setup.mass[..n].to_vec();
    setup.hub.nodes.iter().for_each(|&i| spun[i as usize] = 0.0);
    let mut nodes: Vec<Node> = vec![Node::default(); n];
    for &i in setup.held.iter().chain(&setup.hub.nodes) {
        nodes[i as usize].fixed = true;
    }
    let mut u = vec![Padded::ZERO; n];
    u[setup.disk.clone()].iter_mut().for_each(|u| u.0[2] = setup.start);
    let mut force = vec![Padded::ZERO; n];
    let mut hub = HubMotion { z: setup.start, v: 0.0, mass: 0.0, force_before: 0.0 };
    let (mut contact_bound, mut spring) = (vec![0.0; n], 0.0);
    let mut report = RelaxationReport::default();
    let (mut slowest, mut damping) = (1.0f64, 0.0);
    let mut window = Quotient::default();
    let mut partial = vec![Quotient::default(); n.div_ceil(CHUNK)];
    for iteration in 0..setup.max_iterations {
        let check = iteration % CHECK == 0;
        let pull = centrifugal(setup, &spun, &reference, &u, hub.z, &mut force, &mut partial);
        let sums = solid.subtract_elastic_force(&u, &mut force, check);
        let touching: ContactSums = contact.apply_frictionless(&reference, &u, &mut force);
        if check {
            // Pairs close while the bodies settle: the bounds only grow.
            let mut bound = vec![0.0; n];
            contact.nodal_stiffness_bound(&mut bound);
            for (i, node) in nodes.iter_mut().enumerate() {
                contact_bound[i] = f64::max(contact_bound[i], bound[i]);
                node.mass = NODE_SHARE * (setup.stiffness[i] + contact_bound[i]);
            }
            // Until bodies touch, the load moves the hub by FALL per iteration squared.
            spring = f64::max(spring, contact_stiffness(contact, &setup.disk, n));
            hub.mass = if spring > 0.0 { HUB_SHARE * spring } else { setup.load / FALL };
        }
        // The disk's internal forces cancel: what moves the hub is load, contact and spin.
        let hub_force = touching.force[0][2] + pull - setup.load;
        let mut motion = Quotient {
            stiffness: hub.v * (hub.force_before - hub_force),
            mass: hub.mass * hub.v * hub.v,
            pull: 0.0,
        };
        let keep = (2.0 - damping) / (2.0 + damping);
        let kick = 2.0 / (2.0 + damping);
        hub.v = keep * hub.v + kick * hub_force / hub.mass;
        hub.z += hub.v;
        hub.force_before = hub_force;
        advance(setup, keep, kick, hub.v, &mut nodes, &mut u, &force, &mut partial);
        motion.stiffness += exact_sum::sum(partial.iter().map(|p| p.stiffness));
        motion.mass += exact_sum::sum(partial.iter().map(|p| p.mass));
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
                return Ok((u, report));
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

/// A node's motion relative to the hub, in fictitious time.
#[derive(Clone, Copy, Debug, Default)]
struct Node {
    v: [f64; 3],
    force_before: [f64; 3],
    mass: f64,
    fixed: bool,
}

/// v . K v and v . M~ v of the last step's motion (the Rayleigh quotient), and the centrifugal
/// force in z, of a chunk.
#[derive(Clone, Copy, Debug, Default)]
struct Quotient {
    stiffness: f64,
    mass: f64,
    pull: f64,
}

/// Sets `force` to the centrifugal force of the disk's masses and to zero elsewhere (N); returns
/// its resultant in z.
fn centrifugal(
    setup: &Relaxation<'_>,
    mass: &[f64],
    reference: &[Padded],
    u: &[Padded],
    hub: f64,
    force: &mut [Padded],
    partial: &mut [Quotient],
) -> f64 {
    let squared = setup.omega * setup.omega;
    let axis = [setup.hub.centre[0], setup.hub.centre[2] + hub];
    force.par_chunks_mut(CHUNK).zip(partial.par_iter_mut()).enumerate().for_each(
        |(chunk, (force, sum))| {
            sum.pull = 0.0;
            for (k, f) in force.iter_mut().enumerate() {
                let i = chunk * CHUNK + k;
                *f = Padded::ZERO;
                if setup.disk.contains(&i) {
                    let pull = mass[i] * squared;
                    f.0[0] = pull * (reference[i].0[0] + u[i].0[0] - axis[0]);
                    f.0[2] = pull * (reference[i].0[2] + u[i].0[2] - axis[1]);
                    sum.pull += f.0[2];
                }
            }
        },
    );
    exact_sum::sum(partial.iter().map(|p| p.pull))
}

/// One damped step of all nodes; the disk moves with the hub by `shift` besides.
fn advance(
    setup: &Relaxation<'_>,
    keep: f64,
    kick: f64,
    shift: f64,
    nodes: &mut [Node],
    u: &mut [Padded],
    force: &[Padded],
    partial: &mut [Quotient],
) {
    nodes
        .par_chunks_mut(CHUNK)
        .zip(u.par_chunks_mut(CHUNK))
        .zip(force.par_chunks(CHUNK))
        .zip(partial.par_iter_mut())
        .enumerate()
        .for_each(|(chunk, (((nodes, u), force), sum))| {
            *sum = Quotient::default();
            for (k, ((node, u), f)) in nodes.iter_mut().zip(u).zip(force).enumerate() {
                if !node.fixed {
                    let push = kick / node.mass;
                    for i in 0..3 {
                        let v = node.v[i];
                        sum.stiffness += v * (node.force_before[i] - f.0[i]);
                        sum.mass += node.mass * v * v;
                        node.force_before[i] = f.0[i];
                        node.v[i] = keep * v + push * f.0[i];
                        u.0[i] += node.v[i];
                    }
                }
                if setup.disk.contains(&(chunk * CHUNK + k)) {
                    u.0[2] += shift;
                }
            }
        });
}

/// Stiffness (N/m) of the closed contact against moving the disk as a whole in z.
fn contact_stiffness(contact: &PenaltyContact, disk: &std::ops::Range<usize>, n: usize) -> f64 {
    let mut lift = vec![Padded::ZERO; n];
    lift[disk.clone()].fill(Padded::new([0.0, 0.0, 1.0]));
    let mut force = vec![Padded::ZERO; n];
    contact.stiffness_product(&lift, &mut force);
    exact_sum::sum(force[disk.clone()].iter().map(|f| f.0[2]))
}

/// The hub's vertical motion in fictitious time.
struct HubMotion {
    z: f64,
    v: f64,
    mass: f64,
    force_before: f64,
}
