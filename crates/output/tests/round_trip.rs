//! What is written is read back, and wrong input is refused with a reason.

#![allow(clippy::unwrap_used, missing_docs)]

use output::{
    BackgroundWriter, Cells, Checkpoint, FieldSpec, GridFile, GridSpec, History, HistoryFile, Kept,
    OutputError, Provenance, Results, RunFiles, StaticField, TransientGrid, Values,
    write_json_atomically,
};
use std::path::Path;

const CUBE: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];
const HEX: [[u32; 8]; 1] = [[0, 1, 2, 3, 4, 5, 6, 7]];
const FACES: [[u32; 4]; 2] = [[0, 3, 2, 1], [4, 5, 6, 7]];

fn provenance() -> Provenance {
    Provenance {
        creepage_version: "1.2.3".into(),
        case_hash: "abc".into(),
        created: "2026-01-01T00:00:00Z".into(),
        attributes: Vec::new(),
    }
}

fn body(labels: &[u8]) -> StaticField<'_> {
    StaticField {
        spec: FieldSpec::cell_label("body", "1", "0 disk, 1 bar"),
        values: Values::Integer(labels),
    }
}

fn fields_file(path: &Path) -> TransientGrid {
    let labels = [3];
    let constant = [body(&labels)];
    let grid = GridSpec { points: &CUBE, cells: Cells::Hexahedra(&HEX), constant: &constant };
    let fields =
        [FieldSpec::vector("displacement", "m", "u"), FieldSpec::cell_tensor("stress", "Pa", "s")];
    TransientGrid::create(path, &grid, &fields, &provenance()).unwrap()
}

fn contact_file(path: &Path) -> TransientGrid {
    let labels = [0, 1];
    let constant = [body(&labels)];
    let grid = GridSpec { points: &CUBE, cells: Cells::Quads(&FACES), constant: &constant };
    let fields = [FieldSpec::scalar("pressure", "Pa", "p"), FieldSpec::label("state", "1", "s")];
    TransientGrid::create(path, &grid, &fields, &provenance()).unwrap()
}

fn history_file(path: &Path) -> History {
    let columns = [FieldSpec::scalar("time", "s", "t"), FieldSpec::scalar("force", "N", "f")];
    History::create(path, &columns, &provenance()).unwrap()
}

fn vectors<const N: usize>(count: usize, step: usize) -> Vec<[f64; N]> {
    (0..count)
        .map(|i| std::array::from_fn(|c| (0.1 + step as f64).powi(3) / (1 + N * i + c) as f64))
        .collect()
}

#[test]
fn a_grid_reads_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.vtkhdf");
    let mut file = fields_file(&path);
    for step in 0..300 {
        let (u, s) = (vectors::<3>(8, step), vectors::<6>(1, step));
        file.append(0.5 * step as f64, &[Values::Vector(&u), Values::Tensor(&s)]).unwrap();
    }
    assert_eq!(file.steps(), 300);
    let file = GridFile::open(&path).unwrap();
    assert_eq!(file.steps(), 300);
    assert_eq!(file.times().unwrap()[299], 149.5);
    assert_eq!(file.points().unwrap(), CUBE);
    assert_eq!(file.connectivity().unwrap(), HEX.as_flattened());
    assert_eq!(file.provenance("case_hash").unwrap(), "abc");
    for step in [0, 1, 150, 299] {
        let read = file.read("displacement", false, step).unwrap();
        assert_eq!(read, vectors::<3>(8, step).as_flattened());
        let read = file.read("stress", true, step).unwrap();
        assert_eq!(read, vectors::<6>(1, step).as_flattened());
        assert_eq!(file.read("body", true, step).unwrap(), [3.0]);
    }
    let three = file.read_steps("displacement", false, 148..151).unwrap();
    let one_by_one = [148, 149, 150].map(|step| file.read("displacement", false, step).unwrap());
    assert_eq!(three, one_by_one.concat());
    assert_eq!(file.read_steps("body", true, 0..300).unwrap(), [3.0], "stored once");
    assert!(file.read_steps("stress", true, 299..301).is_err());
    assert_eq!(file.read_steps("stress", true, 7..7).unwrap(), [0.0; 0]);
    let stress = file.fields().iter().find(|field| field.name == "stress").unwrap();
    assert_eq!((stress.components, stress.units.as_str()), (6, "Pa"));
    assert!(stress.on_cells && !stress.constant && !stress.integer);
    let body = file.fields().iter().find(|field| field.name == "body").unwrap();
    assert!(body.on_cells && body.constant && body.integer);
    let missing = file.read("pressure", false, 0).unwrap_err().to_string();
    assert!(missing.contains("displacement"), "should name what there is: {missing}");
    assert!(file.read("stress", true, 300).is_err());
}

