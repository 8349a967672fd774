//! A simulation: the system, its state in time, its balance of energy and its guards.

use crate::guard::{GuardLimits, LostContact};
use crate::hub::{DriveReaction, Hub};
use crate::implicit::Implicit;
use crate::ledger::{Energies, Ledger};
use crate::nodal_state::NodalState;
use crate::share::Share;
use crate::system::System;
use crate::unsolved::Unsolved;
use crate::window::{Travel, Window};
use contact::{Contact, ContactSums};
use mesh::Padded;
use solid::Solid;
use std::time::Duration;

/// Everything a simulation starts from.
pub struct Setup {
    /// The bodies, with what holds and moves them.
    pub system: System,
    /// Displacement at t = 0 (m).
    pub displacement: Vec<Padded>,
    /// Velocity half a step before t = 0 (m/s).
    pub velocity: Vec<Padded>,
    /// Time step (s).
    pub dt: f64,
    /// Longest stable explicit step (s), for the diagnosis.
    pub dt_limit: f64,
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
    /// Where several processes share the steps: how long process 0 waits in them for the others and for messages. What is gathered for
    /// records, and moves of the mesh, are not in it.
    pub exchange: Duration,
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
    /// Of an implicit step that was not solved: the state is then that of its beginning, or of one of its parts.
    pub unsolved: Option<Unsolved>,
}

/// A system in motion: its state at a full step, with velocities at the half step before.
pub struct Simulation {
    pub(crate) system: System,
    /// Its forces are zero between two steps.
    pub(crate) nodes: NodalState,
    pub(crate) dt: f64,
    pub(crate) dt_limit: f64,
    pub(crate) step: usize,
    pub(crate) ledger: Ledger,
    pub(crate) limits: GuardLimits,
    pub(crate) watch: LostContact,
    pub(crate) timers: Timers,
    /// The moves of a mesh that follows the patch, and how far it has moved.
    pub(crate) window: Option<Window>,
    pub(crate) travel: Travel,
    /// The integrator of implicit steps; explicit ones have none.
    pub(crate) implicit: Option<Box<Implicit>>,
    /// The share of this process, where several step the simulation together.
    pub(crate) share: Option<Share>,
}

impl Simulation {
    /// A simulation at t = 0.
    pub fn new(setup: Setup) -> Self {
        let Setup { mut system, mut displacement, mut velocity, dt, dt_limit } = setup;
        system.constrain(&mut displacement, &mut velocity);
        let mut nodes = NodalState::new(displacement, velocity, system.inverse_mass());
        if let Some(contact) = system.contact.as_deref() {
            nodes.trace_of(contact, system.solid.reference());
        }
        Self {
            system,
            nodes,
            dt,
            dt_limit,
            step: 0,
            ledger: Ledger::default(),
            limits: GuardLimits::default(),
            watch: LostContact::default(),
            timers: Timers::default(),
            window: None,
            travel: Travel::default(),
            implicit: None,
            share: None,
        }
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
        &self.nodes.displacement
    }

    /// Mean velocities over the step that led to the present state (m/s), `(u^n - u^{n-1})/dt`: with central difference those at the
    /// half step. Of the last part of an implicit step that was cut. Of implicit steps they are no part of the state: zero until this simulation
    /// takes one.
    pub fn step_velocity(&self) -> &[Padded] {
        self.implicit.as_ref().map_or(&self.nodes.velocity, |implicit| &implicit.w)
    }

    /// Velocities at the half step before the present (m/s); with implicit steps at the present.
    pub fn velocity(&self) -> &[Padded] {
        &self.nodes.velocity
    }

    /// The elements.
    pub fn solid(&self) -> &Solid {
        &self.system.solid
    }

    /// The contact.
    pub fn contact(&self) -> Option<&dyn Contact> {
        self.system.contact.as_deref()
    }

    /// The hub.
    pub fn hub(&self) -> Option<&Hub> {
        self.system.hub.as_ref()
    }

    /// The ledger.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Wall time per stage so far.
    pub fn timers(&self) -> &Timers {
        &self.timers
    }

    /// How far the meshes have moved.
    pub fn travel(&self) -> Travel {
        self.travel
    }

    /// Bytes held for the time loop, contact apart.
    pub fn bytes(&self) -> usize {
        self.system.solid.bytes() + self.nodes.bytes()
    }
}
