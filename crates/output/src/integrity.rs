//! The checksums in the summary of a run that has ended, by which damage is detected: lengths and CRC-32 of its
//! files, and SHA-256 of the summary itself.
//!
//! Files of a run are large: on a processor with instructions for it, SHA-256 of them took 1 % of the time of a
//! run; CRC-32 takes a third of that and misses one random damage in four billion.
//!
//! The checksum of a summary is over its JSON with whatever keys its version wrote: here alone it is a free document.

use crate::OutputError;
use crate::checksums::hexadecimal;
use crate::files::input::{self, Fault, InputError};
use crate::hdf5::damaged;
use crate::layout::file;
use crate::summary::Summary;
use crc32fast::Hasher;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

/// Key of the summary: [`FileSum`] by the name of each file.
const SUMS: &str = "checksums";
/// Key of the summary: SHA-256 of everything else in it.
const SEAL: &str = "sha256";

/// How the last line of `run.log` begins where a run has ended. The status follows, and then ` after ` where
/// the run left a summary.
pub const LOG_END: &str = "end: ";

/// Length and CRC-32 of a file.
#[derive(Clone, Debug, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
pub struct FileSum {
    /// Its length (bytes).
    pub bytes: u64,
    /// CRC-32 of its content, eight hexadecimal digits in lower case.
    pub crc32: String,
}

impl FileSum {
    /// Of the file at `path`.
    fn of(path: &Path) -> Result<Self, Fault> {
        let mut file = input::open(path, input::RESULTS).map_err(|error| error.fault)?;
        let (mut sum, mut bytes, mut block) = (Hasher::new(), 0, vec![0; 1 << 17]);
        loop {
            match file.read(&mut block).map_err(Fault::Unreadable)? {
                0 => return Ok(Self { bytes, crc32: format!("{:08x}", sum.finalize()) }),
                count => {
                    sum.update(&block[..count]);
                    bytes += count as u64;
                }
            }
        }
    }
}

/// Lengths and CRC-32 of those of the files `names` that are in `folder`, by name.
///
/// # Errors
/// A file that is there but cannot be read.
pub(crate) fn sums_of_files(
    folder: &Path,
    names: &[&str],
) -> Result<BTreeMap<String, FileSum>, OutputError> {
    let mut sums = BTreeMap::new();
    for name in names {
        let path = folder.join(name);
        match FileSum::of(&path) {
            Ok(sum) => drop(sums.insert((*name).to_owned(), sum)),
            Err(Fault::Missing) => {}
            Err(fault) => return Err(unreadable(path, fault)),
        }
    }
    Ok(sums)
}

/// SHA-256 of everything in a summary but its key `sha256`, which then holds it: any later change of the summary is
/// taken for damage.
///
/// # Errors
/// A summary that cannot be written as JSON.
pub(crate) fn checksum_of(summary: &Summary) -> Result<String, OutputError> {
    let failed = |reason: String| OutputError::Create { path: file::SUMMARY.into(), reason };
    match serde_json::to_value(summary) {
        Ok(Value::Object(entries)) => Ok(own_sum(&entries)),
        Ok(_) => Err(failed("it is no JSON object".into())),
        Err(error) => Err(failed(error.to_string())),
    }
}

/// SHA-256 of a summary without its key `sha256`: of its JSON without spaces, keys in order, numbers with the
/// fewest digits that read back to the same bits.
fn own_sum(summary: &Map<String, Value>) -> String {
    let rest: BTreeMap<&str, &Value> =
        summary.iter().map(|(k, v)| (k.as_str(), v)).filter(|(k, _)| *k != SEAL).collect();
    let text = serde_json::to_string(&rest).unwrap_or_default();
    hexadecimal(&Sha256::digest(text))
}

