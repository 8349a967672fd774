//! Runs with known content, written through `output`'s own writers.

use creepage::check::{Basis, Checked, Criteria, Limits, PostError, Report, RunPaths, check};
use output::{Cells, FieldSpec, GridSpec, Provenance, StaticField, TransientGrid, Values};
use std::path::Path;

pub const P0: f64 = 1.2e9;
pub const A: f64 = 7.0e-3;
pub const SPEED: f64 = 40.0;
pub const CREEPAGE: f64 = 2.5e-3;
/// s_c
pub const SLIP: f64 = SPEED * CREEPAGE;
pub const DT: f64 = 1e-7;
pub const APPROACH: f64 = 1e-4;

pub const COULOMB: &str = "law = \"coulomb\"\nstatic = 0.5";
pub const FALLING: &str = "law = \"exponential\"\nstatic = 0.5\ndynamic = 0.32\ndecay = 6.0";

pub fn mu(friction: &str, speed: f64) -> f64 {
    if friction == COULOMB { 0.5 } else { 0.32 + 0.18 * libm::exp(-6.0 * speed) }
}

/// What a node carries: pressure, shear and slip velocity of the *bar* (the disk's are opposite),
/// gap, state.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    pub pressure: f64,
    pub shear: [f64; 3],
    pub slip: [f64; 3],
    pub gap: f64,
    pub mu: f64,
    pub state: u8,
}

pub const OPEN: Node =
    Node { pressure: 0.0, shear: [0.0; 3], slip: [0.0; 3], gap: 1e-5, mu: 0.5, state: 0 };

/// A flat disk of `NX` times `NY` nodes on a bar that reaches two elements further on every side;
/// the nodes of the disk lie on the bar's nodes.
pub const NX: usize = 21;
pub const NY: usize = 15;
pub const H: f64 = 1e-3;

pub struct Surfaces {
    pub points: Vec<[f64; 3]>,
    pub faces: Vec<[u32; 4]>,
    pub body: Vec<u8>,
    pub area: Vec<f64>,
    pub disk: usize,
}

pub fn surfaces() -> Surfaces {
    let mut s =
        Surfaces { points: vec![], faces: vec![], body: vec![], area: vec![], disk: NX * NY };
    for (body, nx, ny, x0, y0) in [(0u8, NX, NY, -10e-3, -7e-3), (1, NX + 4, NY + 4, -12e-3, -9e-3)]
    {
        let first = s.points.len();
        for i in 0..nx {
            for j in 0..ny {
                s.points.push([x0 + H * i as f64, y0 + H * j as f64, 0.0]);
                s.area.push(H * H);
            }
        }
        for i in 0..nx - 1 {
            for j in 0..ny - 1 {
                let n = |i: usize, j: usize| (first + i * ny + j) as u32;
                let face = [n(i, j), n(i + 1, j), n(i + 1, j + 1), n(i, j + 1)];
                let [a, b, c, d] = face;
                // outwards is up on the bar and down on the disk
                s.faces.push(if body == 1 { face } else { [a, d, c, b] });
                s.body.push(body);
            }
        }
    }
    s
}

/// Pressure of Hertz's form at a point.
pub fn hertz([x, y, _]: [f64; 3]) -> f64 {
    let inside = 1.0 - (x / A).powi(2) - (y / 5e-3).powi(2);
    // the edge of the ellipse passes through nodes
    if inside > 1e-9 { P0 * inside.sqrt() } else { 0.0 }
}

