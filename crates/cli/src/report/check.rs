//! What a check found, as a table to read.

use std::fmt::Write;

use serde_json::Value;

use super::layout::{count, digits, heading, number, text as word};

/// The whole page.
pub fn text(document: &Value) -> String {
    let mut out = String::new();
    let at = |pointer: &str| number(document, pointer);
    let ms = |pointer: &str| digits(at(pointer).map(|t| 1e3 * t), 5);
    let _ = writeln!(
        out,
        "{}: contact conditions from {} to {} ms, {} records, {} nodes in contact summed over them",
        word(document, "/name"),
        ms("/window/0"),
        ms("/window/1"),
        count(at("/steps")),
        count(at("/node_times")),
    );
    let scale = |name: &str, factor: f64| {
        digits(at(&format!("/scales/{name}/value")).map(|value| factor * value), 4)
    };
    let _ = writeln!(
        out,
        "  scales: p0 {} MPa, approach {} um, s_c {} m/s, slip above {} mm/s; limits for {} methods",
        scale("peak_pressure", 1e-6),
        scale("approach", 1e6),
        scale("slip_speed", 1.0),
        scale("slip_threshold", 1e3),
        word(document, "/limits_for"),
    );
    let _ =
        writeln!(out, "  slip paired with traction: {}\n", creepage::check::slip_paired(document));
    let _ = writeln!(
        out,
        "  {:<20}{:>11} {:<4}{:>14}  {:<6}where",
        "measure", "value", "", "limit", ""
    );
    for creepage::check::Measure { name, .. } in creepage::check::MEASURES {
        let metric = &document["metrics"][name];
        let line = format!(
            "  {name:<20}{:>11} {:<4}{:>14}  {:<6}{}",
            digits(metric["value"].as_f64(), 3),
            unit(metric["units"].as_str()),
            limit(&metric["limit"]),
            verdict(metric),
            place(metric),
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    patch(&mut out, document);
    slip_zone(&mut out, document);
    let notes = document["notes"].as_array().into_iter().flatten().filter_map(Value::as_str);
    for note in notes {
        let _ = writeln!(out, "note: {note}");
    }
    let pass = document["pass"] == Value::Bool(true);
    let word = if pass { "every limit holds" } else { "NOT every limit holds" };
    let _ = writeln!(out, "\n{word}");
    out
}

fn unit(units: Option<&str>) -> &str {
    match units {
        Some("1") | None => "",
        Some(units) => units,
    }
}

fn limit(limit: &Value) -> String {
    match (limit.as_f64(), limit[0].as_f64(), limit[1].as_f64()) {
        (Some(most), ..) => digits(Some(most), 2),
        (None, Some(low), Some(high)) => {
            format!("{}..{}", creepage::check::all_digits(low), creepage::check::all_digits(high))
        }
        _ => "-".into(),
    }
}

fn verdict(metric: &Value) -> &'static str {
    match creepage::check::keeps_limit(metric) {
        None => "",
        Some(true) => "pass",
        Some(false) => "FAIL",
    }
}

/// The worst node and time, or why there is no value.
fn place(metric: &Value) -> String {
    if let Some(note) = metric["note"].as_str() {
        return note.into();
    }
    let place = &metric["where"];
    let side = place["side"].as_str().or(metric["side"].as_str()).unwrap_or_default();
    let mut text = side.to_owned();
    if let Some(node) = place["node"].as_u64() {
        let _ = write!(text, " node {node}");
    }
    if let [Some(x), Some(y)] = [0, 1].map(|i| place["position"][i].as_f64()) {
        let _ = write!(text, " at ({:.2}, {:.2}) mm", 1e3 * x, 1e3 * y);
    }
    if let Some(time) = place["time"].as_f64() {
        let _ = write!(text, ", {:.5} ms", 1e3 * time);
    }
    let value = metric["value"].as_f64();
    if let Some(worst) = place["value"].as_f64().filter(|worst| Some(worst.abs()) != value) {
        let _ = write!(text, ": {}", digits(Some(worst), 3));
    }
    if let [Some(used), Some(law)] = ["mu_used", "mu_law"].map(|key| place[key].as_f64()) {
        let _ = write!(text, " (mu {} for {})", digits(Some(used), 6), digits(Some(law), 6));
    }
    text
}

/// Slip over the slip zone along the centre line.
fn slip_zone(out: &mut String, document: &Value) {
    let at = |pointer: &str| number(document, &format!("/slip_zone/{pointer}"));
    let Some([from, to]) = at("from").zip(at("to")).map(|(from, to)| [1e3 * from, 1e3 * to]) else {
        let note = word(document, "/slip_zone/note");
        if !note.is_empty() {
            heading(out, &format!("Slip zone: {note}"));
        }
        return;
    };
    heading(out, &format!("Slip zone along the centre line, x from {from:.2} to {to:.2} mm"));
    for (label, key, unit) in [
        ("mean slip speed", "mean", "m/s"),
        ("fluctuation, rms", "fluctuation", "m/s"),
        ("fluctuating share", "fluctuating_share", ""),
        ("largest slip speed", "largest", "m/s"),
    ] {
        let half = at(&format!("{key}/ci95")).map(|half| format!("+- {}", digits(Some(half), 2)));
        let line = format!(
            "  {label:<22}{:>11} {unit:<5}{}",
            digits(at(&format!("{key}/value")), 4),
            half.unwrap_or_default()
        );
        let note = word(document, &format!("/slip_zone/{key}/note"));
        let note = if note.is_empty() { String::new() } else { format!("  ({note})") };
        let _ = writeln!(out, "{}{note}", line.trim_end());
    }
}

fn patch(out: &mut String, document: &Value) {
    heading(
        out,
        "Patch: mean with its 95 % confidence interval, standard deviation over the records",
    );
    for creepage::check::PatchLine { label, key, factor, unit } in creepage::check::PATCH_TABLE {
        let at = |part: &str| number(document, &format!("/patch/{key}/{part}"));
        let note = word(document, &format!("/patch/{key}/note"));
        let note = if note.is_empty() { String::new() } else { format!("  ({note})") };
        if let Some(mean) = at("mean") {
            let half = at("ci95").map(|half| format!("+- {}", digits(Some(half * factor), 2)));
            let line = format!(
                "  {label:<22}{:>11} {unit:<5}{:<12}sd {}",
                digits(Some(mean * factor), 4),
                half.unwrap_or_default(),
                digits(at("deviation").map(|d| d * factor), 2)
            );
            let _ = writeln!(out, "{}{note}", line.trim_end());
        } else if !note.is_empty() {
            let _ = writeln!(out, "  {label:<22}{:>11}{note}", "-");
        }
    }
}
