//! What the summary of a run that has ended says of its files, by which damage is seen: their lengths and
//! CRC-32, and SHA-256 of itself.
//!
//! Files of a run are large: on a machine with instructions for it SHA-256 of them took 1 % of a run, CRC-32
//! takes a third of that, and misses one damage in four billion.

use crate::OutputError;
use crate::hdf5::damaged;
use crate::layout::file;
use crate::sums::hexadecimal;
use crc32fast::Hasher;
use files::input::{self, Fault, InputError};
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

/// How the last line of `run.log` begins where a run has ended; the word for how follows, and ` after` where
/// it left a summary.
pub const LOG_END: &str = "end: ";

/// Length and CRC-32 of a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileSum {
    /// Its length.
    pub bytes: u64,
    /// CRC-32 of what it holds, in hexadecimal.
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

/// The sums of those of the files `names` that are in `folder`.
pub fn sums_of_files(
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

/// Adds the sums of the files to a summary, and its own.
pub fn seal(summary: &mut Map<String, Value>, sums: &BTreeMap<String, FileSum>) {
    summary.insert(SUMS.into(), serde_json::json!(sums));
    let own = own_sum(summary);
    summary.insert(SEAL.into(), own.into());
}

/// SHA-256 of a summary without that: of its JSON without spaces, keys in order, numbers with the fewest
/// digits that give them back.
fn own_sum(summary: &Map<String, Value>) -> String {
    let rest: BTreeMap<&str, &Value> =
        summary.iter().map(|(k, v)| (k.as_str(), v)).filter(|(k, _)| *k != SEAL).collect();
    let text = serde_json::to_string(&rest).unwrap_or_default();
    hexadecimal(&Sha256::digest(text))
}

/// The summary of the run in `folder`; none of a run that has not ended.
///
/// One without any sums, as earlier versions wrote it, is taken as it is.
///
/// # Errors
/// A summary that is not what was written, or gone although the run's log says that it ended.
pub fn read_summary(folder: &Path) -> Result<Option<Value>, OutputError> {
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
    let summary: Value = serde_json::from_slice(&text)
        .map_err(|error| damaged(&path, format!("it is no JSON: {error}")))?;
    let Value::Object(entries) = &summary else {
        return Err(damaged(&path, "it is no JSON object".into()));
    };
    match (entries.get(SEAL), entries.get(SUMS)) {
        (None, None) => {}
        (Some(seal), Some(_)) if *seal == own_sum(entries) => {}
        _ => return Err(damaged(&path, "it is not what was written (sha256)".into())),
    }
    Ok(Some(summary))
}

fn log_says_it_ended(folder: &Path) -> bool {
    let log = input::bytes(&folder.join(file::LOG), input::LOG).unwrap_or_default();
    let log = String::from_utf8_lossy(&log);
    let last = log.lines().next_back().and_then(|line| line.strip_prefix(LOG_END));
    last.and_then(|how| how.split_once(' ')).is_some_and(|(_, rest)| rest.starts_with("after "))
}

/// The sums of the files that a summary holds; none in one of an earlier version.
fn sums(summary: &Value) -> Option<BTreeMap<String, FileSum>> {
    serde_json::from_value(summary.get(SUMS)?.clone()).ok()
}

/// Compares the lengths of the files in `folder` with those that `summary` holds; files that are `needed` must
/// be there. Returns whether the summary holds any.
pub fn as_long_as_written(
    folder: &Path,
    summary: &Value,
    needed: impl Fn(&str) -> bool,
) -> Result<bool, OutputError> {
    let Some(sums) = sums(summary) else { return Ok(false) };
    for (name, sum) in sums {
        let path = folder.join(&name);
        match fs::metadata(&path) {
            Ok(found) if found.len() == sum.bytes => {}
            Ok(found) => {
                let reason =
                    format!("it has {} bytes, but {} were written", found.len(), sum.bytes);
                return Err(damaged(&path, reason));
            }
            Err(error) if error.kind() == ErrorKind::NotFound && !needed(&name) => {}
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Err(damaged(&path, "it is gone".into()));
            }
            Err(error) => return Err(unreadable(path, Fault::Unreadable(error))),
        }
    }
    Ok(true)
}

/// Proves by the sums in `summary` that each of the files `wanted` is what was written, where it is there.
pub fn as_written(
    folder: &Path,
    summary: &Value,
    wanted: impl Fn(&str) -> bool,
) -> Result<(), OutputError> {
    for (name, sum) in sums(summary).unwrap_or_default().into_iter().filter(|(n, _)| wanted(n)) {
        let path = folder.join(&name);
        match FileSum::of(&path) {
            Ok(found) if found == sum => {}
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
