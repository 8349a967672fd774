//! Inputs that are HDF5 files: the results of a run, of this program or of others, perhaps damaged.
//!
//! Most metadata of such files carries checksums, which bytes changed at random never match; what lies
//! behind them would not be tested. An input that does not begin like a file is therefore a list of
//! changes to one of the [`SEEDS`], after which the checksums of the seed are computed anew.

use std::hint::black_box;
use std::path::Path;
use std::sync::OnceLock;

use creepage::check::{Basis, Criteria, Limits, Report, RunPaths};
use output::{Checkpoint, GridFile, HistoryFile};
use rust_hdf5::format::checksum::checksum_metadata;

use crate::inputs::text::{in_a_folder, write};

/// How a file begins.
const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// Files to be changed: a fields file, a contact history, a history and a checkpoint of this program,
/// and a contact history and a history as the HDF5 library itself writes them by default.
pub const SEEDS: [&[u8]; 6] = [
    include_bytes!("../../seeds/fields.vtkhdf"),
    include_bytes!("../../seeds/contact.vtkhdf"),
    include_bytes!("../../seeds/history.h5"),
    include_bytes!("../../seeds/checkpoint.h5"),
    include_bytes!("../../seeds/old-contact.vtkhdf"),
    include_bytes!("../../seeds/old-history.h5"),
];

/// A file of bodies or surfaces over time: all of it is read, and checked if it is a contact history.
pub fn grid(data: &[u8]) {
    with_file("contact.vtkhdf", data, |path| {
        let Ok(file) = GridFile::open(path) else { return };
        let fields = file.fields().iter();
        black_box((file.times().is_ok(), file.points().is_ok(), file.connectivity().is_ok()));
        for field in fields {
            let steps = if field.constant { 0..1 } else { 0..file.steps() };
            black_box(file.read_steps(&field.name, field.on_cells, steps).is_ok());
        }
        let Ok(paths) = RunPaths::of(path) else { return };
        let Ok(mut basis) = Basis::read(&paths) else { return };
        for (name, value) in [("peak_pressure", 1e9), ("dt", 1e-7), ("approach", 1e-4)] {
            basis.offer(name, value, "here");
        }
        for (name, value) in [("half_length", 5e-3), ("half_width", 4e-3), ("size", 1e-3)] {
            basis.offer(name, value, "here");
        }
        for (name, value) in [("speed", 40.0), ("creepage", 2e-3), ("shear_wave", 3e3)] {
            basis.offer(name, value, "here");
        }
        let options = Criteria {
            window: None,
            limits: Limits::for_enforcement(None),
            report: Report::Stated,
            map: None,
        };
        match creepage::check::check(&paths, &mut basis, &options) {
            Ok(found) => drop(black_box(found.result)),
            Err(error) => drop(black_box(error.to_string())),
        }
    });
}

/// A table over time: all of it is read.
pub fn history(data: &[u8]) {
    with_file("history.h5", data, |path| {
        let Ok(file) = HistoryFile::open(path) else { return };
        black_box(file.provenance("case_hash").is_ok());
        for column in file.columns().unwrap_or_default() {
            black_box((file.read(&column).is_ok(), file.units(&column).is_ok()));
        }
    });
}

/// A checkpoint.
pub fn checkpoint(data: &[u8]) {
    with_file("checkpoint.h5", data, |path| match Checkpoint::read(path) {
        Ok(found) => drop(black_box(found.state::<Vec<f64>>().is_ok())),
        Err(error) => drop(black_box(error.to_string())),
    });
}

fn with_file(name: &str, data: &[u8], read: impl FnOnce(&Path)) {
    let changed;
    let bytes = if data.starts_with(SIGNATURE) || data.is_empty() {
        data
    } else {
        changed = apply(data);
        &changed
    };
    in_a_folder(|folder| {
        let path = folder.join(name);
        write(&path, bytes);
        read(&path);
    });
}

/// A seed with changes: its number, then three bytes for each change, place and value. A last place
/// cut short cuts the file short.
fn apply(changes: &[u8]) -> Vec<u8> {
    let number = usize::from(changes[0]) % SEEDS.len();
    let mut bytes = SEEDS[number].to_vec();
    let (triples, rest) = changes[1..].as_chunks::<3>();
    for [low, high, value] in triples {
        let place = usize::from(u16::from_le_bytes([*low, *high])) % bytes.len();
        bytes[place] = *value;
    }
    for sum in &sums()[number] {
        let value = checksum_metadata(&bytes[sum.start..sum.end]);
        bytes[sum.end..sum.end + 4].copy_from_slice(&value.to_le_bytes());
    }
    if let [low, high] = rest {
        bytes.truncate(usize::from(u16::from_le_bytes([*low, *high])));
    }
    bytes
}

/// A checksum stands behind the bytes that it is of.
type Sums = Vec<std::ops::Range<usize>>;

/// The checksums of every seed, found by trying.
fn sums() -> &'static [Sums; 6] {
    static SUMS: OnceLock<[Sums; 6]> = OnceLock::new();
    SUMS.get_or_init(|| SEEDS.map(sums_of))
}

/// Marks at the beginning of metadata with a checksum.
const MARKS: [&[u8]; 18] = [
    SIGNATURE, b"OHDR", b"OCHK", b"FRHP", b"FHDB", b"FHIB", b"BTHD", b"BTLF", b"BTIN", b"EAHD",
    b"EAIB", b"EASB", b"EADB", b"FAHD", b"FADB", b"SMTB", b"FSHD", b"FSSE",
];

fn sums_of(seed: &[u8]) -> Sums {
    /// Longer metadata than this the seeds do not have.
    const LONGEST: usize = 4096;
    let mut sums = Vec::new();
    for start in 0..seed.len() {
        if !MARKS.iter().any(|mark| seed[start..].starts_with(mark)) {
            continue;
        }
        let last = seed.len().saturating_sub(4).min(start + LONGEST);
        let found = (start + 8..=last)
            .find(|&end| checksum_metadata(&seed[start..end]).to_le_bytes() == seed[end..end + 4]);
        sums.extend(found.map(|end| start..end));
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_seed_of_a_checkpoint_is_one_of_the_present_form() {
        with_file("checkpoint.h5", SEEDS[3], |path| {
            let read = Checkpoint::read(path);
            assert!(read.is_ok(), "{read:?}: write the seeds anew, as fuzz/README.md says");
        });
    }

    #[test]
    fn the_checksums_of_the_seeds_are_found_and_put_right() {
        let counts: Vec<usize> = sums().iter().map(Vec::len).collect();
        // of the first four files the checkpoint has the fewest: two datasets and their group
        assert!(counts[..4].iter().all(|&count| count >= 5), "{counts:?}");
        for (number, seed) in SEEDS.iter().enumerate() {
            assert_eq!(apply(&[number as u8]), *seed);
            for sum in &sums()[number] {
                let at = (sum.end as u16).to_le_bytes();
                assert_eq!(apply(&[number as u8, at[0], at[1], 1]), *seed, "{number} {sum:?}");
            }
        }
    }
}
