//! Verification of the files of a run against the checksums in its summary.

use crate::check::PostError;
use crate::check::basis::RunPaths;
use crate::check::frames;
use output::layout::{attribute, file};
use output::{OutputError, as_long_as_written, as_written, read_summary};

/// How much is verified.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// The lengths of all files, and the CRC-32 of those that checks, figures and pages read.
    Read,
    /// Lengths and CRC-32 of all files.
    Every,
}

/// The files that checks, figures and pages are made from, beside the summary.
const READ: [&str; 4] = [file::CASE, file::CONTACT, file::HISTORY, file::PROBES];

/// Verifies the files of a run by the checksums in its summary. Returns a warning where there are none; of a run
/// that has a checkpoint and no summary yet, nothing is verified and nothing returned.
///
/// # Errors
/// A file that is not as it was written, cannot be read, or is gone though it is needed.
pub fn verify_files(paths: &RunPaths, depth: Depth) -> Result<Option<String>, PostError> {
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

/// Verifies that the case with the hash `hash` is the one that the contact history names, for a run without a
/// summary. Files that another version than `version` wrote, or another code, are accepted.
///
/// # Errors
/// A contact history that cannot be read or names another hash.
pub fn verify_case(paths: &RunPaths, hash: &str, version: &str) -> Result<(), PostError> {
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

/// Whether a text is a hash of this program; data of other codes have other texts.
fn is_hash(text: &str) -> bool {
    text.len() == 64 && text.bytes().all(|byte| byte.is_ascii_hexdigit())
}
