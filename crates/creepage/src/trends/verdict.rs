//! The verdicts of a sweep: every measure along every axis.

use super::groups::{Group, Sweep, steps};
use super::measures::{MEASURES, SweepMeasure};
use super::trend::{Refinement, Sample, Trend, trend};
use crate::sweep::result::{Measured, SweepResult};
use serde::Serialize;
use std::path::Path;

/// The verdict on a measure along an axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
    pub time_steps: Option<[f64; 2]>,
    /// The verdict in words.
    pub verdict: &'static str,
    /// Why, in a sentence.
    pub why: String,
    /// The trend.
    #[serde(skip)]
    pub trend: Trend,
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

/// The trend of a measure over an axis, and the number of its points; a value of zero on the axis has no place on a
/// fitted trend. `None` where no run has the measure.
pub(super) fn group_trend(
    axis: &str,
    group: &Group<'_>,
    measure: &SweepMeasure,
) -> Option<(usize, Trend)> {
    let points = group.points(measure).into_iter().filter(|(x, _)| *x > 0.0);
    let samples: Vec<Sample> = points
        .map(|(x, Measured { value, half, deviation })| Sample { x, value, half, deviation })
        .collect();
    let trend = trend(&samples, refinement(axis, measure));
    (!samples.is_empty()).then_some((samples.len(), trend))
}

/// The verdicts on all measures that the runs of a sweep have, along each axis of numbers; values of the axis that
/// are not positive are left out. `folder` is the folder of the sweep.
pub fn sweep_verdicts(folder: &Path, sweep: &SweepResult) -> Vec<SweepVerdict> {
    let sweep = Sweep::of(folder, sweep);
    let mut verdicts = Vec::new();
    for axis in sweep.numeric_axes() {
        for group in sweep.groups(axis) {
            let steps = steps(group.members.iter().map(|(_, run)| *run));
            let time_steps = steps.filter(|_| !OF_THE_STEP.contains(&axis));
            for measure in &MEASURES {
                let Some((points, trend)) = group_trend(axis, &group, measure) else { continue };
                verdicts.push(SweepVerdict {
                    axis: axis.into(),
                    others: group.label.clone(),
                    measure: measure.name,
                    unit: measure.unit,
                    points,
                    time_steps,
                    verdict: trend.word(),
                    why: trend.sentence(points, measure.unit),
                    trend,
                });
            }
        }
    }
    verdicts
}
