//! The measures that a sweep follows over its axes.

use crate::check::measure::Measure;
use crate::check::patch_series::PatchMeasure;
use crate::check::result::{Detail, SlipQuantity, View};
use crate::sweep::result::{Entry, Measured};
use output::summary::Mean;

/// A measure of the runs of a sweep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SweepMeasure {
    /// Name in tables and verdicts.
    pub name: &'static str,
    /// Unit after `factor`; empty for pure numbers.
    pub unit: &'static str,
    /// Factor from the SI unit to `unit`.
    pub factor: f64,
    /// Where a run has it.
    source: Source,
    /// Whether the table of runs shows it.
    pub in_table: bool,
    /// Whether it is a force of friction, which friction springs carry.
    pub of_friction: bool,
}

/// Where a run has a measure.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// A mean over the evaluation window; for runs of other codes what their check found.
    Mean(Mean, PatchMeasure),
    /// A mean of the patch, from the check.
    Patch(PatchMeasure),
    /// A statistic of the slip zone.
    SlipZone(SlipQuantity),
    /// A measure of the contact conditions.
    Metric(Measure),
    /// Standard deviation over time of |s|/s_c, of the bar where it has one, in the pairing that the records have.
    SlipRoughness,
}

use Source as S;

const fn measure(
    name: &'static str,
    unit: &'static str,
    factor: f64,
    in_table: bool,
    source: Source,
) -> SweepMeasure {
    SweepMeasure { name, unit, factor, source, in_table, of_friction: false }
}

/// A measure of the contact conditions.
const fn metric(measure: Measure, unit: &'static str, in_table: bool) -> SweepMeasure {
    self::measure(measure.name(), unit, 1.0, in_table, S::Metric(measure))
}

/// The measure as one of a force of friction.
const fn of_friction(measure: SweepMeasure) -> SweepMeasure {
    SweepMeasure { of_friction: true, ..measure }
}

/// Any number.
pub(super) const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// All measures, in the order of figures and tables.
pub(crate) const MEASURES: [SweepMeasure; 24] = [
    measure(
        "peak pressure (fit)",
        "MPa",
        1e-6,
        true,
        S::Mean(Mean::PeakPressure, PatchMeasure::PeakPressure),
    ),
    measure(
        "creepage",
        "10\u{207b}\u{b3}",
        1e3,
        true,
        S::Mean(Mean::Creepage, PatchMeasure::Creepage),
    ),
    of_friction(measure(
        "T/N",
        "",
        1.0,
        true,
        S::Mean(Mean::TractionCoefficient, PatchMeasure::TractionCoefficient),
    )),
    of_friction(measure(
        "peak shear",
        "MPa",
        1e-6,
        true,
        S::Mean(Mean::PeakShear, PatchMeasure::PeakShear),
    )),
    measure(
        "half length",
        "mm",
        1e3,
        true,
        S::Mean(Mean::PatchHalfLength, PatchMeasure::HalfLength),
    ),
    measure(
        "stick fraction",
        "",
        1.0,
        true,
        S::Mean(Mean::StickFraction, PatchMeasure::StickFraction),
    ),
    measure("power of friction", "kW", 1e-3, false, S::Patch(PatchMeasure::Power)),
    measure("mean slip", "m/s", 1.0, true, S::SlipZone(SlipQuantity::Mean)),
    measure("fluctuation of slip", "m/s", 1.0, true, S::SlipZone(SlipQuantity::Fluctuation)),
    measure("fluctuating share", "", 1.0, true, S::SlipZone(SlipQuantity::FluctuatingShare)),
    measure("slip_roughness", "", 1.0, true, S::SlipRoughness),
    metric(Measure::RoughnessRatio, "", true),
    metric(Measure::ViolatingFraction, "", true),
    metric(Measure::ViolatingFractionSlipState, "", true),
    metric(Measure::WrongDirection, "", true),
    metric(Measure::Dissipation, "", false),
    metric(Measure::LawError, "", true),
    metric(Measure::LawErrorSlipState, "", true),
    metric(Measure::Direction, "degrees", true),
    metric(Measure::DirectionSlipState, "degrees", true),
    metric(Measure::AdhesionSlip, "", true),
    metric(Measure::LawScatter, "", false),
    metric(Measure::Penetration, "", true),
    metric(Measure::SwitchingRate, "", true),
];

impl SweepMeasure {
    /// The measure of a run, in the unit of the measure; `None` where the run has none, and for means over the
    /// evaluation window where the run did not complete.
    pub fn of(&self, run: Entry<'_>) -> Option<Measured> {
        let whole = || run.completed().then_some(());
        let found = match self.source {
            Source::Mean(mean, patch) => {
                whole()?;
                let patch = run.patch(patch);
                run.mean(mean).map_or(patch, |found| {
                    let half = found.half.or(patch.and_then(|patch| patch.half));
                    Some(Measured { half, ..found })
                })
            }
            Source::Patch(measure) => whole().and_then(|()| run.patch(measure)),
            Source::SlipZone(quantity) => whole().and_then(|()| run.slip_zone(quantity)),
            Source::Metric(measure) => run.metric(measure),
            Source::SlipRoughness => slip_roughness(run),
        };
        found.map(|found| found.times(self.factor))
    }

    /// Between which values the measure can lie: a share between 0 and 1.
    pub fn bounds(&self) -> [f64; 2] {
        let share = match self.source {
            Source::Mean(mean, _) => mean == Mean::StickFraction,
            Source::SlipZone(quantity) => quantity == SlipQuantity::FluctuatingShare,
            Source::Metric(measure) => measure.definition().statistic == "share",
            Source::Patch(_) | Source::SlipRoughness => false,
        };
        if share { [0.0, 1.0] } else { UNBOUNDED }
    }

    /// Name with unit.
    pub fn heading(&self) -> String {
        if self.unit.is_empty() {
            format!("{} (-)", self.name)
        } else {
            format!("{} ({})", self.name, self.unit)
        }
    }
}

/// The standard deviation over time of |s|/s_c of a run.
fn slip_roughness(run: Entry<'_>) -> Option<Measured> {
    let check = run.check()?;
    let ratio = check.metrics.get(&Measure::RoughnessRatio)?;
    let of = |view: &View| ratio.detail(*view, check.pairing.in_file, Detail::DeviationSlip);
    let value = [View::Bar, View::Disk].iter().find_map(of)?;
    Some(Measured { value, half: None, deviation: None })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::sweep::result::SweepRun;
    use serde_json::json;

    #[test]
    fn the_roughness_of_slip_is_that_of_the_pairing_that_the_records_have() {
        let roughness = MEASURES.iter().find(|measure| measure.name == "slip_roughness").unwrap();
        let of = |in_file: &str| {
            let run = json!({ "check": {
                "pairing": { "in_file": in_file },
                "metrics": { "roughness_ratio": { "sides": { "disk": {
                    "before": { "value": null, "deviation_slip": 1.0 },
                    "after": { "value": null, "deviation_slip": 2.0 },
                } } } },
            } });
            let run: SweepRun = serde_json::from_value(run).unwrap();
            roughness.of(Entry::Run(&run)).unwrap().value
        };
        assert_eq!([of("before"), of("after")], [1.0, 2.0]);
    }
}
