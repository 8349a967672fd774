//! Before a run begins: its folder is locked, its model is made, and it is found where the run goes on.

use crate::case::schema::Case;
use crate::run::checkpoint::State;
use crate::run::error::RunError;
use crate::run::folder::{self, Content};
use crate::run::held::FolderLock;
use crate::run::log::Log;
use crate::run::options::RunOptions;
use crate::run::resume::{self, ResumeFrom, ResumePoint};
use crate::run::text_file::write_text;
use crate::scenario::Model;
use crate::scenario::memory::{BYTES_PER_ELEMENT, enough_for_zones, enough_memory};
use output::NotWritten;
use output::layout::file;
use output::summary::Summary;
use serde::de::DeserializeOwned;

/// A run of the model `M` about to begin, or to go on from a state `T`.
pub(crate) struct OpenRun<M, T> {
    /// The lock of its folder.
    pub(crate) held: FolderLock,
    pub(crate) log: Log,
    pub(crate) model: M,
    /// The checkpoint where it goes on; none for a run that begins.
    pub(crate) point: Option<ResumePoint<T>>,
}

/// What there is to do in a folder.
pub(crate) enum Opening<M, T> {
    /// Nothing: the run is complete. Its summary.
    Complete(Box<Summary>),
    /// A run to begin, or to go on with.
    Run(Box<OpenRun<M, T>>),
}

/// Locks the folder of a run and makes its model by `make`; results of an earlier run are removed only once it is made.
/// `tell` writes of the model into the log.
pub(crate) fn open<M, T: DeserializeOwned>(
    case: &Case,
    options: &RunOptions,
    make: impl FnOnce(Option<&ResumePoint<T>>) -> Result<M, RunError>,
    tell: impl FnOnce(&M, &mut Log) -> Result<(), NotWritten>,
) -> Result<Opening<M, T>, RunError> {
    let begun = folder::is_run(&options.folder(case))
        || folder::content(&options.folder(case)) == Content::Beginning;
    let held =
        if options.resume && begun { Some(folder::take(&options.folder(case))?) } else { None };
    let (point, why) = match resume_from(case, options)? {
        Some(ResumeFrom::Complete(summary)) => return Ok(Opening::Complete(summary)),
        Some(ResumeFrom::Checkpoint(point)) => (Some(*point), None),
        Some(ResumeFrom::Beginning(why)) => (None, Some(why)),
        None => (None, None),
    };
    let replaces = options.force || why.is_some();
    if point.is_none() {
        // A run may be begun anew from the `case.toml` in its own folder, which then is replaced by an equal one.
        if options.force && !(options.resume && resume::is_of(case, &options.folder(case))) {
            folder::refuse_inputs(&options.folder(case), &case.inputs())?;
        }
        // Before the mesh is made, which takes time; the files of an earlier run are removed only after it.
        folder::check(&options.folder(case), replaces)?;
    }
    let model = make(point.as_ref())?;
    let log_file = options.folder(case).join(file::LOG);
    let (held, mut log) = match (&point, held) {
        (Some(_), Some(held)) => (held, Log::append(log_file)?),
        (_, held) => (folder::prepare(&options.folder(case), replaces, held)?, Log::new(log_file)?),
    };
    write_text(options.folder(case).join(file::CASE), &case.to_toml_with_units())?;
    log_opening(case, options, why, &mut log)?;
    tell(&model, &mut log)?;
    Ok(Opening::Run(Box::new(OpenRun { held, log, model, point })))
}

/// The model of a case that this machine has the memory for.
pub(super) fn model(
    case: &Case,
    options: &RunOptions,
    point: Option<&ResumePoint<State>>,
) -> Result<Model, RunError> {
    enough_for_zones(case, BYTES_PER_ELEMENT)?;
    let mut model = crate::scenario::model(case)?;
    model.law = options.law.clone();
    if let Some(point) = point {
        model.kernels = point.kernels;
    }
    enough_memory(model.mesh.hexes.len())?;
    Ok(model)
}

/// Writes the first lines of the log; `why` says why a run that was to be resumed begins at its start.
fn log_opening(
    case: &Case,
    options: &RunOptions,
    why: Option<String>,
    log: &mut Log,
) -> Result<(), NotWritten> {
    log.say(&format!(
        "creepage {}: {} from {}",
        env!("CARGO_PKG_VERSION"),
        case.name,
        options.case.file()
    ))?;
    if let Some(why) = why {
        log.warn(&format!("nothing to go on from, the run begins at its start: {why}"))?;
    }
    case.warnings().iter().try_for_each(|w| log.say(&format!("warning: {w}")))
}

/// Writes of the meshes into the log.
pub(super) fn log_model(case: &Case, model: &Model, log: &mut Log) -> Result<(), NotWritten> {
    model.notes.iter().try_for_each(|note| log.warn(&format!("mesh: {note}")))?;
    model.position.iter().flat_map(|at| at.lines()).try_for_each(|line| log.say(&line))?;
    let (elements, nodes) = (model.mesh.hexes.len(), model.mesh.nodes.len());
    log.say(&format!("mesh: {elements} elements, {nodes} nodes"))?;
    if model.multiplicity > 1.0 {
        log.say(
            "symmetry: y >= 0 is modelled, numbers are of the whole bodies; fluctuations without this symmetry are suppressed",
        )?;
    }
    if let Some(columns) = case.window_columns() {
        let [rear, front] = case.mesh.zone_along();
        log.say(&format!(
            "window: in place of mesh.zone.start and mesh.zone.length, the fine zone is {:.4} mm long and follows the \
             contact by {columns} columns of elements, {:.4} mm, at a time",
            1e3 * (front - rear),
            1e3 * f64::from(columns) * case.mesh.zone.size
        ))?;
    }
    match model.fully_integrated() {
        0 => Ok(()),
        full => log.say(&format!("fully integrated: {full} elements")),
    }
}

/// Where a run that is to be resumed goes on; none for one that begins.
fn resume_from<T: DeserializeOwned>(
    case: &Case,
    options: &RunOptions,
) -> Result<Option<ResumeFrom<T>>, RunError> {
    if !options.resume {
        return Ok(None);
    }
    match resume::resume_from(case, &options.folder(case)) {
        Ok(origin) => Ok(Some(origin)),
        Err(error) if options.force => Ok(Some(ResumeFrom::Beginning(error.to_string()))),
        Err(error) => Err(error.into()),
    }
}
