//! The table of a sweep: a row for each run, and after them one for each point of an ensemble; SI units. `sweep.csv` holds
//! it as text.

use std::fs;
use std::path::Path;

use crate::case::keys;
use crate::check::measure::Measure;
use crate::check::patch_series::PatchMeasure;
use crate::check::result::SlipQuantity;
use crate::sweep::plan::SweepError;
use crate::sweep::result::{Entry, SweepResult};
use output::summary::{Mean, Summary, quantity};
use serde::Serialize;

/// A cell of the table.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// No value.
    #[default]
    Empty,
    /// A number.
    Number(f64),
    /// A count.
    Count(u64),
    /// Whether something holds.
    Flag(bool),
    /// A word, or a sentence.
    Text(String),
    /// A value of the case.
    Parameter(toml::Value),
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        if number.is_finite() { Self::Number(number) } else { Self::Empty }
    }
}

impl From<u64> for Cell {
    fn from(count: u64) -> Self {
        Self::Count(count)
    }
}

impl<T: Into<Self>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty, Into::into)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl Cell {
    /// In the digits that read back to the same bits; empty without a value.
    fn text(&self) -> String {
        match self {
            Self::Empty => String::new(),
            Self::Text(text) | Self::Parameter(toml::Value::String(text)) => text.clone(),
            other => serde_json::to_string(other).unwrap_or_default(),
        }
    }
}

/// Where a column finds its value in a run or a point.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// The run's name, or of how many members a point is the mean.
    Name,
    /// A parameter of the sweep.
    Parameter,
    Status,
    Step,
    /// A number of a run's summary: its section and key there, and the number.
    Summary(&'static str, &'static str, fn(&Summary) -> Cell),
    /// A mean over the evaluation window.
    Mean(Mean),
    /// Its standard deviation, which belongs to a run, not to a point.
    Deviation(Mean),
    /// A statistic of the slip zone.
    Slip(SlipQuantity),
    /// Whether every limit of the check holds.
    Pass,
    /// A measure of the check.
    Measure(Measure),
    /// Why a run failed.
    Reason,
    /// Half the width of the 95 % confidence interval of a mean: over an ensemble's members, else over the window.
    HalfOfMean(Mean),
    /// The same of a statistic of the slip zone.
    HalfOfSlip(SlipQuantity),
    /// The same of a measure.
    HalfOfMeasure(Measure),
}

use Source as S;

/// Declares a column of a number of the summary: `section.key` of an optional section, or `key`.
macro_rules! number {
    ($section:ident?.$key:ident) => {
        S::Summary(stringify!($section), stringify!($key), |summary| {
            summary.$section.as_ref().map_or(Cell::Empty, |section| section.$key.into())
        })
    };
    ($section:ident.$key:ident) => {
        S::Summary(stringify!($section), stringify!($key), |summary| summary.$section.$key.into())
    };
    ($key:ident) => {
        S::Summary("", stringify!($key), |summary| summary.$key.into())
    };
}

