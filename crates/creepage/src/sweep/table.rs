//! The table of a sweep: a row for each run, and after them one for each point of an ensemble; SI units. `sweep.csv` holds
//! it as text.

use std::fs;
use std::path::Path;

use crate::case::keys;
use output::quantities::quantity;
use serde_json::{Value, json};

use crate::sweep::plan::SweepError;

/// Columns besides the parameters and the measures of the checks: heading, and JSON pointer into the entry of a run.
const COLUMNS: [(&str, &str); 62] = [
    ("dt", "/summary/dt"),
    ("dt_limit", "/summary/stability/dt_limit"),
    ("steps", "/summary/steps"),
    ("elements", "/summary/elements"),
    ("normal_force", "/summary/contact/normal_force"),
    ("normal_force_sd", "/summary/window/deviation/normal_force"),
    ("tangential_force", "/summary/contact/tangential_force"),
    ("tangential_force_sd", "/summary/window/deviation/tangential_force"),
    ("lateral_force", "/summary/contact/lateral_force"),
    ("traction_coefficient", "/summary/contact/traction_coefficient"),
    ("traction_coefficient_sd", "/summary/window/deviation/traction_coefficient"),
    ("creepage", "/summary/contact/creepage"),
    ("creepage_sd", "/summary/window/deviation/creepage"),
    ("patch_half_length", "/summary/contact/patch_half_length"),
    ("patch_half_length_sd", "/summary/window/deviation/patch_half_length"),
    ("patch_half_width", "/summary/contact/patch_half_width"),
    ("patch_half_width_sd", "/summary/window/deviation/patch_half_width"),
    ("patch_area", "/summary/contact/patch_area"),
    ("patch_area_sd", "/summary/window/deviation/patch_area"),
    ("patch_area_fitted", "/summary/contact/patch_area_fitted"),
    ("patch_area_fitted_sd", "/summary/window/deviation/patch_area_fitted"),
    ("peak_pressure", "/summary/contact/peak_pressure"),
    ("peak_pressure_sd", "/summary/window/deviation/peak_pressure"),
    ("peak_shear", "/summary/window/peak_shear"),
    ("peak_shear_sd", "/summary/window/deviation/peak_shear"),
    ("stick_fraction", "/summary/contact/stick_fraction"),
    ("stick_fraction_sd", "/summary/window/deviation/stick_fraction"),
    ("slip_fraction", "/summary/contact/slip_fraction"),
    ("slip_fraction_sd", "/summary/window/deviation/slip_fraction"),
    ("stick_border", "/summary/window/stick_border"),
    ("stick_border_sd", "/summary/window/deviation/stick_border"),
    ("torque", "/summary/window/torque"),
    ("torque_sd", "/summary/window/deviation/torque"),
    ("max_penetration", "/summary/window/max_penetration"),
    ("max_penetration_sd", "/summary/window/deviation/max_penetration"),
    ("slip_zone_mean", "/check/slip_zone/mean/value"),
    ("slip_zone_fluctuation", "/check/slip_zone/fluctuation/value"),
    ("slip_zone_fluctuating_share", "/check/slip_zone/fluctuating_share/value"),
    ("slip_zone_largest", "/check/slip_zone/largest/value"),
    ("slip_zone_correlation_length", "/check/slip_zone/correlation_length/value"),
    ("slip_zone_correlation_time", "/check/slip_zone/correlation_time/value"),
    ("slip_zone_mean_wavenumber", "/check/slip_zone/mean_wavenumber/value"),
    ("slip_zone_mean_frequency", "/check/slip_zone/mean_frequency/value"),
    ("energy_kinetic", "/summary/energy/kinetic"),
    ("energy_internal", "/summary/energy/internal"),
    ("energy_hourglass", "/summary/energy/hourglass"),
    ("energy_contact_stored", "/summary/energy/contact_stored"),
    ("friction_dissipated", "/summary/energy/friction_dissipated"),
    ("damping_dissipated", "/summary/energy/damping_dissipated"),
    ("external_work", "/summary/energy/external_work"),
    ("balance_error", "/summary/energy/balance_error"),
    ("cone_excess", "/summary/checks/cone_excess"),
    ("resultant_mismatch", "/summary/checks/resultant_mismatch"),
    ("manifold_node_steps", "/summary/exact_contact/manifold_node_steps"),
    ("steepness_node", "/summary/exact_contact/steepness_node"),
    ("steepness_patch", "/summary/exact_contact/steepness_patch"),
    ("implicit_cut", "/summary/implicit/cut"),
    ("implicit_iterations", "/summary/implicit/iterations"),
    ("check_pass", "/check/pass"),
    ("wall_s", "/summary/wall_s"),
    ("peak_rss_mb", "/summary/peak_rss_mb"),
    ("threads", "/summary/threads"),
];

