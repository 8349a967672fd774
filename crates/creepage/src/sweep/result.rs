//! What a sweep came to: `plan.json` and `sweep.json`.

use std::collections::BTreeMap;
use std::path::Path;

use crate::check::measure::Measure;
use crate::check::patch_series::PatchMeasure;
use crate::check::result::{CheckResult, SlipQuantity};
use output::summary::{Mean, Status, Summary};
use output::{by_all_names, keyed, known};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

/// Values of swept keys, by dotted path, as a case file has them.
pub type Parameters = BTreeMap<String, toml::Value>;

/// The schema of values of keys of a case, which are of any type.
fn values_of_keys(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "object" })
}

/// What a sweep does.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct SweepPlan {
    /// Its name.
    #[serde(default)]
    pub name: String,
    /// Its title.
    #[serde(default)]
    pub title: Option<String>,
    /// Path of the sweep file.
    #[serde(default)]
    pub file: String,
    /// Path of the case that it varies.
    #[serde(default)]
    pub base: String,
    /// Version of the program that laid it out.
    #[serde(default)]
    pub creepage_version: String,
    /// SHA-256 of its cases and the rule of the step: what identifies it.
    #[serde(default)]
    pub hash: String,
    /// `grid` or `zip`.
    #[serde(default)]
    pub mode: String,
    /// Keys of the axes.
    pub parameters: Vec<String>,
    /// Values of each axis.
    #[serde(default)]
    #[schemars(schema_with = "values_of_keys")]
    pub axes: BTreeMap<String, Vec<toml::Value>>,
    /// Key of the axis of the members of an ensemble, where there is one.
    #[serde(default)]
    pub ensemble: Option<String>,
    /// The rule of the time step.
    #[serde(default)]
    pub step: PlannedStep,
}

/// The rule of the time step of a sweep.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct PlannedStep {
    /// `fixed` or `bound`; none where the cases give it.
    pub rule: Option<String>,
    /// The step of all runs (s), with `fixed`.
    pub step: Option<f64>,
}

/// `plan.json`.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct PlanFile {
    /// What the sweep does.
    #[serde(flatten)]
    pub plan: SweepPlan,
    /// Its runs.
    pub runs: Vec<PlannedRun>,
}

/// A run of a plan.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct PlannedRun {
    /// Name of its folder and of its case.
    pub name: String,
    /// Values of the swept keys.
    #[schemars(schema_with = "values_of_keys")]
    pub parameters: Parameters,
}

/// `sweep.json`: what the sweep does, and what its runs gave.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct SweepResult {
    /// What the sweep does.
    #[serde(flatten)]
    pub plan: SweepPlan,
    /// Its runs.
    pub runs: Vec<SweepRun>,
    /// Of a sweep with an ensemble its points, means over their members.
    #[serde(default)]
    pub points: Vec<SweepPoint>,
    /// Fields of summaries that another run of the same sweep does not repeat.
    #[serde(default)]
    pub not_repeated: Vec<String>,
}

/// A run of a sweep.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct SweepRun {
    /// Name of its folder and of its case.
    pub name: Option<String>,
    /// Values of the swept keys.
    #[schemars(schema_with = "values_of_keys")]
    pub parameters: Parameters,
    /// How far it is: `completed`, `failed`, or why it is neither.
    pub status: Option<String>,
    /// Its folder, relative to that of the sweep.
    pub run: Option<String>,
    /// Its summary.
    pub summary: Option<Box<Summary>>,
    /// What its check found.
    pub check: Option<Box<CheckResult>>,
    /// Why it failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// A point of a sweep with an ensemble: means over the members that completed, with half the width of the 95 %
/// confidence intervals of these means (Student 1908).
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct SweepPoint {
    /// Values of the swept keys but for that of the members.
    #[schemars(schema_with = "values_of_keys")]
    pub parameters: Parameters,
    /// Names of its members.
    pub members: Vec<String>,
    /// How many completed.
    pub completed: usize,
    /// `completed` where more than one member did: one alone has no interval.
    pub status: String,
    /// Folder of the first that completed.
    pub run: Option<String>,
    /// Means of their summaries.
    pub summary: PointSummary,
    /// Means of their checks.
    pub check: PointCheck,
}

