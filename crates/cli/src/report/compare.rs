//! How far runs differ, as a table to read.

use std::fmt::Write;

use serde_json::Value;

use super::layout::{count, digits, number, text as word};

/// The whole page.
pub fn text(document: &Value) -> String {
    let mut out = String::new();
    let ms = |pointer: &str| digits(number(document, pointer).map(|t| 1e3 * t), 6);
    let _ = writeln!(
        out,
        "slip along the centre line from {} to {} ms\n\n  {:<40}{:>9}{:>9}{:>13}{:>12}{:>12}",
        ms("/window/0"),
        ms("/window/1"),
        "run",
        "largest",
        "mean",
        "fluctuation",
        "share",
        "alternates"
    );
    let entries = |key: &str| document[key].as_array().cloned().unwrap_or_default();
    for run in entries("runs") {
        let at = |key: &str| run[key].as_f64();
        let _ = writeln!(
            out,
            "  {:<40}{:>9}{:>9}{:>13}{:>12}{:>12}",
            word(&run, "/label"),
            digits(at("largest"), 3),
            digits(at("mean"), 4),
            digits(at("fluctuation"), 4),
            share(at("fluctuating_share")),
            share(at("alternating_slip")),
        );
    }
    let _ = writeln!(
        out,
        "  (m/s; largest from {}; shares of the root mean square)\n\n  {:<62}{:>9}{:>9}{:>9}",
        spans(&document["runs"]),
        "difference over the second run's",
        "local",
        "means",
        "devs"
    );
    for difference in entries("differences") {
        let (from, to) = (word(&difference, "/from"), word(&difference, "/to"));
        for quantity in ["slip", "shear"] {
            let at = |key: &str| share(difference[quantity][key].as_f64());
            let label = format!("{quantity}, {from} to {to}");
            let _ = writeln!(
                out,
                "  {label:<62}{:>9}{:>9}{:>9}",
                at("place_and_time"),
                at("means"),
                at("deviations")
            );
        }
        let growth = &difference["growth"];
        if let Some(rate) = growth["rate"].as_f64() {
            let at = |key: &str| growth["over"][key].as_f64();
            let _ = writeln!(
                out,
                "  twins: their difference grows at {} 1/s, from {} to {} of the slip in {} records",
                digits(Some(rate), 3),
                digits(at("start"), 2),
                digits(at("end"), 2),
                count(at("records"))
            );
        } else if let Some(reason) = growth["reason"].as_str() {
            let _ = writeln!(out, "  twins: no rate of growth, {reason}");
        }
    }
    out
}

/// The spans of time that the largest slip speeds are the largest of.
fn spans(runs: &Value) -> String {
    let of = |run: &Value| {
        let [from, to] =
            [0, 1].map(|i| digits(run["largest_over"][i].as_f64().map(|time| 1e3 * time), 6));
        format!("{from} to {to} ms")
    };
    let mut spans: Vec<String> = runs.as_array().into_iter().flatten().map(of).collect();
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
