//! Means over a window, each from one source, so that all commands show the same number.
//!
//! A run takes means over its evaluation window, over every step or every row of its history, and writes them
//! to its summary: over that window these are the means. Over any other window they are means of the rows of
//! the history, and where there is no history, or no such column, of the records of contact.

use crate::check::PostError;
use crate::check::basis::{Basis, RunPaths};
use crate::check::frames::open_history;
use crate::check::patch_series::{PATCH_MEASURES, PatchRow};
use crate::check::statistics::{mean_and_deviation, time_weights};
use crate::check::window::Window;
use output::FieldSpec;
use output::confidence::of_series;
use output::layout::{HISTORY, file};
use serde_json::{Map, Value, json};
use std::collections::HashMap;
use std::path::Path;

/// The creepage, which a run's history holds and its records of contact do not: name, unit, meaning.
const CREEPAGE: (&str, &str, &str) = ("creepage", "1", "longitudinal creepage");

/// The column of a run's history that holds a measure of the patch.
fn column(measure: &str) -> Option<&'static FieldSpec> {
    let of_patch = |name: &str| name.strip_prefix("patch_") == Some(measure);
    HISTORY.each().into_iter().find(|column| column.name == measure || of_patch(&column.name))
}

/// The name of a measure of the patch in a run's summary and history.
fn name_in_run(measure: &str) -> &str {
    match measure {
        // the history holds the half axes alone
        "area_fitted" => "patch_area_fitted",
        _ => column(measure).map_or(measure, |column| &column.name),
    }
}

/// The reason why a measure has no mean, where the run states none.
fn why_none(measure: &str) -> &'static str {
    match measure {
        "half_length" | "half_width" | "area_fitted" | "centre" | "peak_pressure" => {
            "Hertz's distribution fits the pressure of no record"
        }
        "stick_fraction" | "slip_fraction" => "the file has no field state",
        _ => "no record has a value",
    }
}

/// The sources of means over a window.
pub(crate) struct Sources<'a> {
    summary: Option<&'a Value>,
    history: Option<Rows>,
}

/// The history of a run over a window.
struct Rows {
    /// Columns by their names.
    columns: HashMap<&'static str, Vec<f64>>,
    /// Time within the window that each row stands for (s).
    weights: Vec<f64>,
}

/// The mean of a measure from one source.
#[derive(Default)]
struct Found {
    /// Mean and standard deviation; the latter NaN where the source has none.
    mean: Option<[f64; 2]>,
    from: &'static str,
    /// Half the width of its 95 % confidence interval, by batches of the records.
    half: Option<f64>,
    /// Why there is no mean, or which rows it leaves out.
    note: Option<String>,
}

impl<'a> Sources<'a> {
    /// The sources of a run. Files beside a contact history of another name do not belong to it.
    pub fn of(paths: &RunPaths, basis: &'a Basis, window: &Window) -> Result<Self, PostError> {
        let own = paths.contact.file_name().is_some_and(|name| name == file::CONTACT);
        let summary = basis.summary.as_ref().filter(|_| own && window.of_summary);
        let history = if own { history(&paths.folder, window)? } else { None };
        Ok(Self { summary, history })
    }