/// The summary of the run in `folder`; `None` for a run that has not ended.
///
/// A summary without checksums, as earlier versions wrote it, is accepted.
///
/// # Errors
/// A summary that cannot be read, is not what was written, or is gone although the run's log says that the run
/// ended.
pub fn read_summary(folder: &Path) -> Result<Option<Summary>, OutputError> {
    let path = folder.join(file::SUMMARY);
    let text = match input::bytes(&path, input::DOCUMENT) {
        Ok(text) => text,
        Err(error) if error.is_missing() => {
            return if log_says_it_ended(folder) {
                Err(damaged(&path, "it is gone, though run.log says that the run ended".into()))
            } else {
                Ok(None)
            };
        }
        Err(error) => return Err(unreadable(path, error.fault)),
    };
    // the checksum is over all keys, also those of other versions
    let entries: Map<String, Value> = serde_json::from_slice(&text).map_err(|error| {
        let what = if error.is_data() { "no JSON object" } else { "no JSON" };
        damaged(&path, format!("it is {what}: {error}"))
    })?;
    match (entries.get(SEAL), entries.get(SUMS)) {
        (None, None) => {}
        (Some(seal), Some(_)) if *seal == own_sum(&entries) => {}
        _ => return Err(damaged(&path, "it is not what was written (sha256)".into())),
    }
    let summary = serde_json::from_value(Value::Object(entries));
    summary.map(Some).map_err(|error| damaged(&path, format!("it is no summary: {error}")))
}

fn log_says_it_ended(folder: &Path) -> bool {
    let log = input::bytes(&folder.join(file::LOG), input::LOG).unwrap_or_default();
    let log = String::from_utf8_lossy(&log);
    let last = log.lines().next_back().and_then(|line| line.strip_prefix(LOG_END));
    last.and_then(|how| how.split_once(' ')).is_some_and(|(_, rest)| rest.starts_with("after "))
}

/// Compares the lengths of the files in `folder` with those in `summary`. A missing file is an error where
/// `needed` says so of its name. Returns whether the summary holds lengths at all.
///
/// # Errors
/// A file with another length, a needed file that is gone, a file that cannot be read.
pub fn as_long_as_written(
    folder: &Path,
    summary: &Summary,
    needed: impl Fn(&str) -> bool,
) -> Result<bool, OutputError> {
    let Some(sums) = &summary.checksums else { return Ok(false) };
    for (name, sum) in sums {
        let path = folder.join(name);
        match fs::metadata(&path) {
            Ok(found) if found.len() == sum.bytes => {}
            Ok(found) => {
                let reason =
                    format!("it has {} bytes, but {} were written", found.len(), sum.bytes);
                return Err(damaged(&path, reason));
            }
            Err(error) if error.kind() == ErrorKind::NotFound && !needed(name) => {}
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Err(damaged(&path, "it is gone".into()));
            }
            Err(error) => return Err(unreadable(path, Fault::Unreadable(error))),
        }
    }
    Ok(true)
}

/// Compares length and CRC-32 of the files in `folder` that `wanted` selects by name with those in `summary`.
/// Missing files are passed over; see [`as_long_as_written`].
///
/// # Errors
/// A file that differs or cannot be read.
pub fn as_written(
    folder: &Path,
    summary: &Summary,
    wanted: impl Fn(&str) -> bool,
) -> Result<(), OutputError> {
    for (name, sum) in summary.checksums.iter().flatten().filter(|(name, _)| wanted(name)) {
        let path = folder.join(name);
        match FileSum::of(&path) {
            Ok(found) if found == *sum => {}
            Ok(_) => return Err(damaged(&path, "it is not what was written (crc32)".into())),
            Err(Fault::Missing) => {}
            Err(fault) => return Err(unreadable(path, fault)),
        }
    }
    Ok(())
}

fn unreadable(path: PathBuf, fault: Fault) -> OutputError {
    let reason = InputError { path: path.clone(), kind: input::RESULTS, fault }.problem();
    OutputError::Read { path, reason }
}
