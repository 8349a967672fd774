//! Means over the evaluation window.

use crate::mesh_mode::MeshModeSums;

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

    /// Number of samples.
    pub(crate) fn count(&self) -> u64 {
        self.count as u64
    }

    /// The mean; none without samples.
    pub(crate) fn mean(&self) -> Option<f64> {
        (self.count > 0.0).then_some(self.mean)
    }

    /// The standard deviation; none without samples.
    pub(crate) fn deviation(&self) -> Option<f64> {
        (self.count > 0.0).then(|| (self.squares / self.count).sqrt())
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
    pub(crate) non_unique: u64,
    /// Integrals of mortar rows, in all steps.
    pub(crate) integrated: u64,
    pub(crate) mesh_mode: MeshModeSums,
}

impl Means {
    /// Numbers that they are made of.
    pub(crate) const NUMBERS: usize = 3 * 16 + 5 + MeshModeSums::NUMBERS;

    fn each(&mut self) -> [&mut Mean; 16] {
        let [tangential, lateral, normal] = &mut self.force;
        [
            tangential,
            lateral,
            normal,
            &mut self.traction,
            &mut self.creepage,
            &mut self.torque,
            &mut self.half_length,
            &mut self.half_width,
            &mut self.peak_pressure,
            &mut self.peak_shear,
            &mut self.area,
            &mut self.stick,
            &mut self.slip,
            &mut self.stick_border,
            &mut self.penetration,
            &mut self.hourglass_share,
        ]
    }

    /// As numbers, for a checkpoint; counts are exact below 2^53.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let mut copy = self.clone();
        let means = copy.each().into_iter().flat_map(|m| [m.count, m.mean, m.squares]);
        let counts = [self.most_sweeps as f64, self.non_unique as f64, self.integrated as f64];
        let rest = [self.worst_cone, self.worst_mismatch].into_iter().chain(counts);
        means.chain(rest).chain(self.mesh_mode.numbers()).collect()
    }

    /// The reverse of [`Self::numbers`].
    pub(crate) fn from_numbers(numbers: &[f64; Self::NUMBERS]) -> Self {
        let mut means = Self::default();
        let [samples @ .., cone, mismatch, sweeps, non_unique, integrated, a, b, c, d, e] =
            *numbers;
        for (mean, &[count, value, squares]) in means.each().into_iter().zip(samples.as_chunks().0)
        {
            *mean = Mean { count, mean: value, squares };
        }
        (means.worst_cone, means.worst_mismatch) = (cone, mismatch);
        (means.most_sweeps, means.non_unique) = (sweeps as usize, non_unique as u64);
        means.integrated = integrated as u64;
        means.mesh_mode = MeshModeSums::from_numbers([a, b, c, d, e]);
        means
    }
}
