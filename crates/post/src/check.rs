//! The check of a run: every measure on every view of the interface, in one pass over its records.

mod document;
mod pass;
mod scales;

use crate::PostError;
use crate::basis::{Basis, RunPaths};
use crate::conditions::IN_CONTACT;
use crate::frames::{ContactHistory, Pairing};
use crate::limits::Limits;
use crate::map::MapWriter;
use crate::patch_series::PatchRow;
use crate::statistics::{mean_and_deviation, time_weights};
use output::HistoryFile;
use pass::Pass;
use serde_json::{Value, json};
use std::path::Path;

pub(crate) use scales::Scales;

/// Which pairing in time of slip and traction a check reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Report {
    /// The one that the file states as its method's own, else the stricter.
    #[default]
    Stated,
    /// The larger violation of the two.
    Stricter,
    /// One of them.
    Only(Pairing),
}

/// What to check.
#[derive(Clone, Debug)]
pub struct CheckOptions<'a> {
    /// From and to (s), both included; `None` is the run's evaluation window, or all of it.
    pub window: Option<[f64; 2]>,
    /// Limits.
    pub limits: Limits,
    /// Pairing to report.
    pub report: Report,
    /// Where to write per-node violations over time.
    pub map: Option<&'a Path>,
}

/// What a check found.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The contract's document.
    pub document: Value,
    /// Whether every limit holds.
    pub pass: bool,
    /// The patch over time.
    pub patch: Vec<PatchRow>,
}

/// Checks the contact conditions of a run against `basis`.
///
/// Each record weighs with the time that it stands for, so that spans recorded at every step do
/// not outweigh others.
///
/// # Errors
/// Files that cannot be read or lack what the measures are made of; a window without contact.
pub fn check(
    paths: &RunPaths,
    basis: &mut Basis,
    options: &CheckOptions<'_>,
) -> Result<Checked, PostError> {
    let history = ContactHistory::open(&paths.contact)?;
    let span = options.window.or(basis.window).unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
    let records = match history.window(span) {
        // a run that ended, or has come, only to before its evaluation window
        Err(_) if options.window.is_none() => 0..history.times.len(),
        found => found?,
    };
    let scales = Scales::settle(basis, &history, &records)?;
    let mut pass = Pass::new(&history, basis, scales);
    let mut map = options
        .map
        .map(|path| MapWriter::create(path, &history.surface, &paths.contact))
        .transpose()?;
    let weights = time_weights(&history.times[records.clone()]);
    let first = records.start;
    history.stream_batches(records.clone(), |frames| {
        if let Some(map) = &mut map {
            for frame in &frames {
                map.write(&history.surface, frame, &pass.judge, &pass.scales)?;
            }
        }
        pass.take(frames.into_iter().map(|frame| {
            let weight = weights[frame.index - first];
            (frame, weight)
        }));
        Ok(())
    })?;
    if pass.node_times == 0 {
        return Err(PostError::Lacks {
            path: paths.contact.clone(),
            what: format!(
                "no node is in contact in the window: no pressure exceeds {IN_CONTACT} p0 = {:e} Pa",
                IN_CONTACT * pass.scales.peak_pressure
            ),
        });
    }
    let times = [history.times[records.start], history.times[records.end - 1]];
    let (mut document, holds) = pass.document(basis, options, times, records.len());
    if let Some(creepage) = creepage(&paths.folder.join("history.h5"), times) {
        document["patch"]["creepage"] = creepage;
    }
    Ok(Checked { document, pass: holds, patch: pass.patch })
}

/// Mean and deviation of the creepage that the history holds for the window.
fn creepage(path: &Path, [from, to]: [f64; 2]) -> Option<Value> {
    let history = HistoryFile::open(path).ok()?;
    let (times, values) = (history.read("time").ok()?, history.read("creepage").ok()?);
    let inside = times.iter().zip(&values).filter(|(t, _)| (from..=to).contains(*t));
    let (times, values): (Vec<f64>, Vec<f64>) = inside.unzip();
    let [mean, deviation] = mean_and_deviation(&times, values.into_iter())?;
    Some(json!({ "mean": mean, "deviation": deviation, "units": "1",
                 "about": "longitudinal creepage, from the history" }))
}