    /// The run's summary, where its means are over this window.
    pub fn summary(&self) -> Option<&'a Value> {
        self.summary
    }

    /// Mean of a measure of the patch or of the creepage from the summary or the history.
    pub fn mean(&self, measure: &str) -> Option<f64> {
        self.of_run(measure)?.mean.map(|[mean, _]| mean)
    }

    /// The mean from the summary or the history; `None` where neither has the measure.
    fn of_run(&self, measure: &str) -> Option<Found> {
        let name = name_in_run(measure);
        self.in_summary(name).or_else(|| {
            let Rows { columns, weights } = self.history.as_ref()?;
            let mean = mean_and_deviation(weights, columns.get(name)?.iter().copied());
            Some(Found { mean, from: "history", half: self.half(name), note: None })
        })
    }

    fn in_summary(&self, name: &str) -> Option<Found> {
        let summary = self.summary?;
        let at = |section: &str| summary.pointer(&format!("/{section}/{name}"));
        let number = |section: &str| at(section).and_then(Value::as_f64);
        at("contact").or_else(|| at("window"))?;
        let mean = number("contact").or_else(|| number("window"));
        let note = at("window/reasons").and_then(Value::as_str).map(str::to_owned);
        let mean = mean.map(|mean| [mean, number("window/deviation").unwrap_or(f64::NAN)]);
        Some(Found { mean, from: "summary", half: self.half(name), note })
    }

    /// Half the width of the 95 % confidence interval of a mean, from the rows of the history.
    fn half(&self, name: &str) -> Option<f64> {
        let Rows { columns, weights } = self.history.as_ref()?;
        half(weights, columns.get(name)?)
    }

    /// The object `patch` of documents: means and standard deviations of all measures of the patch. Those that
    /// summary and history do not have are means of `rows`, the records of contact, with the times (s) that they
    /// stand for.
    pub fn patch(&self, rows: &[PatchRow], weights: &[f64]) -> Value {
        let of_records = |i: usize| {
            let values: Vec<f64> = rows.iter().map(|row| row.values[i]).collect();
            let mean = mean_and_deviation(weights, values.iter().copied());
            Found { mean, from: "contact records", half: half(weights, &values), note: None }
        };
        let entry = |(name, units, about): (&str, &str, &str), found: Found| {
            let [mean, deviation] = [0, 1].map(|i| found.mean.map(|both| both[i]));
            let mut entry = json!({ "mean": mean, "deviation": deviation, "ci95": found.half,
                                    "units": units, "about": about, "from": found.from });
            let silent = found.mean.is_none().then(|| why_none(name).to_owned());
            if let Some(note) = found.note.or(silent) {
                entry["note"] = json!(note);
            }
            (name.to_owned(), entry)
        };
        let measured = PATCH_MEASURES.iter().enumerate().map(|(i, measure)| {
            entry(*measure, self.of_run(measure.0).unwrap_or_else(|| of_records(i)))
        });
        let creepage = self.of_run(CREEPAGE.0).map(|found| entry(CREEPAGE, found));
        measured.chain(creepage).collect::<Map<_, _>>().into()
    }
}

/// Half the width of the 95 % confidence interval of the weighted mean of `values`; `None` where a record has no
/// value, or the batches give no interval. Zero where values differ by rounding alone, as a creepage that is driven.
fn half(weights: &[f64], values: &[f64]) -> Option<f64> {
    let counts = |(weight, value): (&f64, &f64)| *weight <= 0.0 || value.is_finite();
    let whole = weights.len() == values.len() && weights.iter().zip(values).all(counts);
    let half = whole.then(|| of_series(weights, values).ok()).flatten()?;
    let largest = values.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
    Some(if half > 1e-12 * largest { half } else { 0.0 })
}

/// The columns of the history of the run in `folder`, with weights for the window; `None` where there is no
/// history or none of its rows is in the window.
fn history(folder: &Path, window: &Window) -> Result<Option<Rows>, PostError> {
    let Some(history) = open_history(&folder.join(file::HISTORY))? else { return Ok(None) };
    let Some(times) = history.column(&HISTORY.time)? else { return Ok(None) };
    let weights = time_weights(&times, window.span);
    if !weights.iter().any(|weight| *weight > 0.0) {
        return Ok(None);
    }
    let mut columns = HashMap::new();
    for (measure, ..) in PATCH_MEASURES.into_iter().chain([CREEPAGE]) {
        let Some(column) = column(measure) else { continue };
        if let Some(values) = history.column(column)? {
            columns.insert(&*column.name, values);
        }
    }
    Ok(Some(Rows { columns, weights }))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::half;

    #[test]
    fn values_that_differ_by_rounding_have_an_interval_of_zero_and_others_have_one() {
        let alternating = |by: f64| (0..200).map(move |i| 2.4e-3 * (1.0 + by * f64::from(i % 3)));
        let of = |by| half(&[1.0; 200], &alternating(by).collect::<Vec<_>>());
        assert_eq!(of(2e-16), Some(0.0));
        assert!(of(1e-6).unwrap() > 0.0);
        assert_eq!(half(&[1.0; 3], &[1.0, f64::NAN, 1.0]), None);
    }
}
