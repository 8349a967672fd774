//! Growth of a disturbance of steady sliding under falling friction with memory.
//!
//! The theory is in [`crate::dispersion`]. Two blocks slide past one another along y, across the x-z plane of the
//! mode. A quarter of the wavelength is meshed. The end x = 0 is a mirror plane; at the other end the mode is
//! zero, and the nodes there, like those of the far ends, move at the steady speed. So the mode is the longest
//! wave that fits. A change of uniform sliding, which would grow faster for R > 1, is excluded. The initial state is
//! steady sliding plus the mode that grows fastest in theory, with a slip speed of 1e-5 of the steady one, in
//! displacement, velocity and coefficient of friction. The component of the slip speed along cos(k x) is measured. The
//! first quarter of the run is left out, in which the mode of the half-spaces adapts to that of the mesh. A real root
//! is the slope of the logarithm; a complex one follows from the recurrence that any `Re(A exp(q t))` obeys (Prony).
//!
//! The law is Eq (8) with k = 6 s/m, between steel bodies at 1 GPa. The blocks bear a millionth of that pressure, with
//! all slip speeds and slip distances a millionth as large: the same dispersion equation, with strains that stay
//! linear. Numbers are given for 1 GPa.
//!
//! Other growing modes are excluded. Elements are fully integrated, since opposite slip on the two free
//! sides is a soft hourglass mode of one-point elements; they are so few heights wide that such slip strains them.
//! Poisson's ratio is zero, since pressure would push the free sides apart. There is no damping.

use crate::body::{SHEARED, at_rest, contact_material};
use crate::convergence::Convergence;
use crate::dispersion::{self, Sliding};
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use contact::{ExactContact, ExactSettings};
use dynamics::{Fixed, Setup, Simulation};
use faer::c64 as Complex;
use friction::{Exponential, FrictionLaw, Memory, NodeConditions, NodeFriction, Remembering};
use halfspace::HalfSpaces;
use mesh::Padded;
use nalgebra::Vector3;
use solid::{Level, Solid, Viscosity, Volumetric};
use std::f64::consts::PI;

/// Pressure, slip speeds and distance of memory of the model over those at 1 GPa.
const SCALE: f64 = 1e-6;
const PRESSURE: f64 = 1e9 * SCALE;
const LAW: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 / SCALE };

/// Sliding speed (m/s), memory (um) and wavelength (mm), as at 1 GPa. At 0.4 m/s R = 7.8, at 0.8 m/s R = 0.7.
const CASES: [[f64; 3]; 10] = [
    [0.4, 1.0, 20.0],
    [0.4, 2.0, 20.0],
    [0.4, 5.0, 20.0],
    [0.4, 10.0, 20.0],
    [0.4, 1.0, 30.0],
    [0.4, 2.0, 30.0],
    [0.4, 5.0, 30.0],
    [0.4, 10.0, 30.0],
    [0.8, 0.5, 40.0],
    [0.8, 2.0, 40.0],
];

/// Slip speed of the disturbance over that of steady sliding.
const SEED: f64 = 1e-5;
/// Elements per wavelength and per length 1/Re(a) of decay, at refinement 1.
const PER_WAVE: f64 = 40.0;
const PER_DECAY: f64 = 5.0;
/// Both blocks are together so many lengths of decay deep: a mode reflected by a far end returns with `exp(-DEPTH)` of
/// its amplitude.
const DEPTH: f64 = 16.0;
/// Width of the elements over their height.
const WIDE: f64 = 10.0;
/// The run ends when the mode has grown by the factor exp(`GROWN`), or after `LONGEST` radians of a shear wave
/// along the interface.
const GROWN: f64 = 4.0;
const LONGEST: f64 = 300.0;

/// Largest relative error that passes.
const REQUIRED: f64 = 0.1;
const SOURCE: &str = "linear stability of sliding between half-spaces (dispersion.rs)";