/// Means over the summaries of an ensemble's members.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct PointSummary {
    /// Time step of the first (s): the members differ in it by no more than their disturbance.
    pub dt: Option<f64>,
    /// Means of the section `contact`.
    #[serde(deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<Mean, f64>")]
    pub contact: BTreeMap<Mean, f64>,
    /// Means of the section `window`.
    pub window: PointWindow,
}

/// Means over the section `window` of an ensemble's members.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct PointWindow {
    /// Half the width of the 95 % confidence intervals of all means.
    pub ci95: PointHalves,
    /// Its ends (s).
    pub from: Option<f64>,
    /// See `from`.
    pub to: Option<f64>,
    /// The means.
    #[serde(flatten, deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<Mean, f64>")]
    pub means: BTreeMap<Mean, f64>,
}

/// Half the widths of the 95 % confidence intervals of a point's window.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct PointHalves {
    /// Of its ends (s).
    pub from: Option<f64>,
    /// See `from`.
    pub to: Option<f64>,
    /// Of the means.
    #[serde(flatten, deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<Mean, f64>")]
    pub means: BTreeMap<Mean, f64>,
}

/// Means over the checks of an ensemble's members.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct PointCheck {
    /// Of the measures.
    #[serde(serialize_with = "by_all_names", deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<Measure, MeanValue>")]
    pub metrics: BTreeMap<Measure, MeanValue>,
    /// Of the patch.
    #[serde(deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<PatchMeasure, MeanOfMeans>")]
    pub patch: BTreeMap<PatchMeasure, MeanOfMeans>,
    /// Of the slip zone.
    #[serde(deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<SlipQuantity, MeanValue>")]
    pub slip_zone: BTreeMap<SlipQuantity, MeanValue>,
}

/// A mean over the members of an ensemble.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct MeanValue {
    /// The mean.
    pub value: f64,
    /// Half the width of its 95 % confidence interval.
    pub ci95: f64,
}

/// A mean over the members of an ensemble of their means over time.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct MeanOfMeans {
    /// The mean.
    pub mean: f64,
    /// Half the width of its 95 % confidence interval.
    pub ci95: f64,
}

/// A value of a run, or of a point of an ensemble.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// Half the width of its 95 % confidence interval, where it has one.
    pub half: Option<f64>,
    /// Its standard deviation over the window, where it is known.
    pub deviation: Option<f64>,
}

impl Measured {
    /// In another unit.
    pub fn times(self, factor: f64) -> Self {
        let scaled = |number: f64| factor * number;
        let Self { value, half, deviation } = self;
        Self { value: scaled(value), half: half.map(scaled), deviation: deviation.map(scaled) }
    }

    /// Length of its bar in a figure to either side: half its interval, without one its standard deviation.
    pub fn bar(&self) -> Option<f64> {
        self.half.or(self.deviation)
    }
}

impl From<MeanValue> for Measured {
    fn from(MeanValue { value, ci95 }: MeanValue) -> Self {
        Self { value, half: Some(ci95), deviation: None }
    }
}

