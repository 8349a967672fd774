//! A scenario at its start: the simulation, and what is known of it.

use dynamics::Simulation;
use serde::{Deserialize, Serialize};

use crate::numbers::DimensionlessNumbers;
use crate::preload::PreloadReport;

/// What the stable step is made of.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Stability {
    /// Largest frequency of the bodies without contact, with margin (rad/s).
    pub omega_elastic: f64,
    /// Largest frequency with the contact springs closed after the preload, with margin (rad/s).
    pub omega_max: f64,
    /// Rigorous upper bound: element bound and contact bound combined (rad/s).
    pub omega_bound: f64,
    /// 2/omega_max (s).
    pub dt_limit: f64,
    /// Time step over that limit (dimensionless).
    pub factor: f64,
}

/// Rolling radii.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct RollingRadius {
    /// Of the undeformed disk (m).
    pub nominal: f64,
    /// V/omega at which the mean slip velocity over the preloaded patch, weighted with the
    /// pressure, vanishes (m).
    pub effective: f64,
}

/// What is known once the start is made.
#[derive(Clone, Debug)]
pub struct Facts {
    /// What the time step is limited by.
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

impl Facts {
    /// What a restart needs of them.
    pub fn found(&self) -> Found {
        let Self { stability, radius, preload, preload_wall, steps, .. } = *self;
        Found { stability, radius, preload, preload_wall, steps }
    }
}

/// What of the facts does not follow from the case without the preload.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Found {
    /// What the time step is limited by.
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

/// A simulation ready to roll.
pub struct Start {
    /// At t = 0, or where it was restored.
    pub simulation: Simulation,
    /// What is known of it.
    pub facts: Facts,
}