pub(crate) fn run(size: Size) -> Outcome {
    let refinements: &[f64] = match size {
        Size::Quick => &[0.5, 1.0],
        Size::Full => &[0.5, 1.0, 2.0],
    };
    let mut rows = Vec::new();
    for [speed, memory, wavelength] in CASES {
        let mode = Mode::new(speed * SCALE, memory * 1e-6 * SCALE, wavelength * 1e-3)?;
        let mut found = Vec::new();
        for &refinement in refinements {
            found.push((mode.cell(refinement), mode.measure(refinement)?));
        }
        let case = format!("V {speed} m/s, d_c {memory} um, wavelength {wavelength} mm");
        let study =
            |of: fn(&Complex) -> f64| Convergence::new(found.iter().map(|(h, q)| (*h, of(q))), 2.0);
        let (growth, exact) = (study(|q| q.re), mode.growth);
        let values = [exact.re, growth.finest()];
        let row = Row::asked(format!("{case}: growth rate (1/s)"), values, REQUIRED, SOURCE);
        rows.push(Row { meshes: growth.samples().to_vec(), order: growth.order(), ..row });
        // near the point where two real roots meet, the root of a mesh may still be real
        if exact.im > 0.5 * exact.re {
            let frequency = study(|q| q.im);
            // the error of a complex root has no preferred direction: both parts have the same uncertainty
            let uncertain = libm::hypot(growth.uncertainty(), frequency.uncertainty()) / exact.im;
            let from = format!("{}, of the complex root", frequency.explain());
            let (what, limit) = (format!("{case}: frequency (rad/s)"), (uncertain, from.as_str()));
            let row = Row::new(what, [exact.im, frequency.finest()], exact.im, limit, SOURCE);
            let meshes = frequency.samples().to_vec();
            rows.push(Row { meshes, order: frequency.order(), ..row }.at_most(REQUIRED));
        }
    }
    Ok(rows)
}

/// The fastest growing mode of a wave number, with the displacement `±D/2 cos(k x) exp(q t - a |z|)` along y and the
/// slip speed `SEED` V at t = 0.
struct Mode {
    /// Speed V of steady sliding (m/s), of the model.
    speed: f64,
    memory: Memory,
    /// k (1/m).
    wave_number: f64,
    /// q (1/s).
    growth: Complex,
    /// a (1/m).
    decay: Complex,
}

impl Mode {
    fn new(speed: f64, distance: f64, wavelength: f64) -> Result<Self, Cause> {
        let sliding = Sliding {
            bodies: HalfSpaces::new(SHEARED.young, SHEARED.poisson, SHEARED.density),
            mode: dispersion::Mode::Antiplane,
            falling: -PRESSURE * LAW.slope(speed),
            delay: distance / speed,
        };
        let wave_number = 2.0 * PI / wavelength;
        let growth = sliding.growth(wave_number).ok_or("no mode grows")?;
        let decay = sliding.decay(wave_number, growth);
        // the floor is below any speed of the run
        let memory = Memory { distance, floor: 0.5 * speed };
        Ok(Self { speed, memory, wave_number, growth, decay })
    }

    /// A quarter of the wavelength (m).
    fn width(&self) -> f64 {
        0.5 * PI / self.wave_number
    }

    /// Elements along that width.
    fn cells(&self, refinement: f64) -> usize {
        let decay = PER_DECAY * self.decay.re * self.width();
        (refinement * decay.max(0.25 * PER_WAVE)).ceil() as usize
    }

    /// Edge of the elements (m).
    fn cell(&self, refinement: f64) -> f64 {
        self.width() / self.cells(refinement) as f64
    }

    /// The amplitude D of slip (m).
    fn slip(&self) -> Complex {
        SEED * self.speed / self.growth
    }

    /// The mode's coefficient of friction at x = 0 and t = 0.
    fn friction(&self) -> f64 {
        let delayed = 1.0 + self.growth * (self.memory.distance / self.speed);
        (LAW.slope(self.speed) * SEED * self.speed / delayed).re
    }

