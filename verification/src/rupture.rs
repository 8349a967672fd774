//! Spontaneous rupture of a fault: the benchmark TPV3.
//!
//! A plane in a full space of `c_p` 6000 m/s, `c_s` 3464 m/s, `rho` 2670 kg/m^3 bears 120 MPa of pressure
//! and 70 MPa of shear along x. Its friction weakens linearly with slip from 0.677 to 0.525 over 0.40 m
//! on a fault 30 km long and 15 km wide; outside it does not slip. In a square of 3 km edge at the
//! middle the shear is 81.6 MPa, just above the strength of 81.24 MPa: slip begins there at t = 0,
//! and the rupture runs from there over the fault (Harris et al. 2009, Seismol. Res. Lett. 80: 119–126; the version in
//! a full space, without a free surface, is that of Day, Dalguer, Lapusta and Liu 2005, J. Geophys. Res. 110: B12307).
//!
//! # Loads
//! The elements carry the change from the initial stress only. The initial stress is applied as the
//! forces that it exerts on either side of the fault, constant loads on the nodes. These balance the
//! traction at t = 0, so that the traction of contact is the total one. The shear of each face is
//! distributed to its nodes by area: on the edge of the square it is 75.8 MPa, at its corners 72.9 MPa.
//!
//! # A quarter
//! The loads are along x and even in x and y. Reflection in y = 0 does not change them: `u_y = 0` there.
//! Reflection in x = 0 reverses the sign of all of them, hence
//! `u(-x) = (u_x, -u_y, -u_z)`: on x = 0 u_y and u_z vanish. (The third symmetry, half a turn about the y axis, makes
//! u_z continuous and the change of pressure zero all over the fault. It is not used; the pressure is a check.)
//! The other sides are free and so far away that no wave comes back to the fault from them during the run.
//!
//! # Scale
//! Elasticity is linear here and friction scales with the pressure: a model with a thousandth of all stresses and of
//! d_0 slips a thousandth as far and as fast at the same times. That model is computed, so that strain stays
//! linear and nodes stay opposite one another. All reported values are scaled back.
//!
//! # Rupture time
//! The time at which the slip speed of a node first exceeds 1 mm/s, linear in between two steps. The reference
//! is the boundary integral solution of Day et al. (2005) on cells of 100 m, `data/TPV3-BI-Rupture-Time.npy` of the
//! repository elygeo/coseis, as used by Ely, Day and Minster (2009, Geophys. J. Int. 177: 1140–1150).
//!
//! # Mesh
//! Uniform on the fault and up to 1.5 km from its plane, coarser outside. There is no damping. Two layers of
//! elements on either side of the fault are fully integrated, as below the contact of rolling runs: one-point
//! elements resist a slip that alternates from node to node by their hourglass stiffness only. With elements of
//! 300 m, where the front is hardly wider than an element, every other node would then rupture late and the front be
//! slow.

use crate::body::{ONE_POINT, at_rest_with, contact_material, side_nodes};
use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::{Field, Row};
use contact::{ContactTables, ExactContact, ExactSettings, NodalContact};
use dynamics::{Fixed, Setup, Simulation};
use friction::{NodeConditions, NodeFriction, SlipWeakening};
use mesh::{Mesh, quad_corner_areas};
use nalgebra::Vector3;
use solid::{Elements, Material, Volumetric};

const C_P: f64 = 6000.0;
const C_S: f64 = 3464.0;
const POISSON: f64 = (C_P * C_P - 2.0 * C_S * C_S) / (2.0 * (C_P * C_P - C_S * C_S));
pub(crate) const ROCK: Material = Material {
    young: 2.0 * 2670.0 * C_S * C_S * (1.0 + POISSON),
    poisson: POISSON,
    density: 2670.0,
};

/// Stress, displacement and velocity of the model over those of the benchmark.
pub(crate) const SCALE: f64 = 1e-3;
/// Normal stress, initial shear on the fault and in the square (Pa).
pub(crate) const PRESSURE: f64 = 120e6;
pub(crate) const SHEAR: f64 = 70e6;
pub(crate) const SHEAR_OF_SQUARE: f64 = 81.6e6;
const LAW: SlipWeakening =
    SlipWeakening { mu_static: 0.677, mu_dynamic: 0.525, distance: 0.4 * SCALE };
