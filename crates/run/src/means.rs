//! Means over the evaluation window.

use crate::mesh_mode::MeshModeSums;
use serde::{Deserialize, Serialize};

/// Running mean and standard deviation.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Mean {
    count: f64,
    mean: f64,
    squares: f64,
}

impl Mean {
    /// Adds a sample (Welford 1962); values that are not finite are left out.
    pub(crate) fn add(&mut self, x: f64) {
        if x.is_finite() {
            self.count += 1.0;
            let away = x - self.mean;
            self.mean += away / self.count;
            self.squares += away * (x - self.mean);
        }
    }

    /// Number of samples.
    pub(crate) fn count(&self) -> u64 {
        self.count as u64
    }

    /// The mean; none without samples.
    pub(crate) fn mean(&self) -> Option<f64> {
        (self.count > 0.0).then_some(self.mean)
    }

    /// The standard deviation of the samples about their own mean; none without samples.
    pub(crate) fn deviation(&self) -> Option<f64> {
        (self.count > 0.0).then(|| (self.squares / self.count).sqrt())
    }
}

/// Means over the evaluation window, and extremes and counts over the run; SI units, forces on the disk.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Means {
    pub(crate) force: [Mean; 3],
    pub(crate) traction: Mean,
    pub(crate) creepage: Mean,
    pub(crate) torque: Mean,
    pub(crate) half_length: Mean,
    pub(crate) half_width: Mean,
    pub(crate) peak_pressure: Mean,
    pub(crate) peak_shear: Mean,
    pub(crate) area: Mean,
    pub(crate) stick: Mean,
    pub(crate) slip: Mean,
    pub(crate) stick_border: Mean,
    pub(crate) penetration: Mean,
    pub(crate) hourglass_share: Mean,
    pub(crate) worst_cone: f64,
    pub(crate) worst_mismatch: f64,
    /// Most sweeps of exact enforcement in a step.
    pub(crate) most_sweeps: usize,
    /// Sum over the steps of the nodes whose friction law had more than one solution.
    pub(crate) non_unique: u64,
    /// Integrals of mortar rows in all steps.
    pub(crate) integrated: u64,
    pub(crate) mesh_mode: MeshModeSums,
}
