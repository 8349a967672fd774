//! What a run means: where and by how much the contact conditions, Eqs. (6) to (8) of Vollebregt's
//! *Comments* (2017), are violated, the measures of the patch, and the figures and the page that show them.
//!
//! Runs are read through `output` alone, so that results of other codes can be judged once they
//! have the layout of `contact.vtkhdf`. The friction laws are those of `friction`; of `contact` only the fit
//! of the patch and the measure of mesh modes are used. The closest-point projection is written anew here
//! (module `projection`), so that a check does not repeat an error of the solver.
//!
//! [`check`](check()) goes through a contact history record by record and returns what `creepage
//! check` prints. Fields are never held for all records; what is kept of each record are its patch
//! measures and its centre line.
//!
//! Units are SI. x is the direction of rolling, y is lateral, z is up. `p_n` is the pressure, `p_tau` the shear
//! traction, `p_f` its size, `s` the slip velocity, `mu` the coefficient of friction.

mod accumulator;
pub(crate) mod basis;
pub(crate) mod centreline;
pub(crate) mod conditions;
mod correlation;
pub(crate) mod digits;
pub(crate) mod error;
mod evaluation;
mod found;
pub(crate) mod frames;
mod import;
mod integrity;
pub(crate) mod law;
pub(crate) mod limits;
mod map;
pub(crate) mod means;
pub(crate) mod measure;
mod mesh_mode;
mod nodal_forces;
pub(crate) mod patch_series;
mod projection;
mod recorded_law;
mod replay;
pub(crate) mod result;
mod roughness;
mod scales;
pub(crate) mod slip_zone;
pub(crate) mod statistics;
pub(crate) mod surface;
pub(crate) mod welch;
pub(crate) mod window;

pub use basis::{Basis, Bound, RunPaths, SCALES, Scale};
pub use conditions::{DIRECTION_TOLERANCE, IN_ADHESION, IN_CONTACT, LAW_TOLERANCE};
pub use digits::all_digits;
pub use error::PostError;
pub use frames::{ContactHistory, Frame, Recorded};
pub use import::{ImportContactOptions, ImportError, Imported, import_contact};
pub use integrity::{Depth, verify_case, verify_files};
pub use law::Law;
pub use limits::{Limit, Limits, MethodKind};
pub use measure::{Definition, Measure};
pub use nodal_forces::{ContactOfForces, NodalForces};
pub use output::layout::Pairing;
pub use patch_series::{PATCH_TABLE, PatchLine, PatchMeasure, PatchRow};
pub use result::*;
pub use surface::{NO_BODY, Surface, body_name};
pub use window::Span;

use centreline::CentreLine;
use evaluation::Evaluation;
use found::Beside;
use map::MapWriter;
use means::Sources;
use slip_zone::SlipZone;
use std::path::Path;
use std::str::FromStr;
use window::Window;

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

/// By what a run is judged, and where the measures of its nodes go.
#[derive(Clone, Debug)]
pub struct Criteria<'a> {
    /// The window; `None` for the run's evaluation window, or all records where it has none.
    pub window: Option<Span>,
    /// Limits of the measures.
    pub limits: Limits,
    /// Which pairing is reported and judged.
    pub report: Report,
    /// Where to write the measures at each node over time, as VTKHDF; `None` for nowhere.
    pub map: Option<&'a Path>,
}

/// What a check found, with the patch over time.
#[derive(Clone, Debug)]
pub struct Checked {
    /// What it found.
    pub result: CheckResult,
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
    options: &Criteria<'_>,
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
    let (slip_zone, slip_note) = match &line {
        Ok(line) => {
            let zone = SlipZone::of(line, &weights);
            let note = zone.as_ref().and_then(SlipZone::note);
            (zone.map(|zone| SlipZoneFound::Measured(zone.measured(line))), note)
        }
        Err(why) => (Some(SlipZoneFound::Not { note: why.to_string() }), None),
    };
    let beside = Beside {
        patch: sources.patch(&evaluation.patch, &weights),
        mesh_mode: mesh_mode::found(&evaluation.mesh_mode, sources.summary(), basis),
        slip_zone,
        slip_note,
    };
    let result = evaluation.result(basis, options, &window, beside);
    Ok(Checked { result, patch: evaluation.patch })
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