    /// The root q (1/s) measured in a run.
    fn measure(&self, refinement: f64) -> Result<Complex, Cause> {
        let mut simulation = Simulation::new(self.setup(refinement)?);
        let mut table = match simulation.contact() {
            Some(contact) => contact.nodal_table(0),
            None => return Err("no contact".into()),
        };
        let reference = simulation.solid().reference();
        let shape: Vec<f64> = table
            .nodes
            .iter()
            .zip(&table.area)
            .map(|(&n, area)| area * libm::cos(self.wave_number * reference[n as usize][0]))
            .collect();
        let radians = LONGEST / (self.wave_number * SHEARED.c_s());
        let end = radians.min(GROWN / self.growth.re);
        let mut history = Vec::with_capacity((end / simulation.dt()) as usize + 1);
        while simulation.time() < end {
            let report = simulation.step(false);
            if let Some(contact) = simulation.contact() {
                contact.nodal(&mut table);
            }
            if report.contact.sticking > 0 {
                return Err(format!("nodes stick after {:e} s", report.time).into());
            }
            let beyond = table.slip_velocity.iter().map(|s| s[1] - self.speed);
            let along: f64 = shape.iter().zip(beyond).map(|(w, s)| w * s).sum();
            history.push(along);
        }
        let settled = &history[history.len() / 4..];
        if self.growth.im == 0.0 {
            return Ok(slope(settled, simulation.dt()).into());
        }
        Ok(prony(settled, self.growth, simulation.dt()))
    }

    /// Steady sliding plus the mode.
    fn setup(&self, refinement: f64) -> Result<Setup, Cause> {
        let (cells, h) = (self.cells(refinement), self.cell(refinement));
        let deep = (0.5 * DEPTH / (self.decay.re * h)).ceil() as usize;
        let size = [self.width(), WIDE * h, deep as f64 * h];
        let upper = mesh::block([cells, 1, deep], size);
        let mut lower = upper.clone();
        lower.nodes.iter_mut().for_each(|x| x[2] -= size[2]);
        // round-off at z = 0 would be a gap, and closing it an impact
        lower.nodes.iter_mut().filter(|x| x[2].abs() < 0.5 * h).for_each(|x| x[2] = 0.0);
        let mesh = mesh::join(&[upper, lower]);
        let mut setup = at_rest(&mesh, SHEARED, 0.67, None)?;
        let bodies = [SHEARED; 2];
        let viscosity = Viscosity::default();
        setup.system.solid =
            Solid::new(&mesh, &bodies, Volumetric::Full, viscosity, Level::detect())?;

        let shear = SHEARED.shear();
        let stress = LAW.mu(self.speed) * PRESSURE;
        let approach = PRESSURE * h / SHEARED.young;
        let before = (-0.5 * setup.dt * self.growth).exp();
        for (body, side) in [(0, 1.0), (1, -1.0)] {
            for n in mesh.bodies[body].nodes.clone() {
                let [x, _, z] = mesh.nodes[n].into();
                let inside = z.abs() < 0.5 * h;
                setup.system.fixed.push(Fixed { node: n as u32, axes: [true, false, !inside] });
                let down = if inside { 0.0 } else { -side * approach };
                let half = 0.5 * side * libm::cos(self.wave_number * x);
                let mode = half * self.slip() * (-self.decay * z.abs()).exp();
                setup.displacement[n] = Padded::new([0.0, stress / shear * z + mode.re, down]);
                let speed = 0.5 * side * self.speed + (mode * self.growth * before).re;
                setup.velocity[n] = Padded::new([0.0, speed, 0.0]);
                if (size[0] - x).min(size[2] - z.abs()) < 0.5 * h {
                    // these nodes drive the blocks: no force changes their velocity
                    setup.system.mass[n] = f64::INFINITY;
                    setup.velocity[n] = Padded::new([0.0, 0.5 * side * self.speed, 0.0]);
                    // a small gap keeps contact, which could not move these nodes, from acting on them
                    if inside {
                        setup.displacement[n].0[2] = side * 1e-6 * approach;
                    }
                }
            }
        }
        // On the free sides the complementary shear stress vanishes, unlike in the bodies. These loads balance its
        // couple at the interface; without them the pressure would differ from one side to the other.
        for hex in &mesh.hexes {
            for &node in hex {
                let [_, y, z] = mesh.at(node).into();
                if z.abs() < 0.5 * h {
                    let out = if y > 0.0 { 1.0 } else { -1.0 };
                    setup
                        .system
                        .load
                        .forces
                        .push((node, 0.25 * out * stress * h * h * Vector3::z()));
                }
            }
        }

        let material = contact_material(&SHEARED);
        let surfaces = [&mesh.bodies[0].surfaces["z-"], &mesh.bodies[1].surfaces["z+"]];
        let law = MemoryFromMode {
            law: Remembering { steady: LAW, memory: self.memory },
            steady: LAW.mu(self.speed),
            mode: self.friction(),
            wave_number: self.wave_number,
        };
        let settings = ExactSettings { slave: Some(0), ..ExactSettings::default() };
        let surfaces = surfaces.map(|s| (s, material));
        setup.system.contact =
            Some(ExactContact::new(&mesh, surfaces, &settings, Box::new(law))?.into());
        Ok(setup)
    }
}

