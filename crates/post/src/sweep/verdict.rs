//! The verdicts of a sweep: every measure along every axis.

use super::document::Sweep;
use super::measures::MEASURES;
use super::trend::{Sample, Trend, trend};
use crate::PostError;
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
            "verdict": self.trend.word(),
            "why": self.trend.sentence(self.points, self.unit),
        })
    }
}

/// Keys whose refinement means smaller values; for all others it means larger values.
const TOWARDS_ZERO: [&str; 5] =
    ["mesh.zone.size", "mesh.growth", "mesh.coarsest", "time.factor", "time.step"];

/// Whether an axis is refined towards zero.
pub(crate) fn towards_zero(axis: &str) -> bool {
    TOWARDS_ZERO.contains(&axis)
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
            for measure in &MEASURES {
                let samples: Vec<Sample> = group
                    .members
                    .iter()
                    // a value of zero has no place on the fitted trend
                    .filter(|(x, _)| *x > 0.0)
                    .filter_map(|(x, run)| {
                        let point = measure.of(*run)?;
                        let scatter = point.scatter().unwrap_or(0.0);
                        Some(Sample { x: *x, value: point.value, scatter })
                    })
                    .collect();
                if !samples.is_empty() {
                    verdicts.push(SweepVerdict {
                        axis: axis.into(),
                        others: group.label.clone(),
                        measure: measure.name,
                        unit: measure.unit,
                        points: samples.len(),
                        trend: trend(&samples, towards_zero(axis)),
                    });
                }
            }
        }
    }
    Ok(verdicts)
}
