//! The verdicts of a sweep: every measure along every axis.

use super::document::{Sweep, steps};
use super::measures::{MEASURES, MeasuredPoint, SweepMeasure};
use super::trend::{Refinement, Sample, Trend, trend};
use crate::check::PostError;
use serde_json::{Value, json};
use std::path::Path;

/// The verdict on a measure along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepVerdict {
    /// Key of the axis, such as `mesh.zone.size`.
    pub axis: String,
    /// The other axes with their values, as text; empty where there are none.
    pub others: String,
    /// Name of the measure.
    pub measure: &'static str,
    /// Its unit; empty for pure numbers.
    pub unit: &'static str,
    /// Number of points.
    pub points: usize,
    /// Smallest and largest time step of the runs (s), where the step changes along the axis and is not what the
    /// axis gives.
    pub steps: Option<[f64; 2]>,
    /// The trend.
    pub trend: Trend,
}

impl SweepVerdict {
    /// The verdict as JSON: measure, axis, whether it settles, and why.
    pub fn document(&self) -> Value {
        json!({
            "axis": self.axis,
            "others": self.others,
            "measure": self.measure,
            "unit": self.unit,
            "points": self.points,
            "time_steps": self.steps,
            "verdict": self.trend.word(),
            "why": self.trend.sentence(self.points, self.unit),
        })
    }
}

/// Keys whose refinement means smaller values; for all others it means larger values.
const TOWARDS_ZERO: [&str; 5] =
    ["mesh.zone.size", "mesh.growth", "mesh.coarsest", "time.factor", "time.step"];

/// Axes that give the time step.
const OF_THE_STEP: [&str; 2] = ["time.factor", "time.step"];

/// Whether an axis is refined towards zero.
pub(crate) fn towards_zero(axis: &str) -> bool {
    TOWARDS_ZERO.contains(&axis)
}

/// The springs that friction forces pass through, in series with the bodies.
const SPRINGS: &str = "contact.penalty.tangential";

fn refinement(axis: &str, measure: &SweepMeasure) -> Refinement {
    match axis {
        SPRINGS if measure.of_friction => Refinement::Springs,
        _ if towards_zero(axis) => Refinement::TowardsZero,
        _ => Refinement::Upwards,
    }
}

/// The verdicts on all measures that the runs of a sweep have, along each axis of numbers; values of the axis that
/// are not positive are left out. `folder` is the folder of the sweep, `sweep` the content of its `sweep.json`.
///
/// # Errors
/// A document that is no sweep.
pub fn sweep_verdicts(folder: &Path, sweep: &Value) -> Result<Vec<SweepVerdict>, PostError> {
    let sweep = Sweep::of(folder, sweep)?;
    let mut verdicts = Vec::new();
    for axis in sweep.numeric_axes() {
        for group in sweep.groups(axis) {
            let steps = steps(group.members.iter().map(|(_, run)| *run));
            let steps = steps.filter(|_| !OF_THE_STEP.contains(&axis));
            for measure in &MEASURES {
                let samples: Vec<Sample> = group
                    .members
                    .iter()
                    // a value of zero has no place on the fitted trend
                    .filter(|(x, _)| *x > 0.0)
                    .filter_map(|(x, run)| {
                        let MeasuredPoint { value, half, deviation } = measure.of(*run)?;
                        Some(Sample { x: *x, value, half, deviation })
                    })
                    .collect();
                if !samples.is_empty() {
                    verdicts.push(SweepVerdict {
                        axis: axis.into(),
                        others: group.label.clone(),
                        measure: measure.name,
                        unit: measure.unit,
                        points: samples.len(),
                        steps,
                        trend: trend(&samples, refinement(axis, measure)),
                    });
                }
            }
        }
    }
    Ok(verdicts)
}
