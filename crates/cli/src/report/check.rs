//! What a check found, as a table to read.

use std::fmt::Write;

use creepage::check::{CheckResult, Limit, Measure, Metric, SlipQuantity, SlipZoneFound, Verdict};

use super::layout::{count, digits, heading};

/// The whole page.
pub fn text(result: &CheckResult) -> String {
    let mut out = String::new();
    let ms = |time: f64| digits(Some(1e3 * time), 5);
    let _ = writeln!(
        out,
        "{}: contact conditions from {} to {} ms, {} records, {} nodes in contact summed over them",
        result.name,
        ms(result.window[0]),
        ms(result.window[1]),
        count(Some(result.steps as f64)),
        count(Some(result.node_times as f64)),
    );
    let scale = |name: &str, factor: f64| {
        digits(result.scales.get(name).map(|scale| factor * scale.value), 4)
    };
    let _ = writeln!(
        out,
        "  scales: p0 {} MPa, approach {} um, s_c {} m/s, slip above {} mm/s; limits for {} methods",
        scale("peak_pressure", 1e-6),
        scale("approach", 1e6),
        scale("slip_speed", 1.0),
        scale("slip_threshold", 1e3),
        result.limits_for,
    );
    let _ = writeln!(out, "  slip paired with traction: {}\n", result.pairing.reported.slip());
    let _ = writeln!(
        out,
        "  {:<30}{:>11} {:<4}{:>14}  {:<8}where",
        "measure", "value", "", "limit", ""
    );
    for measure in Measure::ALL {
        let Some(metric) = result.metrics.get(measure) else {
            continue;
        };
        let line = format!(
            "  {measure:<30}{:>11} {:<4}{:>14}  {:<8}{}",
            digits(metric.value, 3),
            unit(&metric.units),
            limit(metric.limit),
            metric.verdict().word(),
            place(metric),
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    patch(&mut out, result);
    slip_zone(&mut out, result);
    for note in &result.notes {
        let _ = writeln!(out, "note: {note}");
    }
    let _ = writeln!(out, "\n{}", conclusion(result));
    out
}

/// Whether every limit holds; what springs do apart from what is wrong.
fn conclusion(result: &CheckResult) -> String {
    if result.pass {
        return "every limit holds".into();
    }
    let mut out = String::from("NOT every limit holds");
    for (verdict, about) in
        [(Verdict::Springs, " (of nodes that stick: known of the method)"), (Verdict::Fail, "")]
    {
        let found = result.with_verdict(verdict);
        if !found.is_empty() {
            let names: Vec<&str> = found.iter().map(|measure| measure.name()).collect();
            let _ = write!(out, "\n  {:<8}{}{about}", verdict.word(), names.join(", "));
        }
    }
    out
}

fn unit(units: &str) -> &str {
    if units == "1" { "" } else { units }
}

fn limit(limit: Option<Limit>) -> String {
    match limit {
        Some(Limit::Most(most)) => digits(Some(most), 2),
        Some(Limit::Between(low, high)) => {
            format!("{}..{}", creepage::check::all_digits(low), creepage::check::all_digits(high))
        }
        None => "-".into(),
    }
}

/// The worst node and time, or why there is no value.
fn place(metric: &Metric) -> String {
    if let Some(note) = &metric.note {
        return note.clone();
    }
    let Some(place) = &metric.place else {
        return metric.side.map(|side| side.to_string()).unwrap_or_default();
    };
    let mut text = place.side.to_string();
    if let Some(node) = place.node {
        let _ = write!(text, " node {node}");
    }
    if let Some([x, y, _]) = place.position {
        let _ = write!(text, " at ({:.2}, {:.2}) mm", 1e3 * x, 1e3 * y);
    }
    let _ = write!(text, ", {:.5} ms", 1e3 * place.time);
    if let Some(worst) = place.value.filter(|worst| Some(worst.abs()) != metric.value) {
        let _ = write!(text, ": {}", digits(Some(worst), 3));
    }
    if let Some((used, law)) = place.mu_used.zip(place.mu_law) {
        let _ = write!(text, " (mu {} for {})", digits(Some(used), 6), digits(Some(law), 6));
    }
    text
}

/// Slip over the slip zone along the centre line.
fn slip_zone(out: &mut String, result: &CheckResult) {
    let zone = match &result.slip_zone {
        None => return,
        Some(SlipZoneFound::Not { note }) => return heading(out, &format!("Slip zone: {note}")),
        Some(SlipZoneFound::Measured(zone)) => zone,
    };
    let Some((from, to)) = zone.from.zip(zone.to) else {
        return;
    };
    let [from, to] = [from, to].map(|end| 1e3 * end);
    heading(out, &format!("Slip zone along the centre line, x from {from:.2} to {to:.2} mm"));
    for (label, quantity, unit) in [
        ("mean slip speed", SlipQuantity::Mean, "m/s"),
        ("fluctuation, rms", SlipQuantity::Fluctuation, "m/s"),
        ("fluctuating share", SlipQuantity::FluctuatingShare, ""),
        ("largest slip speed", SlipQuantity::Largest, "m/s"),
    ] {
        let Some(found) = zone.statistics.get(&quantity) else {
            continue;
        };
        let half = found.ci95.map(|half| format!("+- {}", digits(Some(half), 2)));
        let value = digits(found.value, 4);
        let line = format!("  {label:<22}{value:>11} {unit:<5}{}", half.unwrap_or_default());
        let _ = writeln!(out, "{}{}", line.trim_end(), bracketed(found.note.as_deref()));
    }
}

/// A note in brackets at the end of a line.
fn bracketed(note: Option<&str>) -> String {
    note.map(|note| format!("  ({note})")).unwrap_or_default()
}

fn patch(out: &mut String, result: &CheckResult) {
    heading(
        out,
        "Patch: mean with its 95 % confidence interval, standard deviation over the records",
    );
    for creepage::check::PatchLine { label, measure, factor, unit } in creepage::check::PATCH_TABLE
    {
        let Some(found) = result.patch.get(&measure) else {
            continue;
        };
        let note = bracketed(found.note.as_deref());
        if let Some(mean) = found.mean {
            let half = found.ci95.map(|half| format!("+- {}", digits(Some(half * factor), 2)));
            let line = format!(
                "  {label:<22}{:>11} {unit:<5}{:<12}sd {}",
                digits(Some(mean * factor), 4),
                half.unwrap_or_default(),
                digits(found.deviation.map(|d| d * factor), 2)
            );
            let _ = writeln!(out, "{}{note}", line.trim_end());
        } else if !note.is_empty() {
            let _ = writeln!(out, "  {label:<22}{:>11}{note}", "-");
        }
    }
}
