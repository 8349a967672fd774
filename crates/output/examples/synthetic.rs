//! Writes the files of a made-up run, to try readers, pictures and the cost of writing without a
//! solver: `cargo run --release -p creepage-output --example synthetic -- DIR [STEPS] [REFINE]`.
//!
//! A disk stands on a bar and moves along it; displacement and stress are smooth bumps around the
//! contact, not mechanics.

use output::{
    Cells, FieldSpec, GridSpec, History, OutputError, Provenance, StaticField, TransientGrid,
    Values, summary, write_json_atomically,
};
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::time::Instant;

const RADIUS: f64 = 0.46;
const HUB: f64 = 0.15;
const HALF_WIDTH: f64 = 0.03;
const BAR_LENGTH: f64 = 0.6;
const BAR_HEIGHT: f64 = 0.1;
const SPEED: f64 = 20.0;
const PEAK: f64 = 1.0e9;
const PATCH: f64 = 0.015;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = PathBuf::from(arguments.next().ok_or("usage: synthetic DIR [STEPS] [REFINE]")?);
    let steps: usize = arguments.next().map_or(Ok(5), |text| text.parse())?;
    let refine: usize = arguments.next().map_or(Ok(1), |text| text.parse())?;
    std::fs::create_dir_all(&folder)?;
    let provenance = Provenance {
        creepage_version: env!("CARGO_PKG_VERSION").into(),
        case_hash: "0".repeat(64),
        created: "2026-01-01T00:00:00Z".into(),
        attributes: Vec::new(),
    };
    let model = Model::new(refine);
    write_fields(&folder, &model, steps, &provenance)?;
    write_contact(&folder, &model, steps, &provenance)?;
    write_history(&folder, steps, &provenance)?;
    write_summary(&folder, &model, steps)?;
    Ok(())
}

/// Both bodies as one grid, and the faces that can touch.
struct Model {
    points: Vec<[f64; 3]>,
    hexes: Vec<[u32; 8]>,
    body: Vec<u8>,
    tread: Vec<[u32; 4]>,
    top: Vec<[u32; 4]>,
}

impl Model {
    fn new(refine: usize) -> Self {
        let (around, across, through) = (240 * refine, 6 * refine, 10 * refine);
        let (along, down) = (120 * refine, 8 * refine);
        let mut model = Self {
            points: Vec::new(),
            hexes: Vec::new(),
            body: Vec::new(),
            tread: Vec::new(),
            top: Vec::new(),
        };
        let lateral = |j: usize| HALF_WIDTH * (2.0 * j as f64 / across as f64 - 1.0);
        let disk = |i: usize, j: usize, k: usize| {
            let angle = TAU * i as f64 / around as f64;
            let radius = HUB + (RADIUS - HUB) * (k as f64 / through as f64).sqrt();
            [radius * libm::sin(angle), lateral(j), RADIUS - radius * libm::cos(angle)]
        };
        let near = around / 13;
        model.block(0, [around, across, through], true, disk, |i| (i + near) % around < 2 * near);
        let bar = |i: usize, j: usize, k: usize| {
            let depth = 1.0 - k as f64 / down as f64;
            let x = BAR_LENGTH * (i as f64 / along as f64 - 0.5);
            [x, lateral(j), -BAR_HEIGHT * depth]
        };
        model.block(1, [along, across, down], false, bar, |i| i.abs_diff(along / 2) < along / 3);
        model
    }

    /// A structured block; its last layer in the third direction carries the contact faces.
    fn block(
        &mut self,
        body: u8,
        [nx, ny, nz]: [usize; 3],
        closed: bool,
        position: impl Fn(usize, usize, usize) -> [f64; 3],
        touches: impl Fn(usize) -> bool,
    ) {
        let first = self.points.len();
        let columns = if closed { nx } else { nx + 1 };
        let node = |i: usize, j: usize, k: usize| {
            (first + ((i % columns) * (ny + 1) + j) * (nz + 1) + k) as u32
        };
        for i in 0..columns {
            for j in 0..=ny {
                self.points.extend((0..=nz).map(|k| position(i, j, k)));
            }
        }
        for i in 0..nx {
            for j in 0..ny {
                for k in 0..nz {
                    let ring = |k| {
                        [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)]
                    };
                    let ([a, b, c, d], [e, f, g, h]) = (ring(k), ring(k + 1));
                    // The disk's third direction points down at the contact: turn it outside in.
                    self.hexes.push(if closed {
                        [e, f, g, h, a, b, c, d]
                    } else {
                        [a, b, c, d, e, f, g, h]
                    });
                    self.body.push(body);
                }
                if touches(i) {
                    let [a, b, c, d] = [
                        node(i, j, nz),
                        node(i + 1, j, nz),
                        node(i + 1, j + 1, nz),
                        node(i, j + 1, nz),
                    ];
                    if closed { self.tread.push([a, d, c, b]) } else { self.top.push([a, b, c, d]) }
                }
            }
        }
    }

    fn is_disk(&self, point: [f64; 3]) -> bool {
        point[2] > 1e-9 || (point[0].abs() < 1e-9 && point[2] == 0.0)
    }
}

