//! The discrete equation of motion that an integrator steps:
//! `M a = -f_int(u, v) + f_boundary(t, v) + f_contact`, with the constraints of nodes that are held, fixed in a
//! direction, paired, or carried by the hub.

use crate::dashpots::{Dashpots, RigidMotion};
use crate::hub::Hub;
use crate::load::{Fixed, Load};
use crate::nodal_state::{NodalState, TraceNode};
use crate::paired;
use crate::quiet::{QuietEnd, QuietWork};
use contact::{ContactSums, Method};
use exact_sum::ExactSum;
use mesh::Padded;
use nalgebra::Vector3;
use solid::{ForceSums, Solid};
use std::time::{Duration, Instant};

/// Elastic bodies with their contact, and what holds, presses and moves them.
pub struct System {
    /// The elements.
    pub solid: Solid,
    /// The contact of the two bodies; none for a free body.
    pub contact: Option<Method>,
    /// The hub; none for a free body.
    pub hub: Option<Hub>,
    /// The quiet ends; empty for none.
    pub quiet: QuietEnd,
    /// Nodes that never move.
    pub held: Vec<u32>,
    /// Nodes that do not move in some directions. With mass-proportional damping such a direction
    /// must be one in which the body's rigid motion has no part.
    pub fixed: Vec<Fixed>,
    /// Pairs of nodes of equal mass that move as one, ascending by the first, which may have several: of contact the first decides.
    pub paired: Vec<[u32; 2]>,
    /// Given forces; empty for none.
    pub load: Load,
    /// What the upper and the lower body are called where the guards speak of them.
    pub names: [&'static str; 2],
    /// Nodes of the upper body, whose rigid motion is the hub's.
    pub upper: std::ops::Range<usize>,
    /// Lumped masses (kg).
    pub mass: Vec<f64>,
    /// Mass-proportional damping relative to the rigid motion (1/s).
    pub mass_damping: f64,
    /// How many parts alike make up the bodies, of which this is one: 2 for half a symmetric model. Forces, works and
    /// energies are reported of all of them.
    pub multiplicity: f64,
}

impl System {
    /// Free bodies with these lumped masses (kg): nothing holds, presses or damps them.
    pub fn free(solid: Solid, mass: Vec<f64>) -> Self {
        Self {
            solid,
            contact: None,
            hub: None,
            quiet: QuietEnd::default(),
            held: Vec::new(),
            fixed: Vec::new(),
            paired: Vec::new(),
            load: Load::default(),
            names: ["upper body", "lower body"],
            upper: 0..0,
            mass,
            mass_damping: 0.0,
            multiplicity: 1.0,
        }
    }

    /// Inverse lumped masses (1/kg), zero for nodes that are held or carried by the hub.
    pub(crate) fn inverse_mass(&self) -> Vec<f64> {
        let mut inverse: Vec<f64> = self.mass.iter().map(|m| 1.0 / m).collect();
        let carried = self.hub.iter().flat_map(|h| &h.nodes);
        self.held.iter().chain(carried).for_each(|&n| inverse[n as usize] = 0.0);
        inverse
    }

    /// Brings displacements and velocities in line with the constraints, and leaves fixed directions of
    /// quiet ends to their supports.
    pub(crate) fn constrain(&mut self, displacement: &mut [Padded], velocity: &mut [Padded]) {
        self.held.iter().for_each(|&n| velocity[n as usize] = Padded::ZERO);
        Fixed::clear(&self.fixed, velocity);
        paired::follow(&self.paired, velocity);
        paired::follow(&self.paired, displacement);
        self.quiet.release(&self.fixed);
    }

    /// Subtracts the internal force (viscous parts with `v^{n-1/2}`) from the forces. Beside it contact follows
    /// the surfaces to `time` with the step `dt` (s), for the time that is returned.
    pub(crate) fn subtract_internal_force(
        &mut self,
        nodes: &mut NodalState,
        [time, dt]: [f64; 2],
        energies: bool,
    ) -> (ForceSums<ExactSum>, Duration) {
        let NodalState { displacement, velocity, force, trace, .. } = nodes;
        let (displacement, velocity) = (&*displacement, &*velocity);
        let contact = &mut self.contact;
        let follow = || {
            let start = Instant::now();
            if let (Some(contact), Some(trace)) = (contact, trace) {
                trace.gather_positions(displacement);
                trace.gather_velocities(velocity);
                contact.follow(&trace.motion(time, dt));
            }
            start.elapsed()
        };
        let solid = &mut self.solid;
        solid.subtract_internal_force_beside(displacement, velocity, force, energies, follow)
    }

    /// Adds given forces and those of the quiet ends at `time` with the step `dt` (s). The work is that of the nodes that
    /// `counts`.
    pub(crate) fn add_boundary_force(
        &self,
        nodes: &mut NodalState,
        [time, dt]: [f64; 2],
        counts: impl Fn(u32) -> bool,
    ) -> QuietWork<ExactSum> {
        let force = &mut nodes.force;
        // a support bears the body's own force; a given one reaches contact first
        Fixed::clear(&self.fixed, force);
        self.load.apply(time, force);
        let work = self.quiet.apply(&nodes.velocity, &nodes.inverse_mass, dt, force, counts);
        paired::share(&self.paired, force);
        work
    }

    /// Adds the contact forces of the step from `time` with `dt` (s) to all other ones. `free` gives the velocity
    /// (m/s) of a node after the step under a force (N).
    pub(crate) fn add_contact_force(
        &mut self,
        nodes: &mut NodalState,
        time_and_step: [f64; 2],
        free: impl Fn(&TraceNode, Vector3<f64>) -> Vector3<f64> + Sync,
    ) -> ContactSums {
        let sums = match &mut self.contact {
            Some(contact) => {
                let sums = nodes.add_contact_force(&mut **contact, time_and_step, free);
                contact.follow_first(&self.paired);
                sums
            }
            None => ContactSums::default(),
        };
        paired::follow(&self.paired, &mut nodes.force);
        Fixed::clear(&self.fixed, &mut nodes.force);
        sums
    }

    /// The dashpots of mass-proportional damping as the hub moves now, if there is any.
    pub(crate) fn dashpots(&self) -> Option<Dashpots> {
        (self.mass_damping > 0.0).then(|| Dashpots {
            alpha: self.mass_damping,
            upper: self.upper.clone(),
            motion: self.hub.as_ref().map(RigidMotion::new),
        })
    }

    /// `y += K x` with the stiffness of the undeformed elements and of the contact springs that are closed
    /// (N), for small `x` (m).
    pub(crate) fn add_tangent_product(&mut self, x: &[Padded], y: &mut [Padded]) {
        self.solid.add_stiffness_product(x, y);
        if let Some(Method::Penalty(springs)) = &self.contact {
            springs.stiffness_product(x, y);
        }
    }
}
