//! Central difference with half-step velocities and lumped mass:
//! `v^{n+1/2} = v^{n-1/2} + dt M^-1 f^n`, `u^{n+1} = u^n + dt v^{n+1/2}`.

use crate::hub::{HubWork, Resultant};
use crate::ledger::{Energies, Works};
use crate::nodal_state::NodalState;
use crate::nodes::{Update, free_velocity};
use crate::share::Share;
use crate::simulation::{Simulation, StepReport};
use crate::step_sums::StepSums;
use contact::ContactSums;
use std::time::{Duration, Instant};

/// Whether a process counts a node: its own, where several share them.
fn counted(share: Option<&Share>) -> impl Fn(u32) -> bool + '_ {
    move |node| share.is_none_or(|share| share.owns(node))
}

impl Simulation {
    /// One step from t^n to t^{n+1}, explicit unless [set](Self::set_implicit) otherwise. With `read` the energies at t^n enter the
    /// ledger.
    pub fn step(&mut self, read: bool) -> StepReport {
        if self.implicit.is_some() {
            return self.implicit_step(read);
        }

        let (n, dt) = (self.step, self.dt);
        let time = n as f64 * dt;
        let start = Instant::now();

        let (system, nodes, mut share) = (&mut self.system, &mut self.nodes, self.share.as_mut());
        if let Some(share) = &mut share {
            share.begin_step(read);
        }
        let mut sums = StepSums::default();
        let following;
        (sums.elements, following) = system.subtract_internal_force(nodes, [time, dt], read);
        let internal = Instant::now();

        sums.quiet = system.add_boundary_force(nodes, [time, dt], counted(share.as_deref()));
        sums.given = system.load.full_power(&nodes.velocity, counted(share.as_deref()));
        let bounded = Instant::now();

        if let Some(share) = &mut share {
            share.send_forces(&mut nodes.force);
        }
        let dashpots = system.dashpots();
        let contact = system.add_contact_force(nodes, [time, dt], |node, force| {
            free_velocity(node, force, dt, dashpots.as_ref())
        });
        if let Some(hub) = &system.hub {
            let counts = counted(share.as_deref());
            sums.load = hub.resultant_sums(&nodes.displacement, &nodes.force, counts);
        }
        let contacted = Instant::now();
        let for_forces = share.as_mut().map_or(Duration::ZERO, |share| share.take_waited());

        let update = Update {
            dt,
            kinetic: read,
            dashpots: dashpots.as_ref(),
            reference: system.solid.reference(),
            level: system.solid.level(),
        };
        match &mut share {
            None => nodes.advance(&update, None),
            Some(share) => {
                let contact = system.contact.as_deref();
                let advance = |nodes: &mut NodalState, chunks: &[bool]| {
                    nodes.advance(&update, Some(chunks));
                };
                share.advance(nodes, contact, dt, advance);
            }
        }
        nodes.take_sums(&update, &mut sums);
        if let Some(share) = &mut share {
            share.add_up(&mut sums);
        }
        let omega_before = system.hub.as_ref().map_or(0.0, |h| h.state.omega);
        let hub = match &mut system.hub {
            Some(hub) => {
                let mut load = Resultant::of(&sums.load);
                load.add(&Resultant::of(&sums.reaction));
                hub.step(time, dt, &load, &mut nodes.displacement, &mut nodes.velocity)
            }
            None => HubWork::default(),
        };
        let given = system.load.fraction(time);
        let given_before = 0.5 * dt * (given * sums.given.value());
        let mut given_after = system.load.full_power(&nodes.velocity, counted(share.as_deref()));
        if let Some(share) = &mut share
            && !system.load.forces.is_empty()
        {
            share.add_up_one(&mut given_after);
        }
        let given_after = 0.5 * dt * (given * given_after.value());
        let moved = Instant::now();
        let for_nodes = share.as_mut().map_or(Duration::ZERO, |share| share.take_waited());

        let given = [given_before, given_after];
        let energies = self.book(&sums, &contact, &hub, given, read);

        let following = following / rayon::current_num_threads() as u32;
        self.timers.internal_force += (internal - start).saturating_sub(following);
        self.timers.boundary += bounded - internal;
        self.timers.contact += contacted - bounded + following - for_forces;
        self.timers.nodes += moved - contacted - for_nodes;
        self.timers.exchange += for_forces + for_nodes;
        self.step += 1;
        let multiplicity = self.system.multiplicity;
        let (drive, omega) = match &self.system.hub {
            Some(h) => (h.reaction.times(multiplicity), 0.5 * (omega_before + h.state.omega)),
            None => Default::default(),
        };
        let contact = contact.times(multiplicity);
        StepReport { step: n, time, contact, energies, drive, omega, unsolved: None }
    }

    /// Books the works of a step of the whole bodies, those of `given` forces (J) before and after the full step; the energies there
    /// if they are `read`.
    fn book(
        &mut self,
        sums: &StepSums,
        contact: &ContactSums,
        hub: &HubWork,
        given: [f64; 2],
        read: bool,
    ) -> Option<Energies> {
        let (dt, multiplicity) = (self.dt, self.system.multiplicity);
        let (quiet, elements) = (sums.quiet.value(), sums.elements.value());
        let viscous = 0.5 * dt * (elements.viscous_power + sums.dashpot_power.value());
        self.ledger.add(&Works {
            friction: multiplicity * contact.friction_work,
            damping: multiplicity * (contact.damping_work + viscous + quiet.dissipated_before),
            contact_damping: multiplicity * contact.damping_work,
            external: multiplicity * (hub.before + quiet.external_before + given[0]),
        });
        let energies = read.then(|| {
            let now = Energies {
                kinetic: multiplicity * (sums.kinetic.value() + hub.kinetic),
                internal: multiplicity * elements.internal,
                hourglass: multiplicity * elements.hourglass,
                contact_stored: multiplicity * (contact.stored_normal + contact.stored_tangential),
                friction_dissipated: self.ledger.friction,
                damping_dissipated: self.ledger.damping,
                contact_damping: self.ledger.contact_damping,
                external_work: self.ledger.external,
            };
            self.ledger.read(&now);
            now
        });
        self.ledger.add(&Works {
            friction: multiplicity * contact.friction_ahead,
            damping: multiplicity * (contact.damping_ahead + viscous + quiet.dissipated_after),
            contact_damping: multiplicity * contact.damping_ahead,
            external: multiplicity * (hub.after + quiet.external_after + given[1]),
        });
        energies
    }
}