/// Columns besides the parameters and the measures of the checks.
const COLUMNS: [(&str, Source); 63] = [
    ("dt", S::Step),
    ("dt_limit", number!(stability?.dt_limit)),
    ("steps", number!(steps)),
    ("elements", number!(elements)),
    ("normal_force", S::Mean(Mean::NormalForce)),
    ("normal_force_sd", S::Deviation(Mean::NormalForce)),
    ("tangential_force", S::Mean(Mean::TangentialForce)),
    ("tangential_force_sd", S::Deviation(Mean::TangentialForce)),
    ("lateral_force", S::Mean(Mean::LateralForce)),
    ("traction_coefficient", S::Mean(Mean::TractionCoefficient)),
    ("traction_coefficient_sd", S::Deviation(Mean::TractionCoefficient)),
    ("creepage", S::Mean(Mean::Creepage)),
    ("creepage_sd", S::Deviation(Mean::Creepage)),
    ("patch_half_length", S::Mean(Mean::PatchHalfLength)),
    ("patch_half_length_sd", S::Deviation(Mean::PatchHalfLength)),
    ("patch_half_width", S::Mean(Mean::PatchHalfWidth)),
    ("patch_half_width_sd", S::Deviation(Mean::PatchHalfWidth)),
    ("patch_area", S::Mean(Mean::PatchArea)),
    ("patch_area_sd", S::Deviation(Mean::PatchArea)),
    ("patch_area_fitted", S::Mean(Mean::PatchAreaFitted)),
    ("patch_area_fitted_sd", S::Deviation(Mean::PatchAreaFitted)),
    ("peak_pressure", S::Mean(Mean::PeakPressure)),
    ("peak_pressure_sd", S::Deviation(Mean::PeakPressure)),
    ("peak_shear", S::Mean(Mean::PeakShear)),
    ("peak_shear_sd", S::Deviation(Mean::PeakShear)),
    ("stick_fraction", S::Mean(Mean::StickFraction)),
    ("stick_fraction_sd", S::Deviation(Mean::StickFraction)),
    ("slip_fraction", S::Mean(Mean::SlipFraction)),
    ("slip_fraction_sd", S::Deviation(Mean::SlipFraction)),
    ("stick_border", S::Mean(Mean::StickBorder)),
    ("stick_border_sd", S::Deviation(Mean::StickBorder)),
    ("torque", S::Mean(Mean::Torque)),
    ("torque_sd", S::Deviation(Mean::Torque)),
    ("max_penetration", S::Mean(Mean::MaxPenetration)),
    ("max_penetration_sd", S::Deviation(Mean::MaxPenetration)),
    ("slip_zone_mean", S::Slip(SlipQuantity::Mean)),
    ("slip_zone_fluctuation", S::Slip(SlipQuantity::Fluctuation)),
    ("slip_zone_fluctuating_share", S::Slip(SlipQuantity::FluctuatingShare)),
    ("slip_zone_fluctuating_share_of_elements", S::Slip(SlipQuantity::FluctuatingShareOfElements)),
    ("slip_zone_largest", S::Slip(SlipQuantity::Largest)),
    ("slip_zone_correlation_length", S::Slip(SlipQuantity::CorrelationLength)),
    ("slip_zone_correlation_time", S::Slip(SlipQuantity::CorrelationTime)),
    ("slip_zone_mean_wavenumber", S::Slip(SlipQuantity::MeanWavenumber)),
    ("slip_zone_mean_frequency", S::Slip(SlipQuantity::MeanFrequency)),
    ("energy_kinetic", number!(energy.kinetic)),
    ("energy_internal", number!(energy.internal)),
    ("energy_hourglass", number!(energy.hourglass)),
    ("energy_contact_stored", number!(energy.contact_stored)),
    ("friction_dissipated", number!(energy.friction_dissipated)),
    ("damping_dissipated", number!(energy.damping_dissipated)),
    ("external_work", number!(energy.external_work)),
    ("balance_error", number!(energy.balance_error)),
    ("cone_excess", number!(checks?.cone_excess)),
    ("resultant_mismatch", number!(checks?.resultant_mismatch)),
    ("manifold_node_steps", number!(exact_contact?.manifold_node_steps)),
    ("steepness_node", number!(exact_contact?.steepness_node)),
    ("steepness_patch", number!(exact_contact?.steepness_patch)),
    ("implicit_cut", number!(implicit?.cut)),
    ("implicit_iterations", number!(implicit?.iterations)),
    ("check_pass", S::Pass),
    ("wall_s", number!(wall_s)),
    ("peak_rss_mb", number!(peak_rss_mb)),
    ("threads", number!(threads)),
];

/// A column of the table of a sweep.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its heading.
    pub name: String,
    /// SI unit of its numbers, `1` for ratios and counts; empty for text.
    pub units: String,
    /// What it is; empty where the heading says it.
    pub meaning: String,
    source: Source,
}

/// The table of a sweep.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its columns.
    pub columns: Vec<Column>,
    /// A row for each run, one cell for each column.
    pub runs: Vec<Vec<Cell>>,
    /// The same for each point of an ensemble, means over its members.
    pub points: Vec<Vec<Cell>>,
}

impl Table {
    /// The table of a sweep.
    pub fn of(sweep: &SweepResult) -> Self {
        let columns = columns(sweep);
        let row = |entry: Entry<'_>| columns.iter().map(|column| column.value(entry)).collect();
        let runs = sweep.runs.iter().map(|run| row(Entry::Run(run))).collect();
        let points = sweep.points.iter().map(|point| row(Entry::Point(point))).collect();
        Self { runs, points, columns }
    }

