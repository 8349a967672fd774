//! What happened: whether the run ended, whether its contact obeys the conditions, a picture, and the numbers that matter.

use super::{escape, foreign, worth};
use crate::check::basis::Basis;
use crate::check::digits::digits;
use crate::check::limits::Limit;
use crate::check::measure::Measure;
use crate::check::patch_series::{PATCH_TABLE, PatchLine, PatchMeasure};
use crate::check::result::{CheckResult, Verdict};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use output::summary::Status;
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
pub(super) fn section(out: &mut String, basis: &Basis, folder: &Path, checked: &CheckResult) {
    out.push_str("<h2 id=\"overview\">What happened</h2>\n");
    let is_foreign = foreign::is_foreign(basis, folder);
    let (class, text) =
        if is_foreign { ("", "The records are of another program.".into()) } else { ending(basis) };
    let _ = writeln!(out, "<p class=\"{class}\">{}</p>", escape(&text));
    for (class, text) in conditions(checked) {
        let _ = writeln!(out, "<p class=\"{class}\">{}</p>", escape(&text));
    }
    let _ = writeln!(out, "<div class=\"wide\">{}</div>", numbers(basis, checked));
    if is_foreign {
        foreign::not_judged(out, basis, checked);
    }
    out.push_str(&super::scene::section(folder));
}

/// Whether the run ended as it should.
fn ending(basis: &Basis) -> (&'static str, String) {
    let summary = basis.summary.as_ref();
    let diagnosis = summary.and_then(|summary| summary.diagnosis.as_deref()).unwrap_or_default();
    match summary.and_then(|summary| summary.status) {
        Some(Status::Completed) => ("pass", "The run reached its end.".into()),
        Some(Status::Interrupted) => {
            ("", "The run was interrupted. The page shows what it reached.".into())
        }
        Some(Status::Failed) => (
            "fail",
            format!(
                "The run failed: its own guards stopped it. The page shows what it reached. {diagnosis}"
            ),
        ),
        None => {
            ("", "The run has no summary: it is in progress, or was stopped before its end.".into())
        }
    }
}

/// Whether contact obeys its conditions, which is a matter of the method, not of whether the run worked: what is known
/// of penalty springs apart from what is wrong.
fn conditions(checked: &CheckResult) -> Vec<(&'static str, String)> {
    if checked.pass {
        return vec![(
            "pass",
            "Its contact obeys the contact conditions within all limits.".into(),
        )];
    }
    let springs = checked.with_verdict(Verdict::Springs);
    let mut wrong = checked.with_verdict(Verdict::Fail);
    let mut found = Vec::new();
    if !springs.is_empty() {
        found.push(("springs", in_stick(checked, &springs)));
        let own: Vec<_> = springs.iter().filter_map(|measure| measure.in_slip_state()).collect();
        let class = if own.iter().any(|own| wrong.contains(own)) { "fail" } else { "pass" };
        wrong.retain(|measure| !own.contains(measure));
        found.push((class, in_slip(checked, &own)));
    }
    if !wrong.is_empty() {
        let share = value(checked, Measure::ViolatingFraction).filter(|_| springs.is_empty());
        let share = share.map(|share| {
            let share = digits(100.0 * share, 2);
            format!(
                "On {share} % of contact area and time, the conditions of contact are violated. "
            )
        });
        let text = format!(
            "{}The limits of {} methods are exceeded by {}. This is a finding about the method, not a failure of the run.",
            share.unwrap_or_default(),
            checked.limits_for,
            names(&wrong)
        );
        found.push(("fail", text));
    }
    found
}

/// What springs in stick do, and how much of it.
fn in_stick(checked: &CheckResult, springs: &[Measure]) -> String {
    let slip = value(checked, Measure::AdhesionSlip);
    let slip = slip.map(|slip| format!(", at up to {} times the rigid slip", digits(slip, 2)));
    format!(
        "Penalty springs deform: nodes that stick move{}. This is known of the method; it takes {} beyond the limit.",
        slip.unwrap_or_default(),
        names(springs)
    )
}

/// What is left of these measures where the algorithm lets nodes slip.
fn in_slip(checked: &CheckResult, own: &[Measure]) -> String {
    let part = |measure: &Measure| {
        let metric = checked.metrics.get(measure)?;
        let (value, Limit::Most(most)) = (metric.value?, metric.limit?) else { return None };
        let percent = |share: f64| format!("{} %", digits(100.0 * share, 2));
        let degrees = |angle: f64| format!("{} degrees", digits(angle, 2));
        Some(match measure {
            Measure::LawErrorSlipState => {
                format!(
                    "the shear differs from its bound by {} (limit {})",
                    percent(value),
                    percent(most)
                )
            }
            Measure::DirectionSlipState => format!(
                "it deviates from the direction opposite to the slip by {} (limit {})",
                degrees(value),
                degrees(most)
            ),
            _ => format!(
                "the conditions are violated on {} of the contact (limit {})",
                percent(value),
                percent(most)
            ),
        })
    };
    let parts: Vec<String> = own.iter().filter_map(part).collect();
    format!("Where the algorithm lets nodes slip, {}.", parts.join("; "))
}

fn value(checked: &CheckResult, measure: Measure) -> Option<f64> {
    checked.metrics.get(&measure)?.value
}

fn names(measures: &[Measure]) -> String {
    measures.iter().map(|measure| measure.name()).collect::<Vec<_>>().join(", ")
}

/// The numbers that matter.
const NUMBERS: [PatchMeasure; 6] = [
    PatchMeasure::NormalForce,
    PatchMeasure::TractionCoefficient,
    PatchMeasure::Creepage,
    PatchMeasure::PeakPressure,
    PatchMeasure::HalfLength,
    PatchMeasure::StickFraction,
];

/// The table of these numbers beside Hertz's.
fn numbers(basis: &Basis, checked: &CheckResult) -> String {
    let mut out = String::from(
        "<table>\n<tr><th>mean over the window</th><th class=\"n\">value</th><th></th>\
         <th class=\"n\">half-space</th></tr>\n",
    );
    let line = |measure: &PatchMeasure| PATCH_TABLE.iter().find(|line| line.measure == *measure);
    for PatchLine { label, measure, factor, unit } in NUMBERS.iter().filter_map(line) {
        let found = checked.patch.get(measure);
        let Some((mean, found)) = found.and_then(|found| Some((found.mean?, found))) else {
            let note = found.and_then(|found| found.note.as_deref());
            let _ = writeln!(
                out,
                "<tr><td>{label}</td><td class=\"n\">\u{2013}</td><td colspan=\"2\">{}</td></tr>",
                escape(note.unwrap_or_default())
            );
            continue;
        };
        let scale = super::half_space(basis, *measure);
        let _ = writeln!(
            out,
            "<tr><td>{label}</td><td class=\"n\">{}</td><td>{unit}</td><td class=\"n\">{}</td></tr>",
            worth(factor * mean, found.ci95.map(|half| factor * half)),
            scale.map(|scale| digits(factor * scale, 4)).unwrap_or_default()
        );
    }
    out.push_str("</table>");
    out
}

/// Appends a link to what `creepage check --json` prints.
pub(super) fn data(out: &mut String, checked: &CheckResult) {
    let encoded = STANDARD.encode(serde_json::to_string(checked).unwrap_or_default());
    let _ = writeln!(
        out,
        "<p><a download=\"check.json\" href=\"data:application/json;base64,{encoded}\">All numbers of the check as \
         JSON</a>; each table has a link to it as CSV.</p>"
    );
}
