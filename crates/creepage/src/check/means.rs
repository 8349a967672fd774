//! Means over a window, each from one source, so that all commands show the same number.
//!
//! A run takes means over its evaluation window, over every step or every row of its history, and writes them
//! to its summary: over that window these are the means. Over any other window they are means of the rows of
//! the history, and where there is no history, or no such column, of the records of contact.

use crate::check::PostError;
use crate::check::basis::{Basis, RunPaths};
use crate::check::frames::open_history;
use crate::check::patch_series::{PatchMeasure, PatchRow};
use crate::check::result::PatchMean;
use crate::check::statistics::{mean_and_deviation, time_weights};
use crate::check::window::Window;
use output::FieldSpec;
use output::confidence::of_series;
use output::layout::{HISTORY, file};
use output::summary::Summary;
use std::collections::BTreeMap;
use std::path::Path;

/// The column of a run's history that holds a measure of the patch.
fn column(measure: PatchMeasure) -> Option<&'static FieldSpec> {
    let of_patch = |name: &str| name.strip_prefix("patch_") == Some(measure.name());
    HISTORY
        .each()
        .into_iter()
        .find(|column| column.name == measure.name() || of_patch(&column.name))
}

/// The reason why a measure has no mean, where the run states none.
fn why_none(measure: PatchMeasure) -> &'static str {
    match measure {
        PatchMeasure::HalfLength
        | PatchMeasure::HalfWidth
        | PatchMeasure::AreaFitted
        | PatchMeasure::Centre
        | PatchMeasure::PeakPressure => "Hertz's distribution fits the pressure of no record",
        PatchMeasure::StickFraction | PatchMeasure::SlipFraction => "the file has no field state",
        _ => "no record has a value",
    }
}

/// The sources of means over a window.
pub(crate) struct Sources<'a> {
    summary: Option<&'a Summary>,
    history: Option<Rows>,
}

/// The history of a run over a window.
struct Rows {
    /// Columns by their measures.
    columns: BTreeMap<PatchMeasure, Vec<f64>>,
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
    pub fn summary(&self) -> Option<&'a Summary> {
        self.summary
    }

    /// Mean of a measure of the patch from the summary or the history.
    pub fn mean(&self, measure: PatchMeasure) -> Option<f64> {
        self.of_run(measure)?.mean.map(|[mean, _]| mean)
    }

    /// The mean from the summary or the history; `None` where neither has the measure.
    fn of_run(&self, measure: PatchMeasure) -> Option<Found> {
        self.of_summary(measure).or_else(|| {
            let Rows { columns, weights } = self.history.as_ref()?;
            let mean = mean_and_deviation(weights, columns.get(&measure)?.iter().copied());
            Some(Found { mean, from: "history", half: self.half(measure), note: None })
        })
    }

    fn of_summary(&self, measure: PatchMeasure) -> Option<Found> {
        let (summary, mean) = (self.summary?, measure.in_summary()?);
        let window = summary.window.as_ref();
        let deviation = window.and_then(|window| window.deviation.get(&mean).copied().flatten());
        let note = window.and_then(|window| window.reasons.get(&mean).cloned());
        let mean = summary.mean(mean).map(|value| [value, deviation.unwrap_or(f64::NAN)]);
        Some(Found { mean, from: "summary", half: self.half(measure), note })
    }

    /// Half the width of the 95 % confidence interval of a mean, from the rows of the history.
    fn half(&self, measure: PatchMeasure) -> Option<f64> {
        let Rows { columns, weights } = self.history.as_ref()?;
        half(weights, columns.get(&measure)?)
    }

    /// Means and standard deviations of all measures of the patch. Those that summary and history do not have are means
    /// of `rows`, the records of contact, with the times (s) that they stand for; these have no creepage.
    pub fn patch(&self, rows: &[PatchRow], weights: &[f64]) -> BTreeMap<PatchMeasure, PatchMean> {
        let of_records = |i: usize| {
            let values: Vec<f64> = rows.iter().map(|row| row.values[i]).collect();
            let mean = mean_and_deviation(weights, values.iter().copied());
            Found { mean, from: "contact records", half: half(weights, &values), note: None }
        };
        let entry = |measure: PatchMeasure, found: Found| {
            let finite = |value: f64| Some(value).filter(|value| value.is_finite());
            let (_, units, about) = measure.definition();
            let silent = found.mean.is_none().then(|| why_none(measure).to_owned());
            let mean = PatchMean {
                mean: found.mean.and_then(|[mean, _]| finite(mean)),
                deviation: found.mean.and_then(|[_, deviation]| finite(deviation)),
                ci95: found.half,
                units: units.into(),
                about: about.into(),
                from: found.from.into(),
                note: found.note.or(silent),
            };
            (measure, mean)
        };
        let records = PatchMeasure::OF_RECORDS.iter().enumerate();
        let measured = records.map(|(i, &measure)| {
            entry(measure, self.of_run(measure).unwrap_or_else(|| of_records(i)))
        });
        let creepage = self.of_run(PatchMeasure::Creepage);
        measured.chain(creepage.map(|found| entry(PatchMeasure::Creepage, found))).collect()
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
    let mut columns = BTreeMap::new();
    for &measure in PatchMeasure::ALL {
        let Some(column) = column(measure) else { continue };
        if let Some(values) = history.column(column)? {
            columns.insert(measure, values);
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
