//! Checkpoints: the whole state of a run at a step, from which it goes on with the same bits.
//!
//! `checkpoint.h5` holds named arrays with units, and the lengths and sums of the run's result files at
//! that step. It is written under another name, synced and renamed, and the one before stays as
//! `checkpoint-1.h5`; the root attribute `sha256`, over all names and numbers, proves it whole.

use crate::hdf5::{Creator, LayOut, Source, read_error};
use crate::layout::attribute;
use crate::sums::Kept;
use crate::{OutputError, Provenance};
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Names of the checkpoints of a run, the newest first.
pub const CHECKPOINTS: [&str; 2] = ["checkpoint.h5", "checkpoint-1.h5"];

/// Root attribute with the SHA-256 of everything else, in hexadecimal.
const CHECKSUM: &str = "sha256";
/// Root attribute with the step, for people; the program takes it from [`LENGTHS`].
const STEP: &str = "step";
/// Root attributes that are not further ones of the provenance.
const OWN: [&str; 5] =
    [attribute::VERSION, attribute::CASE_HASH, attribute::CREATED, STEP, CHECKSUM];
/// Dataset of the step and the records of each of [`Results`].
const LENGTHS: &str = "results/lengths";
/// Dataset of their sums: for each file how many there are, then they.
const SUMS: &str = "results/sums";

/// An array of a checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Name, with `/` between groups and dataset.
    pub name: String,
    /// SI units, `"1"` for a pure number.
    pub units: String,
    /// Numbers per row.
    pub components: usize,
    /// What it is, in a phrase.
    pub description: String,
    /// The numbers, row after row.
    pub values: Numbers,
}

/// The numbers of an [`Array`].
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Quantities.
    Real(Vec<f64>),
    /// Indices, counters and labels.
    Whole(Vec<u64>),
}

/// What of each result file belongs to a checkpoint.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Results {
    /// Of `fields.vtkhdf`.
    pub fields: Kept,
    /// Of `contact.vtkhdf`.
    pub contact: Kept,
    /// Of `history.h5`.
    pub history: Kept,
    /// Of `probes.h5`; nothing where the run has none.
    pub probes: Kept,
}

/// A checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Where it comes from; its further attributes are kept too.
    pub provenance: Provenance,
    /// Steps done.
    pub step: u64,
    /// What of the result files belongs to it.
    pub results: Results,
    /// The state.
    pub arrays: Vec<Array>,
}

impl Checkpoint {
    /// Writes it as the newest of `folder`; the newest so far becomes the one before.
    pub fn write(&self, folder: &Path) -> Result<(), OutputError> {
        let [newest, before] = CHECKPOINTS.map(|name| folder.join(name));
        let mut provenance = self.provenance.clone();
        provenance.attributes.push((CHECKSUM.into(), self.checksum()));
        let mut file = Creator::new(&newest, &provenance)?;
        file.count(&[], STEP, self.step as i64)?;
        let own = self.results.arrays(self.step);
        let mut groups = std::collections::BTreeSet::new();
        for array in self.arrays.iter().chain(&own) {
            let parts: Vec<&str> = array.name.split('/').collect();
            let Some((name, group)) = parts.split_last() else { continue };
            for depth in 1..=group.len() {
                if groups.insert(group[..depth].join("/")) {
                    file.group(&group[..depth])?;
                }
            }
            let place = LayOut {
                group,
                name,
                units: &array.units,
                components: array.components,
                description: &array.description,
            };
            match &array.values {
                Numbers::Real(values) => file.plain(&place, values)?,
                Numbers::Whole(values) => file.plain(&place, values)?,
            }
        }
        file.close_by(|partial| {
            match fs::rename(&newest, &before) {
                Err(cause) if cause.kind() != io::ErrorKind::NotFound => return Err(cause),
                _ => fs::rename(partial, &newest)?,
            }
            sync_folder(folder)
        })
    }

    /// Reads one and proves it whole.
    pub fn read(path: &Path) -> Result<Self, OutputError> {
        let file = Source::open(path)?;
        let refuse = |reason: &str| read_error(path, reason.to_owned());
        let mut provenance = Provenance {
            creepage_version: file.root_text(attribute::VERSION)?,
            case_hash: file.root_text(attribute::CASE_HASH)?,
            created: file.root_text(attribute::CREATED)?,
            attributes: Vec::new(),
        };
        for name in file.root_names()?.into_iter().filter(|name| !OWN.contains(&name.as_str())) {
            let text = file.root_text(&name)?;
            provenance.attributes.push((name, text));
        }
        let mut arrays = Vec::new();
        let (mut records, mut sums) = (None, None);
        for name in file.all_names()? {
            let array = Array {
                units: file.text(&name, "units")?,
                components: file.shape(&name)?.get(1).copied().unwrap_or(1),
                description: file.text(&name, "description")?,
                values: file.plain(&name)?,
                name,
            };
            match (array.name.as_str(), &array.values) {
                (LENGTHS, Numbers::Whole(values)) => records = Some(values.clone()),
                (SUMS, Numbers::Whole(values)) => sums = Some(values.clone()),
                _ => arrays.push(array),
            }
        }
        let records = records.ok_or_else(|| refuse("it has no list of lengths"))?;
        let sums = sums.ok_or_else(|| {
            refuse("it has no sums of the result files: another version of creepage wrote it")
        })?;
        let (step, results) = Results::from_numbers(&records, &sums)
            .ok_or_else(|| refuse("its lists of lengths and sums do not fit together"))?;
        let found = Self { provenance, step, results, arrays };
        if found.checksum() != file.root_text(CHECKSUM)? {
            return Err(refuse("its checksum does not match"));
        }
        Ok(found)
    }

