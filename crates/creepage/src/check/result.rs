//! What a check found: the document of `creepage check`.

use crate::check::limits::{Limit, MethodKind};
use crate::check::measure::Measure;
use crate::check::patch_series::PatchMeasure;
use crate::check::surface::body_name;
use output::layout::Pairing;
use output::summary;
use output::{Aliased, by_all_names, keyed, known};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// What a check found; `docs/checks.md` describes it. Numbers in SI units unless an entry says otherwise. What a file of
/// another version lacks has its default.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct CheckResult {
    /// Name of the run's case, else of its folder.
    pub name: String,
    /// The window, from and to (s).
    pub window: [f64; 2],
    /// Times of the first and the last record in it (s).
    pub recorded: [f64; 2],
    /// Number of these records.
    pub steps: usize,
    /// Nodes of both surfaces.
    pub nodes: usize,
    /// Nodes in contact, summed over the records.
    pub node_times: usize,
    /// Whether every limit holds.
    pub pass: bool,
    /// The kind of method that the limits are for.
    pub limits_for: MethodKind,
    /// The limit of each measure; none where it has none.
    #[serde(serialize_with = "by_all_names", deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<Measure, Option<Limit>>")]
    pub limits: BTreeMap<Measure, Option<Limit>>,
    /// The measures.
    #[serde(serialize_with = "by_all_names", deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<Measure, Metric>")]
    pub metrics: BTreeMap<Measure, Metric>,
    /// Which slip velocity a traction is paired with.
    pub pairing: PairingUsed,
    /// The friction law.
    pub law: LawUsed,
    /// On which part of contact area and time the law's coefficient is known.
    #[serde(deserialize_with = "by_either_name")]
    pub law_followed: LawFollowed,
    /// The scales of the measures by their names.
    pub scales: BTreeMap<String, ScaleUsed>,
    /// From where on a node is in contact or adhesion, and violates the law or the direction.
    pub tolerances: Tolerances,
    /// Means of the patch.
    #[serde(deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<PatchMeasure, PatchMean>")]
    pub patch: BTreeMap<PatchMeasure, PatchMean>,
    /// Slip that alternates from node to node.
    pub mesh_mode: MeshModeFound,
    /// Slip over the slip zone; none where nothing slips.
    pub slip_zone: Option<SlipZoneFound>,
    /// What could not be measured, and what to know of the rest.
    pub notes: Vec<String>,
}

/// A part of the interface.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, JsonSchema, Serialize, Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum View {
    /// The nodes of the disk with the slip velocity recorded for them.
    Disk,
    /// The nodes of the bar with the slip velocity recorded for them.
    Bar,
    /// The nodes of a third body.
    Other,
    /// The slave nodes with the slip velocity of their closest-point projection on the other body's faces.
    Pair,
    /// The nodes of both bodies.
    Both,
}

impl View {
    /// The nodes of a body by its number in the layout.
    pub fn of(body: u8) -> Self {
        match body {
            0 => Self::Disk,
            1 => Self::Bar,
            _ => Self::Other,
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Disk => body_name(0),
            Self::Bar => body_name(1),
            Self::Other => body_name(u8::MAX),
            Self::Pair => "pair",
            Self::Both => "both",
        }
    }
}

impl fmt::Display for View {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// A measure of the contact conditions over the window.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct Metric {
    /// Its value; none where it could not be measured, or is infinite.
    pub value: Option<f64>,
    /// Its limit.
    pub limit: Option<Limit>,
    /// Whether it is within its limit. Without a value it fails only where the user set the limit.
    pub pass: bool,
    /// Whether penalty springs that deform in stick take it beyond its limit: what is left of it where the algorithm's
    /// state is slip keeps its limit, or is at most a tenth of it.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub by_springs: bool,
    /// Where and when it is worst.
    #[serde(rename = "where")]
    pub place: Option<Place>,
    /// Unit of its value.
    pub units: String,
    /// The statistic over nodes and times that it is.
    pub statistic: String,
    /// Its definition.
    pub about: String,
    /// The part of the interface that the value is of.
    pub side: Option<View>,
    /// The pairing that the value is of.
    pub pairing: Option<Pairing>,
    /// Standard deviation over the records of the same statistic of single records.
    pub deviation: Option<f64>,
    /// Switches per node and microsecond, of `switching_rate`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub per_node_and_microsecond: Option<f64>,
    /// Why there is no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// The statistics of all parts of the interface.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sides: Option<Sides>,
}