/// Friction with memory whose state starts from steady sliding plus a mode instead of from rest.
#[derive(Debug)]
struct MemoryFromMode {
    law: Remembering<Exponential>,
    /// Coefficient of steady sliding, and that of the mode at x = 0.
    steady: f64,
    mode: f64,
    wave_number: f64,
}

impl NodeFriction for MemoryFromMode {
    fn begin(&self, at: &NodeConditions) -> [f64; 2] {
        [self.steady + self.mode * libm::cos(self.wave_number * at.position[0]), 0.0]
    }

    fn advance(&self, state: [f64; 2], slip_speed: f64, at: &NodeConditions, dt: f64) -> [f64; 2] {
        self.law.advance(state, slip_speed, at, dt)
    }

    fn mu(&self, state: [f64; 2], slip_speed: f64, at: &NodeConditions) -> f64 {
        self.law.mu(state, slip_speed, at)
    }

    fn mu_static(&self) -> f64 {
        self.law.mu_static()
    }
}

/// Growth rate (1/s) of `values`, one every `dt` (s): the least-squares slope of the logarithm of their magnitude.
fn slope(values: &[f64], dt: f64) -> f64 {
    let middle = 0.5 * (values.len() as f64 - 1.0);
    let (mut along, mut squares) = (0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        let t = i as f64 - middle;
        along += t * libm::log(value.abs());
        squares += t * t;
    }
    along / squares / dt
}

/// The q (1/s) of the `Re(A exp(q t))` nearest to `values`, one every `dt` (s). With `e = exp(q m dt)` three values m
/// steps apart obey `A_2 - 2 Re(e) A_1 + |e|^2 A_0 = 0`, here in the sense of least squares; m steps are about 1/|q| of
/// the `expected` root.
pub(crate) fn prony(values: &[f64], expected: Complex, dt: f64) -> Complex {
    let m = (1.0 / (expected.norm() * dt)).ceil() as usize;
    // the normal equations of the rows (2 A_1, -A_0) with the right-hand sides A_2
    let ([mut xx, mut xy, mut yy], [mut xr, mut yr]) = ([0.0; 3], [0.0; 2]);
    for i in 0..values.len().saturating_sub(2 * m) {
        let (x, y, r) = (2.0 * values[i + m], -values[i], values[i + 2 * m]);
        (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
        (xr, yr) = (xr + x * r, yr + y * r);
    }
    let determinant = xx * yy - xy * xy;
    let real = (xr * yy - yr * xy) / determinant;
    let square = (xx * yr - xy * xr) / determinant;
    let e = real + Complex::from(real * real - square).sqrt();
    e.ln() / (m as f64 * dt)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_of_a_history_is_found() {
        let dt = 0.01;
        for q in [Complex::new(0.05, 0.8), Complex::new(0.6, 0.08), Complex::new(-0.1, 1.0)] {
            let values: Vec<f64> = (0..1500)
                .map(|i| (Complex::new(0.3, 0.7) * (q * dt * f64::from(i)).exp()).re)
                .collect();
            assert!((prony(&values, 1.1 * q, dt) - q).norm() < 1e-6, "{q}");
        }
        let values: Vec<f64> =
            (0..300).map(|i| -0.2 * libm::exp(3.0 * dt * f64::from(i))).collect();
        assert!((slope(&values, dt) - 3.0).abs() < 1e-12);
    }
}
