//! What happened: whether the run ended, whether its contact obeys the conditions, a picture, and the numbers that matter.

use super::{escape, number, worth};
use crate::check::basis::Basis;
use crate::check::digits::digits;
use crate::check::limits::MEASURES;
use crate::check::patch_series::{PATCH_TABLE, PatchLine};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// Appends the table of contents.
pub(super) fn contents(out: &mut String) {
    let sections = [
        ("overview", "What happened"),
        ("patch", "The patch"),
        ("conditions", "Contact conditions"),
        ("details", "Details"),
        ("reproduce", "How to reproduce"),
    ];
    out.push_str("<nav>");
    for (anchor, title) in sections {
        let _ = write!(out, "<a href=\"#{anchor}\">{title}</a> ");
    }
    out.push_str("</nav>\n");
}

/// Appends the section.
pub(super) fn section(out: &mut String, basis: &Basis, folder: &Path, checked: &Value) {
    out.push_str("<h2 id=\"overview\">What happened</h2>\n");
    let (class, text) = ending(basis);
    let _ = writeln!(out, "<p class=\"{class}\">{}</p>", escape(&text));
    let (class, text) = conditions(checked);
    let _ = writeln!(out, "<p class=\"{class}\">{}</p>", escape(&text));
    let _ = writeln!(out, "<div class=\"wide\">{}</div>", numbers(basis, checked));
    out.push_str(&super::scene::section(folder));
}

/// Whether the run ended as it should.
fn ending(basis: &Basis) -> (&'static str, String) {
    let summary = basis.summary.as_ref();
    let diagnosis = summary.and_then(|summary| summary["diagnosis"].as_str()).unwrap_or_default();
    match summary.and_then(|summary| summary["status"].as_str()) {
        Some("completed") => ("pass", "The run reached its end.".into()),
        Some("interrupted") => {
            ("", "The run was interrupted. The page shows what it reached.".into())
        }
        Some(_) => (
            "fail",
            format!(
                "The run failed: its own guards stopped it. The page shows what it reached. {diagnosis}"
            ),
        ),
        None => (
            "",
            "The run has no summary: it is in progress, or its data come from elsewhere.".into(),
        ),
    }
}

/// Whether contact obeys its conditions, which is a matter of the method, not of whether the run worked.
fn conditions(checked: &Value) -> (&'static str, String) {
    if checked["pass"] == Value::Bool(true) {
        return ("pass", "Its contact obeys the contact conditions within all limits.".into());
    }
    let beyond = |name: &&str| checked["metrics"][*name]["pass"] == Value::Bool(false);
    let names: Vec<&str> = MEASURES.iter().map(|measure| measure.name).filter(beyond).collect();
    let by = checked["limits_for"].as_str().unwrap_or("its");
    let share = number(checked, "/metrics/violating_fraction/value")
        .map(|share| {
            let share = digits(100.0 * share, 2);
            format!(
                "On {share} % of contact area and time, the conditions of contact are violated. "
            )
        })
        .unwrap_or_default();
    (
        "fail",
        format!(
            "{share}The limits of {by} methods are exceeded by {}. This is a finding about the method, not a failure \
             of the run.",
            names.join(", ")
        ),
    )
}

/// The numbers that matter, by their keys in [`PATCH_TABLE`].
const NUMBERS: [&str; 6] = [
    "normal_force",
    "traction_coefficient",
    "creepage",
    "peak_pressure",
    "half_length",
    "stick_fraction",
];

/// The table of these numbers beside Hertz's.
fn numbers(basis: &Basis, checked: &Value) -> String {
    let mut out = String::from(
        "<table>\n<tr><th>mean over the window</th><th class=\"n\">value</th><th></th>\
         <th class=\"n\">half-space</th></tr>\n",
    );
    let line = |key: &&str| PATCH_TABLE.iter().find(|line| line.key == *key);
    for PatchLine { label, key, factor, unit } in NUMBERS.iter().filter_map(line) {
        let at = |part: &str| number(checked, &format!("/patch/{key}/{part}")).map(|v| factor * v);
        let Some(mean) = at("mean") else {
            let note = checked.pointer(&format!("/patch/{key}/note")).and_then(Value::as_str);
            let _ = writeln!(
                out,
                "<tr><td>{label}</td><td class=\"n\">\u{2013}</td><td colspan=\"2\">{}</td></tr>",
                escape(note.unwrap_or_default())
            );
            continue;
        };
        let scale = super::half_space(basis, key);
        let _ = writeln!(
            out,
            "<tr><td>{label}</td><td class=\"n\">{}</td><td>{unit}</td><td class=\"n\">{}</td></tr>",
            worth(mean, at("ci95")),
            scale.map(|scale| digits(factor * scale, 4)).unwrap_or_default()
        );
    }
    out.push_str("</table>");
    out
}

/// Appends a link to the document of `creepage check --json`.
pub(super) fn data(out: &mut String, checked: &Value) {
    let encoded = STANDARD.encode(checked.to_string());
    let _ = writeln!(
        out,
        "<p><a download=\"check.json\" href=\"data:application/json;base64,{encoded}\">All numbers of the check as \
         JSON</a>; each table has a link to it as CSV.</p>"
    );
}
