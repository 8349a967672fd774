//! Checkpoints are whole or refused, and result files go on from them.

#![allow(clippy::unwrap_used, missing_docs)]

use output::{
    CHECKPOINTS, Cells, Checkpoint, FieldSpec, GridFile, GridSpec, History, HistoryFile, Kept,
    OutputError, Provenance, Results, StaticField, TransientGrid, Values, verify,
};
use std::path::Path;

fn provenance() -> Provenance {
    Provenance {
        creepage_version: "0".into(),
        case_hash: "none".into(),
        created: "2026-01-01T00:00:00Z".into(),
        attributes: vec![("facts".into(), "{\"dt\":1e-7}".into())],
    }
}

/// What a run may keep.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
struct State {
    step: u64,
    displacement: Vec<[f64; 3]>,
    slaves: Vec<u32>,
    hub: Option<(f64, bool)>,
}

fn state(step: u64) -> State {
    State {
        step,
        displacement: vec![[0.1, -0.0, f64::NAN], [5e-324, 1e300, f64::NEG_INFINITY]],
        slaves: vec![0, 7, u32::MAX],
        hub: Some((f64::from_bits(0xfff8_0000_0000_1234), true)),
    }
}

fn checkpoint(step: u64) -> Checkpoint {
    let results = Results {
        fields: Kept { records: 1, sums: vec![1, u32::MAX] },
        contact: Kept { records: 2, sums: vec![3] },
        history: Kept { records: 3, sums: Vec::new() },
        probes: Kept { records: 4, sums: vec![5, 6, 7] },
    };
    Checkpoint::new(provenance(), step, results, &state(step)).unwrap()
}

/// NaN is not equal to itself; its bits are.
fn bits(state: &State) -> (Vec<u64>, String) {
    let numbers = state.displacement.as_flattened().iter().chain(state.hub.iter().map(|(x, _)| x));
    (numbers.map(|x| x.to_bits()).collect(), format!("{state:?}"))
}

#[test]
fn a_checkpoint_reads_back_to_the_bit_and_the_one_before_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    for step in [10, 20, 30] {
        checkpoint(step).write(folder.path()).unwrap();
    }
    for (name, step) in CHECKPOINTS.iter().zip([30, 20]) {
        let found = Checkpoint::read(&folder.path().join(name)).unwrap();
        assert_eq!(found, checkpoint(step), "{name}");
        assert_eq!(bits(&found.state().unwrap()), bits(&state(step)), "{name}");
        assert!(found.state::<Vec<String>>().is_err(), "a state of another type");
        assert_eq!(found.text("facts"), Some("{\"dt\":1e-7}"));
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "partial files are left");
}

#[test]
fn no_byte_of_the_state_can_be_changed_and_no_end_cut_off_unnoticed() {
    let folder = tempfile::tempdir().unwrap();
    checkpoint(10).write(folder.path()).unwrap();
    let path = folder.path().join(CHECKPOINTS[0]);
    let whole = std::fs::read(&path).unwrap();
    let expected = checkpoint(10);
    let mut refused = 0;
    for at in (0..whole.len()).step_by(7) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x10;
        std::fs::write(&path, &damaged).unwrap();
        match Checkpoint::read(&path) {
            Ok(found) => assert_eq!(found, expected, "byte {at} was changed unnoticed"),
            Err(_) => refused += 1,
        }
    }
    assert!(refused > whole.len() / 70, "only {refused} changes of {} bytes noticed", whole.len());
    for length in (0..whole.len()).step_by(101) {
        std::fs::write(&path, &whole[..length]).unwrap();
        let Ok(found) = Checkpoint::read(&path) else { continue };
        assert_eq!(found, expected, "cut off at {length} unnoticed");
    }
}

#[test]
fn a_checkpoint_of_another_form_is_refused_as_one_of_another_version() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(CHECKPOINTS[0]);
    // a file of this program without the attribute, as it was before there was one
    History::create(&path, &[FieldSpec::scalar("time", "s", "t")], &provenance()).unwrap();
    let error = Checkpoint::read(&path).unwrap_err().to_string();
    assert!(error.contains("another version of creepage"), "{error}");
}

const POINTS: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

