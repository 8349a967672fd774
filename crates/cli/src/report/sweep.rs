//! The runs of a sweep as a table to read.

use std::fmt::Write;
use std::path::Path;

use creepage::check::Measure;
use creepage::sweep::{SweepResult, SweepRun};

use super::layout::{digits, duration};

/// A heading, and the value below it.
type Column = (&'static str, fn(&SweepRun) -> Option<f64>);

const COLUMNS: [Column; 5] = [
    ("T/N", |run| run.summary.as_ref()?.contact.traction_coefficient),
    ("creepage 1e-3", |run| Some(1e3 * run.summary.as_ref()?.contact.creepage?)),
    ("peak p MPa", |run| Some(1e-6 * run.summary.as_ref()?.contact.peak_pressure?)),
    ("violating", |run| run.check.as_ref()?.metrics.get(&Measure::ViolatingFraction)?.value),
    ("roughness_ratio", |run| run.check.as_ref()?.metrics.get(&Measure::RoughnessRatio)?.value),
];

/// The whole page.
pub fn text(sweep: &SweepResult, folder: &Path, page: &Path) -> String {
    let mut out = String::new();
    let runs = &sweep.runs;
    let name = |run: &SweepRun| run.name.clone().unwrap_or_default();
    let width = runs.iter().map(|run| name(run).len()).max().unwrap_or(0).max(4);
    let _ = write!(out, "{:<width$}  {:<11}", "run", "status");
    COLUMNS.iter().for_each(|(heading, ..)| {
        let _ = write!(out, "{heading:>16}");
    });
    let _ = writeln!(out, "{:>12}", "wall time");
    for run in runs {
        let status = run.status.as_deref().unwrap_or_default();
        let _ = write!(out, "{:<width$}  {status:<11}", name(run));
        for (_, value) in COLUMNS {
            let value = value(run).filter(|_| run.completed());
            let _ = write!(out, "{:>16}", digits(value, 4));
        }
        let time = run.summary.as_ref().map(|summary| summary.wall_s);
        let _ = writeln!(out, "{:>12}", duration(time));
    }
    for run in runs {
        if let Some(reason) = &run.reason {
            let _ = writeln!(out, "{}: {reason}", name(run));
        }
    }
    let steps = runs.iter().filter_map(|run| Some(run.summary.as_ref()?.dt));
    let [least, most] =
        steps.fold([f64::INFINITY, 0.0], |[a, b], step| [f64::min(a, step), f64::max(b, step)]);
    // members of an ensemble differ by their disturbance
    if most > least * (1.0 + 1e-6) {
        let [least, most] = [least, most].map(|step| digits(Some(1e9 * step), 4));
        let _ = writeln!(out, "\nThe time step differs from run to run: {least} to {most} ns");
    }
    let completed = runs.iter().filter(|run| run.completed()).count();
    let _ = writeln!(
        out,
        "\n{completed} of {} runs completed. All numbers: {}; page: {}",
        runs.len(),
        folder.join("sweep.csv").display(),
        page.display()
    );
    out
}
