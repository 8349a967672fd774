//! Writes a made-up contact history of a given length, to time a check:
//! `cargo run --release -p creepage-lib --example long_history -- DIR [STEPS] [NODES]`.
//!
//! Every node of both surfaces is in contact and every value carries noise, which no compression
//! removes: the worst case for reading and judging.

use output::{Cells, FieldSpec, GridSpec, Provenance, StaticField, TransientGrid, Values};
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("usage: long_history DIR [STEPS] [NODES]")?);
    let steps: usize = arguments.next().map_or(Ok(5000), |text| text.parse())?;
    let nodes: usize = arguments.next().map_or(Ok(2000), |text| text.parse())?;
    std::fs::create_dir_all(&folder)?;
    std::fs::write(
        folder.join("case.toml"),
        "name = \"long-history\"\n[drive]\nspeed = 40.0\ncreepage = 2.5e-3\n[load]\nnormal = 1e5\n\
         [contact]\nenforcement = \"penalty\"\n[friction]\nlaw = \"exponential\"\nstatic = 0.5\n\
         dynamic = 0.32\ndecay = 6.0\n[scales]\npeak_pressure = 1e9\napproach = 1e-4\n\
         half_length = 7e-3\ndt = 1e-7\n",
    )?;
    let (nx, ny) = (nodes / 2 / 25, 25);
    let (mut points, mut faces, mut body) = (Vec::new(), Vec::new(), Vec::new());
    for side in 0..2u8 {
        let first = points.len();
        for i in 0..nx {
            points.extend((0..ny).map(|j| [1e-3 * i as f64, 1e-3 * j as f64, 0.0]));
        }
        for i in 0..nx - 1 {
            for j in 0..ny - 1 {
                let n = |i: usize, j: usize| (first + i * ny + j) as u32;
                let [a, b, c, d] = [n(i, j), n(i + 1, j), n(i + 1, j + 1), n(i, j + 1)];
                faces.push(if side == 1 { [a, b, c, d] } else { [a, d, c, b] });
                body.push(side);
            }
        }
    }
    let count = points.len();
    let fields = [
        FieldSpec::scalar("pressure", "Pa", "p"),
        FieldSpec::vector("shear", "Pa", "t"),
        FieldSpec::vector("slip_velocity", "m/s", "s"),
        FieldSpec::scalar("gap", "m", "gap"),
        FieldSpec::scalar("mu", "1", "mu"),
        FieldSpec::label("state", "1", "state"),
        FieldSpec::vector("velocity", "m/s", "v"),
        FieldSpec::vector("displacement", "m", "u"),
    ];
    let constant = [StaticField {
        spec: FieldSpec::cell_label("body", "1", "0 disk, 1 bar"),
        values: Values::Integer(&body),
    }];
    let grid = GridSpec { points: &points, cells: Cells::Quads(&faces), constant: &constant };
    let provenance = Provenance {
        creepage_version: env!("CARGO_PKG_VERSION").into(),
        case_hash: "0".repeat(64),
        created: "2026-01-01T00:00:00Z".into(),
        attributes: Vec::new(),
    };
    let path = folder.join("contact.vtkhdf");
    let mut file = TransientGrid::create(&path, &grid, &fields, &provenance)?;
    let mut state = 1u64;
    let mut noise = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    for step in 0..steps {
        let pressure: Vec<f64> = (0..count).map(|_| 0.5e9 + 0.5e9 * noise()).collect();
        let speed: Vec<f64> = (0..count).map(|_| noise()).collect();
        let mu: Vec<f64> = speed.iter().map(|s| 0.32 + 0.18 * libm::exp(-6.0 * s)).collect();
        let sign = |row: usize| if row < count / 2 { 1.0 } else { -1.0 };
        let vectors = |of: &dyn Fn(usize) -> f64, z: f64| -> Vec<[f64; 3]> {
            (0..count).map(|row| [of(row), 0.1 * of(row), z]).collect()
        };
        let shear = vectors(&|row| -sign(row) * 0.9 * mu[row] * pressure[row], 0.0);
        let slip = vectors(&|row| sign(row) * speed[row], 0.0);
        let velocity = vectors(&|row| sign(row) * 0.5 * speed[row], 1.0);
        let displacement: Vec<[f64; 3]> = (0..count).map(|_| [1e-6 * noise(), 0.0, 0.0]).collect();
        let gap: Vec<f64> = (0..count).map(|_| -1e-6 * noise()).collect();
        let states: Vec<u8> = (0..count).map(|_| 1 + (noise() > 0.5) as u8).collect();
        file.append(
            1e-7 * step as f64,
            &[
                Values::Scalar(&pressure),
                Values::Vector(&shear),
                Values::Vector(&slip),
                Values::Scalar(&gap),
                Values::Scalar(&mu),
                Values::Integer(&states),
                Values::Vector(&velocity),
                Values::Vector(&displacement),
            ],
        )?;
    }
    Ok(())
}