    /// As comma-separated values.
    fn text(&self) -> String {
        let mut text = String::new();
        line(&mut text, self.columns.iter().map(|column| column.name.clone()));
        for row in self.runs.iter().chain(&self.points) {
            line(&mut text, row.iter().map(Cell::text));
        }
        text
    }
}

impl Column {
    fn value(&self, entry: Entry<'_>) -> Cell {
        // means over the evaluation window count only where the run reached its end
        let whole = entry.completed();
        let mean = |mean: Mean| entry.mean(mean).filter(|_| whole);
        let slip = |quantity: SlipQuantity| entry.slip_zone(quantity).filter(|_| whole);
        match self.source {
            S::Name => match entry {
                Entry::Run(run) => run.name.as_deref().into(),
                Entry::Point(point) => Cell::Text(format!("mean of {}", point.completed)),
            },
            S::Parameter => match entry.parameters().get(&self.name) {
                Some(value) => Cell::Parameter(value.clone()),
                None => Cell::Empty,
            },
            S::Status => match entry {
                Entry::Run(run) => run.status.as_deref().into(),
                Entry::Point(_) => "ensemble".into(),
            },
            S::Step => entry.step().into(),
            S::Summary(.., of) => entry.summary().map(of).unwrap_or_default(),
            S::Mean(of) => mean(of).map(|found| found.value).into(),
            S::Deviation(of) => match entry {
                Entry::Run(run) => {
                    let window = run.summary.as_ref().and_then(|summary| summary.window.as_ref());
                    let deviation = window.and_then(|window| window.deviation.get(&of).copied());
                    deviation.flatten().filter(|_| whole).into()
                }
                Entry::Point(_) => Cell::Empty,
            },
            S::Slip(quantity) => slip(quantity).map(|found| found.value).into(),
            S::Pass => entry.check().map_or(Cell::Empty, |check| Cell::Flag(check.pass)),
            S::Measure(measure) => entry.metric(measure).map(|found| found.value).into(),
            S::Reason => match entry {
                Entry::Run(run) => run.reason.as_deref().into(),
                Entry::Point(_) => Cell::Empty,
            },
            S::HalfOfMean(of) => {
                let over_members = mean(of).and_then(|found| found.half);
                let over_window = || entry.patch(of_patch(of)?).filter(|_| whole)?.half;
                over_members.or_else(over_window).into()
            }
            S::HalfOfSlip(quantity) => slip(quantity).and_then(|found| found.half).into(),
            S::HalfOfMeasure(measure) => entry.metric(measure).and_then(|found| found.half).into(),
        }
    }
}

/// The measure of the patch whose mean a summary holds.
fn of_patch(mean: Mean) -> Option<PatchMeasure> {
    PatchMeasure::ALL.iter().copied().find(|measure| measure.in_summary() == Some(mean))
}

/// The columns of a sweep: its parameters, results, the measures of all runs and the confidence intervals.
fn columns(sweep: &SweepResult) -> Vec<Column> {
    let text = |name: &str, source: Source| Column {
        name: name.into(),
        units: String::new(),
        meaning: String::new(),
        source,
    };
    // a run that another version checked may lack some
    let checked = |measure: &Measure| {
        let checks = sweep.runs.iter().filter_map(|run| run.check.as_ref());
        checks.into_iter().any(|check| check.metrics.contains_key(measure))
    };
    let mut measures: Vec<Measure> = Measure::ALL.iter().copied().filter(checked).collect();
    measures.sort_unstable_by_key(|measure| measure.name());
    let mut columns = vec![text("name", S::Name)];
    columns.extend(sweep.plan.parameters.iter().map(|name| parameter(name)));
    columns.push(text("status", S::Status));
    columns.extend(COLUMNS.iter().map(|(name, source)| result(name, *source)));
    columns.extend(measures.iter().flat_map(|&measure| {
        let definition = measure.definition();
        measure.names().map(move |name| Column {
            name: format!("check_{name}"),
            units: definition.units.into(),
            meaning: definition.about.into(),
            source: S::Measure(measure),
        })
    }));
    columns.push(text("reason", S::Reason));
    let halves: Vec<Column> = columns.iter().filter_map(interval).collect();
    columns.extend(halves);
    columns
}