/// Slip speed at which a node counts as ruptured (m/s).
pub(crate) const RUPTURED: f64 = 1e-3 * SCALE;

/// Half the edges of fault and square (m).
pub(crate) const FAULT: [f64; 2] = [15e3, 7.5e3];
pub(crate) const SQUARE: f64 = 1.5e3;
/// Ends of the quarter (m).
const ENDS: [f64; 3] = [38.5e3, 34.5e3, 30e3];
/// Uniform elements reach so far beyond the fault's edges and from its plane (m).
const MARGINS: [f64; 3] = [0.5e3, 0.5e3, 1.5e3];
/// Outside, elements grow by 1/3 of the size on the fault per km (1/m), up to six times that size, so that
/// meshes of all sizes are similar.
const GROWTH: f64 = 1.0 / 3e3;
const COARSEST: f64 = 6.0;
/// Fully integrated layers on either side of the fault.
const LAYERS: usize = 2;
/// End of the run at the latest (s): P waves from the square come back from the ends to the far edges of the fault
/// after (2 x 38.5 - 15 - 1.5)/6 = 10.1 s, (2 x 34.5 - 7.5 - 1.5)/6 = 10.0 s and 2 x 30/6 = 10 s.
const END: f64 = 10.0;

/// Rupture times of the boundary integral solution (s) on the quarter, `x` and `y` in km; each is the mean of
/// the four cells of 100 m around the point. NaN in the square, which ruptures at t = 0.
#[rustfmt::skip]
pub(crate) const BOUNDARY_INTEGRAL: [[f64; 15]; 8] = [
    [f64::NAN, f64::NAN, 0.635, 1.068, 1.501, 1.949, 2.386, 2.791, 3.176, 3.546, 3.907, 4.263, 4.609, 4.956, 5.297],
    [f64::NAN, f64::NAN, 0.698, 1.143, 1.581, 2.016, 2.435, 2.829, 3.209, 3.572, 3.931, 4.282, 4.629, 4.970, 5.309],
    [0.741, 0.799, 1.051, 1.424, 1.814, 2.194, 2.569, 2.940, 3.298, 3.652, 3.998, 4.340, 4.681, 5.018, 5.353],
    [1.309, 1.376, 1.559, 1.824, 2.124, 2.449, 2.779, 3.113, 3.445, 3.775, 4.107, 4.436, 4.768, 5.095, 5.425],
    [1.881, 1.927, 2.054, 2.247, 2.485, 2.752, 3.034, 3.330, 3.633, 3.941, 4.251, 4.568, 4.886, 5.204, 5.523],
    [2.411, 2.444, 2.540, 2.682, 2.868, 3.084, 3.325, 3.582, 3.856, 4.138, 4.431, 4.730, 5.028, 5.333, 5.646],
    [2.892, 2.913, 2.988, 3.099, 3.248, 3.426, 3.633, 3.859, 4.104, 4.362, 4.633, 4.912, 5.201, 5.499, 5.798],
    [3.320, 3.342, 3.399, 3.488, 3.613, 3.767, 3.948, 4.147, 4.369, 4.605, 4.859, 5.129, 5.408, 5.692, 5.981],
];

/// [`SlipWeakening`] on the fault, and a barrier that no stress of the problem overcomes outside and
/// on its edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnFault(SlipWeakening);

/// Friction of the model.
pub(crate) const ON_FAULT: OnFault = OnFault(LAW);

/// Coefficient of friction of the barrier.
const BARRIER: f64 = 1e4;

impl OnFault {
    fn holds(at: &NodeConditions) -> bool {
        on_fault([at.position[0], at.position[1]])
    }
}

/// Whether a point lies inside the fault's edges, which themselves do not slip.
fn on_fault(x: [f64; 2]) -> bool {
    x[0].abs() < FAULT[0] - 1.0 && x[1].abs() < FAULT[1] - 1.0
}

impl NodeFriction for OnFault {
    fn begin(&self, at: &NodeConditions) -> [f64; 2] {
        self.0.begin(at)
    }

    fn advance(&self, state: [f64; 2], slip_speed: f64, at: &NodeConditions, dt: f64) -> [f64; 2] {
        self.0.advance(state, slip_speed, at, dt)
    }

    fn mu(&self, state: [f64; 2], slip_speed: f64, at: &NodeConditions) -> f64 {
        if Self::holds(at) { self.0.mu(state, slip_speed, at) } else { BARRIER }
    }

