//! What a comparison of runs came to.

use crate::check::result::{SlipZoneMeasured, View};
use serde::{Deserialize, Serialize};

/// The document of `creepage compare --json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparisonResult {
    /// The span of time (s) that is compared.
    pub window: [f64; 2],
    /// The places and instants at which the runs are compared.
    pub grid: ComparisonGrid,
    /// The runs.
    pub runs: Vec<ComparedRun>,
    /// The difference of each run from the one before it.
    pub differences: Vec<RunDifference>,
    /// The figure, where one was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub figure: Option<String>,
}

/// The places along the centre line and the instants at which runs are compared.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparisonGrid {
    /// Rear end, from the centre of contact (m).
    pub from: f64,
    /// Front end (m).
    pub to: f64,
    /// Number of places.
    pub places: usize,
    /// Number of instants.
    pub instants: usize,
}

/// What is compared of a run; slip speeds in m/s along the centre line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparedRun {
    /// Name of its case.
    pub name: String,
    /// What tells it from the others.
    pub label: String,
    /// Its folder.
    pub folder: String,
    /// The body whose nodes are taken.
    pub side: View,
    /// Largest slip speed.
    pub largest: Option<f64>,
    /// The span of time (s) that it is the largest of.
    pub largest_over: [f64; 2],
    /// Mean slip speed of the slip zone.
    pub mean: Option<f64>,
    /// Root mean square of its fluctuation.
    pub fluctuation: Option<f64>,
    /// That over the root mean square of all slip.
    pub fluctuating_share: Option<f64>,
    /// All statistics of the slip zone.
    pub slip_zone: Option<SlipZoneMeasured>,
    /// Share of the slip that alternates from node to node.
    pub alternating_slip: Option<f64>,
}

/// How far a run differs from the one before it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunDifference {
    /// Label of the one before.
    pub from: String,
    /// Label of the run.
    pub to: String,
    /// Difference of slip.
    pub slip: Difference,
    /// Difference of shear.
    pub shear: Difference,
    /// Growth of a small disturbance; none where the runs are no twins.
    pub growth: Option<Growth>,
}

/// Root mean square of a difference over that of the second run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Pointwise over place and time.
    pub place_and_time: Option<f64>,
    /// Of the means in time.
    pub means: Option<f64>,
    /// Of the standard deviations in time.
    pub deviations: Option<f64>,
}

/// Growth of the difference between twins.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Growth {
    /// Its rate (1/s).
    pub rate: Option<f64>,
    /// Why there is no rate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The records in which the difference is small.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<GrownOver>,
}

impl Growth {
    pub(super) fn none(reason: &str) -> Self {
        Self { rate: None, reason: Some(reason.into()), over: None }
    }
}

/// Records in which a difference is small, and its size over the largest slip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GrownOver {
    /// Time of the first (s).
    pub from: f64,
    /// Time of the last (s).
    pub to: f64,
    /// How many.
    pub records: usize,
    /// The difference in the first.
    pub start: f64,
    /// The difference in the last.
    pub end: f64,
}
