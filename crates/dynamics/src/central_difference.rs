//! Central difference with half-step velocities and lumped mass:
//! `v^{n+1/2} = v^{n-1/2} + dt M^-1 f^n`, `u^{n+1} = u^n + dt v^{n+1/2}`.

use crate::hub::HubWork;
use crate::ledger::{Energies, Works};
use crate::nodes::{Update, free_velocity};
use crate::simulation::{Simulation, StepReport};
use std::time::Instant;

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

        let (system, nodes) = (&mut self.system, &mut self.nodes);
        let (sums, following) = system.subtract_internal_force(nodes, [time, dt], read);
        let internal = Instant::now();

        let quiet = system.add_boundary_force(nodes, [time, dt]);
        let given_before = 0.5 * dt * system.load.power(time, &nodes.velocity);
        let bounded = Instant::now();

        let dashpots = system.dashpots();
        let contact = system.add_contact_force(nodes, [time, dt], |node, force| {
            free_velocity(node, force, dt, dashpots.as_ref())
        });
        let load = system.hub.as_ref().map(|hub| hub.resultant(&nodes.displacement, &nodes.force));
        let contacted = Instant::now();

        let updated = nodes.advance(&Update {
            dt,
            kinetic: read,
            dashpots: dashpots.as_ref(),
            reference: system.solid.reference(),
            level: system.solid.level(),
        });
        let omega_before = system.hub.as_ref().map_or(0.0, |h| h.state.omega);
        let hub = match (&mut system.hub, load) {
            (Some(hub), Some(load)) => {
                let mut load = load;
                load.add(&updated.reaction);
                hub.step(time, dt, &load, &mut nodes.displacement, &mut nodes.velocity)
            }
            _ => HubWork::default(),
        };
        let given_after = 0.5 * dt * system.load.power(time, &nodes.velocity);
        let moved = Instant::now();

        // from here on of the whole bodies
        let multiplicity = system.multiplicity;
        let viscous = 0.5 * dt * (sums.viscous_power + updated.dashpot_power);
        self.ledger.add(&Works {
            friction: multiplicity * contact.friction_work,
            damping: multiplicity * (contact.damping_work + viscous + quiet.dissipated_before),
            contact_damping: multiplicity * contact.damping_work,
            external: multiplicity * (hub.before + quiet.external_before + given_before),
        });
        let energies = read.then(|| {
            let now = Energies {
                kinetic: multiplicity * (updated.kinetic + hub.kinetic),
                internal: multiplicity * sums.internal,
                hourglass: multiplicity * sums.hourglass,
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
            external: multiplicity * (hub.after + quiet.external_after + given_after),
        });

        let following = following / rayon::current_num_threads() as u32;
        self.timers.internal_force += (internal - start).saturating_sub(following);
        self.timers.boundary += bounded - internal;
        self.timers.contact += contacted - bounded + following;
        self.timers.nodes += moved - contacted;
        self.step += 1;
        let (drive, omega) = match &system.hub {
            Some(h) => (h.reaction.times(multiplicity), 0.5 * (omega_before + h.state.omega)),
            None => Default::default(),
        };
        let contact = contact.times(multiplicity);
        StepReport { step: n, time, contact, energies, drive, omega, unsolved: None }
    }
}
