//! A scenario at its start: the simulation, and the results of the preload and of the stability analysis.

use dynamics::Simulation;
pub use output::summary::Stability;
use serde::{Deserialize, Serialize};

use crate::scenario::numbers::DimensionlessNumbers;
use crate::scenario::preload::PreloadReport;

/// Rolling radii of the disk.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct RollingRadius {
    /// Of the undeformed disk (m).
    pub nominal: f64,
    /// V/omega at which the mean slip velocity over the preloaded patch, weighted with the
    /// pressure, vanishes (m); the nominal radius without a preload.
    pub effective: f64,
}

/// What is known when the disk begins to roll.
#[derive(Clone, Debug)]
pub struct InitialState {
    /// The frequencies that limit the time step.
    pub stability: Stability,
    /// Rolling radii of the disk.
    pub radius: RollingRadius,
    /// How the preload was found; none with `preload.method = "none"`.
    pub preload: Option<PreloadReport>,
    /// Wall time of the preload (s).
    pub preload_wall: f64,
    /// Dimensionless numbers of contact and friction.
    pub numbers: DimensionlessNumbers,
    /// Time steps to take.
    pub steps: u64,
}

impl InitialState {
    /// The part of them that a checkpoint keeps.
    pub fn found(&self) -> KeptState {
        let Self { stability, radius, preload, preload_wall, steps, .. } = *self;
        KeptState { stability, radius, preload, preload_wall, steps }
    }
}

/// The part of [`InitialState`] that a checkpoint keeps, since it takes a preload to find it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct KeptState {
    /// The frequencies that limit the time step.
    pub stability: Stability,
    /// Rolling radii of the disk.
    pub radius: RollingRadius,
    /// How the preload was found; none with `preload.method = "none"`.
    pub preload: Option<PreloadReport>,
    /// Wall time of the preload (s).
    pub preload_wall: f64,
    /// Time steps to take.
    pub steps: u64,
}

/// A simulation that can be stepped.
pub struct Start {
    /// At t = 0, or in the state of a checkpoint.
    pub simulation: Simulation,
    /// What is known of it.
    pub facts: InitialState,
}
