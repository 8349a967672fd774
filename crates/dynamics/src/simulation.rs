//! The time loop.

use crate::dashpots::{Dashpots, RigidMotion};
use crate::guard::{Limits, Watch};
use crate::hub::{DriveReaction, Hub, HubWork};
use crate::ledger::{Energies, Ledger};
use crate::load::{Fixed, Load};
use crate::nodes::{self, NodeSums};
use crate::paired;
use crate::quiet::QuietEnd;
use contact::{Contact, ContactSums, Motion, Trial};
use mesh::Padded;
use solid::Solid;
use std::time::{Duration, Instant};

/// Everything a simulation starts from.
pub struct Setup {
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
    /// Displacement at t = 0 (m).
    pub displacement: Vec<Padded>,
    /// Velocity half a step before t = 0 (m/s).
    pub velocity: Vec<Padded>,
    /// Time step (s).
    pub dt: f64,
    /// Largest frequency of the assembly (rad/s), for the diagnosis.
    pub omega_max: f64,
    /// Mass-proportional damping relative to the rigid motion (1/s).
    pub mass_damping: f64,
}

/// Wall time per stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Timers {
    /// Internal force.
    pub internal_force: Duration,
    /// Contact. What one thread of it does beside the internal force counts by its share in the threads.
    pub contact: Duration,
    /// Quiet ends and the force on the hub.
    pub boundary: Duration,
    /// Velocity and position of nodes and hub, mass damping.
    pub nodes: Duration,
}

/// What a step found at its start, time t^n.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Number n of the full step.
    pub step: usize,
    /// Its time (s).
    pub time: f64,
    /// Contact at t^n.
    pub contact: ContactSums,
    /// Energies at t^n, if they were read.
    pub energies: Option<Energies>,
    /// What the hub's drive supplies.
    pub drive: DriveReaction,
    /// Angular velocity of the hub at t^n (rad/s), the mean of the half steps around it.
    pub omega: f64,
}

/// Central difference over the whole model.
pub struct Simulation {
    pub(crate) solid: Solid,
    pub(crate) contact: Option<Box<dyn Contact>>,
    pub(crate) hub: Option<Hub>,
    pub(crate) quiet: QuietEnd,
    fixed: Vec<Fixed>,
    paired: Vec<[u32; 2]>,
    load: Load,
    pub(crate) disk: std::ops::Range<usize>,
    pub(crate) inverse_mass: Vec<f64>,
    pub(crate) displacement: Vec<Padded>,
    pub(crate) velocity: Vec<Padded>,
    pub(crate) force: Vec<Padded>,
    partial: Vec<NodeSums>,
    pub(crate) dt: f64,
    pub(crate) omega_max: f64,
    mass_damping: f64,
    pub(crate) step: usize,
    pub(crate) ledger: Ledger,
    pub(crate) limits: Limits,
    pub(crate) watch: Watch,
    pub(crate) timers: Timers,
}

impl Simulation {
    /// A simulation at t = 0.
    pub fn new(mut setup: Setup) -> Self {
        let mut inverse_mass: Vec<f64> = setup.mass.iter().map(|m| 1.0 / m).collect();
        let carried = setup.hub.iter().flat_map(|h| &h.nodes);
        setup.held.iter().chain(carried).for_each(|&n| inverse_mass[n as usize] = 0.0);
        let mut velocity = setup.velocity;
        setup.held.iter().for_each(|&n| velocity[n as usize] = Padded::ZERO);
        Fixed::clear(&setup.fixed, &mut velocity);
        paired::follow(&setup.paired, &mut velocity);
        paired::follow(&setup.paired, &mut setup.displacement);
        setup.quiet.release(&setup.fixed);
        let n = inverse_mass.len();
        Self {
            solid: setup.solid,
            contact: setup.contact,
            hub: setup.hub,
            quiet: setup.quiet,
            fixed: setup.fixed,
            paired: setup.paired,
            load: setup.load,
            disk: setup.disk,
            inverse_mass,
            displacement: setup.displacement,
            velocity,
            force: vec![Padded::ZERO; n],
            partial: vec![NodeSums::default(); nodes::chunks(n)],
            dt: setup.dt,
            omega_max: setup.omega_max,
            mass_damping: setup.mass_damping,
            step: 0,
            ledger: Ledger::default(),
            limits: Limits::default(),
            watch: Watch::default(),
            timers: Timers::default(),
        }
    }