    fn mu_static(&self) -> f64 {
        self.0.mu_static
    }
}

/// The results of one mesh, scaled back to the benchmark.
#[derive(Debug)]
struct Rupture {
    /// Rupture time of the nodes inside the fault (s), infinite for those that did not rupture.
    front: Field,
    /// Slip of the same nodes [`SINCE`] after that (m), infinite where the run ended before.
    slip: Field,
    checks: Checks,
}

/// Conditions that must hold at every node in every step: the largest violations of the run.
#[derive(Clone, Copy, Debug, Default)]
struct Checks {
    /// Distance of a slipping node's traction from the law of its own slip path, over the static strength.
    off_curve: f64,
    /// Shear of a sticking node beyond that strength, over the static one.
    beyond: f64,
    /// Component of shear that does not oppose slip, over the static strength.
    aside: f64,
    /// Change of pressure over the initial one.
    pressure: f64,
    /// Sum of the forces on both sides over the normal force.
    resultant: f64,
    /// Nodes of the barrier that slip.
    leaks: usize,
    /// Imbalance of energy over the energy exchanged.
    energy: f64,
    /// Largest slip path (m), of the model.
    slip: f64,
}

fn quarter(h: f64) -> Result<Mesh, Cause> {
    let growth = 1.0 + GROWTH * h;
    let line = |axis: usize, fine: f64| {
        mesh::graded_line([0.0, ENDS[axis]], [0.0, fine], h, growth, COARSEST * h)
    };
    // the margins in whole elements
    let whole = |axis: usize, edge: f64| edge + (MARGINS[axis] / h).ceil() * h;
    let xs = line(0, whole(0, FAULT[0]))?;
    let ys = line(1, whole(1, FAULT[1]))?;
    let zs = line(2, whole(2, 0.0))?;
    let below: Vec<f64> = zs.iter().rev().map(|z| -z).collect();
    let [upper, lower] = [&zs, &below].map(|z| mesh::graded_block([&xs, &ys, z]));
    Ok(mesh::join(&[upper?, lower?]))
}

/// Which elements are fully integrated: [`LAYERS`] on either side of the fault.
fn beside_fault(mesh: &Mesh) -> Vec<bool> {
    let mut full = vec![false; mesh.hexes.len()];
    for (body, side) in mesh.bodies.iter().zip(["z-", "z+"]) {
        for hex in mesh::layers_below(mesh, body, &body.surfaces[side].faces, LAYERS) {
            full[hex as usize] = true;
        }
    }
    full
}

/// The initial stress as forces on the nodes of both sides: upwards along +x and down on the upper one.
fn initial_stress(mesh: &Mesh, surfaces: [&mesh::Surface; 2]) -> Vec<(u32, Vector3<f64>)> {
    let mut force = std::collections::BTreeMap::<u32, Vector3<f64>>::new();
    for (surface, side) in surfaces.into_iter().zip([1.0, -1.0]) {
        for face in &surface.faces {
            let corners = face.nodes.map(|n| mesh.at(n));
            let middle = corners.iter().map(|c| 0.25 * c).sum::<Vector3<f64>>();
            let inside = middle.x < SQUARE && middle.y < SQUARE;
            let shear = SCALE * if inside { SHEAR_OF_SQUARE } else { SHEAR };
            for (&node, area) in face.nodes.iter().zip(quad_corner_areas(&corners)) {
                let traction = Vector3::new(shear, 0.0, -SCALE * PRESSURE);
                *force.entry(node).or_default() += side * traction * area;
            }
        }
    }
    force.into_iter().collect()
}

/// The model with elements of `h` (m), a table for the contact of its upper side, and the monitor of that side.
fn model(h: f64) -> Result<(Setup, NodalContact, Monitor), Cause> {
    let mesh = quarter(h)?;
    let full = beside_fault(&mesh);
    let elements = Elements::mixed(ONE_POINT, &full, Volumetric::default());
    let mut setup = at_rest_with(&mesh, ROCK, elements, 0.67, None)?;
    for body in 0..2 {
        for (side, axes) in [("x-", [false, true, true]), ("y-", [false, true, false])] {
            let nodes = side_nodes(&mesh, body, side);
            setup.system.fixed.extend(nodes.iter().map(|&node| Fixed { node, axes }));
        }
    }
    let surfaces = [&mesh.bodies[0].surfaces["z-"], &mesh.bodies[1].surfaces["z+"]];
    setup.system.load.forces = initial_stress(&mesh, surfaces);
    let material = contact_material(&ROCK);
    let contact = ExactContact::new(
        &mesh,
        surfaces.map(|s| (s, material)),
        &ExactSettings { slave: Some(0), ..ExactSettings::default() },
        Box::new(OnFault(LAW)),
    )?;
    let table = contact.nodal_table(0);
    let monitor = Monitor::new(&mesh, &table, h);
    setup.system.contact = Some(contact.into());
    Ok((setup, table, monitor))
}

