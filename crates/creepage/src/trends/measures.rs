//! The measures that a sweep follows over its axes.

use super::document::Run;
use serde_json::Value;

/// A measure of the runs of a sweep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SweepMeasure {
    /// Name in tables and verdicts.
    pub name: &'static str,
    /// Unit after `factor`; empty for pure numbers.
    pub unit: &'static str,
    /// Factor from the SI unit to `unit`.
    pub factor: f64,
    /// Where a run's entry has it; the first source with a value counts.
    sources: &'static [Source],
    /// Whether the table of runs shows it.
    pub in_table: bool,
    /// Whether it is a force of friction, which friction springs carry.
    pub of_friction: bool,
}

/// JSON pointers to a value, to half the width of its 95 % confidence interval (the first that is there), and to its
/// standard deviation over the window.
type Source = (&'static str, &'static [&'static str], &'static str);

/// The value of a measure for a run, in the unit of the measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MeasuredPoint {
    pub value: f64,
    /// Half the width of its 95 % confidence interval, where it has one.
    pub half: Option<f64>,
    /// Its standard deviation over the window, where it is known.
    pub deviation: Option<f64>,
}

impl MeasuredPoint {
    /// Length of its bar in a figure to either side: half its interval, without one its standard deviation.
    pub fn bar(&self) -> Option<f64> {
        self.half.or(self.deviation)
    }
}

const fn measure(
    name: &'static str,
    unit: &'static str,
    factor: f64,
    in_table: bool,
    sources: &'static [Source],
) -> SweepMeasure {
    SweepMeasure { name, unit, factor, sources, in_table, of_friction: false }
}

/// The measure as one of a force of friction.
const fn of_friction(measure: SweepMeasure) -> SweepMeasure {
    SweepMeasure { of_friction: true, ..measure }
}

/// Source of a measure of the contact conditions.
macro_rules! metric {
    ($name:literal) => {
        (
            concat!("/check/metrics/", $name, "/value"),
            &[concat!("/check/metrics/", $name, "/ci95")],
            concat!("/check/metrics/", $name, "/deviation"),
        )
    };
}

/// Source of a patch measure.
macro_rules! patch {
    ($name:literal) => {
        (
            concat!("/check/patch/", $name, "/mean"),
            &[concat!("/check/patch/", $name, "/ci95")],
            concat!("/check/patch/", $name, "/deviation"),
        )
    };
}

/// Places of a mean over the evaluation window: of an ensemble's point, of a run, and for runs of other codes
/// what their check found.
macro_rules! mean {
    ($section:literal, $name:literal, $patch:literal) => {
        &[
            (
                concat!("/summary/", $section, "/", $name),
                &[
                    concat!("/summary/window/ci95/", $name),
                    concat!("/check/patch/", $patch, "/ci95"),
                ],
                concat!("/summary/window/deviation/", $name),
            ),
            patch!($patch),
        ]
    };
}

/// In a pointer: the pairing in time of slip and traction that the records have.
const RECORDED: &str = "RECORDED";

/// Source of a statistic of the slip zone.
macro_rules! slip_zone {
    ($name:literal) => {
        (
            concat!("/check/slip_zone/", $name, "/value"),
            &[concat!("/check/slip_zone/", $name, "/ci95")],
            concat!("/check/slip_zone/", $name, "/deviation"),
        )
    };
}

