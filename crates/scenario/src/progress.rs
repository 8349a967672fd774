//! What a run tells whoever watches it.

/// The stages of a run, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The mesh is generated and the stable step found.
    Mesh,
    /// The disk is pressed on the bar.
    Preload,
    /// The disk rolls.
    Roll,
}

/// A look at a run under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The stage under way.
    pub stage: Stage,
    /// Steps done in this stage.
    pub step: u64,
    /// Steps planned in this stage; in [`Stage::Preload`] the most there can be.
    pub steps: u64,
    /// Simulated time of rolling (s).
    pub time: f64,
    /// Simulated time at the end (s).
    pub end_time: f64,
    /// Normal force in contact (N).
    pub normal_force: f64,
    /// Tangential force in contact, in the rolling direction (N).
    pub tangential_force: f64,
    /// Elements times steps per second of wall time (1/s).
    pub element_steps_per_s: f64,
}