fn bump(p: [f64; 3], x0: f64) -> f64 {
    let r2 = (p[0] - x0).powi(2) + p[1].powi(2) + (1.5 * p[2]).powi(2);
    libm::exp(-r2 / (2.0 * PATCH * PATCH))
}

/// Small waves everywhere, so that no number is trivially compressible, as in a real run.
fn wave(p: [f64; 3], time: f64) -> f64 {
    libm::sin(90.0 * p[0] + 70.0 * p[1] - 50.0 * p[2] + 3e5 * time)
}

fn time_of(step: usize) -> f64 {
    1e-4 * step as f64
}

fn write_fields(
    folder: &Path,
    model: &Model,
    steps: usize,
    provenance: &Provenance,
) -> Result<(), OutputError> {
    let path = folder.join("fields.vtkhdf");
    let body = StaticField {
        spec: FieldSpec::cell_label("body", "1", "0 disk, 1 bar"),
        values: Values::Integer(&model.body),
    };
    let grid = GridSpec {
        points: &model.points,
        cells: Cells::Hexahedra(&model.hexes),
        constant: &[body],
    };
    let fields = [
        FieldSpec::vector("displacement", "m", "from the reference position"),
        FieldSpec::vector("velocity", "m/s", "of the material"),
        FieldSpec::cell_tensor("stress", "Pa", "Cauchy: xx yy zz xy yz xz"),
    ];
    let mut file = TransientGrid::create(&path, &grid, &fields, provenance)?;
    let mut spent = 0.0;
    for step in 0..steps {
        let time = time_of(step);
        let x0 = SPEED * time;
        let (sin, cos) = libm::sincos(x0 / RADIUS);
        let mut displacement = Vec::with_capacity(model.points.len());
        let mut velocity = Vec::with_capacity(model.points.len());
        for &p in &model.points {
            let w = wave(p, time);
            let dent = -2e-4 * bump(p, 0.0);
            if model.is_disk(p) {
                let (x, z) = (p[0], p[2] - RADIUS);
                let (turned_x, turned_z) = (x * cos + z * sin, z * cos - x * sin);
                displacement.push([turned_x - x + x0 + 1e-8 * w, 3e-9 * w, turned_z - z + dent]);
                let (vx, vz) = (SPEED * (1.0 + turned_z / RADIUS), -SPEED * turned_x / RADIUS);
                velocity.push([vx + 3e-3 * w, 1e-3 * w, vz + 2e-3 * w * w]);
            } else {
                let dent = -2e-4 * bump(p, x0);
                displacement.push([0.1 * dent + 1e-8 * w, 2e-9 * w, dent - 1e-8 * w]);
                velocity.push([3e-3 * w, 1e-3 * w * w, 1e3 * dent + 2e-3 * w]);
            }
        }
        let stress: Vec<[f64; 6]> = model
            .hexes
            .iter()
            .zip(&model.body)
            .map(|(hex, &body)| {
                let centre = hex.iter().fold([0.0; 3], |sum, &node| {
                    let mut p = model.points[node as usize];
                    if body == 0 {
                        let u = displacement[node as usize];
                        p = [p[0] + u[0], p[1] + u[1], p[2] + u[2]];
                    }
                    [sum[0] + p[0] / 8.0, sum[1] + p[1] / 8.0, sum[2] + p[2] / 8.0]
                });
                let s = -PEAK * bump(centre, x0);
                let w = 1e5 * wave(centre, time);
                [
                    0.6 * s + w,
                    0.5 * s - 0.3 * w,
                    s + 0.2 * w,
                    0.01 * s + 0.1 * w,
                    0.3 * w * w / 1e5,
                    0.3 * s + w,
                ]
            })
            .collect();
        let start = Instant::now();
        file.append(
            time,
            &[Values::Vector(&displacement), Values::Vector(&velocity), Values::Tensor(&stress)],
        )?;
        spent += start.elapsed().as_secs_f64();
    }
    let raw = model.points.len() * 48 + model.hexes.len() * 48;
    report(&path, (model.points.len(), model.hexes.len()), steps, spent, raw);
    Ok(())
}

