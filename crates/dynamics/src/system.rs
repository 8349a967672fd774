//! The discrete equation of motion that an integrator steps:
//! `M a = -f_int(u, v) + f_boundary(t, v) + f_contact`, with the constraints of nodes that are held, fixed in a
//! direction, paired, or carried by the hub.

use crate::dashpots::{Dashpots, RigidMotion};
use crate::hub::Hub;
use crate::load::{Fixed, Load};
use crate::paired;
use crate::quiet::{QuietEnd, QuietWork};
use contact::{Contact, ContactSums, FreeMotion, Motion};
use mesh::Padded;
use solid::{ForceSums, Solid};
use std::time::{Duration, Instant};

/// Elastic bodies with their contact, and what holds, presses and moves them.
pub struct System {
    /// The elements.
    pub solid: Solid,
    /// The contact of the two bodies; none for a free body.
    pub contact: Option<Box<dyn Contact>>,
    /// The hub; none for a free body.
    pub hub: Option<Hub>,
    /// The quiet ends; empty for none.
    pub quiet: QuietEnd,
    /// Nodes that never move.
    pub held: Vec<u32>,
    /// Nodes that do not move in some directions. With mass-proportional damping such a direction
    /// must be one in which the body's rigid motion has no part.
    pub fixed: Vec<Fixed>,
    /// Pairs of nodes of equal mass that move as one, ascending by the first: of contact the first decides.
    pub paired: Vec<[u32; 2]>,
    /// Given forces; empty for none.
    pub load: Load,
    /// Nodes of the disk, whose rigid motion is the hub's.
    pub disk: std::ops::Range<usize>,
    /// Lumped masses (kg).
    pub mass: Vec<f64>,
    /// Mass-proportional damping relative to the rigid motion (1/s).
    pub mass_damping: f64,
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
            disk: 0..0,
            mass,
            mass_damping: 0.0,
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

    /// Subtracts the internal force (viscous parts with `v^{n-1/2}`) from `force`. Beside it contact follows
    /// the surfaces, for the time that is returned.
    pub(crate) fn subtract_internal_force(
        &mut self,
        motion: &Motion<'_>,
        force: &mut [Padded],
        energies: bool,
    ) -> (ForceSums, Duration) {
        let contact = &mut self.contact;
        self.solid.subtract_internal_force_beside(
            motion.displacement,
            motion.velocity,
            force,
            energies,
            |reference| {
                let start = Instant::now();
                if let Some(contact) = contact {
                    contact.follow(&Motion { reference, ..*motion });
                }
                start.elapsed()
            },
        )
    }

    /// Adds given forces and those of the quiet ends.
    pub(crate) fn add_boundary_force(
        &self,
        motion: &Motion<'_>,
        force: &mut [Padded],
    ) -> QuietWork {
        // a support bears the body's own force; a given one reaches contact first
        Fixed::clear(&self.fixed, force);
        self.load.apply(motion.time, force);
        let work = self.quiet.apply(motion.velocity, motion.inverse_mass, motion.dt, force);
        paired::share(&self.paired, force);
        work
    }

    /// Adds the contact forces to `force`, which holds all other ones. `free` gives a node's velocity after
    /// the step under a force.
    pub(crate) fn add_contact_force(
        &mut self,
        motion: &Motion<'_>,
        free: impl Fn(u32, [f64; 3], Option<&Dashpots<'_>>) -> [f64; 3] + Sync,
        force: &mut [Padded],
    ) -> ContactSums {
        let dashpots = dashpots(self.mass_damping, &self.disk, self.hub.as_ref(), &self.solid);
        let sums = match &mut self.contact {
            Some(contact) => {
                let motion = Motion { reference: self.solid.reference(), ..*motion };
                let free_motion = FreeMotion {
                    velocity: &|node, force| free(node, force, dashpots.as_ref()),
                    inverse_mass: motion.inverse_mass,
                };
                let sums = contact.apply(&motion, &free_motion, force);
                contact.follow_first(&self.paired);
                sums
            }
            None => ContactSums::default(),
        };
        paired::follow(&self.paired, force);
        Fixed::clear(&self.fixed, force);
        sums
    }

    /// The dashpots of mass-proportional damping, if there is any.
    pub(crate) fn dashpots(&self) -> Option<Dashpots<'_>> {
        dashpots(self.mass_damping, &self.disk, self.hub.as_ref(), &self.solid)
    }

    /// `y += K x` with the stiffness of the undeformed elements and of the contact springs that are closed
    /// (N), for small `x` (m).
    pub(crate) fn add_tangent_product(&mut self, x: &[Padded], y: &mut [Padded]) {
        self.solid.add_stiffness_product(x, y);
        if let Some(contact) = &self.contact {
            contact.add_stiffness_product(x, y);
        }
    }
}

fn dashpots<'a>(
    alpha: f64,
    disk: &std::ops::Range<usize>,
    hub: Option<&Hub>,
    solid: &'a Solid,
) -> Option<Dashpots<'a>> {
    (alpha > 0.0).then(|| Dashpots {
        alpha,
        disk: disk.clone(),
        reference: solid.reference(),
        motion: hub.map(RigidMotion::new),
    })
}