fn with_grid<T>(then: impl FnOnce(&GridSpec<'_>, &[FieldSpec]) -> T) -> T {
    let grid = GridSpec {
        points: &POINTS,
        cells: Cells::Quads(&[[0, 1, 2, 3]]),
        constant: &[StaticField {
            spec: FieldSpec::cell_label("body", "1", "label"),
            values: Values::Integer(&[1]),
        }],
    };
    let fields = [
        FieldSpec::scalar("pressure", "Pa", "pressure"),
        FieldSpec::vector("shear", "Pa", "shear"),
        FieldSpec::cell_tensor("stress", "Pa", "stress"),
        FieldSpec::label("state", "1", "state"),
    ];
    then(&grid, &fields)
}

fn append(grid: &mut TransientGrid, steps: std::ops::Range<usize>) {
    for step in steps {
        let s = step as f64;
        grid.append(
            s,
            &[
                Values::Scalar(&[s, s + 0.25, s + 0.5, s + 0.75]),
                Values::Vector(&[[s, -s, 0.5]; 4]),
                Values::Tensor(&[[s; 6]]),
                Values::Integer(&[step as u8; 4]),
            ],
        )
        .unwrap();
    }
}

/// Every number of a grid file.
fn numbers(path: &Path) -> Vec<Vec<f64>> {
    let file = GridFile::open(path).unwrap();
    let mut all = vec![file.times().unwrap()];
    for field in file.fields() {
        let steps = if field.constant { 0..1 } else { 0..file.steps() };
        all.push(file.read_steps(&field.name, field.on_cells, steps).unwrap());
    }
    all
}

#[test]
fn a_grid_cut_off_and_continued_holds_what_one_written_at_once_holds() {
    with_grid(|grid, fields| {
        let folder = tempfile::tempdir().unwrap();
        let at_once = folder.path().join("at-once.vtkhdf");
        append(&mut TransientGrid::create(&at_once, grid, fields, &provenance()).unwrap(), 0..600);
        let at_once = numbers(&at_once);
        // to nothing, within a chunk of rows, at its border, and with nothing to cut off
        for kept in [0, 1, 255, 256, 257, 599] {
            let path = folder.path().join("continued.vtkhdf");
            let mut writer = TransientGrid::create(&path, grid, fields, &provenance()).unwrap();
            append(&mut writer, 0..kept);
            let then = writer.kept();
            append(&mut writer, kept..600);
            let whole = writer.kept();
            verify(&path, &then).unwrap();
            let mut writer = TransientGrid::reopen(&path, grid, fields, &then).unwrap();
            assert_eq!(GridFile::open(&path).unwrap().steps(), kept);
            assert_eq!(writer.steps(), kept);
            append(&mut writer, kept..600);
            assert_eq!(writer.kept(), whole, "cut off at {kept}");
            verify(&path, &whole).unwrap();
            assert_eq!(numbers(&path), at_once, "cut off at {kept}");
        }
    });
}

#[test]
fn a_history_cut_off_and_continued_holds_what_one_written_at_once_holds() {
    let folder = tempfile::tempdir().unwrap();
    let columns = ["time", "force"].map(|name| FieldSpec::scalar(name, "1", "a number"));
    let path = folder.path().join("history.h5");
    let rows = |range: std::ops::Range<usize>| -> Vec<f64> {
        range.flat_map(|row| [row as f64, 1.0 / (row as f64 + 1.0)]).collect()
    };
    for kept in [0, 3, 256, 300, 700] {
        let mut history = History::create(&path, &columns, &provenance()).unwrap();
        history.append(&rows(0..kept)).unwrap();
        let then = history.kept();
        history.append(&rows(kept..700)).unwrap();
        verify(&path, &then).unwrap();
        let mut history = History::reopen(&path, &columns, &then).unwrap();
        assert_eq!(HistoryFile::open(&path).unwrap().rows(), kept);
        history.append(&rows(kept..710)).unwrap();
        let file = HistoryFile::open(&path).unwrap();
        let both = [file.read("time").unwrap(), file.read("force").unwrap()];
        let column = |c| rows(0..710).into_iter().skip(c).step_by(2).collect::<Vec<f64>>();
        let expected = [0, 1].map(column);
        assert_eq!(both, expected, "cut off at {kept}");
    }
}

#[test]
fn a_file_shorter_than_its_checkpoint_says_is_refused() {
    with_grid(|grid, fields| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("short.vtkhdf");
        append(&mut TransientGrid::create(&path, grid, fields, &provenance()).unwrap(), 0..3);
        let kept = Kept { records: 4, sums: Vec::new() };
        let error = TransientGrid::reopen(&path, grid, fields, &kept).unwrap_err();
        assert!(matches!(error, OutputError::Read { .. }), "{error}");
        assert!(error.to_string().contains("fewer than"), "{error}");
    });
}

