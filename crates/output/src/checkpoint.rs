//! Checkpoints: the whole state of a run at a step, from which it is resumed with the same bits.
//!
//! `checkpoint.h5` holds the state of the run and the lengths and checksums of its result files at that step,
//! both serialised by serde in the format postcard: compact, and every bit of a number reads back. It is written
//! under another name, synced and renamed; the previous one stays as `checkpoint-1.h5`. The root attribute
//! `sha256`, over provenance and both datasets, shows whether it is intact.

use crate::checksums::{Kept, hexadecimal};
use crate::grid::dataset_spec;
use crate::hdf5::{Creator, Source, read_error};
use crate::layout::attribute;
use crate::{FieldSpec, OutputError, Provenance};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Names of the checkpoints of a run, the newest first.
pub const CHECKPOINTS: [&str; 2] = ["checkpoint.h5", "checkpoint-1.h5"];

/// Root attribute with the version of the file's form; other versions are refused.
const FORM: &str = "checkpoint_form";
/// The version written here: results and state as postcard.
const THIS_FORM: &str = "6";
/// Root attribute with the SHA-256 of provenance, results and state, in hexadecimal.
const CHECKSUM: &str = "sha256";
/// Root attribute with the step, for people; the program takes it from [`RESULTS`].
const STEP: &str = "step";
/// Root attributes that are not further ones of the provenance.
const OWN: [&str; 6] =
    [attribute::VERSION, attribute::CASE_HASH, attribute::CREATED, FORM, STEP, CHECKSUM];
/// The step, and the parts of the result files that belong to it.
static RESULTS: FieldSpec = FieldSpec::label(
    "results",
    "1",
    "postcard: steps done; of each result file the records and CRC-32",
);
/// The state.
static STATE: FieldSpec =
    FieldSpec::label("state", "1", "postcard: everything that goes on from step to step");

/// The part of each result file that belongs to a checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Results {
    /// Of `fields.vtkhdf`; the default where the run has none.
    pub fields: Kept,
    /// Of `contact.vtkhdf`.
    pub contact: Kept,
    /// Of `history.h5`.
    pub history: Kept,
    /// Of `probes.h5`; the default where the run has none.
    pub probes: Kept,
}

/// The state of a run after a step, with the parts of its result files that belong to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checkpoint {
    /// Provenance of the run; its further attributes are kept too.
    pub provenance: Provenance,
    /// Steps done.
    pub step: u64,
    /// The parts of the result files that belong to it.
    pub results: Results,
    /// The state, as postcard.
    state: Vec<u8>,
}

impl Checkpoint {
    /// A checkpoint after `step` steps. Every bit of `state` reads back.
    ///
    /// # Errors
    /// A state that postcard cannot serialise, such as a sequence of unknown length.
    pub fn new(
        provenance: Provenance,
        step: u64,
        results: Results,
        state: &impl Serialize,
    ) -> Result<Self, OutputError> {
        Ok(Self { provenance, step, results, state: bytes_of(state)? })
    }

    /// The state, as the type of which it was made.
    ///
    /// # Errors
    /// A state of another type.
    pub fn state<S: DeserializeOwned>(&self) -> Result<S, OutputError> {
        of_bytes(&self.state)
    }

    /// Writes it to `folder` as the newest of [`CHECKPOINTS`]; the newest so far becomes the previous one.
    ///
    /// # Errors
    /// A file that cannot be written, synced or renamed.
    pub fn write(&self, folder: &Path) -> Result<(), OutputError> {
        let [newest, before] = CHECKPOINTS.map(|name| folder.join(name));
        let results = bytes_of(&(self.step, &self.results))?;
        let mut provenance = self.provenance.clone();
        let sum = checksum(&provenance, [&results, &self.state]);
        provenance.attributes.push((FORM.into(), THIS_FORM.into()));
        provenance.attributes.push((CHECKSUM.into(), sum));
        let mut file = Creator::new(&newest, &provenance)?;
        file.count(&[], STEP, self.step as i64)?;
        file.plain(&dataset_spec(&[], &RESULTS), &results)?;
        file.plain(&dataset_spec(&[], &STATE), &self.state)?;
        file.close_by(|partial| {
            match fs::rename(&newest, &before) {
                Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(cause.into()),
                _ => fs::rename(partial, &newest)?,
            }
            Ok(sync_folder(folder)?)
        })
    }

