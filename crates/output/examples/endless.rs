//! Appends snapshots and history rows until it is killed, at full speed or with a pause after each,
//! to try what a kill leaves and what a reader finds meanwhile:
//! `cargo run --release -p creepage-output --example endless -- DIR [PAUSE_MS [QUADS]]`.
//!
//! Every number follows from its step and place ([`value`]), so that a reader can check them all.

use output::{
    Cells, FieldSpec, GridSpec, History, OutputError, Provenance, StaticField, TransientGrid,
    Values,
};
use std::path::Path;
use std::time::Duration;

/// Quads of the strip unless others are asked for; its point count is even, its cell count a prime.
pub const QUADS: usize = 5_003;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("usage: endless DIR [PAUSE_MS [QUADS]]")?;
    let pause = arguments.next().map_or(Ok(0), |text| text.parse())?;
    let quads = arguments.next().map_or(Ok(QUADS), |text| text.parse())?;
    write_forever(Path::new(&folder), Duration::from_millis(pause), quads)?;
    Ok(())
}

/// The number at `place` of a field at `step`: exact in `f64`, and hard to compress.
pub fn value(step: usize, place: usize) -> f64 {
    ((step * 7_919 + place * 104_729) % 1_000_003) as f64 + step as f64 * 1_048_576.0
}

/// Writes a strip of `count` quads to `strip.vtkhdf`, and `history.h5`, in `folder` and does not return
/// but by an error.
pub fn write_forever(folder: &Path, pause: Duration, count: usize) -> Result<(), OutputError> {
    let provenance = Provenance {
        creepage_version: "0".into(),
        case_hash: "none".into(),
        created: "2026-01-01T00:00:00Z".into(),
        attributes: Vec::new(),
    };
    let points: Vec<[f64; 3]> =
        (0..2 * (count + 1)).map(|i| [(i / 2) as f64, (i % 2) as f64, 0.0]).collect();
    let quads: Vec<[u32; 4]> =
        (0..count as u32).map(|i| [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]).collect();
    let body = vec![1u8; count];
    let grid = GridSpec {
        points: &points,
        cells: Cells::Quads(&quads),
        constant: &[StaticField {
            spec: FieldSpec::cell_label("body", "1", "label"),
            values: Values::Integer(&body),
        }],
    };
    let fields = [
        FieldSpec::scalar("scalar", "1", "one number"),
        FieldSpec::vector("vector", "1", "three numbers"),
        FieldSpec::cell_tensor("tensor", "1", "six numbers"),
        FieldSpec::label("label", "1", "small integers"),
    ];
    let columns = ["time", "force", "energy"].map(|name| FieldSpec::scalar(name, "1", "a number"));
    let mut strip =
        TransientGrid::create(folder.join("strip.vtkhdf"), &grid, &fields, &provenance)?;
    let mut history = History::create(folder.join("history.h5"), &columns, &provenance)?;
    let n = points.len();
    for step in 0.. {
        let scalar: Vec<f64> = (0..n).map(|i| value(step, i)).collect();
        let vector: Vec<[f64; 3]> =
            (0..n).map(|i| [0, 1, 2].map(|c| value(step, 3 * i + c))).collect();
        let tensor: Vec<[f64; 6]> =
            (0..count).map(|i| [0, 1, 2, 3, 4, 5].map(|c| value(step, 6 * i + c))).collect();
        let label: Vec<u8> = (0..n).map(|i| value(step, i) as u64 as u8).collect();
        strip.append(
            step as f64,
            &[
                Values::Scalar(&scalar),
                Values::Vector(&vector),
                Values::Tensor(&tensor),
                Values::Integer(&label),
            ],
        )?;
        // From one to seven rows, so that chunks are filled and crossed in many ways.
        let first = history.rows();
        let rows: Vec<f64> = (first..first + 1 + step % 7)
            .flat_map(|row| [value(row, 0), value(row, 1), value(row, 2)])
            .collect();
        history.append(&rows)?;
        std::thread::sleep(pause);
    }
    Ok(())
}
