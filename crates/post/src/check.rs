//! The check of a run: every measure on every view of the interface, in one pass over its records.

mod document;
mod mesh_mode;
mod pass;
mod scales;

use crate::PostError;
use crate::basis::{Basis, RunPaths};
use crate::centreline::CentreLine;
use crate::conditions::IN_CONTACT;
use crate::frames::ContactHistory;
use crate::limits::Limits;
use crate::map::MapWriter;
use crate::means::Sources;
use crate::patch_series::PatchRow;
use crate::slip_zone::SlipZone;
use crate::window::{Span, Window};
use output::layout::Pairing;
use pass::Pass;
use serde_json::{Value, json};
use std::path::Path;
use std::str::FromStr;

pub(crate) use pass::judged_faces;
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

/// What to check.
#[derive(Clone, Debug)]
pub struct CheckOptions<'a> {
    /// `None` is the run's evaluation window, or all of it.
    pub window: Option<Span>,
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
    let window = Window::resolve(options.window, basis, &history)?;
    let records = window.records.clone();
    let scales = Scales::resolve(basis, &history, &records)?;
    let mut pass = Pass::new(&history, basis, scales);
    pass.lead_in(records.start)?;
    let mut map = options
        .map
        .map(|path| MapWriter::create(path, &history.surface, &paths.contact))
        .transpose()?;
    let weights = window.weights(&history.times);
    let mut line = CentreLine::new(&history, basis);
    let first = records.start;
    history.stream_batches(records, |frames| {
        if let Some(map) = &mut map {
            for frame in &frames {
                map.write(&history.surface, frame, &pass.judge, &pass.scales)?;
            }
        }
        if let Ok(line) = &mut line {
            frames.iter().for_each(|frame| line.take(&history.surface, frame));
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
    let sources = Sources::of(paths, basis, &window)?;
    let patch = sources.patch(&pass.patch, &weights);
    let mesh_mode = mesh_mode::document(&pass.mesh_mode, sources.summary(), basis);
    let (mut document, holds) = pass.document(basis, options, &window, patch, mesh_mode);
    document["slip_zone"] = match &line {
        Ok(line) => SlipZone::of(line, &weights).map_or(Value::Null, |zone| zone.document(line)),
        Err(why) => json!({ "note": why.to_string() }),
    };
    Ok(Checked { document, pass: holds, patch: pass.patch })
}
