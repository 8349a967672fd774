//! The page of a sweep: its table and how results follow the parameters.

use super::{digits, escape, head};
use crate::PostError;
use figure::{Axis, Draw, Figure, Panel, Series, colour};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// What the table shows of each run: heading, pointer into the run's entry, factor.
const COLUMNS: [(&str, &str, f64); 8] = [
    ("T/N", "/summary/contact/traction_coefficient", 1.0),
    ("creepage (10\u{207b}\u{b3})", "/summary/contact/creepage", 1e3),
    ("half length (mm)", "/summary/contact/patch_half_length", 1e3),
    ("peak pressure (MPa)", "/summary/contact/peak_pressure", 1e-6),
    ("stick fraction", "/summary/contact/stick_fraction", 1.0),
    ("violating fraction", "/check/metrics/violating_fraction/value", 1.0),
    ("wrong direction", "/check/metrics/wrong_direction/value", 1.0),
    ("roughness ratio", "/check/metrics/roughness_ratio/value", 1.0),
];

/// The page of a sweep from its `sweep.json`.
///
/// # Errors
/// A document that is no sweep; a figure that cannot be drawn.
pub fn sweep_page(name: &str, path: &Path, sweep: &Value) -> Result<String, PostError> {
    let broken = |reason: &str| PostError::Text { path: path.into(), reason: reason.into() };
    let parameters = sweep["parameters"].as_array();
    let parameters: Vec<&str> = parameters
        .ok_or_else(|| broken("is no sweep: it has no parameters"))?
        .iter()
        .filter_map(Value::as_str)
        .collect();
    let runs = sweep["runs"].as_array().ok_or_else(|| broken("is no sweep: it has no runs"))?;
    let mut out = head(name);
    let _ = write!(
        out,
        "<h1>{}</h1>\n<p>{} runs over {}.</p>\n<h2>Runs</h2>\n<table>\n<tr>",
        escape(name),
        runs.len(),
        escape(&parameters.join(", "))
    );
    for parameter in &parameters {
        let _ = write!(out, "<th class=\"n\">{}</th>", escape(parameter));
    }
    out.push_str("<th>status</th>");
    for (heading, ..) in COLUMNS {
        let _ = write!(out, "<th class=\"n\">{heading}</th>");
    }
    out.push_str("<th>checks</th></tr>\n");
    for run in runs {
        out.push_str("<tr>");
        for parameter in &parameters {
            let _ = write!(out, "<td class=\"n\">{}</td>", shown(&run["parameters"][*parameter]));
        }
        let status = run["status"].as_str().unwrap_or("unknown");
        let _ = write!(out, "<td>{}</td>", escape(status));
        for (_, pointer, factor) in COLUMNS {
            let value = run.pointer(pointer).and_then(Value::as_f64);
            let text = value.map_or("\u{2013}".into(), |value| digits(factor * value, 4));
            let _ = write!(out, "<td class=\"n\">{text}</td>");
        }
        let (word, class) = match run.pointer("/check/pass").and_then(Value::as_bool) {
            Some(true) => ("pass", "pass"),
            Some(false) => ("fail", "fail"),
            None => ("", ""),
        };
        let _ = writeln!(out, "<td class=\"{class}\">{word}</td></tr>");
    }
    out.push_str("</table>\n");
    for parameter in &parameters {
        if let Some(figure) = figure(parameter, runs) {
            let svg = figure.svg_element()?;
            let _ = writeln!(out, "<figure>{svg}</figure>");
        }
    }
    let _ = writeln!(
        out,
        "<p>Made by Creepage {} from {}.</p>\n</body>\n</html>",
        env!("CARGO_PKG_VERSION"),
        escape(&path.file_name().unwrap_or_default().to_string_lossy())
    );
    Ok(out)
}

fn shown(value: &Value) -> String {
    match value {
        Value::Number(n) => n.as_f64().map_or(String::new(), |x| digits(x, 4)),
        Value::String(text) => escape(text),
        Value::Null => "\u{2013}".into(),
        other => escape(&other.to_string()),
    }
}

/// Results against a parameter that is a number and takes more than one value.
fn figure(parameter: &str, runs: &[Value]) -> Option<Figure> {
    let at = |run: &Value| run["parameters"][parameter].as_f64();
    let mut values: Vec<f64> = runs.iter().filter_map(at).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let (least, most) = (*values.first()?, *values.last()?);
    if values.len() < 2 {
        return None;
    }
    let log = least > 0.0 && most / least > 20.0;
    let mut panels = Vec::new();
    for (heading, pointer, factor) in COLUMNS {
        let mut points: Vec<[f64; 2]> = runs
            .iter()
            .filter_map(|run| Some([at(run)?, factor * run.pointer(pointer)?.as_f64()?]))
            .collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        if points.is_empty() {
            continue;
        }
        panels.push(Panel {
            title: String::new(),
            x: if log { Axis::log(parameter) } else { Axis::linear(parameter) },
            y: Axis::linear(heading),
            fill: None,
            series: vec![Series {
                label: String::new(),
                points,
                draw: Draw::Dots(colour::BLUE, 2.5),
            }],
            marks: Vec::new(),
        });
    }
    if panels.is_empty() {
        return None;
    }
    let size = [1000, 250 * panels.len().div_ceil(2) as u32 + 30];
    let caption = format!("Results of all runs against {parameter}.");
    Some(Figure { size, columns: 2, panels, caption })
}