/// The column of a parameter, a key of the case.
fn parameter(name: &str) -> Column {
    let units = match keys::find(name).map(|key| key.unit) {
        Some("-") => "1",
        Some(units) => units,
        None => "",
    };
    let (name, units) = (name.into(), units.into());
    Column { name, units, meaning: String::new(), source: S::Parameter }
}

/// A column of [`COLUMNS`]: summary and check declare the units of their numbers.
fn result(name: &str, source: Source) -> Column {
    let found = match source {
        S::Step => quantity("", "dt"),
        S::Summary(section, key, _) => quantity(section, key),
        S::Mean(mean) | S::Deviation(mean) => mean.quantity(),
        _ => None,
    };
    let (units, meaning) = match source {
        S::Slip(quantity) => quantity.definition(),
        _ => found.map(|quantity| (quantity.units, quantity.name)).unwrap_or_default(),
    };
    let meaning = match source {
        S::Deviation(mean) => format!("standard deviation over the window of {}", mean.key().1),
        _ => meaning.to_owned(),
    };
    Column { name: name.into(), units: units.into(), meaning, source }
}

/// The column of the half widths of the confidence intervals of a column that has them: means with a deviation,
/// statistics of the slip zone and measures.
fn interval(column: &Column) -> Option<Column> {
    let (of, source) = match column.source {
        S::Deviation(mean) => (mean.key().1, S::HalfOfMean(mean)),
        S::Slip(quantity) => (column.name.as_str(), S::HalfOfSlip(quantity)),
        S::Measure(measure) => (column.name.as_str(), S::HalfOfMeasure(measure)),
        _ => return None,
    };
    Some(Column {
        name: format!("{of}_ci95"),
        units: column.units.clone(),
        meaning: format!("half width of the 95 % confidence interval of {of}"),
        source,
    })
}

/// Writes the table of a sweep.
pub(super) fn write(path: &Path, sweep: &SweepResult) -> Result<(), SweepError> {
    let text = Table::of(sweep).text();
    let failed = |cause| SweepError::File { path: path.into(), cause };
    let partial = path.with_extension("csv.partial");
    fs::write(&partial, text).and_then(|()| fs::rename(&partial, path)).map_err(failed)
}

/// A line of comma-separated values (RFC 4180).
fn line(text: &mut String, cells: impl Iterator<Item = String>) {
    for (i, cell) in cells.enumerate() {
        if i > 0 {
            text.push(',');
        }
        if cell.contains([',', '"', '\n', '\r']) {
            text.push('"');
            text.push_str(&cell.replace('"', "\"\""));
            text.push('"');
        } else {
            text.push_str(&cell);
        }
    }
    text.push('\n');
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use serde_json::json;

    #[test]
    fn every_number_of_a_summary_has_a_unit_and_spreads_have_that_of_their_mean() {
        let measure = json!({ "value": 1.5, "units": "deg", "about": "angle of the shear" });
        let zone = json!({ "mean": { "value": 0.2, "units": "m/s", "about": "mean slip" } });
        let run = json!({ "name": "000", "status": "completed", "parameters": { "drive.speed": 40.0 },
            "summary": { "contact": { "normal_force": 1e5 } },
            "check": { "metrics": { "direction": measure }, "slip_zone": zone } });
        let sweep = json!({ "parameters": ["drive.speed", "friction.static"], "runs": [run] });
        let table = Table::of(&serde_json::from_value(sweep).unwrap());
        let of = |name: &str| table.columns.iter().find(|column| column.name == name).unwrap();
        for (name, source) in COLUMNS {
            assert!(matches!(source, S::Pass) || !of(name).units.is_empty(), "{name}");
        }
        for (name, units) in [
            ("drive.speed", "m/s"),
            ("friction.static", "1"),
            ("normal_force", "N"),
            ("normal_force_sd", "N"),
            ("normal_force_ci95", "N"),
            ("slip_zone_mean", "m/s"),
            ("check_direction", "deg"),
            ("check_direction_ci95", "deg"),
            ("status", ""),
        ] {
            assert_eq!(of(name).units, units, "{name}");
        }
        assert_eq!(of("check_direction").meaning, "angle of the shear from -s in slip");
        let place = table.columns.iter().position(|column| column.name == "normal_force").unwrap();
        assert_eq!(table.runs[0][place], Cell::Number(1e5));
        assert_eq!(table.text().lines().count(), 2);
    }
}
