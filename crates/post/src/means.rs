//! Means over a window, each from the one source that every command shows.
//!
//! A run keeps means over its evaluation window at every step or row of its history and writes them
//! to its summary; those stand wherever that window is meant. Over any other window the rows of the
//! history give them, and where there is no history, or no such column, the records of contact.

use crate::basis::{Basis, RunPaths};
use crate::patch_series::{PATCH_MEASURES, PatchRow};
use crate::statistics::{mean_and_deviation, time_weights};
use crate::window::Window;
use output::HistoryFile;
use serde_json::{Map, Value, json};

/// The creepage, which a run's history holds and its records of contact do not: name, unit, meaning.
const CREEPAGE: (&str, &str, &str) = ("creepage", "1", "longitudinal creepage");

/// What a measure of the patch is called in a run's summary and history.
fn name_in_run(measure: &str) -> String {
    match measure {
        "half_length" | "half_width" | "area" => format!("patch_{measure}"),
        other => other.to_owned(),
    }
}

/// Where means over a window come from.
pub(crate) struct Sources<'a> {
    summary: Option<&'a Value>,
    /// The history with the weight of each of its rows.
    history: Option<(HistoryFile, Vec<f64>)>,
}

impl<'a> Sources<'a> {
    /// Those of a run; the files beside a contact history of another name are not its own.
    pub fn of(paths: &RunPaths, basis: &'a Basis, window: &Window) -> Self {
        let own = paths.contact.file_name().is_some_and(|name| name == RunPaths::CONTACT);
        let history = own.then(|| HistoryFile::open(paths.folder.join("history.h5")).ok());
        let history = history.flatten().and_then(|history| {
            let weights = time_weights(&history.read("time").ok()?, window.span);
            weights.iter().any(|weight| *weight > 0.0).then_some((history, weights))
        });
        let summary = basis.summary.as_ref().filter(|_| own && window.of_summary);
        Self { summary, history }
    }

    /// Mean, deviation and origin of a measure of the patch or of the creepage, as far as the run
    /// itself holds them.
    pub fn of_run(&self, measure: &str) -> Option<([f64; 2], &'static str)> {
        let name = name_in_run(measure);
        self.in_summary(&name).or_else(|| {
            let (history, weights) = self.history.as_ref()?;
            let values = history.read(&name).ok()?;
            Some((mean_and_deviation(weights, values.into_iter())?, "history"))
        })
    }

    fn in_summary(&self, name: &str) -> Option<([f64; 2], &'static str)> {
        let summary = self.summary?;
        let number = |section: &str| summary.pointer(&format!("/{section}/{name}"))?.as_f64();
        let mean = number("contact").or_else(|| number("window"))?;
        Some(([mean, number("window/deviation")?], "summary"))
    }

    /// Means and standard deviations of all measures of the patch, those that the run does not hold
    /// from `rows`, its records of contact, with the time that each stands for.
    pub fn patch(&self, rows: &[PatchRow], weights: &[f64]) -> Value {
        let of_records = |i: usize| {
            let values = rows.iter().map(|row| row.values[i]);
            Some((mean_and_deviation(weights, values)?, "contact records"))
        };
        let entry = |(name, units, about): (&str, &str, &str), found: Option<_>| {
            let ([mean, deviation], from): ([f64; 2], &str) = found?;
            let value = json!({ "mean": mean, "deviation": deviation, "units": units,
                                "about": about, "from": from });
            Some((name.to_owned(), value))
        };
        let measured = PATCH_MEASURES.iter().enumerate().filter_map(|(i, measure)| {
            entry(*measure, self.of_run(measure.0).or_else(|| of_records(i)))
        });
        let creepage = entry(CREEPAGE, self.of_run(CREEPAGE.0));
        measured.chain(creepage).collect::<Map<_, _>>().into()
    }
}
