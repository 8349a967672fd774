//! Means over the evaluation window.

/// Running mean and standard deviation.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mean {
    count: f64,
    mean: f64,
    squares: f64,
}

impl Mean {
    /// Takes a sample in (Welford 1962); values that are not numbers are left out.
    pub(crate) fn add(&mut self, x: f64) {
        if x.is_finite() {
            self.count += 1.0;
            let away = x - self.mean;
            self.mean += away / self.count;
            self.squares += away * (x - self.mean);
        }
    }

    /// The mean; zero without samples.
    pub(crate) fn mean(&self) -> f64 {
        self.mean
    }

    /// The standard deviation; zero without samples.
    pub(crate) fn deviation(&self) -> f64 {
        if self.count > 0.0 { (self.squares / self.count).sqrt() } else { 0.0 }
    }
}

/// Means over the evaluation window and extremes over the run.
#[derive(Clone, Debug, Default)]
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
    /// Nodes and steps in which the law of friction had more than one solution.
    pub(crate) manifold: u64,
    /// Integrals of mortar rows, in all steps.
    pub(crate) integrated: u64,
}