/// All measures, in the order of figures and tables.
pub(crate) const MEASURES: [SweepMeasure; 23] = [
    measure(
        "peak pressure (fit)",
        "MPa",
        1e-6,
        true,
        mean!("contact", "peak_pressure", "peak_pressure"),
    ),
    measure("creepage", "10\u{207b}\u{b3}", 1e3, true, mean!("contact", "creepage", "creepage")),
    of_friction(measure(
        "T/N",
        "",
        1.0,
        true,
        mean!("contact", "traction_coefficient", "traction_coefficient"),
    )),
    of_friction(measure(
        "peak shear",
        "MPa",
        1e-6,
        true,
        mean!("window", "peak_shear", "peak_shear"),
    )),
    measure("half length", "mm", 1e3, true, mean!("contact", "patch_half_length", "half_length")),
    measure("stick fraction", "", 1.0, true, mean!("contact", "stick_fraction", "stick_fraction")),
    measure("power of friction", "kW", 1e-3, false, &[patch!("power")]),
    measure("mean slip", "m/s", 1.0, true, &[slip_zone!("mean")]),
    measure("fluctuation of slip", "m/s", 1.0, true, &[slip_zone!("fluctuation")]),
    measure("fluctuating share", "", 1.0, true, &[slip_zone!("fluctuating_share")]),
    measure(
        "slip_roughness",
        "",
        1.0,
        true,
        &[
            ("/check/metrics/roughness_ratio/sides/bar/RECORDED/deviation_slip", &[], ""),
            ("/check/metrics/roughness_ratio/sides/disk/RECORDED/deviation_slip", &[], ""),
        ],
    ),
    measure("roughness_ratio", "", 1.0, true, &[metric!("roughness_ratio")]),
    measure("violating_fraction", "", 1.0, true, &[metric!("violating_fraction")]),
    measure("wrong_direction", "", 1.0, true, &[metric!("wrong_direction")]),
    measure("dissipation", "", 1.0, false, &[metric!("dissipation")]),
    measure("law_error", "", 1.0, true, &[metric!("law_error")]),
    measure("law_error_let_slip", "", 1.0, true, &[metric!("law_error_let_slip")]),
    measure("direction", "degrees", 1.0, true, &[metric!("direction")]),
    measure("direction_let_slip", "degrees", 1.0, true, &[metric!("direction_let_slip")]),
    measure("adhesion_slip", "", 1.0, true, &[metric!("adhesion_slip")]),
    measure("law_scatter", "", 1.0, false, &[metric!("law_scatter")]),
    measure("penetration", "", 1.0, true, &[metric!("penetration")]),
    measure("switching_rate", "", 1.0, true, &[metric!("switching_rate")]),
];

impl SweepMeasure {
    /// The measure of a run, times `factor`; `None` where the run has none, and for means over the evaluation
    /// window where the run did not complete.
    pub fn of(&self, run: Run<'_>) -> Option<MeasuredPoint> {
        let recorded = run.entry.pointer("/check/pairing/in_file").and_then(Value::as_str);
        let number = |pointer: &str| {
            let pointer = pointer.replace(RECORDED, recorded.unwrap_or("before"));
            run.entry.pointer(&pointer).and_then(Value::as_f64).filter(|value| value.is_finite())
        };
        let whole = |source: &&Source| run.completed() || source.0.starts_with("/check/metrics/");
        self.sources.iter().filter(whole).find_map(|(value, halves, deviation)| {
            let scaled = |pointer: &str| number(pointer).map(|number| self.factor * number);
            let half = halves.iter().find_map(|place| scaled(place));
            let deviation = (!deviation.is_empty()).then(|| scaled(deviation)).flatten();
            Some(MeasuredPoint { value: scaled(value)?, half, deviation })
        })
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use serde_json::json;

    #[test]
    fn the_roughness_of_slip_is_that_of_the_pairing_that_the_records_have() {
        let roughness = MEASURES.iter().find(|measure| measure.name == "slip_roughness").unwrap();
        let of = |in_file: &str| {
            let entry = json!({ "check": {
                "pairing": { "in_file": in_file },
                "metrics": { "roughness_ratio": { "sides": { "disk": {
                    "before": { "deviation_slip": 1.0 }, "after": { "deviation_slip": 2.0 },
                } } } },
            } });
            roughness.of(Run { entry: &entry }).unwrap().value
        };
        assert_eq!([of("before"), of("after")], [1.0, 2.0]);
    }
}