/// A node that obeys the conditions: sticks ahead of x = -2 mm, slips behind it.
pub fn perfect(friction: &str, x: [f64; 3], step: usize) -> Node {
    let pressure = hertz(x);
    if pressure <= 0.0 {
        return OPEN;
    }
    let along = -libm::sin(step as f64 * 0.7 + 900.0 * x[0]) * 0.1;
    let direction = [libm::cos(along), libm::sin(along), 0.0];
    let (slip, used, state, ratio) = if x[0] > -2e-3 {
        (0.0, 0.5, 1, 0.3)
    } else {
        // a speed that fluctuates from step to step, and with it mu(|s|)
        let speed = SLIP * (3.0 + libm::sin(1.3 * step as f64 + 500.0 * x[0]));
        (speed, mu(friction, speed), 2, mu(friction, speed))
    };
    Node {
        pressure,
        shear: direction.map(|c| -c * ratio * pressure),
        slip: direction.map(|c| c * slip),
        gap: 0.0,
        mu: used,
        state,
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub struct Leave {
    pub gap: bool,
    pub motion: bool,
    pub mu: bool,
}

/// Writes a run of `steps` records one time step apart.
pub fn write(
    folder: &Path,
    friction: &str,
    enforcement: &str,
    steps: usize,
    node: impl Fn([f64; 3], usize) -> Node,
) {
    write_with(folder, friction, enforcement, steps, DT, Leave::default(), node);
}

pub fn case(folder: &Path, friction: &str, enforcement: &str) {
    std::fs::create_dir_all(folder).unwrap();
    let text = format!(
        "name = \"planted\"\n[drive]\nspeed = {SPEED:?}\ncreepage = {CREEPAGE:?}\n[load]\nnormal = 1e5\n\
         [contact]\nenforcement = \"{enforcement}\"\n[friction]\n{friction}\n[scales]\n\
         peak_pressure = {P0:?}\napproach = {APPROACH:?}\nhalf_length = {A:?}\ndt = {DT:?}\n"
    );
    std::fs::write(folder.join("case.toml"), text).unwrap();
}

pub fn create(path: &Path, s: &Surfaces, leave: Leave) -> TransientGrid {
    create_with(path, s, leave, &[])
}

/// With further attributes of the file: name and text.
pub fn create_with(
    path: &Path,
    s: &Surfaces,
    leave: Leave,
    attributes: &[(&str, &str)],
) -> TransientGrid {
    let mut fields = vec![
        FieldSpec::scalar("pressure", "Pa", "p"),
        FieldSpec::vector("shear", "Pa", "t"),
        FieldSpec::vector("slip_velocity", "m/s", "s"),
        FieldSpec::label("state", "1", "state"),
    ];
    if !leave.mu {
        fields.push(FieldSpec::scalar("mu", "1", "mu"));
    }
    if !leave.gap {
        fields.push(FieldSpec::scalar("gap", "m", "gap"));
    }
    if !leave.motion {
        fields.push(FieldSpec::vector("velocity", "m/s", "v"));
        fields.push(FieldSpec::vector("displacement", "m", "u"));
    }
    let provenance = Provenance {
        creepage_version: "0".into(),
        case_hash: "0".into(),
        created: "2026-01-01T00:00:00Z".into(),
        attributes: attributes
            .iter()
            .map(|(name, text)| ((*name).into(), (*text).into()))
            .collect(),
    };
    let constant = [
        StaticField {
            spec: FieldSpec::cell_label("body", "1", "body"),
            values: Values::Integer(&s.body),
        },
        StaticField {
            spec: FieldSpec::scalar("area", "m2", "area"),
            values: Values::Scalar(&s.area),
        },
    ];
    let grid = GridSpec { points: &s.points, cells: Cells::Quads(&s.faces), constant: &constant };
    TransientGrid::create(path, &grid, &fields, &provenance).unwrap()
}

pub fn write_with(
    folder: &Path,
    friction: &str,
    enforcement: &str,
    steps: usize,
    interval: f64,
    leave: Leave,
    node: impl Fn([f64; 3], usize) -> Node,
) {
    case(folder, friction, enforcement);
    let s = surfaces();
    let mut file = create(&folder.join("contact.vtkhdf"), &s, leave);
    for step in 0..steps {
        append(&mut file, &s, step, interval, leave, &node);
    }
}

pub fn append(
    file: &mut TransientGrid,
    s: &Surfaces,
    step: usize,
    interval: f64,
    leave: Leave,
    node: &impl Fn([f64; 3], usize) -> Node,
) {
    let nodes: Vec<Node> = s.points.iter().map(|&x| node(x, step)).collect();
    let sign = |row: usize| if row < s.disk { -1.0 } else { 1.0 };
    let vectors = |of: fn(&Node) -> [f64; 3]| -> Vec<[f64; 3]> {
        nodes.iter().enumerate().map(|(row, n)| of(n).map(|c| c * sign(row))).collect()
    };
    let pressure: Vec<f64> = nodes.iter().map(|n| n.pressure).collect();
    let (shear, slip) = (vectors(|n| n.shear), vectors(|n| n.slip));
    let mu: Vec<f64> = nodes.iter().map(|n| n.mu).collect();
    let state: Vec<u8> = nodes.iter().map(|n| n.state).collect();
    let gap: Vec<f64> = nodes.iter().map(|n| n.gap).collect();
    // the bar moves with a velocity of its own, the disk with it and against the bar's slip
    let drift = [3.0, -1.0, 0.0];
    let velocity: Vec<[f64; 3]> = nodes
        .iter()
        .enumerate()
        .map(|(row, n)| {
            let relative = if row < s.disk { n.slip.map(|c| -c) } else { [0.0; 3] };
            [0, 1, 2].map(|i| drift[i] + relative[i])
        })
        .collect();
    let displacement = vec![[0.25e-3, 0.0, 0.0]; nodes.len()];
    let mut values = vec![
        Values::Scalar(&pressure),
        Values::Vector(&shear),
        Values::Vector(&slip),
        Values::Integer(&state),
    ];
    if !leave.mu {
        values.push(Values::Scalar(&mu));
    }
    if !leave.gap {
        values.push(Values::Scalar(&gap));
    }
    if !leave.motion {
        values.push(Values::Vector(&velocity));
        values.push(Values::Vector(&displacement));
    }
    file.append(interval * step as f64, &values).unwrap();
}

/// A check, and what `creepage check --json` prints of it.
pub struct Judged {
    pub checked: Checked,
    pub document: serde_json::Value,
}

pub fn judge(folder: &Path, report: Report) -> Result<Judged, PostError> {
    let paths = RunPaths::of(folder)?;
    let mut basis = Basis::read(&paths)?;
    let limits = Limits::for_enforcement(basis.enforcement.as_deref());
    let options = Criteria { window: None, limits, report, map: None };
    let checked = check(&paths, &mut basis, &options)?;
    let document = serde_json::to_value(&checked.result).unwrap();
    Ok(Judged { checked, document })
}