fn rupture(h: f64) -> Result<Rupture, Cause> {
    let (setup, mut table, mut monitor) = model(h)?;
    let dt = setup.dt;
    let mut simulation = Simulation::new(setup);
    let mut checks = Checks::default();
    while simulation.time() < END && !monitor.is_done() {
        let report = simulation.step(simulation.steps().is_multiple_of(10));
        let Some(contact) = simulation.contact() else { return Err("no contact".into()) };
        contact.nodal(&mut table);
        monitor.read(&table, report.time, dt, &mut checks);
        let [on_upper, on_lower] = report.contact.force;
        worst(&mut checks.resultant, (on_upper + on_lower).norm() / report.contact.normal_force);
    }
    checks.energy = simulation.ledger().balance_error();
    checks.slip = monitor.path.iter().fold(0.0, |most, slip| most.max(*slip));
    let (front, slip) = (monitor.field(&monitor.time), monitor.field(&monitor.late));
    Ok(Rupture { front, slip, checks })
}

/// Records rupture and slip of the nodes of the upper side.
struct Monitor {
    /// Number of nodes inside the fault along x and y.
    counts: [usize; 2],
    /// Size of the elements on the fault (m).
    h: f64,
    /// Row of each of these nodes in the table, x fastest.
    rows: Vec<usize>,
    /// Rows of the nodes of the barrier.
    barrier: Vec<usize>,
    /// Of each node inside: slip speed of the step before (m/s) and slip path (m), of the model; rupture time (s).
    speed: Vec<f64>,
    path: Vec<f64>,
    time: Vec<f64>,
    /// Slip path [`SINCE`] after the rupture time (m), scaled back; infinite before.
    late: Vec<f64>,
}

/// Slip is compared this long after the arrival of the rupture (s).
const SINCE: f64 = 2.0;
/// Stations of the reference (m), and its slip there (m), `data/TPV3-BI-P1-Slip.npy` and `-P2-`.
const SLIPS: [(&str, [f64; 2], f64); 2] =
    [("7.45 km along strike", [7450.0, 50.0], 2.105), ("5.95 km along dip", [50.0, 5950.0], 1.648)];

impl Monitor {
    fn new(mesh: &Mesh, table: &NodalContact, h: f64) -> Self {
        let counts = FAULT.map(|edge| (edge / h).round() as usize);
        let mut rows = vec![usize::MAX; counts[0] * counts[1]];
        let mut barrier = Vec::new();
        for (row, &node) in table.nodes.iter().enumerate() {
            let [x, y, _] = mesh.at(node).into();
            if on_fault([x, y]) {
                let [i, j] = [x, y].map(|x| (x / h).round() as usize);
                rows[i + counts[0] * j] = row;
            } else {
                barrier.push(row);
            }
        }
        let n = rows.len();
        let (zeros, never) = (vec![0.0; n], vec![f64::INFINITY; n]);
        Self {
            counts,
            h,
            rows,
            barrier,
            speed: zeros.clone(),
            path: zeros,
            time: never.clone(),
            late: never,
        }
    }

