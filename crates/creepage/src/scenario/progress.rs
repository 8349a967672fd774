//! What a run reports to its observer.

use serde::Serialize;

/// The stages of a run, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// The mesh is generated or read, and the elements are set up.
    Mesh,
    /// The disk is pressed on the bar.
    Preload,
    /// The disk rolls.
    Roll,
}

/// What a run will take, as estimated before its first step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Elements.
    pub elements: usize,
    /// Steps planned.
    pub steps: u64,
    /// Time step (s).
    pub dt: f64,
    /// Wall time of rolling without output (s), from the time that this machine takes for the first steps.
    pub seconds: f64,
    /// Room that the results take on the disk (bytes).
    pub disk: f64,
}

/// How far a run is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Progress {
    /// The stage under way.
    pub stage: Stage,
    /// Steps, or iterations of the preload, that are done in this stage.
    pub step: u64,
    /// Steps planned in this stage; in [`Stage::Preload`] the most there can be.
    pub steps: u64,
    /// Simulated time since rolling began (s).
    pub time: f64,
    /// Simulated time at the end (s).
    pub end_time: f64,
    /// Normal force in contact (N).
    pub normal_force: f64,
    /// Tangential force of the contact on the disk, positive in the rolling direction +x (N).
    pub tangential_force: f64,
    /// Elements times steps per second of wall time (1/s); of the preload, evaluations of elements.
    pub element_steps_per_s: f64,
    /// What the run will take: told once, before the first step. Not estimated are steps of half-spaces, implicit steps, and a friction law
    /// in Python.
    pub cost: Option<Cost>,
}