/// Damages a file in many ways, one at a time; what `prove` lets pass must read as before.
#[track_caller]
fn nothing_passes_changed<T: PartialEq + std::fmt::Debug>(
    path: &Path,
    kept: &Kept,
    read: impl Fn(&Path) -> T,
) {
    let whole = std::fs::read(path).unwrap();
    let expected = read(path);
    let mut refused = 0;
    for at in (0..whole.len()).step_by(37) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x10;
        std::fs::write(path, &damaged).unwrap();
        match verify(path, kept) {
            Ok(()) => assert_eq!(read(path), expected, "byte {at} was changed unnoticed"),
            Err(error) => {
                assert!(error.damaged().is_some(), "{error}");
                refused += 1;
            }
        }
    }
    assert!(refused > whole.len() / 37 / 10, "only {refused} changes noticed");
    for length in (0..whole.len()).step_by(211) {
        std::fs::write(path, &whole[..length]).unwrap();
        assert!(verify(path, kept).is_err(), "cut off at {length} unnoticed");
        assert!(GridFile::open(path).is_err() && HistoryFile::open(path).is_err(), "{length}");
    }
}

#[test]
fn no_damage_of_a_grid_that_is_to_be_continued_passes_unnoticed() {
    with_grid(|grid, fields| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grid.vtkhdf");
        let mut writer = TransientGrid::create(&path, grid, fields, &provenance()).unwrap();
        append(&mut writer, 0..20);
        nothing_passes_changed(&path, &writer.kept(), |path| {
            let file = GridFile::open(path).unwrap();
            let texts = ["creepage_version", "case_hash", "created", "facts"];
            let texts = texts.map(|name| file.provenance(name).unwrap());
            (numbers(path), file.points().unwrap(), file.connectivity().unwrap(), texts)
        });
    });
}

#[test]
fn no_damage_of_a_history_that_is_to_be_continued_passes_unnoticed() {
    let folder = tempfile::tempdir().unwrap();
    let columns = ["time", "force"].map(|name| FieldSpec::scalar(name, "N", "a number"));
    let path = folder.path().join("history.h5");
    let mut history = History::create(&path, &columns, &provenance()).unwrap();
    let rows: Vec<f64> = (0..600).map(f64::from).collect();
    history.append(&rows).unwrap();
    nothing_passes_changed(&path, &history.kept(), |path| {
        let file = HistoryFile::open(path).unwrap();
        let read = |name| (file.read(name).unwrap(), file.units(name).unwrap());
        ["time", "force"].map(read)
    });
}

/// By the checksums that readers verify anyway: those of headers and indexes, and Adler-32 of compressed data.
#[test]
#[cfg_attr(feature = "libhdf5", ignore = "its indices of chunks carry no checksum")]
fn no_reader_is_handed_a_changed_mesh_or_snapshot() {
    with_grid(|grid, fields| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grid.vtkhdf");
        append(&mut TransientGrid::create(&path, grid, fields, &provenance()).unwrap(), 0..20);
        let read = |path: &Path| -> Result<Vec<Vec<f64>>, OutputError> {
            let file = GridFile::open(path)?;
            let cells = file.connectivity()?.into_iter().map(f64::from).collect();
            let mut all = vec![file.points()?.concat(), cells];
            for field in file.fields() {
                let steps = if field.constant { 0..1 } else { 0..file.steps() };
                all.push(file.read_steps(&field.name, field.on_cells, steps)?);
            }
            Ok(all)
        };
        let expected = read(&path).unwrap();
        let whole = std::fs::read(&path).unwrap();
        let mut refused = 0;
        for at in (0..whole.len()).step_by(23) {
            let mut damaged = whole.clone();
            damaged[at] ^= 0x04;
            std::fs::write(&path, &damaged).unwrap();
            match read(&path) {
                Ok(found) => assert_eq!(found, expected, "byte {at} was changed unnoticed"),
                Err(_) => refused += 1,
            }
        }
        assert!(refused > 50, "only {refused} changes noticed");
    });
}
