//! How far runs differ, as a table to read.

use std::fmt::Write;

use creepage::compare::{ComparedRun, ComparisonResult};

use super::layout::{count, digits};

/// The whole page.
pub fn text(result: &ComparisonResult) -> String {
    let mut out = String::new();
    let ms = |time: f64| digits(Some(1e3 * time), 6);
    let _ = writeln!(
        out,
        "slip along the centre line from {} to {} ms\n\n  {:<40}{:>9}{:>9}{:>13}{:>12}{:>12}",
        ms(result.window[0]),
        ms(result.window[1]),
        "run",
        "largest",
        "mean",
        "fluctuation",
        "share",
        "alternates"
    );
    for run in &result.runs {
        let _ = writeln!(
            out,
            "  {:<40}{:>9}{:>9}{:>13}{:>12}{:>12}",
            run.label,
            digits(run.largest, 3),
            digits(run.mean, 4),
            digits(run.fluctuation, 4),
            share(run.fluctuating_share),
            share(run.alternating_slip),
        );
    }
    let _ = writeln!(
        out,
        "  (m/s; largest from {}; shares of the root mean square)\n\n  {:<62}{:>9}{:>9}{:>9}",
        spans(&result.runs),
        "difference over the second run's",
        "local",
        "means",
        "devs"
    );
    for difference in &result.differences {
        for (quantity, of) in [("slip", &difference.slip), ("shear", &difference.shear)] {
            let label = format!("{quantity}, {} to {}", difference.from, difference.to);
            let _ = writeln!(
                out,
                "  {label:<62}{:>9}{:>9}{:>9}",
                share(of.place_and_time),
                share(of.means),
                share(of.deviations)
            );
        }
        let Some(growth) = &difference.growth else {
            continue;
        };
        if let Some((rate, over)) = growth.rate.zip(growth.over) {
            let _ = writeln!(
                out,
                "  twins: their difference grows at {} 1/s, from {} to {} of the slip in {} records",
                digits(Some(rate), 3),
                digits(Some(over.start), 2),
                digits(Some(over.end), 2),
                count(Some(over.records as f64))
            );
        } else if let Some(reason) = &growth.reason {
            let _ = writeln!(out, "  twins: no rate of growth, {reason}");
        }
    }
    out
}

/// The spans of time that the largest slip speeds are the largest of.
fn spans(runs: &[ComparedRun]) -> String {
    let of = |run: &ComparedRun| {
        let [from, to] = run.largest_over.map(|time| digits(Some(1e3 * time), 6));
        format!("{from} to {to} ms")
    };
    let mut spans: Vec<String> = runs.iter().map(of).collect();
    spans.dedup();
    spans.join(", ")
}

fn share(value: Option<f64>) -> String {
    match value {
        Some(small) if small < 1e-3 => format!("{small:.0e}"),
        Some(value) => format!("{value:.3}"),
        None => "-".into(),
    }
}