    /// Reads the checkpoint at `path` and verifies its checksum.
    ///
    /// # Errors
    /// [`OutputError::Form`] for one of another version; a file that cannot be read or whose checksum differs.
    pub fn read(path: &Path) -> Result<Self, OutputError> {
        let file = Source::open(path)?;
        let refuse = |reason: &str| read_error(path, reason.to_owned());
        let names = file.root_names()?;
        if !names.iter().any(|name| name == FORM) || file.root_text(FORM)? != THIS_FORM {
            return Err(OutputError::Form { path: path.to_owned() });
        }
        let mut provenance = Provenance {
            creepage_version: file.root_text(attribute::VERSION)?,
            case_hash: file.root_text(attribute::CASE_HASH)?,
            created: file.root_text(attribute::CREATED)?,
            attributes: Vec::new(),
        };
        for name in names.into_iter().filter(|name| !OWN.contains(&name.as_str())) {
            let text = file.root_text(&name)?;
            provenance.attributes.push((name, text));
        }
        let (results, state) = (file.bytes(&RESULTS.name)?, file.bytes(&STATE.name)?);
        if checksum(&provenance, [&results, &state]) != file.root_text(CHECKSUM)? {
            return Err(refuse("its checksum does not match"));
        }
        let (step, results) = postcard::from_bytes(&results)
            .map_err(|_| refuse("its record of the result files cannot be read"))?;
        Ok(Self { provenance, step, results, state })
    }

    /// The further attribute `name` of the provenance.
    pub fn text(&self, name: &str) -> Option<&str> {
        let attributes = &self.provenance.attributes;
        attributes.iter().find(|(n, _)| n == name).map(|(_, text)| text.as_str())
    }
}

/// A value as postcard, every bit of its numbers with it.
///
/// # Errors
/// A value that postcard cannot serialise, such as a sequence of unknown length.
pub fn bytes_of(value: &impl Serialize) -> Result<Vec<u8>, OutputError> {
    postcard::to_allocvec(value).map_err(|cause| OutputError::State { cause })
}

/// The value of which [`bytes_of`] made these bytes.
///
/// # Errors
/// Bytes of another type.
pub fn of_bytes<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, OutputError> {
    postcard::from_bytes(bytes).map_err(|cause| OutputError::State { cause })
}

/// SHA-256 over provenance and datasets, in an order that does not depend on that of the attributes.
fn checksum(provenance: &Provenance, datasets: [&[u8]; 2]) -> String {
    let mut sum = Sha256::new();
    let Provenance { creepage_version, case_hash, created, attributes } = provenance;
    let mut attributes: Vec<_> = attributes.iter().collect();
    attributes.sort();
    let attributes = attributes.into_iter().flat_map(|(name, value)| [name, value]);
    let texts = [creepage_version, case_hash, created].into_iter().chain(attributes);
    for bytes in texts.map(String::as_bytes).chain(datasets) {
        sum.update((bytes.len() as u64).to_le_bytes());
        sum.update(bytes);
    }
    hexadecimal(&sum.finalize())
}

/// Syncs the content of a result file to the disk.
#[expect(clippy::disallowed_methods, reason = "a file of the run itself, of which nothing is read")]
pub(crate) fn sync_file(path: &Path) -> Result<(), OutputError> {
    File::open(path)
        .and_then(|file| file.sync_all())
        .map_err(|cause| OutputError::Append { path: path.to_owned(), reason: cause.to_string() })
}

/// Syncs renamings in a folder to the disk, where the system can.
#[expect(clippy::disallowed_methods, reason = "a folder, of which nothing is read")]
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}