    /// Reads the contact of the step of `dt` (s) that starts at `time` (s), and updates the checks.
    fn read(&mut self, table: &NodalContact, time: f64, dt: f64, checks: &mut Checks) {
        let middle = time + 0.5 * dt;
        let at = NodeConditions::default();
        for (i, &row) in self.rows.iter().enumerate() {
            let (p, shear, s) = (table.pressure[row], table.shear[row], table.slip_velocity[row]);
            let speed = s.norm();
            let strength = LAW.mu([self.path[i], 0.0], speed, &at) * p;
            let scale = LAW.mu_static * p;
            if table.state[row] == SLIPS_STATE {
                worst(&mut checks.off_curve, (shear.norm() - strength).abs() / scale);
                let against = -shear.dot(&s);
                worst(&mut checks.aside, (shear.norm() - against / speed).abs() / scale);
            } else {
                worst(&mut checks.beyond, (shear.norm() - strength) / scale);
            }
            worst(&mut checks.pressure, (p / (SCALE * PRESSURE) - 1.0).abs());
            if self.time[i].is_infinite() && speed > RUPTURED {
                let late = dt * (speed - RUPTURED) / (speed - self.speed[i]);
                self.time[i] = (middle - late).max(0.0);
            }
            self.speed[i] = speed;
            self.path[i] += dt * speed;
            let over = time + dt - (self.time[i] + SINCE);
            if self.late[i].is_infinite() && over >= 0.0 {
                self.late[i] = (self.path[i] - over * speed) / SCALE;
            }
        }
        let slips = |row: &&usize| table.state[**row] == SLIPS_STATE;
        checks.leaks = checks.leaks.max(self.barrier.iter().filter(slips).count());
    }

    fn is_done(&self) -> bool {
        self.time.iter().all(|t| t.is_finite())
    }

    fn field(&self, values: &[f64]) -> Field {
        let [x, y] = self.counts.map(|n| (0..n).map(|i| i as f64 * self.h).collect());
        let name = format!("h = {} m", self.h);
        Field { name, size: self.h, x, y, values: values.to_vec() }
    }
}

/// State of a node that slips in [`NodalContact`].
const SLIPS_STATE: u8 = 2;

/// Keeps the larger of two numbers; once NaN, it stays NaN.
fn worst(most: &mut f64, value: f64) {
    if value > *most || value.is_nan() {
        *most = value;
    }
}

pub(crate) fn run(size: Size) -> Outcome {
    let sizes: &[f64] = match size {
        Size::Quick => &[375.0, 250.0],
        Size::Full => &[300.0, 150.0, 100.0],
    };
    let runs = sizes.iter().map(|&h| rupture(h)).collect::<Result<Vec<_>, Cause>>()?;
    let Some(finest) = runs.last() else { return Err("no mesh".into()) };
    let study = |value: &dyn Fn(&Rupture) -> f64| {
        Convergence::new(runs.iter().map(|r| (r.front.size, value(r))), ORDER)
    };
    let mut rows = vec![across(&runs)];
    for (axis, name, places) in
        [(0, "strike", [3, 6, 9, 12].as_slice()), (1, "dip", [2, 3, 4, 5, 6].as_slice())]
    {
        let mut arrivals = Vec::new();
        for &km in places {
            let [i, j] = if axis == 0 { [km, 0] } else { [0, km] };
            let at = [i, j].map(|k| 1e3 * k as f64);
            let study = study(&|r| r.front.at(at));
            let row = Row::converged(
                format!("arrival {km} km along {name} (s)"),
                BOUNDARY_INTEGRAL[j][i],
                &study,
                (STEP / BOUNDARY_INTEGRAL[j][i], "one time step of the reference"),
                SOURCE,
            );
            arrivals.push(match size {
                Size::Quick => row.at_most(lateness(finest.front.size, WIDTHS[axis])),
                Size::Full => row,
            });
        }
        rows.extend(no_later_than_beyond(arrivals));
    }
    let whole = whole_fault(&runs);
    rows.push(match size {
        Size::Quick => whole.at_most(lateness(finest.front.size, WIDTHS[1])),
        Size::Full => whole,
    });
    for (name, at, reference) in SLIPS {
        // slip across a crack of half width w falls as sqrt(w^2 - y^2)
        let (w, y) = (FAULT[1], at[1]);
        let edge = 0.5 * CELL * w / (w * w - y * y);
        rows.push(Row::converged(
            format!("slip {SINCE} s after the arrival, {name} (m)"),
            reference,
            &study(&|r| r.slip.at(at)),
            (edge, "half a cell of the reference at the edge of the fault"),
            SOURCE,
        ));
    }
    rows.extend(falling_differences(&runs));
    rows.extend(finest.checks.rows(finest.front.size));
    Ok(rows)
}

/// Widths of the front along strike and along dip (m), over which friction weakens.
const WIDTHS: [f64; 2] = [475.0, 404.0];