impl Metric {
    /// A measure with its value and limit; `asked`: the user set the limit.
    pub(super) fn new(
        measure: Measure,
        value: Option<f64>,
        limit: Option<Limit>,
        asked: bool,
    ) -> Self {
        let definition = measure.definition();
        let pass = match (value, limit) {
            (Some(value), Some(limit)) => limit.holds(value),
            (None, Some(_)) => !asked,
            (_, None) => true,
        };
        Self {
            value: value.filter(|value| value.is_finite()),
            limit,
            pass,
            units: definition.units.into(),
            statistic: definition.statistic.into(),
            about: definition.about.into(),
            ..Self::default()
        }
    }

    /// A statistic beside its value on a part of the interface, in a pairing where there are two.
    pub fn detail(&self, view: View, pairing: Pairing, detail: Detail) -> Option<f64> {
        let Some(Sides::Views(views)) = &self.sides else {
            return None;
        };
        let statistics = match views.get(&view)? {
            OnView::Paired(paired) => paired.get(&pairing)?,
            OnView::Single(statistics) => statistics,
        };
        statistics.more.get(&detail).copied().flatten()
    }

    /// How it stands to its limit.
    pub fn verdict(&self) -> Verdict {
        match self.keeps_limit() {
            None => Verdict::None,
            Some(true) => Verdict::Pass,
            Some(false) if self.by_springs => Verdict::Springs,
            Some(false) => Verdict::Fail,
        }
    }

    /// Whether it keeps its limit; `None` without a limit, or without a value that could keep it.
    pub fn keeps_limit(&self) -> Option<bool> {
        let without = self.limit.is_none() || (self.value.is_none() && self.pass);
        (!without).then_some(self.pass)
    }
}

/// What is left of a measure where the algorithm's state is slip, at most, if springs account for the rest.
pub(super) const IN_SLIP_STATE: f64 = 0.1;

/// How a measure stands to its limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It has no limit, or no value that could keep one.
    None,
    /// It keeps its limit.
    Pass,
    /// It exceeds its limit because penalty springs deform in stick, which is known of the method.
    Springs,
    /// It exceeds its limit.
    Fail,
}

impl Verdict {
    /// The word for it in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Pass => "pass",
            Self::Springs => "springs",
            Self::Fail => "FAIL",
        }
    }
}

/// Where and when a measure is worst.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Place {
    /// The part of the interface.
    pub side: View,
    /// The pairing.
    pub pairing: Option<Pairing>,
    /// Index of the node in the file.
    pub node: Option<usize>,
    /// Its reference position (m).
    pub position: Option<[f64; 3]>,
    /// Time (s).
    pub time: f64,
    /// The value there; none where it is infinite.
    pub value: Option<f64>,
    /// The coefficient that the algorithm used there, of `mu_error` and `mu_error_uncertain`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mu_used: Option<f64>,
    /// The coefficient of the law there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mu_law: Option<f64>,
}

/// The statistics of a measure on all parts of the interface.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Sides {
    /// Switches per node and microsecond.
    Switches {
        /// By the algorithm's state.
        by_state: BTreeMap<View, f64>,
        /// By the slip velocity.
        by_slip: BTreeMap<View, f64>,
    },
    /// Of any other measure.
    Views(BTreeMap<View, OnView>),
}

/// The statistics of a measure on a part of the interface.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(untagged)]
pub enum OnView {
    /// In either pairing.
    Paired(BTreeMap<Pairing, Statistics>),
    /// Of a measure without slip.
    Single(Statistics),
}

/// A value with further statistics.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Statistics {
    /// The value of the measure.
    pub value: Option<f64>,
    /// Further statistics.
    #[serde(flatten, serialize_with = "by_all_names", deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<Detail, Option<f64>>")]
    pub more: BTreeMap<Detail, Option<f64>>,
}

