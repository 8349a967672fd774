//! Writes the HDF5 seeds of this program into a folder: as small as files of their kind can be.
#![allow(clippy::unwrap_used)]

use output::{
    Cells, Checkpoint, FieldSpec, GridSpec, History, Provenance, Results, StaticField,
    TransientGrid, Values,
};
use std::path::PathBuf;

fn main() {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or("seeds".into()));
    std::fs::create_dir_all(&folder).unwrap();
    let provenance = Provenance {
        creepage_version: "0.1.0".into(),
        case_hash: "0".into(),
        created: "then".into(),
        attributes: vec![("slip_pairing".into(), "after".into())],
    };
    let at = |i: usize| 1e-3 * [0.0, 1.0, 2.0][i % 3];
    let points: Vec<[f64; 3]> =
        (0..18).map(|i| [at(i), at(i / 3 % 3), if i < 9 { 0.0 } else { 1e-6 }]).collect();
    let quads: Vec<[u32; 4]> = [0, 1, 3, 4, 9, 10, 12, 13].map(|n| [n, n + 1, n + 4, n + 3]).into();
    let body = [1, 1, 1, 1, 0, 0, 0, 0];
    let labels = |count| StaticField {
        spec: FieldSpec::cell_label("body", "1", "0 disk, 1 bar"),
        values: Values::Integer(&body[..count]),
    };
    let of = |step: usize, i: usize| 1.0 / (1 + step + i) as f64;

    let constant = [labels(1)];
    let cube: Vec<[f64; 3]> = [0, 1, 4, 3, 9, 10, 13, 12].map(|i| points[i]).into();
    let hex = [[0, 1, 2, 3, 4, 5, 6, 7]];
    let grid = GridSpec { points: &cube, cells: Cells::Hexahedra(&hex), constant: &constant };
    let fields = [FieldSpec::vector("displacement", "m", "u")];
    let path = folder.join("fields.vtkhdf");
    let mut file = TransientGrid::create(path, &grid, &fields, &provenance).unwrap();
    for step in 0..2 {
        let u: Vec<[f64; 3]> = (0..8).map(|i| [of(step, i); 3]).collect();
        file.append(step as f64, &[Values::Vector(&u)]).unwrap();
    }

    let constant = [labels(8)];
    let grid = GridSpec { points: &points, cells: Cells::Quads(&quads), constant: &constant };
    let fields = [
        FieldSpec::scalar("pressure", "Pa", "p"),
        FieldSpec::vector("shear", "Pa", "t"),
        FieldSpec::vector("slip_velocity", "m/s", "s"),
        FieldSpec::label("state", "1", "0 open, 1 stick, 2 slip"),
    ];
    let path = folder.join("contact.vtkhdf");
    let mut file = TransientGrid::create(path, &grid, &fields, &provenance).unwrap();
    for step in 0..3 {
        let p: Vec<f64> = (0..18).map(|i| 1e9 * of(step, i)).collect();
        let t: Vec<[f64; 3]> = (0..18).map(|i| [4e8 * of(step, i), 0.0, 0.0]).collect();
        let s: Vec<[f64; 3]> = (0..18).map(|i| [-0.1 * of(step, i), 0.0, 0.0]).collect();
        let state: Vec<u8> = (0..18).map(|i| 1 + (i % 2) as u8).collect();
        let values =
            [Values::Scalar(&p), Values::Vector(&t), Values::Vector(&s), Values::Integer(&state)];
        file.append(1e-5 * step as f64, &values).unwrap();
    }

    let columns = [FieldSpec::scalar("time", "s", "t"), FieldSpec::scalar("creepage", "1", "c")];
    let mut file = History::create(folder.join("history.h5"), &columns, &provenance).unwrap();
    (0..3).for_each(|step| file.append(&[1e-5 * step as f64, 2e-3]).unwrap());

    let state = vec![1.0, 2.0, 3.0];
    let checkpoint = Checkpoint::new(provenance, 7, Results::default(), &state).unwrap();
    checkpoint.write(&folder).unwrap();
}
