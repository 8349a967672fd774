//! Implicit steps of a simulation: a step is solved, or cut and solved in parts; then nodes and hub move, and the works are booked.

use crate::dashpots::RigidMotion;
use crate::hub::{HubState, HubWork};
use crate::implicit::{CUTS, Implicit, Solved, Span};
use crate::ledger::{Energies, Works};
use crate::simulation::{Simulation, StepReport};
use crate::unsolved::{Effort, Unsolved};
use contact::{ContactSums, Method};
use mesh::Padded;
use std::time::Instant;

impl Simulation {
    /// Takes implicit steps from here on, with `theta` from 1/2 (second order) to 1 (first order, most dissipative).
    ///
    /// The velocities of the present state then are those of its own time, not of half a step before. Contact, if there is any, must be
    /// [exact](contact::ExactContact).
    ///
    /// # Panics
    /// If `theta` lies outside 1/2 to 1, or contact is a method of springs.
    pub fn set_implicit(&mut self, theta: f64) {
        assert!((0.5..=1.0).contains(&theta), "theta from 1/2 to 1");
        assert!(!matches!(self.system.contact, Some(Method::Penalty(_))), "exact contact");
        self.implicit = Some(Box::new(Implicit::new(theta, &self.system, &self.nodes)));
    }

    /// What implicit steps took so far; none of explicit ones.
    pub fn effort(&self) -> Option<Effort> {
        self.implicit.as_ref().map(|implicit| implicit.effort)
    }

    /// One implicit step from t^n to t^{n+1}. With `read` the energies at t^n enter the ledger.
    pub(crate) fn implicit_step(&mut self, read: bool) -> StepReport {
        let (n, dt) = (self.step, self.dt);
        let time = n as f64 * dt;
        let energies = read.then(|| self.energies());
        let omega_before = self.system.hub.as_ref().map_or(0.0, |h| h.state.omega);
        let begun = Instant::now();
        let mut report = StepReport { step: n, time, energies, ..StepReport::default() };
        match self.take(Span { time, dt, cuts: 0 }) {
            Ok(contact) => report.contact = contact.times(self.system.multiplicity),
            Err(unsolved) => report.unsolved = Some(unsolved),
        }
        self.timers.nodes += begun.elapsed();
        self.step += 1;
        if let Some(hub) = &self.system.hub {
            report.drive = hub.reaction.times(self.system.multiplicity);
            report.omega = 0.5 * (omega_before + hub.state.omega);
        }
        report
    }

    /// The energies of the present state, read into the ledger.
    fn energies(&mut self) -> Energies {
        let multiplicity = self.system.multiplicity;
        let nodes = &mut self.nodes;
        let sums =
            self.system.solid.subtract_elastic_force(&nodes.displacement, &mut nodes.force, true);
        nodes.force.fill(Padded::ZERO);
        let kinetic = nodes.velocity.iter().zip(&nodes.inverse_mass).map(|(v, w)| {
            let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            if *w > 0.0 { 0.5 * square / w } else { 0.0 }
        });
        let hub = self.system.hub.as_ref().map_or(0.0, |hub| hub.kinetic());
        let now = Energies {
            kinetic: multiplicity * (exact_sum::sum(kinetic) + hub),
            internal: multiplicity * sums.internal,
            hourglass: multiplicity * sums.hourglass,
            contact_stored: 0.0,
            friction_dissipated: self.ledger.friction,
            damping_dissipated: self.ledger.damping,
            contact_damping: self.ledger.contact_damping,
            external_work: self.ledger.external,
        };
        self.ledger.read(&now);
        now
    }

    /// Solves a span as one step, or in halves where that fails.
    fn take(&mut self, span: Span) -> Result<ContactSums, Unsolved> {
        let Some(mut implicit) = self.implicit.take() else { return Ok(ContactSums::default()) };
        let solved = implicit.solve(&mut self.system, &mut self.nodes, span);
        let result = match solved {
            Ok(solved) => {
                implicit.effort.solved += 1;
                self.finish(&mut implicit, span, &solved);
                let mut contact = solved.contact;
                if span.cuts > 0 {
                    // of whole steps alone
                    contact.steepness = [0.0; 2];
                }
                Ok(contact)
            }
            Err(unsolved) => {
                self.nodes.force.fill(Padded::ZERO);
                Err(unsolved)
            }
        };
        self.implicit = Some(implicit);
        let unsolved = match result {
            Ok(contact) => return Ok(contact),
            Err(unsolved) => unsolved,
        };
        if span.cuts == CUTS {
            return Err(unsolved);
        }
        if let Some(implicit) = &mut self.implicit {
            implicit.effort.cut += 1;
        }
        let half = 0.5 * span.dt;
        self.take(Span { dt: half, cuts: span.cuts + 1, ..span })?;
        self.take(Span { time: span.time + half, dt: half, cuts: span.cuts + 1 })
    }

    /// Moves nodes and hub to the end of a solved span, and books the works.
    fn finish(&mut self, implicit: &mut Implicit, span: Span, solved: &Solved) {
        let (theta, dt, multiplicity) = (implicit.theta, span.dt, self.system.multiplicity);
        let (system, nodes) = (&mut self.system, &mut self.nodes);
        // the mean velocity of the step is all that the stiffness product needs
        let stiffness = implicit.stiffness_energy(system);
        // what a rigid turn changes in the velocities, elements give back: their forces turn on within the step
        let turns = |hub: HubState| system.hub.as_ref().map(|body| RigidMotion::of(body, hub));
        let before = system.hub.as_ref().and_then(|hub| turns(hub.state)).unwrap_or_default();
        let after = turns(solved.hub).unwrap_or_default();
        let (upper, reference) = (&system.upper, system.solid.reference());
        let mut inertia = exact_sum::ExactSum::ZERO;
        let arrays = nodes.displacement.iter_mut().zip(&mut nodes.velocity).zip(&implicit.w);
        for (n, (((u, v), w), inverse)) in arrays.zip(&nodes.inverse_mass).enumerate() {
            let mut rigid = [0.0; 4];
            if upper.contains(&n) {
                let [old, new] = [before, after].map(|motion| motion.at(reference[n]).0);
                (0..3).for_each(|i| rigid[i] = new[i] - old[i]);
            }
            let mut square = 0.0;
            for i in 0..3 {
                let change = (w[i] - v[i]) / theta;
                square += (change - rigid[i]) * (change - rigid[i]);
                v[i] = if *inverse > 0.0 { v[i] + change } else { w[i] };
                u[i] += dt * w[i];
            }
            if *inverse > 0.0 {
                inertia.add(square / inverse);
            }
        }
        let mut work = HubWork::default();
        let mut lost = (theta - 0.5) * (inertia.value() + dt * dt * stiffness);
        if let Some(hub) = &mut system.hub {
            let old = hub.state;
            work = hub.advance(span.time, dt, &solved.load);
            hub.state = solved.hub;
            hub.place([old, hub.state], dt, &mut nodes.displacement, &mut nodes.velocity);
            lost += hub.kinetic_of_change(old);
        }
        let contact = &solved.contact;
        self.ledger.add(&Works {
            friction: multiplicity * contact.friction_ahead,
            damping: multiplicity * (contact.damping_ahead + dt * solved.dissipated + lost),
            contact_damping: multiplicity * contact.damping_ahead,
            // the drive acts over the whole step at the velocity of the step
            external: multiplicity * (2.0 * work.after + dt * solved.given),
        });
    }
}