#[test]
fn a_history_reads_back_whatever_the_sizes_of_its_appends() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("history.h5");
    let mut history = history_file(&path);
    for size in [1, 300, 0, 255, 1, 700] {
        let first = history.rows();
        let rows: Vec<f64> =
            (first..first + size).flat_map(|row| [row as f64, -(row as f64).sqrt()]).collect();
        history.append(&rows).unwrap();
    }
    let file = HistoryFile::open(&path).unwrap();
    assert_eq!(file.rows(), 1257);
    assert_eq!(file.columns().unwrap(), ["force", "time"]);
    assert_eq!(file.units("force").unwrap(), "N");
    assert_eq!(file.read("time").unwrap(), (0..1257).map(f64::from).collect::<Vec<_>>());
    assert_eq!(file.read("force").unwrap()[1256], -(1256f64).sqrt());
    assert!(history.append(&[1.0]).unwrap_err().to_string().contains("2 columns"));
}

/// Writes the three files of a run with `step` calls in a fixed order.
fn write_run(folder: &Path, background: bool) {
    let mut files = RunFiles {
        fields: Some(fields_file(&folder.join("fields.vtkhdf"))),
        contact: contact_file(&folder.join("contact.vtkhdf")),
        history: history_file(&folder.join("history.h5")),
    };
    let frame = |step: usize| (vectors::<3>(8, step), vectors::<6>(1, step));
    let contact = |step: usize| {
        let pressure: Vec<f64> = (0..8).map(|i| (i * step) as f64).collect();
        (pressure, [step as u8; 8])
    };
    if background {
        let mut writer = BackgroundWriter::start(files).unwrap();
        for step in 0..40 {
            let ((u, s), (p, state)) = (frame(step), contact(step));
            let time = step as f64;
            writer.append_fields(time, &[Values::Vector(&u), Values::Tensor(&s)]).unwrap();
            writer.append_contact(time, &[Values::Scalar(&p), Values::Integer(&state)]).unwrap();
            writer.append_history(&[time, 1.0]).unwrap();
        }
        files = writer.finish().unwrap();
    } else {
        for step in 0..40 {
            let ((u, s), (p, state)) = (frame(step), contact(step));
            let time = step as f64;
            let fields = files.fields.as_mut().unwrap();
            fields.append(time, &[Values::Vector(&u), Values::Tensor(&s)]).unwrap();
            files.contact.append(time, &[Values::Scalar(&p), Values::Integer(&state)]).unwrap();
            files.history.append(&[time, 1.0]).unwrap();
        }
    }
    let fields = files.fields.as_ref().unwrap();
    assert_eq!((fields.steps(), files.contact.steps(), files.history.rows()), (40, 40, 40));
}

#[test]
fn equal_runs_give_equal_files_with_and_without_the_background_thread() {
    let folders = [false, false, true].map(|background| {
        let folder = tempfile::tempdir().unwrap();
        write_run(folder.path(), background);
        folder
    });
    for name in ["fields.vtkhdf", "contact.vtkhdf", "history.h5"] {
        let [first, again, background] =
            [0, 1, 2].map(|i| std::fs::read(folders[i].path().join(name)).unwrap());
        assert!(first == again, "{name} differs between equal runs");
        assert!(first == background, "{name} differs when written in the background");
    }
}

#[test]
fn the_background_writer_hands_back_the_error_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.vtkhdf");
    let files = RunFiles {
        fields: Some(fields_file(&path)),
        contact: contact_file(&folder.path().join("contact.vtkhdf")),
        history: history_file(&folder.path().join("history.h5")),
    };
    std::fs::remove_file(&path).unwrap();
    let mut writer = BackgroundWriter::start(files).unwrap();
    let (u, s) = (vectors::<3>(8, 0), vectors::<6>(1, 0));
    let error = (0..100)
        .find_map(|_| {
            std::thread::sleep(std::time::Duration::from_millis(1));
            writer.append_fields(0.0, &[Values::Vector(&u), Values::Tensor(&s)]).err()
        })
        .unwrap();
    assert!(error.to_string().contains("fields.vtkhdf"), "{error}");
    assert!(writer.finish().is_err());
}