    /// A further attribute of the provenance.
    pub fn text(&self, name: &str) -> Option<&str> {
        let attributes = &self.provenance.attributes;
        attributes.iter().find(|(n, _)| n == name).map(|(_, text)| text.as_str())
    }

    /// SHA-256 over everything, in an order that does not depend on that of arrays or attributes.
    fn checksum(&self) -> String {
        let mut sum = Sha256::new();
        let Provenance { creepage_version, case_hash, created, attributes } = &self.provenance;
        let mut attributes: Vec<_> = attributes.iter().collect();
        attributes.sort();
        let attributes = attributes.into_iter().flat_map(|(name, value)| [name, value]);
        for text in [creepage_version, case_hash, created].into_iter().chain(attributes) {
            text_into(&mut sum, text);
        }
        let own = self.results.arrays(self.step);
        let mut arrays: Vec<&Array> = self.arrays.iter().chain(&own).collect();
        arrays.sort_by(|a, b| a.name.cmp(&b.name));
        for array in arrays {
            for text in [&array.name, &array.units, &array.description] {
                text_into(&mut sum, text);
            }
            sum.update((array.components as u64).to_le_bytes());
            match &array.values {
                Numbers::Real(values) => bytes(&mut sum, b'r', values, |x| x.to_le_bytes()),
                Numbers::Whole(values) => bytes(&mut sum, b'w', values, |x| x.to_le_bytes()),
            }
        }
        hexadecimal(&sum.finalize())
    }
}

impl Results {
    fn files(&self) -> [&Kept; 4] {
        [&self.fields, &self.contact, &self.history, &self.probes]
    }

    /// As arrays of a checkpoint of step `step`.
    fn arrays(&self, step: u64) -> [Array; 2] {
        let array = |name: &str, description: &str, values| Array {
            name: name.into(),
            units: "1".into(),
            components: 1,
            description: description.into(),
            values: Numbers::Whole(values),
        };
        let records = self.files().map(|kept| kept.records);
        let sums = self.files().into_iter().flat_map(|kept| {
            [kept.sums.len() as u64].into_iter().chain(kept.sums.iter().map(|&sum| sum.into()))
        });
        let lengths = "steps done; snapshots in fields.vtkhdf and contact.vtkhdf; rows in \
                       history.h5 and probes.h5";
        let about = "for each of these files how many CRC-32 follow: of what does not change, then of \
                     each growing dataset by name";
        [
            array(LENGTHS, lengths, [step].into_iter().chain(records).collect()),
            array(SUMS, about, sums.collect()),
        ]
    }

    /// The reverse, with the step.
    fn from_numbers(lengths: &[u64], mut sums: &[u64]) -> Option<(u64, Self)> {
        let &[step, ref records @ ..] = lengths else { return None };
        let records: [u64; 4] = records.try_into().ok()?;
        let mut files = records.map(|records| Kept { records, sums: Vec::new() });
        for kept in &mut files {
            let (&count, rest) = sums.split_first()?;
            let (mine, rest) = rest.split_at_checked(usize::try_from(count).ok()?)?;
            kept.sums = mine.iter().map(|&sum| sum as u32).collect();
            sums = rest;
        }
        let [fields, contact, history, probes] = files;
        Some((step, Self { fields, contact, history, probes }))
    }
}

pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn text_into(sum: &mut Sha256, text: &str) {
    sum.update((text.len() as u64).to_le_bytes());
    sum.update(text);
}

/// Takes numbers into the sum, many at a time: one by one takes ten times as long.
fn bytes<T: Copy>(sum: &mut Sha256, kind: u8, values: &[T], of: impl Fn(T) -> [u8; 8]) {
    sum.update([kind]);
    sum.update((values.len() as u64).to_le_bytes());
    let mut block = Vec::with_capacity(8 * 1024);
    for part in values.chunks(1024) {
        block.clear();
        part.iter().for_each(|x| block.extend(of(*x)));
        sum.update(&block);
    }
}

/// Brings the content of a result file to the disk.
#[expect(clippy::disallowed_methods, reason = "a file of the run itself, of which nothing is read")]
pub(crate) fn sync_file(path: &Path) -> Result<(), OutputError> {
    File::open(path)
        .and_then(|file| file.sync_all())
        .map_err(|cause| OutputError::Append { path: path.to_owned(), reason: cause.to_string() })
}

/// Brings renamings to the disk, where the system can.
#[expect(clippy::disallowed_methods, reason = "a folder, of which nothing is read")]
fn sync_folder(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}
