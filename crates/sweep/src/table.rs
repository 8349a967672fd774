//! `sweep.csv`: one line per run, and after them one per point of an ensemble; SI units.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::plan::SweepError;

/// Columns besides the parameters and the measures of the checks: heading, and JSON pointer into the entry of a run.
const COLUMNS: [(&str, &str); 60] = [
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

/// Writes the table of a sweep's document beside it.
pub(super) fn write(path: &Path, document: &Value) -> Result<(), SweepError> {
    let parameters: Vec<&str> =
        document["parameters"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    let runs = document["runs"].as_array().map(Vec::as_slice).unwrap_or_default();
    // The measures of all runs: a run of another friction law may lack some.
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
    let mut text = String::new();
    let headings = ["name"].into_iter().chain(parameters.iter().copied()).chain(["status"]);
    let headings = headings.chain(COLUMNS.iter().map(|(heading, _)| *heading));
    let measured = measures.iter().map(|name| format!("check_{name}"));
    let headings = headings.map(str::to_owned).chain(measured).chain(["reason".to_owned()]);
    let points = document["points"].as_array().map(Vec::as_slice).unwrap_or_default();
    let intervals = intervals(&measures);
    let halves = |entry: &Value| -> Vec<String> {
        let half = |places: &[String; 2]| cell(first(entry, places));
        intervals.iter().map(|(_, places)| half(places)).collect()
    };
    line(&mut text, headings.chain(intervals.iter().map(|(heading, _)| heading.clone())));
    for run in runs {
        let values = [&run["name"]].into_iter();
        let values = values.chain(parameters.iter().map(|name| &run["parameters"][*name]));
        let values = values.chain([&run["status"]]);
        let values = values
            .chain(COLUMNS.iter().map(|(_, at)| value_at(run, at)))
            .chain(measures.iter().map(|name| &run["check"]["metrics"][*name]["value"]))
            .chain([&run["reason"]]);
        line(&mut text, values.map(cell).chain(halves(run)));
    }
    for point in points {
        let name = format!("mean of {}", point["completed"]);
        let parameters = parameters.iter().map(|name| cell(&point["parameters"][*name]));
        let of_means = |(heading, at): &(&str, &'static str)| {
            // a deviation over the window belongs to a run, not to a point
            if heading.ends_with(DEVIATION) { String::new() } else { cell(value_at(point, at)) }
        };
        let metrics = measures.iter().map(|name| cell(&point["check"]["metrics"][*name]["value"]));
        let values = [name].into_iter().chain(parameters).chain(["ensemble".to_owned()]);
        let values = values.chain(COLUMNS.iter().map(of_means)).chain(metrics);
        line(&mut text, values.chain([String::new()]).chain(halves(point)));
    }
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
