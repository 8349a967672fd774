//! Central difference with half-step velocities and lumped mass:
//! `v^{n+1/2} = v^{n-1/2} + dt M^-1 f^n`, `u^{n+1} = u^n + dt v^{n+1/2}`.

use crate::hub::HubWork;
use crate::ledger::{Energies, Works};
use crate::nodes;
use crate::simulation::{Simulation, StepReport};
use contact::Motion;
use std::time::Instant;

impl Simulation {
    /// One step from t^n to t^{n+1}. With `read` the energies at t^n enter the ledger.
    pub fn step(&mut self, read: bool) -> StepReport {
        let (n, dt) = (self.step, self.dt);
        let time = n as f64 * dt;
        let start = Instant::now();

        let system = &mut self.system;
        let motion = Motion {
            reference: &[],
            displacement: &self.displacement,
            velocity: &self.velocity,
            inverse_mass: &self.inverse_mass,
            time,
            dt,
        };
        let (sums, following) = system.subtract_internal_force(&motion, &mut self.force, read);
        let internal = Instant::now();

        let quiet = system.add_boundary_force(&motion, &mut self.force);
        let given_before = 0.5 * dt * system.load.power(time, &self.velocity);
        let bounded = Instant::now();

        let (velocity, inverse_mass) = (&self.velocity, &self.inverse_mass);
        let contact = system.add_contact_force(
            &motion,
            |node, force, dashpots| {
                let i = node as usize;
                nodes::free_velocity(i, velocity[i].xyz(), force, inverse_mass[i], dt, dashpots)
            },
            &mut self.force,
        );
        let load = system.hub.as_ref().map(|hub| hub.resultant(&self.displacement, &self.force));
        let contacted = Instant::now();

        let nodes = nodes::advance(
            &mut self.displacement,
            &mut self.velocity,
            &mut self.force,
            &self.inverse_mass,
            dt,
            read,
            system.dashpots().as_ref(),
            &mut self.partial,
            system.solid.level(),
        );
        let omega_before = system.hub.as_ref().map_or(0.0, |h| h.state.omega);
        let hub = match (&mut system.hub, load) {
            (Some(hub), Some(load)) => {
                let load = [0, 1, 2].map(|i| load[i] + nodes.reaction[i]);
                hub.step(time, dt, load, &mut self.displacement, &mut self.velocity)
            }
            _ => HubWork::default(),
        };
        let given_after = 0.5 * dt * system.load.power(time, &self.velocity);
        let moved = Instant::now();

        let viscous = 0.5 * dt * (sums.viscous_power + nodes.dashpot_power);
        self.ledger.add(&Works {
            friction: contact.friction_work,
            damping: contact.damping_work + viscous + quiet.dissipated_before,
            contact_damping: contact.damping_work,
            external: hub.before + quiet.external_before + given_before,
        });
        let energies = read.then(|| {
            let now = Energies {
                kinetic: nodes.kinetic + hub.kinetic,
                internal: sums.internal,
                hourglass: sums.hourglass,
                contact_stored: contact.stored_normal + contact.stored_tangential,
                friction_dissipated: self.ledger.friction,
                damping_dissipated: self.ledger.damping,
                contact_damping: self.ledger.contact_damping,
                external_work: self.ledger.external,
            };
            self.ledger.read(&now);
            now
        });
        self.ledger.add(&Works {
            friction: contact.friction_ahead,
            damping: contact.damping_ahead + viscous + quiet.dissipated_after,
            contact_damping: contact.damping_ahead,
            external: hub.after + quiet.external_after + given_after,
        });

        let following = following / rayon::current_num_threads() as u32;
        self.timers.internal_force += (internal - start).saturating_sub(following);
        self.timers.boundary += bounded - internal;
        self.timers.contact += contacted - bounded + following;
        self.timers.nodes += moved - contacted;
        self.step += 1;
        let (drive, omega) = match &system.hub {
            Some(h) => (h.reaction, 0.5 * (omega_before + h.state.omega)),
            None => Default::default(),
        };
        StepReport { step: n, time, contact, energies, drive, omega }
    }
}