fn write_contact(
    folder: &Path,
    model: &Model,
    steps: usize,
    provenance: &Provenance,
) -> Result<(), OutputError> {
    let path = folder.join("contact.vtkhdf");
    let mut number = vec![u32::MAX; model.points.len()];
    let mut points = Vec::new();
    let mut on_disk = Vec::new();
    let mut quads = Vec::new();
    let mut body = Vec::new();
    for (side, faces) in [(0u8, &model.tread), (1, &model.top)] {
        for face in faces {
            quads.push(face.map(|node| {
                let slot = &mut number[node as usize];
                if *slot == u32::MAX {
                    *slot = points.len() as u32;
                    points.push(model.points[node as usize]);
                    on_disk.push(side == 0);
                }
                *slot
            }));
            body.push(side);
        }
    }
    let body = StaticField {
        spec: FieldSpec::cell_label("body", "1", "0 disk, 1 bar"),
        values: Values::Integer(&body),
    };
    let grid = GridSpec { points: &points, cells: Cells::Quads(&quads), constant: &[body] };
    let fields = [
        FieldSpec::vector("displacement", "m", "from the reference position"),
        FieldSpec::scalar("pressure", "Pa", "normal traction, compression positive"),
        FieldSpec::vector("shear", "Pa", "tangential traction on this side"),
        FieldSpec::vector("slip_velocity", "m/s", "relative tangential velocity"),
        FieldSpec::vector("slip", "m", "accumulated slip"),
        FieldSpec::scalar("mu", "1", "coefficient of friction in use"),
        FieldSpec::label("state", "1", "0 open, 1 stick, 2 slip"),
        FieldSpec::scalar("gap", "m", "positive where open"),
        FieldSpec::scalar("area", "m2", "of the surface per node"),
        FieldSpec::vector("velocity", "m/s", "of the material"),
    ];
    let mut file = TransientGrid::create(&path, &grid, &fields, provenance)?;
    let n = points.len();
    let mut spent = 0.0;
    for step in 0..steps {
        let x0 = SPEED * time_of(step);
        let load: Vec<f64> = points
            .iter()
            .map(|p| (1.0 - ((p[0] - x0).powi(2) + p[1].powi(2)) / PATCH.powi(2)).max(0.0).sqrt())
            .collect();
        let waves: Vec<f64> = points.iter().map(|&p| wave(p, time_of(step))).collect();
        let vector = |x: f64, z: f64, noise: f64| {
            let both = load.iter().zip(&waves);
            both.map(|(&l, &w)| [x * l + noise * w, 0.4 * noise * w, z * l]).collect::<Vec<_>>()
        };
        let displacement: Vec<[f64; 3]> = on_disk
            .iter()
            .zip(&waves)
            .map(|(&disk, &w)| [if disk { x0 } else { 0.0 } + 1e-8 * w, 3e-9 * w, 2e-9 * w * w])
            .collect();
        let pressure: Vec<f64> = load.iter().map(|&l| PEAK * l).collect();
        let state: Vec<u8> = points
            .iter()
            .zip(&load)
            .map(|(p, &l)| if l == 0.0 { 0 } else { 1 + u8::from(p[0] < x0) })
            .collect();
        let gap: Vec<f64> =
            load.iter().zip(&points).map(|(&l, p)| p[2].abs() - 1e-6 * l + 1e-9 * p[0]).collect();
        let (mu, area) = (vec![0.3; n], vec![1e-6; n]);
        let start = Instant::now();
        file.append(
            time_of(step),
            &[
                Values::Vector(&displacement),
                Values::Scalar(&pressure),
                Values::Vector(&vector(0.3 * PEAK, 0.0, 0.0)),
                Values::Vector(&vector(0.01, 0.0, 3e-3)),
                Values::Vector(&vector(1e-6 * step as f64, 0.0, 0.0)),
                Values::Scalar(&mu),
                Values::Integer(&state),
                Values::Scalar(&gap),
                Values::Scalar(&area),
                Values::Vector(&vector(SPEED, 0.1, 3e-3)),
            ],
        )?;
        spent += start.elapsed().as_secs_f64();
    }
    report(&path, (n, quads.len()), steps, spent, n * (8 * 19 + 1));
    Ok(())
}

fn write_history(folder: &Path, steps: usize, provenance: &Provenance) -> Result<(), OutputError> {
    let path = folder.join("history.h5");
    let columns = [
        FieldSpec::scalar("time", "s", "simulated time"),
        FieldSpec::scalar("kinetic", "J", "kinetic energy"),
        FieldSpec::scalar("normal_force", "N", "on the bar"),
    ];
    let mut history = History::create(&path, &columns, provenance)?;
    let rows: Vec<f64> = (0..steps).flat_map(|step| [time_of(step), 1.0, 1.7e5]).collect();
    history.append(&rows)
}

fn write_summary(folder: &Path, model: &Model, steps: usize) -> Result<(), OutputError> {
    let summary = summary::Summary {
        name: "synthetic".into(),
        status: Some(summary::Status::Completed),
        steps: steps as u64,
        dt: 1e-4,
        t_end: time_of(steps.saturating_sub(1)),
        elements: model.hexes.len() as u64,
        nodes: model.points.len() as u64,
        threads: 1,
        wall_s: 0.0,
        element_steps_per_s: 0.0,
        peak_rss_mb: 0.0,
        energy: summary::Energy::default(),
        contact: summary::Contact::default(),
        files: summary::Files::default(),
        stages: [("output".to_owned(), 0.0)].into(),
        ..summary::Summary::default()
    };
    write_json_atomically(folder.join("summary.json"), &summary)
}

fn report(path: &Path, (points, cells): (usize, usize), steps: usize, spent: f64, raw: usize) {
    let size = std::fs::metadata(path).map_or(0, |data| data.len());
    println!(
        "{}: {points} points, {cells} cells, {steps} steps; {:.2} ms and {:.3} MB per step \
         ({:.3} MB raw); file {:.2} MB",
        path.display(),
        1e3 * spent / steps as f64,
        size as f64 / steps as f64 / 1e6,
        raw as f64 / 1e6,
        size as f64 / 1e6,
    );
}
