//! The runs of a sweep as a table to read.

use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use super::layout::{digits, duration, number, text as word};

/// Heading, pointer into a run's entry, factor.
const COLUMNS: [(&str, &str, f64); 5] = [
    ("T/N", "/summary/contact/traction_coefficient", 1.0),
    ("creepage 1e-3", "/summary/contact/creepage", 1e3),
    ("peak p MPa", "/summary/contact/peak_pressure", 1e-6),
    ("violating", "/check/metrics/violating_fraction/value", 1.0),
    ("roughness", "/check/metrics/roughness_ratio/value", 1.0),
];

/// The whole page.
pub fn text(sweep: &Value, folder: &Path, page: &Path) -> String {
    let mut out = String::new();
    let runs = sweep["runs"].as_array().map(Vec::as_slice).unwrap_or_default();
    let names: Vec<&str> = runs.iter().map(|run| word(run, "/name")).collect();
    let width = names.iter().map(|name| name.len()).max().unwrap_or(0).max(4);
    let _ = write!(out, "{:<width$}  {:<11}", "run", "status");
    COLUMNS.iter().for_each(|(heading, ..)| {
        let _ = write!(out, "{heading:>15}");
    });
    let _ = writeln!(out, "{:>12}", "wall time");
    for run in runs {
        let _ = write!(out, "{:<width$}  {:<11}", word(run, "/name"), word(run, "/status"));
        for (_, pointer, factor) in COLUMNS {
            let done = run["status"] == "completed";
            let value = number(run, pointer).filter(|_| done).map(|x| x * factor);
            let shown = value.map_or("-".into(), |x| digits(Some(x), 4));
            let _ = write!(out, "{shown:>15}");
        }
        let _ = writeln!(out, "{:>12}", duration(number(run, "/summary/wall_s")));
    }
    for run in runs {
        if let Some(reason) = run["reason"].as_str() {
            let _ = writeln!(out, "{}: {reason}", word(run, "/name"));
        }
    }
    let steps = runs.iter().filter_map(|run| number(run, "/summary/dt"));
    let [least, most] =
        steps.fold([f64::INFINITY, 0.0], |[a, b], step| [f64::min(a, step), f64::max(b, step)]);
    // members of an ensemble differ by their disturbance
    if most > least * (1.0 + 1e-6) {
        let [least, most] = [least, most].map(|step| digits(Some(1e9 * step), 4));
        let _ = writeln!(out, "\nThe time step differs from run to run: {least} to {most} ns");
    }
    let completed = runs.iter().filter(|run| run["status"] == "completed").count();
    let _ = writeln!(
        out,
        "\n{completed} of {} runs completed. All numbers: {}; page: {}",
        runs.len(),
        folder.join("sweep.csv").display(),
        page.display()
    );
    out
}