/// By how much a front of that `width` (m) may be late on the elements of the size `h` (m) of quick runs, whose two meshes
/// differ so much that their difference limits little: half the square of elements over width, the second order of the method.
fn lateness(h: f64, width: f64) -> f64 {
    0.5 * (h / width).powi(2)
}

/// Order of convergence of elements and time step, assumed where the meshes show none.
const ORDER: f64 = 2.0;
/// Time step (s) and cells (m) of the boundary integral solution.
pub(crate) const STEP: f64 = 0.0096;
const CELL: f64 = 100.0;
pub(crate) const SOURCE: &str = "boundary integral solution of Day et al. (2005), cells of 100 m";

/// Limits the uncertainty of arrivals, in rising distance along a line. A front that is late at one place is late by at
/// least as much at all places beyond, so that no place is less certain (s) than those beyond it. The mesh study of a
/// place near the square is weaker, since there the order of the start mixes with that of the front.
fn no_later_than_beyond(mut arrivals: Vec<Row>) -> Vec<Row> {
    let mut beyond = f64::INFINITY;
    for row in arrivals.iter_mut().rev() {
        let own = row.limit * row.reference;
        if beyond < own {
            row.limit = beyond / row.reference;
            row.pass = row.error <= row.limit;
            row.limit_from = "that of a place beyond, where the front is no less late".into();
        }
        beyond = beyond.min(own);
    }
    arrivals
}

/// The rupture runs over the whole fault on every mesh.
fn across(runs: &[Rupture]) -> Row {
    let share = |r: &Rupture| {
        let ruptured = r.front.values.iter().filter(|t| t.is_finite()).count();
        ruptured as f64 / r.front.values.len() as f64
    };
    let least = runs.iter().map(share).fold(1.0, f64::min);
    let fields = runs.iter().map(|r| r.front.clone()).chain([reference()]).collect();
    let row = Row::new(
        "share of the fault that ruptured, least of the meshes",
        [1.0, least],
        1.0,
        (0.0, "exact"),
        "asked: the rupture runs over the whole fault",
    );
    Row { fields, ..row }
}

/// The reference as a field.
fn reference() -> Field {
    let line = |n: usize| (0..n).map(|i| 1e3 * i as f64).collect();
    Field {
        name: "boundary integral".into(),
        size: CELL,
        x: line(15),
        y: line(8),
        values: BOUNDARY_INTEGRAL.as_flattened().to_vec(),
    }
}

/// Places of the reference outside the square (m), and its rupture times there (s).
fn places() -> impl Iterator<Item = ([f64; 2], f64)> {
    let rows = BOUNDARY_INTEGRAL.iter().enumerate();
    rows.flat_map(|(j, row)| {
        row.iter().enumerate().map(move |(i, t)| ([i, j].map(|k| 1e3 * k as f64), *t))
    })
    .filter(|(_, t)| t.is_finite())
}

/// Root mean square.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (n, sum) = values.fold((0.0, 0.0), |(n, sum), v| (n + 1.0, sum + v * v));
    f64::sqrt(sum / n)
}

/// Rupture times all over the fault compared with the reference. The limit is the rms uncertainty of the
/// single places, each from its own mesh study.
fn whole_fault(runs: &[Rupture]) -> Row {
    let mean = places().map(|(_, t)| t).sum::<f64>() / places().count() as f64;
    let study = |at| Convergence::new(runs.iter().map(|r| (r.front.size, r.front.at(at))), ORDER);
    let error = rms(places().map(|(at, t)| study(at).finest() - t)) / mean;
    let limit = rms(places().map(|(at, _)| study(at).uncertainty())) / mean + STEP / mean;
    Row::new(
        format!("rms difference of rupture time at {} places over its mean", places().count()),
        [0.0, error],
        1.0,
        (limit, "rms of the places' mesh convergence (GCI) and one time step of the reference"),
        SOURCE,
    )
}

/// Whether the rms differences over the fault between meshes fall at first order at least.
fn falling_differences(runs: &[Rupture]) -> Option<Row> {
    let [.., coarse, middle, fine] = runs else { return None };
    let between =
        |a: &Rupture, b: &Rupture| rms(places().map(|(at, _)| a.front.at(at) - b.front.at(at)));
    let ratio = between(fine, middle) / between(middle, coarse);
    let [c, m, f] = [coarse, middle, fine].map(|r| r.front.size);
    Some(Row::new(
        "rms difference of the finer two meshes over that of the coarser two",
        [0.0, ratio],
        1.0,
        ((m - f) / (c - m), "first order"),
        "convergence with the mesh",
    ))
}

