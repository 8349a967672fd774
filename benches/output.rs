//! One snapshot appended to `fields.vtkhdf` and one to `contact.vtkhdf`, compression included.
//! Bytes are those of the arrays in memory.
#![allow(missing_docs)]

use divan::counter::BytesCount;
use output::{Cells, FieldSpec, GridSpec, Provenance, TransientGrid, Values};

fn main() {
    divan::main();
}

fn provenance() -> Provenance {
    Provenance {
        creepage_version: env!("CARGO_PKG_VERSION").into(),
        case_hash: "0".repeat(64),
        created: "2026-01-01T00:00:00Z".into(),
        attributes: Vec::new(),
    }
}

/// A smooth number in full mantissa, larger near the middle of the row, as fields of a run are.
fn wave(i: usize, k: usize) -> f64 {
    let s = i as f64;
    1e-4 * (1e-3 * s + k as f64).sin() / (1.0 + 1e-5 * s)
}

fn field<const N: usize>(rows: usize) -> Vec<[f64; N]> {
    (0..rows).map(|i| std::array::from_fn(|k| wave(i, k))).collect()
}

/// Displacement, velocity and stress of the reference case at 1 mm: 150 k nodes, 140 k elements.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn fields_150k_nodes(bencher: divan::Bencher) {
    let n = [99, 49, 29];
    let mesh = mesh::block(n, [0.099, 0.049, 0.029]);
    let (nodes, cells) = (mesh.nodes.len(), mesh.hexes.len());
    let folder = tempfile::tempdir().expect("a folder");
    let points: Vec<[f64; 3]> = mesh.nodes.iter().map(|point| (*point).into()).collect();
    let grid = GridSpec { points: &points, cells: Cells::Hexahedra(&mesh.hexes), constant: &[] };
    let specs = [
        FieldSpec::vector("displacement", "m", ""),
        FieldSpec::vector("velocity", "m/s", ""),
        FieldSpec::cell_tensor("stress", "Pa", ""),
    ];
    let path = folder.path().join("fields.vtkhdf");
    let mut file = TransientGrid::create(path, &grid, &specs, &provenance()).expect("a file");
    let (displacement, velocity, stress) =
        (field::<3>(nodes), field::<3>(nodes), field::<6>(cells));
    let values =
        [Values::Vector(&displacement), Values::Vector(&velocity), Values::Tensor(&stress)];
    bencher
        .counter(BytesCount::new(48 * (nodes + cells)))
        .bench_local(|| file.append(file.steps() as f64, &values).expect("an append"));
}

/// The contact surfaces of the reference case at 1 mm: 3,402 nodes, of which one in six touches.
#[divan::bench(sample_count = 100, sample_size = 1)]
fn contact_3400_nodes(bencher: divan::Bencher) {
    let (nx, ny) = (81, 42);
    let mut points = Vec::new();
    for i in 0..nx {
        points.extend((0..ny).map(|j| [1e-3 * f64::from(i), 1e-3 * f64::from(j), 0.0]));
    }
    let ny = ny as u32;
    let quads: Vec<[u32; 4]> = (0..nx as u32 - 1)
        .flat_map(|i| (0..ny - 1).map(move |j| i * ny + j))
        .map(|a| [a, a + ny, a + ny + 1, a + 1])
        .collect();
    let folder = tempfile::tempdir().expect("a folder");
    let grid = GridSpec { points: &points, cells: Cells::Quads(&quads), constant: &[] };
    let specs = [
        FieldSpec::scalar("pressure", "1", ""),
        FieldSpec::vector("shear", "1", ""),
        FieldSpec::vector("slip_velocity", "1", ""),
        FieldSpec::vector("slip", "1", ""),
        FieldSpec::scalar("mu", "1", ""),
        FieldSpec::label("state", "1", ""),
        FieldSpec::scalar("gap", "1", ""),
        FieldSpec::vector("velocity", "1", ""),
        FieldSpec::vector("displacement", "1", ""),
    ];
    let path = folder.path().join("contact.vtkhdf");
    let mut file = TransientGrid::create(path, &grid, &specs, &provenance()).expect("a file");
    let nodes = points.len();
    let closed = |i: usize| i / (nodes / 6) == 2;
    let patch = |k: usize| {
        (0..nodes).map(move |i| if closed(i) { wave(i, k) } else { 0.0 }).collect::<Vec<_>>()
    };
    let patches =
        || (0..nodes).map(|i| if closed(i) { [0, 1, 2].map(|k| wave(i, k)) } else { [0.0; 3] });
    let (shear, slip_velocity, slip): (Vec<_>, Vec<_>, Vec<_>) =
        (patches().collect(), patches().collect(), patches().collect());
    let state: Vec<u8> = (0..nodes).map(|i| u8::from(closed(i))).collect();
    let (pressure, mu, gap) = (patch(0), vec![0.5; nodes], patch(1));
    let (velocity, displacement) = (field::<3>(nodes), field::<3>(nodes));
    let values = [
        Values::Scalar(&pressure),
        Values::Vector(&shear),
        Values::Vector(&slip_velocity),
        Values::Vector(&slip),
        Values::Scalar(&mu),
        Values::Integer(&state),
        Values::Scalar(&gap),
        Values::Vector(&velocity),
        Values::Vector(&displacement),
    ];
    bencher
        .counter(BytesCount::new(nodes * (8 * (3 + 5 * 3) + 1)))
        .bench_local(|| file.append(file.steps() as f64, &values).expect("an append"));
}