/// A run, or a point of an ensemble.
#[derive(Clone, Copy, Debug)]
pub enum Entry<'a> {
    /// A run.
    Run(&'a SweepRun),
    /// A point of an ensemble.
    Point(&'a SweepPoint),
}

/// The status of a run or a point whose results count.
pub const COMPLETED: &str = Status::Completed.word();

impl SweepRun {
    /// Whether it reached its end; one without a status where it has a summary.
    pub fn completed(&self) -> bool {
        match &self.status {
            Some(status) => status == COMPLETED,
            None => self.summary.is_some(),
        }
    }
}

impl SweepPlan {
    /// The rule that a time step of its own follows in every run.
    pub fn step_is_bound(&self) -> bool {
        self.step.rule.as_deref() == Some("bound")
    }
}

impl<'a> Entry<'a> {
    /// Whether it reached its end.
    pub fn completed(self) -> bool {
        match self {
            Self::Run(run) => run.completed(),
            Self::Point(point) => point.status == COMPLETED,
        }
    }

    /// Its status.
    pub fn status(self) -> &'a str {
        match self {
            Self::Run(run) => run.status.as_deref().unwrap_or("unknown"),
            Self::Point(point) => &point.status,
        }
    }

    /// Values of the swept keys.
    pub fn parameters(self) -> &'a Parameters {
        match self {
            Self::Run(run) => &run.parameters,
            Self::Point(point) => &point.parameters,
        }
    }

    /// Its folder, relative to that of the sweep; that of its first member.
    pub fn folder(self) -> Option<&'a Path> {
        match self {
            Self::Run(run) => run.run.as_deref(),
            Self::Point(point) => point.run.as_deref(),
        }
        .map(Path::new)
    }

    /// Its time step (s).
    pub fn step(self) -> Option<f64> {
        match self {
            Self::Run(run) => run.summary.as_ref().map(|summary| summary.dt),
            Self::Point(point) => point.summary.dt,
        }
    }

    /// The summary of a run.
    pub fn summary(self) -> Option<&'a Summary> {
        match self {
            Self::Run(run) => run.summary.as_deref(),
            Self::Point(_) => None,
        }
    }

    /// What the check of a run found.
    pub fn check(self) -> Option<&'a CheckResult> {
        match self {
            Self::Run(run) => run.check.as_deref(),
            Self::Point(_) => None,
        }
    }

    /// A mean over the evaluation window, from the summary.
    pub fn mean(self, mean: Mean) -> Option<Measured> {
        match self {
            Self::Run(run) => {
                let summary = run.summary.as_deref()?;
                let window = summary.window.as_ref();
                let deviation =
                    window.and_then(|window| window.deviation.get(&mean).copied().flatten());
                Some(Measured { value: summary.mean(mean)?, half: None, deviation })
            }
            Self::Point(point) => {
                let PointSummary { contact, window, .. } = &point.summary;
                let found = contact.get(&mean).or_else(|| window.means.get(&mean));
                let half = window.ci95.means.get(&mean).copied();
                Some(Measured { value: *found?, half, deviation: None })
            }
        }
    }

    /// A measure of the contact conditions.
    pub fn metric(self, measure: Measure) -> Option<Measured> {
        match self {
            Self::Run(run) => {
                let metric = run.check.as_ref()?.metrics.get(&measure)?;
                Some(Measured { value: metric.value?, half: None, deviation: metric.deviation })
            }
            Self::Point(point) => point.check.metrics.get(&measure).copied().map(Into::into),
        }
    }

    /// A mean of the patch, from the check.
    pub fn patch(self, measure: PatchMeasure) -> Option<Measured> {
        match self {
            Self::Run(run) => {
                let found = run.check.as_ref()?.patch.get(&measure)?;
                let (half, deviation) = (found.ci95, found.deviation);
                Some(Measured { value: found.mean?, half, deviation })
            }
            Self::Point(point) => {
                let MeanOfMeans { mean, ci95 } = *point.check.patch.get(&measure)?;
                Some(Measured { value: mean, half: Some(ci95), deviation: None })
            }
        }
    }

    /// A statistic of the slip zone.
    pub fn slip_zone(self, quantity: SlipQuantity) -> Option<Measured> {
        match self {
            Self::Run(run) => {
                let found = run.check.as_ref()?.slip_zone()?.statistics.get(&quantity)?;
                let (half, deviation) = (found.ci95, found.deviation);
                Some(Measured { value: found.value?, half, deviation })
            }
            Self::Point(point) => point.check.slip_zone.get(&quantity).copied().map(Into::into),
        }
    }
}