/// A statistic beside the value of a measure, in the unit of the measure unless it says otherwise.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, JsonSchema, Serialize, Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Detail {
    /// Weighted mean.
    Mean,
    /// Median.
    Median,
    /// Root mean square.
    Rms,
    /// 95 % of the values are below.
    P95,
    /// Largest value.
    Max,
    /// Root mean square where the algorithm's state is slip.
    #[serde(alias = "rms_where_let_slip")]
    RmsSlipState,
    /// Energy exchanged in slip (J).
    Energy,
    /// Standard deviation over time of p_f/p_n (dimensionless).
    DeviationTraction,
    /// The same of mu(|s|) (dimensionless).
    DeviationLaw,
    /// The same of |s|/s_c (dimensionless).
    DeviationSlip,
    /// Mean coefficient that the algorithm used.
    MuUsed,
    /// Mean coefficient of the law.
    MuLaw,
    /// The coefficient used where the error is largest.
    MuUsedWorst,
    /// That of the law there.
    MuLawWorst,
    /// Median of the relative interval in which the law's coefficient is known to lie.
    #[serde(alias = "blur_median")]
    UncertaintyMedian,
    /// Its root mean square.
    #[serde(alias = "blur_rms")]
    UncertaintyRms,
    /// 95 % of it is below.
    #[serde(alias = "blur_p95")]
    UncertaintyP95,
}

impl Aliased for Detail {
    fn aliases(&self) -> &'static [&'static str] {
        match self {
            Self::RmsSlipState => &["rms_where_let_slip"],
            Self::UncertaintyMedian => &["blur_median"],
            Self::UncertaintyRms => &["blur_rms"],
            Self::UncertaintyP95 => &["blur_p95"],
            _ => &[],
        }
    }
}

impl Aliased for Measure {
    fn aliases(&self) -> &'static [&'static str] {
        self.definition().aliases
    }
}

/// Which slip velocity a traction is paired with in time.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct PairingUsed {
    /// The pairing that the values are of.
    pub reported: Reported,
    /// That of each record of the file.
    pub in_file: Pairing,
    /// Whether the file states it as its method's own.
    pub stated_by_file: bool,
    /// The body at whose nodes the conditions are enforced, where the file says it.
    pub enforced_on: Option<View>,
    /// Number of records of which the other pairing is measured too.
    pub records_with_the_other: usize,
}

/// The pairing that the values of a check are of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Reported {
    /// With the slip velocity of the step before.
    Before,
    /// With that of the step after.
    After,
    /// Measure by measure with that which gives the larger violation.
    #[default]
    Stricter,
}

impl Reported {
    /// The slip velocity that is paired with a traction, in words.
    pub fn slip(self) -> &'static str {
        match self {
            Self::Before => "that of the step before",
            Self::After => "that of the step after",
            Self::Stricter => "that of the step before or after, whichever is stricter",
        }
    }
}

impl From<Pairing> for Reported {
    fn from(pairing: Pairing) -> Self {
        match pairing {
            Pairing::Before => Self::Before,
            Pairing::After => Self::After,
        }
    }
}

/// The friction law of a check.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct LawUsed {
    /// Its word, of Coulomb's law and of those of the form of Eq. (8).
    pub law: Option<String>,
    /// Coefficient at rest.
    #[serde(rename = "static", default, skip_serializing_if = "Option::is_none")]
    pub mu_static: Option<f64>,
    /// Coefficient at high slip velocity, as in Eq. (8).
    #[serde(rename = "dynamic", default, skip_serializing_if = "Option::is_none")]
    pub mu_dynamic: Option<f64>,
    /// Its decay (s/m).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decay: Option<f64>,
    /// Which coefficient bounds the shear.
    pub bound: String,
}

/// Shares of contact area and time on which the law's coefficient is known.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct LawFollowed {
    /// To round-off.
    pub known: Option<f64>,
    /// To an interval.
    pub uncertain: Option<f64>,
    /// The same, by another name.
    pub blurred: Option<f64>,
    /// Not at all.
    pub unknown: Option<f64>,
    /// Why the law cannot be followed.
    pub note: Option<String>,
}

