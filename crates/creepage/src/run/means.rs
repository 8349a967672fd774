//! Means over the evaluation window.

use crate::case::schema::{Case, LoadMode};
use crate::case::value::number;
use crate::run::mesh_mode::MeshModeSums;
use output::confidence;
use serde::{Deserialize, Serialize};

/// Parts of the evaluation window, one after the other, of which the normal force has a mean each.
const PARTS: usize = 20;
/// A mean normal force nearer to the load than this part of it is as good as meshes and springs are.
const NEAR: f64 = 0.01;

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
    /// The normal force in parts of the window.
    #[serde(default)]
    pub(crate) normal_force_in_parts: [Mean; PARTS],
    pub(crate) traction: Mean,
    pub(crate) creepage: Mean,
    pub(crate) torque: Mean,
    pub(crate) half_length: Mean,
    pub(crate) half_width: Mean,
    pub(crate) peak_pressure: Mean,
    pub(crate) peak_shear: Mean,
    pub(crate) area: Mean,
    pub(crate) fitted_area: Mean,
    pub(crate) stick: Mean,
    pub(crate) slip: Mean,
    pub(crate) stick_border: Mean,
    pub(crate) penetration: Mean,
    pub(crate) hourglass_share: Mean,
    /// Time (s) and work of friction so far (J), in the first and the last row of the window.
    pub(crate) friction_work: Option<[[f64; 2]; 2]>,
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
    /// Adds the normal force (N) at a time that has `passed` so much of the evaluation window, from 0 to 1.
    pub(crate) fn add_normal_force(&mut self, force: f64, passed: f64) {
        let part = ((passed * PARTS as f64) as usize).min(PARTS - 1);
        self.normal_force_in_parts[part].add(force);
    }

    /// The warning about a mean normal force that misses the prescribed load by more than its 95 % interval, for a run
    /// that reached its end.
    pub(crate) fn load_warning(&self, case: &Case) -> Option<String> {
        let load = case.load.normal;
        let mean = self.force[2].mean()?;
        let miss = (mean - load).abs();
        let parts = self.normal_force_in_parts.map(|part| part.mean().unwrap_or(f64::NAN));
        let interval = confidence::of_series(&[1.0; PARTS], &parts);
        let is_far = miss > NEAR * load && !interval.is_ok_and(|half| miss <= half);
        if case.load.mode != LoadMode::Load || !is_far {
            return None;
        }
        let interval = match interval {
            Ok(half) => format!("and its 95 % interval is only +- {half:.2e} N"),
            Err(why) => format!("and has no interval ({why})"),
        };
        Some(format!(
            "the mean normal force of the evaluation window, {mean:.4e} N, is {:.0} % off load.normal = {} N, {interval}: \
             the disk has not come to rest on the bar, and its inertia bears the difference; roll further (time.roll), \
             evaluate later (evaluate.last), or refine mesh.zone.size until the patch has several elements",
            100.0 * miss / load,
            number(load)
        ))
    }

    /// The mean power of friction between the first and the last row of the window (W).
    pub(crate) fn friction_power(&self) -> Option<f64> {
        let [[from, before], [to, after]] = self.friction_work?;
        (to > from).then(|| (after - before) / (to - from))
    }

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
                 {change:.1e} of the largest, and the conditions of contact and friction hold no better than that; give both \
                 contact surfaces elements of one size"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
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

    /// Means of a normal force over the evaluation window.
    fn pressed(force: impl Fn(f64) -> f64) -> Means {
        let mut means = Means::default();
        for step in 0..1000 {
            let passed = f64::from(step) / 1000.0;
            let force = force(passed);
            means.force[2].add(force);
            means.add_normal_force(force, passed);
        }
        means
    }

    #[test]
    fn a_mean_normal_force_that_misses_the_load_by_more_than_its_interval_is_told() {
        let text = "load.normal = 1e5\ndrive.speed = 38.89\ndrive.creepage = 2e-3\nfriction.static = 0.5\n";
        let held = Case::from_text(text, "a.toml".as_ref(), &["load.mode=height".into()]).unwrap();
        let case = Case::from_text(text, "a.toml".as_ref(), &[]).unwrap();
        let wave = |size: f64| move |passed: f64| size * libm::sin(400.0 * passed);
        let said = pressed(|t| 6e3 + wave(1e3)(t)).load_warning(&case).unwrap_or_default();
        for words in
            ["6.00", "94 % off load.normal = 100000 N", "95 % interval is only", "time.roll"]
        {
            assert!(said.contains(words), "{said}");
        }
        assert!(pressed(|_| 6e3).load_warning(&held).is_none());
        assert!(pressed(|t| 100.4e3 + wave(300.0)(t)).load_warning(&case).is_none());
        // a bounce as slow as the window has no interval
        let said = pressed(|t| 2e5 * t * t).load_warning(&case).unwrap_or_default();
        assert!(said.contains("33 % off") && said.contains("no interval (it drifts"), "{said}");
        assert!(Means::default().load_warning(&case).is_none());
    }
}
