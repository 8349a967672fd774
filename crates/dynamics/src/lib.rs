//! Dynamics of an upper body, carried by a hub, that rolls on a lower one.
//!
//! Central difference with half-step velocities v^{n-1/2} and lumped mass. A step reads as the
//! method does: internal force, given forces and quiet ends, contact, then velocity and position of every node in one
//! pass (with mass damping) and the hub, with the energy ledger in the form that the scheme
//! conserves.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod central_difference;
mod check;
mod dashpots;
mod diagnosis;
mod guard;
mod hub;
mod implicit;
mod implicit_step;
mod ledger;
mod load;
mod mesh_move;
mod nodal_state;
mod nodes;
mod paired;
mod partition;
mod quiet;
mod ramp;
mod ranks;
mod relax;
mod rolling;
mod second_moments;
mod share;
mod sideways;
mod simulation;
mod state;
mod step_sums;
mod system;
mod unsolved;
mod window;

pub use diagnosis::{Cause, Diagnosis, Location, USUAL_HOURGLASS};
pub use guard::{GuardLimits, LostContact, SHAPE_STEPS};
pub use hub::{DriveReaction, Hub, HubState, Resultant, Spin, Vertical};
pub use ledger::{Energies, Ledger};
pub use load::{Fixed, Load};
pub use mesh_move::Moved;
pub use partition::{CHUNK, Partition};
pub use quiet::QuietEnd;
pub use ramp::{interpolated, smoothstep};
pub use ranks::{Message, Ranks};
pub use relax::{Relaxation, RelaxationError, RelaxationReport, relax};
pub use rolling::{RollingField, rolling_field, rolling_field_of_unlike};
pub use share::{ShareSize, share_sizes};
pub use sideways::Sideways;
pub use simulation::{Setup, Simulation, StepReport, Timers};
pub use state::{RestoreError, SimulationState};
pub use system::System;
pub use unsolved::{Effort, Unsolved};
pub use window::{MeshMove, Missed, Travel, Window};

#[cfg(test)]
mod tests;
