//! The check of a run: every measure on every view of the interface, in one pass over its records.

mod document;
mod evaluation;
mod mesh_mode;
mod scales;

pub use document::{keeps_limit, slip_paired};

use crate::PostError;
use crate::basis::{Basis, RunPaths};
use crate::centreline::CentreLine;
use crate::conditions::IN_CONTACT;
use crate::frames::{ContactHistory, Frame};
use crate::limits::Limits;
use crate::map::MapWriter;
use crate::means::Sources;
use crate::patch_series::PatchRow;
use crate::slip_zone::SlipZone;
use crate::window::{Span, Window};
use evaluation::Evaluation;
use output::layout::Pairing;
use serde_json::{Value, json};
use std::path::Path;
use std::str::FromStr;

pub(crate) use evaluation::judged_faces;
pub(crate) use scales::Scales;

/// Which pairing in time of slip and traction a check reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Report {
    /// The one that the file states as its method's own, else the stricter.
    #[default]
    Stated,
    /// The one with the larger violation, measure by measure.
    Stricter,
    /// This one.
    Only(Pairing),
}

impl FromStr for Report {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text {
            "stricter" => Ok(Self::Stricter),
            "before" => Ok(Self::Only(Pairing::Before)),
            "after" => Ok(Self::Only(Pairing::After)),
            _ => Err("one of stricter, before, after is needed"),
        }
    }
}

/// Options of a check.
#[derive(Clone, Debug)]
pub struct CheckOptions<'a> {
    /// The window; `None` for the run's evaluation window, or all records where it has none.
    pub window: Option<Span>,
    /// Limits of the measures.
    pub limits: Limits,
    /// Which pairing is reported and judged.
    pub report: Report,
    /// Where to write the measures at each node over time, as VTKHDF; `None` for nowhere.
    pub map: Option<&'a Path>,
}

/// The result of a check.
#[derive(Clone, Debug)]
pub struct Checked {
    /// The JSON document of `creepage check`, as `docs/checks.md` describes it.
    pub document: Value,
    /// Whether every measure is within its limit.
    pub pass: bool,
    /// The patch over time, a row for each record of the window.
    pub patch: Vec<PatchRow>,
}

/// Checks the contact conditions of a run by the law and scales of `basis`, to which it adds scales found in the
/// records.
///
/// Each record is weighted with the time that it stands for, so that spans recorded at every step do not
/// outweigh others.
///
/// # Errors
/// Files that cannot be read or lack data or scales that the measures need; a window without a record, or
/// without contact; a map that cannot be written.
pub fn check(
    paths: &RunPaths,
    basis: &mut Basis,
    options: &CheckOptions<'_>,
) -> Result<Checked, PostError> {
    let history = ContactHistory::open(&paths.contact)?;
    let window = Window::resolve(options.window, basis, &history)?;
    let records = window.records.clone();
    let scales = Scales::resolve(basis, &history, &records)?;
    let mut evaluation = Evaluation::new(&history, basis, scales);
    evaluation.lead_in(records.start)?;
    let mut map = options
        .map
        .map(|path| MapWriter::create(path, &history.surface, &paths.contact))
        .transpose()?;
    let weights = window.weights(&history.times);
    let mut line = CentreLine::new(&history, basis);
    let first = records.start;
    history.stream_batches(records, |frames| {
        if let Ok(line) = &mut line {
            frames.iter().for_each(|frame| line.take(&history.surface, frame));
        }
        let weigh = |frame: Frame| {
            let weight = weights[frame.index - first];
            (frame, weight)
        };
        evaluation.take(frames.into_iter().map(weigh), map.as_mut())
    })?;
    if evaluation.node_times == 0 {
        return Err(PostError::Lacks {
            path: paths.contact.clone(),
            what: format!(
                "no node is in contact in the window: no pressure exceeds {IN_CONTACT} p0 = {:e} Pa",
                IN_CONTACT * evaluation.scales.peak_pressure
            ),
        });
    }
    let sources = Sources::of(paths, basis, &window)?;
    let patch = sources.patch(&evaluation.patch, &weights);
    let mesh_mode = mesh_mode::document(&evaluation.mesh_mode, sources.summary(), basis);
    let (mut document, holds) = evaluation.document(basis, options, &window, patch, mesh_mode);
    document["slip_zone"] = match &line {
        Ok(line) => {
            let zone = SlipZone::of(line, &weights);
            let note = zone.as_ref().and_then(SlipZone::note);
            if let (Some(notes), Some(note)) = (document["notes"].as_array_mut(), note) {
                notes.push(json!(note));
            }
            zone.map_or(Value::Null, |zone| zone.document(line))
        }
        Err(why) => json!({ "note": why.to_string() }),
    };
    Ok(Checked { document, pass: holds, patch: evaluation.patch })
}

/// What a run tells of slip that fluctuates much in its evaluation window, as a check notes it; `None` where it does not.
///
/// # Errors
/// As of [`check`].
pub fn fluctuating_slip(paths: &RunPaths, basis: &mut Basis) -> Result<Option<String>, PostError> {
    let history = ContactHistory::open(&paths.contact)?;
    let window = Window::resolve(None, basis, &history)?;
    let weights = window.weights(&history.times);
    let mut line = CentreLine::new(&history, basis)?;
    history.stream_batches(window.records, |frames| {
        frames.iter().for_each(|frame| line.take(&history.surface, frame));
        Ok(())
    })?;
    Ok(SlipZone::of(&line, &weights).and_then(|zone| zone.note()))
}
