//! Means over the evaluation window.

use crate::mesh_mode::MeshModeSums;
use case::remedy;
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
    /// Steps whose sweeps ended before forces had converged, and the largest change of a force in the last of them
    /// over the largest force.
    pub(crate) unconverged: (u64, f64),
    /// Sum over the steps of the nodes whose friction law had more than one solution.
    pub(crate) non_unique: u64,
    /// Largest steepness of friction in an implicit step, of a node and of all.
    pub(crate) steepness: [f64; 2],
    /// Integrals of mortar rows in all steps.
    pub(crate) integrated: u64,
    pub(crate) mesh_mode: MeshModeSums,
}

impl Means {
    /// Counts a step whose last sweep changed a force by `change` of the largest, where it did not converge.
    pub(crate) fn add_unconverged(&mut self, change: f64) {
        if change > 0.0 {
            let (steps, largest) = self.unconverged;
            self.unconverged = (steps + 1, largest.max(change));
        }
    }

    /// The warning about steps in which exact enforcement did not converge.
    pub(crate) fn unconverged_warning(&self) -> Option<String> {
        let (steps, change) = self.unconverged;
        (steps > 0).then(|| {
            format!(
                "exact contact did not converge in {steps} steps: its last sweep still changed a force by up to \
                 {change:.1e} of the largest, and the conditions of contact and friction hold no better than that; {}",
                remedy!(
                    "give both contact surfaces elements of one size"
                )
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_that_did_not_converge_are_counted_and_told() {
        let mut means = Means::default();
        assert_eq!(means.unconverged_warning(), None);
        [0.0, 1e-7, 0.0, 3e-5].into_iter().for_each(|change| means.add_unconverged(change));
        assert_eq!(means.unconverged, (2, 3e-5));
        let said = means.unconverged_warning().unwrap_or_default();
        assert!(said.contains("in 2 steps") && said.contains("3.0e-5"), "{said}");
    }
}
