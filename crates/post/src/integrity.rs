//! Whether the files of a run are still what the run left.

use crate::PostError;
use crate::basis::RunPaths;
use crate::frames;
use output::layout::{attribute, file};
use output::{OutputError, as_long_as_written, as_written, read_summary};

/// How much is proven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// The lengths of all files, and every bit of those that are read whole.
    Read,
    /// Every bit of all files.
    Every,
}

/// The files that checks, figures and pages are made from, beside the summary.
const READ: [&str; 4] = [file::CASE, file::CONTACT, file::HISTORY, file::PROBES];

/// Proves by the summary of a run that its files are those that it left; of a run without a summary, which
/// goes on or was killed, nothing is known. Returns what to warn of: that there was nothing to prove it by.
///
/// # Errors
/// A file that is not as it was written, or gone though it is needed.
pub fn prove(paths: &RunPaths, depth: Depth) -> Result<Option<String>, PostError> {
    let folder = &paths.folder;
    let is_read = |name: &str| READ.contains(&name);
    let unproven = |why: &str| {
        let folder = folder.display();
        Ok(Some(format!("nothing proves that the files in {folder} are whole: {why}")))
    };
    let Some(summary) = read_summary(folder)? else {
        if output::CHECKPOINTS.iter().any(|name| folder.join(name).exists()) {
            return Ok(None);
        }
        return unproven("there is no summary.json with their checksums");
    };
    if !as_long_as_written(folder, &summary, is_read)? {
        return unproven("summary.json has no checksums (an earlier version wrote it)");
    }
    let wanted = |name: &str| depth == Depth::Every || is_read(name);
    as_written(folder, &summary, wanted)?;
    Ok(None)
}

/// Proves that the case of a run of version `version` is the one that its files name, for a run whose summary
/// cannot say so.
///
/// # Errors
/// A case with another hash.
pub fn prove_case(paths: &RunPaths, hash: &str, version: &str) -> Result<(), PostError> {
    let file = frames::open(&paths.contact)?;
    let of_this_version = file.provenance(attribute::VERSION).is_ok_and(|found| found == version);
    match file.provenance(attribute::CASE_HASH) {
        Ok(found) if of_this_version && found != hash && is_hash(&found) => {
            let reason = "it is not the case of this run: contact.vtkhdf names another".into();
            Err(OutputError::Damaged { path: paths.case.clone(), reason }.into())
        }
        _ => Ok(()),
    }
}

/// Data of other codes name something else.
fn is_hash(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}