    /// One step from t^n to t^{n+1}. With `read` the energies at t^n enter the ledger.
    pub fn step(&mut self, read: bool) -> StepReport {
        let (n, dt) = (self.step, self.dt);
        let time = n as f64 * dt;
        let start = Instant::now();

        // internal force at u^n (viscous parts with v^{n-1/2}), and beside it what of contact needs no forces
        let contact = &mut self.contact;
        let (displacement, velocity) = (&self.displacement[..], &self.velocity[..]);
        let inverse_mass = &self.inverse_mass[..];
        let motion = Motion { reference: &[], displacement, velocity, inverse_mass, time, dt };
        let (sums, following) = self.solid.subtract_internal_force_beside(
            displacement,
            velocity,
            &mut self.force,
            read,
            |reference| {
                let start = Instant::now();
                if let Some(contact) = contact {
                    contact.follow(&Motion { reference, ..motion });
                }
                start.elapsed()
            },
        );
        let internal = Instant::now();

        // boundary forces
        // a support bears the body's own force; a given one reaches contact first
        Fixed::clear(&self.fixed, &mut self.force);
        self.load.apply(time, &mut self.force);
        let quiet = self.quiet.apply(&self.velocity, &self.inverse_mass, dt, &mut self.force);
        paired::share(&self.paired, &mut self.force);
        let given_before = 0.5 * dt * self.load.power(time, &self.velocity);
        let bounded = Instant::now();

        // contact at u^n, with all other forces known
        let dashpots = (self.mass_damping > 0.0).then(|| Dashpots {
            alpha: self.mass_damping,
            disk: self.disk.clone(),
            reference: self.solid.reference(),
            motion: self.hub.as_ref().map(RigidMotion::new),
        });
        let contact = match &mut self.contact {
            Some(contact) => {
                let motion = Motion { reference: self.solid.reference(), ..motion };
                let trial = Trial {
                    velocity: &|node, force| {
                        let (v, w) = (velocity[node as usize].xyz(), inverse_mass[node as usize]);
                        nodes::trial(node as usize, v, force, w, dt, dashpots.as_ref())
                    },
                    inverse_mass,
                };
                let sums = contact.apply(&motion, &trial, &mut self.force);
                contact.follow_first(&self.paired);
                sums
            }
            None => ContactSums::default(),
        };
        paired::follow(&self.paired, &mut self.force);
        Fixed::clear(&self.fixed, &mut self.force);
        let load = self.hub.as_ref().map(|hub| hub.resultant(&self.displacement, &self.force));
        let contacted = Instant::now();

        // velocity v^{n+1/2} and position u^{n+1}, then the hub with its nodes
        let nodes = nodes::advance(
            &mut self.displacement,
            &mut self.velocity,
            &mut self.force,
            &self.inverse_mass,
            dt,
            read,
            dashpots.as_ref(),
            &mut self.partial,
            self.solid.level(),
        );
        let omega_before = self.hub.as_ref().map_or(0.0, |h| h.state.omega);
        let hub = match (&mut self.hub, load) {
            (Some(hub), Some(load)) => {
                let load = [0, 1, 2].map(|i| load[i] + nodes.reaction[i]);
                hub.step(time, dt, load, &mut self.displacement, &mut self.velocity)
            }
            _ => HubWork::default(),
        };
        let given_after = 0.5 * dt * self.load.power(time, &self.velocity);
        let moved = Instant::now();

        let viscous = 0.5 * dt * (sums.viscous_power + nodes.dashpot_power);
        self.ledger.friction += contact.friction_work;
        self.ledger.contact_damping += contact.damping_work;
        self.ledger.damping += contact.damping_work + viscous + quiet.dissipated_before;
        self.ledger.external += hub.before + quiet.external_before + given_before;
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
        self.ledger.friction += contact.friction_ahead;
        self.ledger.contact_damping += contact.damping_ahead;
        self.ledger.damping += contact.damping_ahead + viscous + quiet.dissipated_after;
        self.ledger.external += hub.after + quiet.external_after + given_after;

        let following = following / rayon::current_num_threads() as u32;
        self.timers.internal_force += (internal - start).saturating_sub(following);
        self.timers.boundary += bounded - internal;
        self.timers.contact += contacted - bounded + following;
        self.timers.nodes += moved - contacted;
        self.step += 1;
        let (drive, omega) = match &self.hub {
            Some(h) => (h.reaction, 0.5 * (omega_before + h.state.omega)),
            None => Default::default(),
        };
        StepReport { step: n, time, contact, energies, drive, omega }
    }

    /// Steps done; the state is at t = steps dt.
    pub fn steps(&self) -> usize {
        self.step
    }

    /// Time step (s).
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Time of the present state (s).
    pub fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    /// Displacements (m).
    pub fn displacement(&self) -> &[Padded] {
        &self.displacement
    }

    /// Velocities at the half step before the present (m/s).
    pub fn velocity(&self) -> &[Padded] {
        &self.velocity
    }

    /// The elements.
    pub fn solid(&self) -> &Solid {
        &self.solid
    }

    /// The contact.
    pub fn contact(&self) -> Option<&dyn Contact> {
        self.contact.as_deref()
    }

    /// The hub.
    pub fn hub(&self) -> Option<&Hub> {
        self.hub.as_ref()
    }

    /// The ledger.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Wall time per stage so far.
    pub fn timers(&self) -> &Timers {
        &self.timers
    }

    /// Bytes held for the time loop, contact apart.
    pub fn bytes(&self) -> usize {
        self.solid.bytes() + self.displacement.len() * (3 * size_of::<Padded>() + size_of::<f64>())
    }
}