/// A document of another version has one of the names alone.
fn by_either_name<'de, D: Deserializer<'de>>(from: D) -> Result<LawFollowed, D::Error> {
    let read = LawFollowed::deserialize(from)?;
    let share = read.uncertain.or(read.blurred);
    Ok(LawFollowed { uncertain: share, blurred: share, ..read })
}

/// A scale of the measures.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct ScaleUsed {
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub units: String,
    /// What it is.
    pub about: String,
    /// Its origin.
    pub from: String,
}

/// Tolerances of the conditions at a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct Tolerances {
    /// Pressure over p0 above which a node is in contact.
    pub in_contact: f64,
    /// Shear over the bound below which a node is in adhesion.
    pub in_adhesion: f64,
    /// |p_f/(mu p_n) - 1| above which the law is violated.
    pub law_error: f64,
    /// Angle (degrees) above which the direction is.
    pub direction: f64,
}

/// A mean of the patch over the window.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct PatchMean {
    /// The mean; none where no record has a value.
    pub mean: Option<f64>,
    /// Standard deviation over the records.
    pub deviation: Option<f64>,
    /// Half the width of the 95 % confidence interval of the mean.
    pub ci95: Option<f64>,
    /// Its unit.
    pub units: String,
    /// What it is.
    pub about: String,
    /// Where it comes from: the summary, the history or the contact records.
    pub from: String,
    /// Why there is no mean, or which rows it leaves out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// Slip that alternates from node to node, and where it was measured.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct MeshModeFound {
    /// What was found.
    #[serde(flatten)]
    pub mode: summary::MeshMode,
    /// The summary of the run, or its contact records.
    pub from: String,
}

/// Statistics of slip over the slip zone, or why there are none.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SlipZoneFound {
    /// Why there are none.
    Not {
        /// The reason.
        note: String,
    },
    /// The statistics.
    Measured(SlipZoneMeasured),
}

/// Statistics of slip over the slip zone; docs/checks.md defines them.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct SlipZoneMeasured {
    /// The statistics.
    #[serde(flatten, deserialize_with = "known")]
    #[schemars(schema_with = "keyed::<SlipQuantity, SlipStatistic>")]
    pub statistics: BTreeMap<SlipQuantity, SlipStatistic>,
    /// Rear end of the zone (m).
    #[serde(default)]
    pub from: Option<f64>,
    /// Front end of the zone (m).
    #[serde(default)]
    pub to: Option<f64>,
}

/// A statistic of slip over the slip zone.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, JsonSchema, Serialize, Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum SlipQuantity {
    /// Mean slip speed.
    Mean,
    /// Root mean square of the fluctuation.
    Fluctuation,
    /// That over the root mean square of all slip.
    FluctuatingShare,
    /// The same share with the mean over the time in which three elements pass.
    FluctuatingShareOfElements,
    /// Largest slip speed.
    Largest,
    /// Distance over which the fluctuation correlates.
    CorrelationLength,
    /// Time over which it does.
    CorrelationTime,
    /// Mean wavenumber of its power spectrum.
    MeanWavenumber,
    /// Mean frequency of its power spectrum.
    MeanFrequency,
}

impl SlipQuantity {
    /// Its unit and what it is.
    pub const fn definition(self) -> (&'static str, &'static str) {
        match self {
            Self::Mean => ("m/s", "mean slip speed"),
            Self::Fluctuation => ("m/s", "rms of what differs from the mean over 2a/(10 V)"),
            Self::FluctuatingShare => ("1", "that over the rms of all slip"),
            Self::FluctuatingShareOfElements => ("1", "the same share with the mean over 3 h/V"),
            Self::Largest => ("m/s", "largest slip speed"),
            Self::CorrelationLength => {
                ("m", "distance over which the fluctuation correlates to more than 1/e")
            }
            Self::CorrelationTime => ("s", "time over which it does, at places of the patch"),
            Self::MeanWavenumber => ("1/m", "mean wavenumber of its power spectrum"),
            Self::MeanFrequency => ("Hz", "mean frequency of its power spectrum"),
        }
    }
}