impl Checks {
    fn rows(&self, h: f64) -> Vec<Row> {
        /// The Gauss–Seidel sweeps of exact contact end at this relative change.
        const SWEPT: (f64, &str) = (1e-12, "tolerance of the sweeps");
        let law = "the law of friction, at every node in every step";
        let zero = |quantity: &str, value: f64, limit: (f64, &str), source: &str| {
            Row::new(quantity, [0.0, value], 1.0, limit, source)
        };
        vec![
            zero("traction of slipping nodes off the weakening curve", self.off_curve, SWEPT, law),
            zero("traction of slipping nodes that does not oppose slip", self.aside, SWEPT, law),
            zero("traction of sticking nodes beyond their strength", self.beyond, SWEPT, law),
            zero("nodes of the barrier that slip", self.leaks as f64, (0.0, "exact"), law),
            zero(
                "sum of the contact forces over the normal force",
                self.resultant,
                (1e-12, "asked: 1e-12"),
                "action and reaction",
            ),
            zero(
                "change of pressure over the pressure",
                self.pressure,
                (self.slip / h, "slip over the element, by which nodes no longer face one another"),
                "antisymmetry of the two sides",
            ),
            zero(
                "imbalance of energy",
                self.energy,
                (
                    SCALE * SHEAR_OF_SQUARE / ROCK.shear(),
                    "the strain, by which finite strain departs from small strain",
                ),
                "energy",
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first step on a coarse mesh: places (m), pressure and shear (MPa, scaled back).
    fn first_step() -> Vec<([f64; 2], f64, f64)> {
        let (setup, mut table, _) = model(1500.0).unwrap();
        let places: Vec<[f64; 2]> = table
            .nodes
            .iter()
            .map(|&n| setup.system.solid.reference()[n as usize].xyz())
            .map(|[x, y, _]| [x, y])
            .collect();
        let mut simulation = Simulation::new(setup);
        simulation.step(false);
        simulation.contact().unwrap().nodal(&mut table);
        let mpa = 1e-6 / SCALE;
        let values = table.pressure.iter().zip(&table.shear);
        places.into_iter().zip(values).map(|(x, (p, q))| (x, mpa * p, mpa * q.norm())).collect()
    }

    #[test]
    fn at_first_the_traction_is_the_initial_stress_bounded_by_the_strength_also_on_the_planes_of_symmetry()
     {
        for (x, pressure, shear) in first_step() {
            let on_edge = [0, 1].map(|i| (x[i] - SQUARE).abs() < 1.0);
            let inside = x.iter().all(|x| *x < SQUARE + 1.0);
            let expected = match (inside, on_edge) {
                (false, _) => 70.0,
                (true, [true, true]) => 72.9,
                (true, [false, false]) => 0.677 * 120.0,
                (true, _) => 75.8,
            };
            assert!((pressure - 120.0).abs() < 1e-9, "{x:?}: {pressure}");
            assert!((shear - expected).abs() < 1e-9, "{x:?}: {shear} {expected}");
        }
    }

    #[test]
    fn the_edge_of_the_fault_belongs_to_the_barrier() {
        let at =
            |x: f64, y: f64| NodeConditions { position: [x, y, 0.0], ..NodeConditions::default() };
        let law = OnFault(LAW);
        let weak = [1.0, 0.0];
        assert_eq!(law.mu(weak, 0.0, &at(14.9e3, 7.4e3)), 0.525);
        for edge in [at(15e3, 0.0), at(0.0, 7.5e3), at(20e3, 20e3)] {
            assert_eq!(law.mu(weak, 0.0, &edge), BARRIER);
        }
    }

    #[test]
    fn the_reference_is_later_farther_from_the_square_along_either_axis() {
        let field = reference();
        for y in 0..7 {
            for x in 0..14 {
                let [here, right, up] = [(x, y), (x + 1, y), (x, y + 1)]
                    .map(|(i, j)| field.at([1e3 * f64::from(i), 1e3 * f64::from(j)]));
                assert!(here.is_nan() || (right > here && up > here), "{x} {y}");
            }
        }
    }
}