/// Where a column finds its value in the entry of a run or a point.
#[derive(Clone, Debug)]
enum Place {
    /// The run's name, or of how many members a point is the mean.
    Name,
    /// A parameter of the sweep.
    Parameter,
    Status,
    /// At a JSON pointer.
    At(&'static str),
    /// A measure of the check.
    Measure(String),
    /// Why a run failed.
    Reason,
    /// The first of two JSON pointers that the entry has.
    Interval([String; 2]),
}

/// A column of the table of a sweep.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its heading.
    pub name: String,
    /// SI unit of its numbers, `1` for ratios and counts; empty for text, and for measures of a check that no run has.
    pub units: String,
    /// What it is; empty where the heading says it.
    pub meaning: String,
    place: Place,
}

/// The table of a sweep. A cell without a value is null.
#[derive(Clone, Debug)]
pub struct Table {
    /// Its columns.
    pub columns: Vec<Column>,
    /// A row for each run, one cell for each column.
    pub runs: Vec<Vec<Value>>,
    /// The same for each point of an ensemble, means over its members.
    pub points: Vec<Vec<Value>>,
}

impl Table {
    /// The table of a sweep's document.
    pub fn of(document: &Value) -> Self {
        let columns = columns(document);
        let rows = |key: &str, of_point: bool| {
            let entries = document[key].as_array().map(Vec::as_slice).unwrap_or_default();
            let row =
                |entry: &Value| columns.iter().map(|c| c.value(entry, of_point).clone()).collect();
            entries.iter().map(row).collect::<Vec<Vec<Value>>>()
        };
        let (runs, mut points) = (rows("runs", false), rows("points", true));
        for (row, point) in
            points.iter_mut().zip(document["points"].as_array().into_iter().flatten())
        {
            for (cell, column) in row.iter_mut().zip(&columns) {
                match column.place {
                    Place::Name => *cell = json!(format!("mean of {}", point["completed"])),
                    Place::Status => *cell = json!("ensemble"),
                    _ => {}
                }
            }
        }
        Self { columns, runs, points }
    }

    /// As comma-separated values, in the digits that read back to the same bits.
    fn text(&self) -> String {
        let mut text = String::new();
        line(&mut text, self.columns.iter().map(|column| column.name.clone()));
        for row in self.runs.iter().chain(&self.points) {
            line(&mut text, row.iter().map(cell));
        }
        text
    }
}

impl Column {
    fn value<'a>(&self, entry: &'a Value, of_point: bool) -> &'a Value {
        match &self.place {
            Place::Name => &entry["name"],
            Place::Parameter => &entry["parameters"][&self.name],
            Place::Status => &entry["status"],
            // a deviation over the window belongs to a run, not to a point
            Place::At(_) if of_point && self.name.ends_with(DEVIATION) => &Value::Null,
            Place::At(at) => value_at(entry, at),
            Place::Measure(name) => &entry["check"]["metrics"][name]["value"],
            Place::Reason => &entry["reason"],
            Place::Interval(places) => first(entry, places),
        }
    }
}

/// The columns of a sweep: its parameters, results, the measures of all runs and the confidence intervals.
fn columns(document: &Value) -> Vec<Column> {
    let runs = document["runs"].as_array().map(Vec::as_slice).unwrap_or_default();
    // a run of another friction law may lack some
    let mut measures: Vec<&str> = Vec::new();
    for run in runs {
        let metrics = run.pointer("/check/metrics").and_then(Value::as_object);
        for name in metrics.into_iter().flat_map(|metrics| metrics.keys()) {
            if !measures.contains(&name.as_str()) {
                measures.push(name);
            }
        }
    }
    measures.sort_unstable();
    let text = |name: &str, place: Place| Column {
        name: name.into(),
        units: String::new(),
        meaning: String::new(),
        place,
    };
    let mut columns = vec![text("name", Place::Name)];
    let parameters = document["parameters"].as_array().into_iter().flatten();
    columns.extend(parameters.filter_map(Value::as_str).map(parameter));
    columns.push(text("status", Place::Status));
    columns.extend(COLUMNS.iter().map(|(name, at)| result(name, at, runs)));
    columns.extend(measures.iter().map(|name| {
        let [units, meaning] = ["units", "about"].map(|key| {
            told(runs, &format!("/check/metrics/{name}/{key}")).unwrap_or_default().to_owned()
        });
        let place = Place::Measure((*name).to_owned());
        Column { name: format!("check_{name}"), units, meaning, place }
    }));
    columns.push(text("reason", Place::Reason));
    let halves = intervals(&measures).into_iter().map(|(name, places)| {
        let of = name.trim_end_matches("_ci95");
        let base = columns.iter().find(|column| column.name == of);
        let units = base.map(|column| column.units.clone()).unwrap_or_default();
        let meaning = format!("half width of the 95 % confidence interval of {of}");
        Column { name, units, meaning, place: Place::Interval(places) }
    });
    let halves: Vec<Column> = halves.collect();
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
    let place = Place::Parameter;
    Column { name: name.into(), units: units.into(), meaning: String::new(), place }
}