/// The value of a statistic of slip.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct SlipStatistic {
    /// Its value; none where the records do not resolve it.
    pub value: Option<f64>,
    /// Half the width of its 95 % confidence interval.
    pub ci95: Option<f64>,
    /// Standard deviation over the records of the same statistic of single records.
    pub deviation: Option<f64>,
    /// Its unit.
    pub units: String,
    /// What it is.
    pub about: String,
    /// Why there is no value, or no interval.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

impl SlipStatistic {
    /// One without an interval.
    pub(super) fn of(quantity: SlipQuantity, value: Option<f64>) -> Self {
        let (units, about) = quantity.definition();
        Self { value, units: units.into(), about: about.into(), ..Self::default() }
    }
}

impl CheckResult {
    /// The slip zone, where it was measured.
    pub fn slip_zone(&self) -> Option<&SlipZoneMeasured> {
        match self.slip_zone.as_ref()? {
            SlipZoneFound::Measured(zone) => Some(zone),
            SlipZoneFound::Not { .. } => None,
        }
    }

    /// The measures with this verdict.
    pub fn with_verdict(&self, verdict: Verdict) -> Vec<Measure> {
        let found = self.metrics.iter().filter(|(_, metric)| metric.verdict() == verdict);
        found.map(|(measure, _)| *measure).collect()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_view_has_one_name_on_pages_and_in_documents() {
        for view in [View::Disk, View::Bar, View::Other, View::Pair, View::Both] {
            assert_eq!(serde_json::to_value(view).unwrap(), view.name());
        }
    }

    #[test]
    fn a_measure_that_this_version_does_not_know_is_left_out() {
        let written = r#"{ "metrics": { "penetration": { "value": 1.0, "sides": { "bar": {
            "before": { "value": 1.0, "rms": 2.0, "p99": 3.0 } } } }, "stretch": 4 } }"#;
        let result: CheckResult = serde_json::from_str(written).unwrap();
        assert_eq!(result.metrics.len(), 1);
        let rms =
            result.metrics[&Measure::Penetration].detail(View::Bar, Pairing::Before, Detail::Rms);
        assert_eq!(rms, Some(2.0));
    }

    #[test]
    fn a_measure_reads_by_its_alias_and_stands_in_the_document_by_both_names() {
        let written = r#"{ "law_followed": { "blurred": 0.5 }, "metrics": { "direction_let_slip": { "value": 2.5, "sides": { "bar": {
            "before": { "value": 2.5, "blur_rms": 2.0 } } } } } }"#;
        let result: CheckResult = serde_json::from_str(written).unwrap();
        let metric = &result.metrics[&Measure::DirectionSlipState];
        let rms = metric.detail(View::Bar, Pairing::Before, Detail::UncertaintyRms);
        assert_eq!((metric.value, rms), (Some(2.5), Some(2.0)));
        assert_eq!(result.law_followed.uncertain, Some(0.5));
        let document = serde_json::to_value(&result).unwrap();
        let metrics = &document["metrics"];
        assert_eq!(metrics["direction_slip_state"], metrics["direction_let_slip"]);
        let statistics = &metrics["direction_slip_state"]["sides"]["bar"]["before"];
        assert_eq!(
            (&statistics["blur_rms"], &statistics["uncertainty_rms"]),
            (&2.0.into(), &2.0.into())
        );
        assert_eq!(serde_json::from_value::<CheckResult>(document).unwrap(), result);
    }

    #[test]
    fn a_measure_without_a_value_is_not_judged_unless_its_limit_was_asked_for() {
        let of = |value, limit, asked| {
            Metric::new(Measure::Penetration, value, limit, asked).keeps_limit()
        };
        let limit = Some(Limit::Most(5e-3));
        assert_eq!(of(None, limit, false), None);
        assert_eq!(of(None, limit, true), Some(false));
        assert_eq!(of(Some(1e-3), limit, false), Some(true));
        assert_eq!(of(Some(1e-2), limit, false), Some(false));
        assert_eq!(of(Some(f64::INFINITY), limit, false), Some(false));
        assert_eq!(of(Some(1e-2), None, false), None);
    }
}