#[test]
fn a_run_may_have_no_fields_and_then_takes_no_snapshot_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let files = || RunFiles {
        fields: None,
        contact: contact_file(&folder.path().join("contact.vtkhdf")),
        history: history_file(&folder.path().join("history.h5")),
    };
    let mut writer = BackgroundWriter::start(files()).unwrap();
    writer.append_history(&[0.0, 1.0]).unwrap();
    let (sender, kept) = std::sync::mpsc::channel();
    let provenance = provenance();
    let make = move |results: Results| {
        sender.send(results.clone()).unwrap();
        Checkpoint::new(provenance, 1, results, &0u64)
    };
    writer.keep(make, folder.path(), None).unwrap();
    assert!(writer.finish().unwrap().fields.is_none());
    let kept = kept.recv().unwrap();
    assert_eq!((kept.fields, kept.history.records), (Kept::default(), 1));
    let mut writer = BackgroundWriter::start(files()).unwrap();
    writer.append_fields(0.0, &[]).unwrap();
    assert!(matches!(writer.finish(), Err(OutputError::NoFields)));
}

#[test]
fn wrong_shapes_are_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.vtkhdf");
    let mut file = fields_file(&path);
    let (u, s) = (vectors::<3>(7, 0), vectors::<6>(1, 0));
    let error = file.append(0.0, &[Values::Vector(&u), Values::Tensor(&s)]).unwrap_err();
    assert!(error.to_string().contains("displacement"), "{error}");
    assert!(file.append(0.0, &[Values::Tensor(&s)]).is_err());
    let swapped = [Values::Tensor(&s), Values::Vector(&u)];
    assert!(file.append(0.0, &swapped).is_err());
    assert_eq!(GridFile::open(&path).unwrap().steps(), 0);

    let outside = [[0, 1, 2, 3, 4, 5, 6, 8]];
    let grid = GridSpec { points: &CUBE, cells: Cells::Hexahedra(&outside), constant: &[] };
    let error = TransientGrid::create(&path, &grid, &[], &provenance()).unwrap_err();
    assert!(error.to_string().contains("point 8"), "{error}");
    let empty = GridSpec { points: &[], cells: Cells::Quads(&[]), constant: &[] };
    assert!(TransientGrid::create(&path, &empty, &[], &provenance()).is_err());
    let twice = [0, 0].map(|_| FieldSpec::vector("u", "m", ""));
    let grid = GridSpec { points: &CUBE, cells: Cells::Hexahedra(&HEX), constant: &[] };
    assert!(TransientGrid::create(&path, &grid, &twice, &provenance()).is_err());
}

#[test]
fn a_path_that_cannot_be_written_is_named_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("missing").join("history.h5");
    let error = History::create(&path, &[FieldSpec::scalar("time", "s", "t")], &provenance());
    let text = error.unwrap_err().to_string();
    assert!(text.contains("history.h5") && text.contains("folder exists"), "{text}");
    let text = write_json_atomically(&path, &1).unwrap_err().to_string();
    assert!(text.contains("history.h5"), "{text}");
    std::fs::write(folder.path().join("text.vtkhdf"), "not HDF5").unwrap();
    let text = GridFile::open(folder.path().join("text.vtkhdf")).err().unwrap().to_string();
    assert!(text.contains("text.vtkhdf"), "{text}");
}

#[test]
fn json_replaces_the_old_text_whole_and_leaves_no_neighbour() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("summary.json");
    write_json_atomically(&path, &vec![1.0; 1000]).unwrap();
    write_json_atomically(&path, &[0.1, 1e-300]).unwrap();
    let read: Vec<f64> = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    assert_eq!(read, [0.1, 1e-300]);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// Two processes that write one file, as where a lock was deleted: rows of both would be neither's run.
#[test]
fn who_finds_rows_of_another_process_stops_and_leaves_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("history.h5");
    let columns = [FieldSpec::scalar("time", "s", "t"), FieldSpec::scalar("force", "N", "f")];
    let mut first = history_file(&path);
    first.append(&[0.0, 1.0]).unwrap();
    let nothing = Kept { records: 0, sums: Vec::new() };
    let mut second = History::reopen(&path, &columns, &nothing).unwrap();
    second.append(&[5.0, 6.0, 7.0, 8.0]).unwrap();
    let error = first.append(&[1.0, 2.0]).unwrap_err();
    assert!(matches!(error, OutputError::Another { found: 2, left: 1, .. }), "{error}");
    assert_eq!(HistoryFile::open(&path).unwrap().read("time").unwrap(), [5.0, 7.0]);
    second.append(&[9.0, 9.0]).unwrap();

    let path = folder.path().join("contact.vtkhdf");
    let mut first = contact_file(&path);
    let (pressure, state) = ([0.0; 8], [0; 8]);
    let values = [Values::Scalar(&pressure), Values::Integer(&state)];
    first.append(0.0, &values).unwrap();
    let mut second = contact_file(&path);
    let error = first.append(1.0, &values).unwrap_err();
    assert!(matches!(error, OutputError::Another { found: 0, left: 1, .. }), "{error}");
    second.append(0.0, &values).unwrap();
    assert_eq!(GridFile::open(&path).unwrap().steps(), 1);
}