/// A column of [`COLUMNS`]: the summary declares the unit of its quantities, a check tells those of its own.
fn result(name: &str, at: &'static str, runs: &[Value]) -> Column {
    let (units, meaning) = match (at.strip_prefix("/summary/"), at.strip_suffix("/value")) {
        (Some(key), _) => quantity(&key.replace('/', ".")).unwrap_or_default(),
        (None, Some(entry)) => {
            let of = |key: &str| told(runs, &format!("{entry}/{key}")).unwrap_or_default();
            (of("units"), of("about"))
        }
        (None, None) => Default::default(),
    };
    let meaning = match name.strip_suffix(DEVIATION) {
        Some(mean) => format!("standard deviation over the window of {mean}"),
        None => meaning.to_owned(),
    };
    Column { name: name.into(), units: units.to_owned(), meaning, place: Place::At(at) }
}

/// The text at a JSON pointer of the first run that has it.
fn told<'a>(runs: &'a [Value], at: &str) -> Option<&'a str> {
    runs.iter().find_map(|run| run.pointer(at).and_then(Value::as_str))
}

/// Writes the table of a sweep's document beside it.
pub(super) fn write(path: &Path, document: &Value) -> Result<(), SweepError> {
    let text = Table::of(document).text();
    let failed = |cause| SweepError::File { path: path.into(), cause };
    let partial = path.with_extension("csv.partial");
    fs::write(&partial, text).and_then(|()| fs::rename(&partial, path)).map_err(failed)
}

/// End of the heading of a standard deviation over the window.
const DEVIATION: &str = "_sd";

/// Headings of the half widths of 95 % confidence intervals, each with two JSON pointers: to that of the mean over an
/// ensemble's members, and to that of the mean over the window of a run.
fn intervals(measures: &[&str]) -> Vec<(String, [String; 2])> {
    let means = COLUMNS.iter().filter_map(|(heading, at)| {
        if let Some(entry) = at.strip_prefix("/check/slip_zone/") {
            let entry = entry.strip_suffix("/value")?;
            let place = format!("/check/slip_zone/{entry}/ci95");
            return Some((format!("{heading}_ci95"), [place, String::new()]));
        }
        let name = heading.strip_suffix(DEVIATION)?;
        let in_check = name.strip_prefix("patch_").unwrap_or(name);
        let places =
            [format!("/summary/window/ci95/{name}"), format!("/check/patch/{in_check}/ci95")];
        Some((format!("{name}_ci95"), places))
    });
    let measures = measures.iter().map(|name| {
        (format!("check_{name}_ci95"), [format!("/check/metrics/{name}/ci95"), String::new()])
    });
    means.chain(measures).collect()
}

/// The value at the first of the pointers that an entry has; null where it has neither.
fn first<'a>(entry: &'a Value, places: &[String; 2]) -> &'a Value {
    let there =
        places.iter().map(|at| if at.is_empty() { &Value::Null } else { value_at(entry, at) });
    there.into_iter().find(|value| !value.is_null()).unwrap_or(&Value::Null)
}

/// The value at a pointer into the entry of a run, else null; means over the evaluation window only of a run that is
/// completed.
fn value_at<'a>(run: &'a Value, at: &str) -> &'a Value {
    let mean = ["/summary/contact/", "/summary/window/", "/check/patch/", "/check/slip_zone/"]
        .iter()
        .any(|section| at.starts_with(section));
    match run.pointer(at) {
        Some(value) if !mean || run["status"] == "completed" => value,
        _ => &Value::Null,
    }
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
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

    #[test]
    fn every_number_of_a_summary_has_a_unit_and_spreads_have_that_of_their_mean() {
        let measure = json!({ "value": 1.5, "units": "deg", "about": "angle of the shear" });
        let zone = json!({ "mean": { "value": 0.2, "units": "m/s", "about": "mean slip" } });
        let run = json!({ "name": "000", "status": "completed", "parameters": { "drive.speed": 40.0 },
            "summary": { "contact": { "normal_force": 1e5 } },
            "check": { "metrics": { "direction": measure }, "slip_zone": zone } });
        let document = json!({ "parameters": ["drive.speed", "friction.static"], "runs": [run] });
        let table = Table::of(&document);
        let of = |name: &str| table.columns.iter().find(|column| column.name == name).unwrap();
        for (name, at) in COLUMNS {
            assert!(!at.starts_with("/summary/") || !of(name).units.is_empty(), "{name}");
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
        assert_eq!(of("check_direction").meaning, "angle of the shear");
        let place = table.columns.iter().position(|column| column.name == "normal_force").unwrap();
        assert_eq!(table.runs[0][place], 1e5);
        assert_eq!(table.text().lines().count(), 2);
    }
}
