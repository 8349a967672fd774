//! Whether and from where `--resume` can go on.

pub(crate) mod error;

use std::path::Path;

use crate::case::schema::Case;
use crate::run::checkpoint::KERNELS;
use crate::run::folder::{Content, content, has_no_results, is_run};
use crate::run::log::Log;
use crate::run::text_file::remove;
use error::ResumeError;
use output::layout::file;
use output::summary::{Status, Summary};
use output::{
    CHECKPOINTS, Checkpoint, NotWritten, OutputError, Results, as_long_as_written, read_summary,
    verify,
};
use serde::de::DeserializeOwned;
use solid::Level;

/// Where a run goes on.
pub(crate) enum ResumeFrom<T> {
    /// Nowhere: the run is complete. Its summary.
    Complete(Box<Summary>),
    /// At its beginning. The reason.
    Beginning(String),
    /// At a checkpoint.
    Checkpoint(Box<ResumePoint<T>>),
}

/// A checkpoint to go on from, with the state that it holds.
pub(crate) struct ResumePoint<T> {
    pub(crate) checkpoint: Checkpoint,
    pub(crate) state: T,
    pub(crate) kernels: Level,
    /// Newer checkpoints that cannot be used, and why.
    pub(crate) damaged: Vec<(&'static str, String)>,
}

impl<T> ResumePoint<T> {
    /// Says in the log where the run goes on, and removes checkpoints that cannot be used.
    pub(crate) fn tell(self, folder: &Path, log: &mut Log) -> Result<Self, NotWritten> {
        for (name, damage) in &self.damaged {
            log.warn(&format!("not used, {name}: {damage}; the one before is"))?;
            // of two checkpoints the next one replaces the older: that must not be the good one
            remove(&folder.join(name))?;
        }
        log.say(&format!("resumed from the checkpoint of step {}", self.checkpoint.step))?;
        Ok(self)
    }
}

/// Where the run of `case` in `folder` goes on.
pub(crate) fn resume_from<T: DeserializeOwned>(
    case: &Case,
    folder: &Path,
) -> Result<ResumeFrom<T>, ResumeError> {
    let path = || folder.to_path_buf();
    match content(folder) {
        Content::Run if is_run(folder) => {}
        Content::Beginning => {
            return Ok(ResumeFrom::Beginning("the run was killed as it began".into()));
        }
        _ => return Err(ResumeError::NoRun { folder: path() }),
    }
    if let Some(difference) = difference(case, folder) {
        if has_no_results(folder) {
            return Ok(ResumeFrom::Beginning(format!(
                "the folder holds no results, and {difference}"
            )));
        }
        return Err(ResumeError::AnotherCase { folder: path(), difference });
    }
    let damage =
        |error: OutputError| ResumeError::Damaged { folder: path(), reason: error.to_string() };
    let summary = read_summary(folder);
    if let Ok(Some(summary)) = &summary
        && summary.status == Some(Status::Completed)
    {
        as_long_as_written(folder, summary, |_| true).map_err(damage)?;
        return Ok(ResumeFrom::Complete(Box::new(summary.clone())));
    }
    let mut damaged = Vec::new();
    for name in CHECKPOINTS {
        if !folder.join(name).exists() {
            continue;
        }
        match usable(case, folder, name) {
            Ok((checkpoint, state, kernels)) => {
                let point = ResumePoint { checkpoint, state, kernels, damaged };
                return Ok(ResumeFrom::Checkpoint(Box::new(point)));
            }
            Err(reason) => damaged.push((name, reason)),
        }
    }
    if damaged.is_empty() {
        // a summary that is damaged matters only where there is no checkpoint
        summary.map_err(damage)?;
        return Ok(ResumeFrom::Beginning("the run has no checkpoint yet".into()));
    }
    let reasons: Vec<_> =
        damaged.iter().map(|(name, reason)| format!("{name}: {reason}")).collect();
    Err(ResumeError::Unusable { folder: path(), reasons: reasons.join("; ") })
}

/// Whether the run in `folder` is of `case`.
pub(crate) fn is_of(case: &Case, folder: &Path) -> bool {
    is_run(folder) && difference(case, folder).is_none()
}

/// What differs between `case` and that of the run in `folder`.
fn difference(case: &Case, folder: &Path) -> Option<String> {
    let path = folder.join(file::CASE);
    let theirs = match Case::load(&path, &[]) {
        Ok(theirs) => theirs,
        Err(error) => return Some(format!("its case.toml cannot be read: {error}")),
    };
    let (ours, theirs) = (case.table(), theirs.table());
    let mut keys = Vec::new();
    differing(&ours, &theirs, "", &mut keys);
    // no result depends on these
    keys.retain(|key| !key.starts_with("checkpoint") && !key.starts_with("guards"));
    match &keys[..] {
        [] => None,
        [some @ .., last] if some.len() < 4 => {
            let all = [some, std::slice::from_ref(last)].concat().join(", ");
            Some(format!("{all} differ{} (case.toml)", if keys.len() == 1 { "s" } else { "" }))
        }
        keys => {
            let (some, more) = (keys[..3].join(", "), keys.len() - 3);
            Some(format!("{some} and {more} further keys differ (case.toml)"))
        }
    }
}

fn differing(ours: &toml::Table, theirs: &toml::Table, prefix: &str, keys: &mut Vec<String>) {
    let others = theirs.keys().filter(|key| !ours.contains_key(*key));
    for key in ours.keys().chain(others) {
        let name = format!("{prefix}{key}");
        match (ours.get(key), theirs.get(key)) {
            (Some(toml::Value::Table(a)), Some(toml::Value::Table(b))) => {
                differing(a, b, &format!("{name}."), keys);
            }
            (a, b) if a == b => {}
            _ => keys.push(name),
        }
    }
}

/// The checkpoint if the run can go on from it, or else why not.
fn usable<T: DeserializeOwned>(
    case: &Case,
    folder: &Path,
    name: &str,
) -> Result<(Checkpoint, T, Level), String> {
    let checkpoint = Checkpoint::read(&folder.join(name)).map_err(|error| match error {
        OutputError::Read { reason, .. } => format!("it is damaged: {reason}"),
        error => error.to_string(),
    })?;
    let version = &checkpoint.provenance.creepage_version;
    if version != env!("CARGO_PKG_VERSION") {
        return Err(format!(
            "it is of version {version} of creepage, this is {}",
            env!("CARGO_PKG_VERSION")
        ));
    }
    if checkpoint.provenance.case_hash != case.hash() {
        return Err("it is of another case".into());
    }
    let kernels = checkpoint.text(KERNELS).unwrap_or_default();
    let level = Level::named(kernels).and_then(Level::with_the_same_bits).ok_or_else(|| {
        format!("it was computed with {kernels} kernels, which this machine cannot run")
    })?;
    let state = checkpoint.state().map_err(|error| error.to_string())?;
    results_reach(&checkpoint, folder)?;
    Ok((checkpoint, state, level))
}

/// Whether the result files hold all that belongs to the checkpoint, unchanged, and can be extended.
fn results_reach(checkpoint: &Checkpoint, folder: &Path) -> Result<(), String> {
    let Results { fields, contact, history, probes } = &checkpoint.results;
    let always = [(file::CONTACT, contact), (file::HISTORY, history)];
    // Only of runs that record their bodies, and of cases with probes.
    let others = [(file::FIELDS, fields), (file::PROBES, probes)];
    let others = others.into_iter().filter(|(_, kept)| !kept.sums.is_empty());
    for (name, kept) in others.chain(always) {
        verify(folder.join(name), kept).map_err(|error| error.to_string())?;
    }
    Ok(())
}
