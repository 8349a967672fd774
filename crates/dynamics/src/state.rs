//! The state between two steps, as plain data: enough to go on with the same bits.

use crate::guard::LostContact;
use crate::hub::{DriveReaction, HubState};
use crate::ledger::Ledger;
use crate::simulation::{Simulation, Timers};
use crate::unsolved::Effort;
use crate::window::Travel;
use contact::{ContactState, StateError};
use mesh::Padded;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// State of a simulation at a full step, with velocities at the half step before. What follows from
/// the setup (masses, elements, boundary conditions, loads) is not part of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SimulationState {
    /// Steps done.
    pub step: usize,
    /// Displacements (m).
    pub displacement: Vec<[f64; 3]>,
    /// Velocities (m/s).
    pub velocity: Vec<[f64; 3]>,
    /// Motion of the hub and the last reaction of its drive, if there is a hub.
    pub hub: Option<(HubState, DriveReaction)>,
    /// Forces (N) on the nodes of the quiet ends that balance the preload.
    pub reactions: Vec<[f64; 3]>,
    /// Accumulated works and the balance.
    pub ledger: Ledger,
    /// Contact, if there is any.
    pub contact: Option<ContactState>,
    /// What the guards have seen.
    pub watch: LostContact,
    /// Wall time per stage so far.
    pub timers: Timers,
    /// How far the meshes have moved.
    pub travel: Travel,
    /// What implicit steps took so far.
    pub effort: Effort,
    /// The nodes whose columns of the compliance are in the effort, of whole steps and of each cut.
    pub columns: Vec<BTreeSet<u32>>,
}

/// Why a simulation cannot go on from a state.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RestoreError {
    /// The state is of another model.
    #[error("the state has {found} {what}, the model {wanted}")]
    Count {
        /// What was counted.
        what: &'static str,
        /// As many as the model has.
        wanted: usize,
        /// As many as the state has.
        found: usize,
    },
    /// The state of contact is of another model.
    #[error(transparent)]
    Contact(#[from] StateError),
    /// The state came from another process in another form.
    #[error("the state of process 0 has another form")]
    Form(#[from] postcard::Error),
    /// Another process cannot go on from it.
    #[error("another process cannot go on from the state of process 0")]
    Process,
}

impl Simulation {
    /// The state now.
    pub fn snapshot(&self) -> SimulationState {
        let vectors = |field: &[Padded]| field.iter().map(|v| v.xyz()).collect();
        SimulationState {
            step: self.step,
            displacement: vectors(&self.nodes.displacement),
            velocity: vectors(&self.nodes.velocity),
            hub: self.system.hub.as_ref().map(|hub| (hub.state, hub.reaction)),
            reactions: self.system.quiet.reactions().collect(),
            ledger: self.ledger,
            contact: self.system.contact.as_ref().map(|contact| contact.snapshot()),
            watch: self.watch,
            timers: self.timers,
            travel: self.travel,
            effort: self.effort().unwrap_or_default(),
            columns: self.implicit.as_ref().map(|implicit| implicit.counted()).unwrap_or_default(),
        }
    }

    /// Takes over the state of a simulation of the same setup: the next steps have the same bits as
    /// those of the simulation that it was taken from, on any number of threads.
    ///
    /// # Errors
    /// A state of another model. This simulation is then in no state to go on.
    pub fn restore(&mut self, state: &SimulationState) -> Result<(), RestoreError> {
        let count = |what, wanted, found| {
            let error = RestoreError::Count { what, wanted, found };
            if wanted == found { Ok(()) } else { Err(error) }
        };
        let nodes = self.nodes.displacement.len();
        count("displacements", nodes, state.displacement.len())?;
        count("velocities", nodes, state.velocity.len())?;
        count("hubs", usize::from(self.system.hub.is_some()), usize::from(state.hub.is_some()))?;
        let contacts = usize::from(self.system.contact.is_some());
        count("contacts", contacts, usize::from(state.contact.is_some()))?;
        count("quiet nodes", self.system.quiet.nodes().count(), state.reactions.len())?;
        let padded = |field: &mut [Padded], from: &[[f64; 3]]| {
            field.iter_mut().zip(from).for_each(|(v, x)| *v = Padded::new(*x));
        };
        padded(&mut self.nodes.displacement, &state.displacement);
        padded(&mut self.nodes.velocity, &state.velocity);
        self.nodes.force.fill(Padded::ZERO);
        if let (Some(hub), Some((motion, reaction))) = (&mut self.system.hub, state.hub) {
            (hub.state, hub.reaction) = (motion, reaction);
        }
        self.system.quiet.set_reactions(&state.reactions);
        if let (Some(contact), Some(state)) = (&mut self.system.contact, &state.contact) {
            contact.restore(state)?;
        }
        (self.step, self.ledger, self.timers) = (state.step, state.ledger, state.timers);
        (self.watch, self.travel) = (state.watch, state.travel);
        self.take_heights();
        if let Some(implicit) = &mut self.implicit {
            implicit.effort = state.effort;
            implicit.set_counted(&state.columns);
        }
        Ok(())
    }
}
