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
    /// |normal force - load|/load.
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
    let mut fixed = vec![false; n];
    setup.held.iter().chain(&setup.hub.nodes).for_each(|&i| fixed[i as usize] = true);
    let mut u = vec![Padded::ZERO; n];
    u[setup.disk.clone()].iter_mut().for_each(|u| u.0[2] = setup.start);
    let mut v = vec![Padded::ZERO; n];
    let (mut f, mut before) = (v.clone(), v.clone());
    let mut hub = HubMotion { z: setup.start, v: 0.0, mass: 0.0, force_before: 0.0 };
    let mut contact_bound = vec![0.0; n];
    let mut mass = vec![0.0; n];
    let mut report = RelaxationReport::default();
    let mut damping = 0.0;
    let axis = [setup.hub.centre[0], setup.hub.centre[2]];
    for iteration in 0..setup.max_iterations {
        let check = iteration % CHECK == 0;
        f.fill(Padded::ZERO);
        let sums = solid.subtract_internal_force(&u, &v, &mut f, check);
        let squared = setup.omega * setup.omega;
        for i in setup.disk.clone() {
            let pull = setup.mass[i] * squared;
            f[i].0[0] += pull * (reference[i].0[0] + u[i].0[0] - axis[0]);
            f[i].0[2] += pull * (reference[i].0[2] + u[i].0[2] - axis[1] - hub.z);
        }
        let touching: ContactSums = contact.apply_frictionless(&reference, &u, &mut f);
        if check {
            // Pairs close while the bodies settle: the bounds only grow.
            let mut bound = vec![0.0; n];
            contact.nodal_stiffness_bound(&mut bound);
            for i in 0..n {
                contact_bound[i] = f64::max(contact_bound[i], bound[i]);
                mass[i] = NODE_SHARE * (setup.stiffness[i] + contact_bound[i]);
            }
            let spring = contact_stiffness(contact, &setup.disk, n);
            hub.mass = hub.mass.max(HUB_SHARE * spring);
        }
        let hub_force: f64 = f[setup.disk.clone()].iter().map(|f| f.0[2]).sum::<f64>() - setup.load;

        // Rayleigh quotient of the motion of the last step
        let (mut vkv, mut vmv) = (hub.v * (hub.force_before - hub_force), hub.mass * hub.v * hub.v);
        for i in 0..n {
            if !fixed[i] {
                for k in 0..3 {
                    vkv += v[i].0[k] * (before[i].0[k] - f[i].0[k]);
                    vmv += mass[i] * v[i].0[k] * v[i].0[k];
                }
            }
        }
        if check {
            report = RelaxationReport {
                iterations: iteration,
                kinetic_ratio: 0.5 * vmv / sums.internal,
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
        if vmv > 0.0 {
            damping = 2.0 * (vkv / vmv).max(0.0).sqrt();
        }
        let keep = (2.0 - damping) / (2.0 + damping);
        let kick = 2.0 / (2.0 + damping);
        hub.v = keep * hub.v + kick * hub_force / hub.mass;
        hub.z += hub.v;
        hub.force_before = hub_force;
        for i in 0..n {
            if !fixed[i] {
                let push = kick / mass[i];
                for k in 0..3 {
                    v[i].0[k] = keep * v[i].0[k] + push * f[i].0[k];
                    u[i].0[k] += v[i].0[k];
                }
            }
        }
        u[setup.disk.clone()].iter_mut().for_each(|u| u.0[2] += hub.v);
        std::mem::swap(&mut before, &mut f);
    }
    Err(RelaxationError::Slow { report, tolerance: setup.tolerance })
}

/// Stiffness (N/m) of the closed contact against moving the disk as a whole in z.
fn contact_stiffness(contact: &PenaltyContact, disk: &std::ops::Range<usize>, n: usize) -> f64 {
    let mut lift = vec![Padded::ZERO; n];
    lift[disk.clone()].fill(Padded::new([0.0, 0.0, 1.0]));
    let mut force = vec![Padded::ZERO; n];
    contact.stiffness_product(&lift, &mut force);
    force[disk.clone()].iter().map(|f| f.0[2]).sum()
}

/// The hub's vertical motion in fictitious time.
struct HubMotion {
    z: f64,
    v: f64,
    mass: f64,
    force_before: f64,
}
