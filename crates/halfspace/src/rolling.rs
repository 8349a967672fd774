//! A patch that travels over two half-spaces, with friction.

use crate::compliance::HalfSpaces;
use crate::history::History;
use crate::kernel::{Extent, Kernel, KernelError};
use crate::plane::Plane;
use crate::return_mapping::{Friction, Point, is_non_unique};
use friction::{NodeFriction, Place, Slid};
use realfft::num_complex::Complex64;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A force is met within this part of it.
const MISSED: f64 = 1e-6;
/// Columns of points beyond those that the patch needs.
const SLACK: usize = 1;
/// The columns by which the patch moves on lengthen its memory in turn, in plane strain, by less than this factor.
const CARRIED: f64 = 1.1;
/// Speeds above this part of that of Rayleigh waves are refused: the pressure would no longer be Hertz's.
const FASTEST: f64 = 0.3;

/// The pressure of Hertz's contact: an ellipse, or in plane strain a strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Half axis along x (m).
    pub half_length: f64,
    /// Half axis along y (m); `None` in plane strain.
    pub half_width: Option<f64>,
    /// Largest pressure (Pa).
    pub peak_pressure: f64,
}

impl Ellipse {
    /// Mean pressure (Pa) over a square of the side `h` (m; in plane strain over the length h) about a point relative to the
    /// centre (m): so that a patch that moves over the points bears the same load at any place.
    ///
    /// Exact along x; across by the midpoint rule on four lines.
    pub fn mean_pressure(&self, [x, y]: [f64; 2], h: f64) -> f64 {
        let a = self.half_length;
        // of the integral of sqrt(c^2 - x^2)
        let area = |x: f64, c: f64| {
            let x = x.clamp(-c, c);
            0.5 * (x * (c * c - x * x).max(0.0).sqrt() + c * c * libm::asin(x / c))
        };
        let line = |inside: f64| {
            if inside <= 0.0 {
                return 0.0;
            }
            let c = a * inside.sqrt();
            self.peak_pressure / a * (area(x + 0.5 * h, c) - area(x - 0.5 * h, c)) / h
        };
        let Some(b) = self.half_width else { return line(1.0) };
        let across = (0..LINES).map(|i| y + ((f64::from(i) + 0.5) / f64::from(LINES) - 0.5) * h);
        across.map(|y| line(1.0 - (y / b).powi(2))).sum::<f64>() / f64::from(LINES)
    }
}

/// Lines across a square over which the pressure is taken.
const LINES: u32 = 4;

/// Whether the half-spaces have inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// Waves.
    Dynamic,
    /// The quasi-static limit on the same grid.
    Static,
}

/// The bodies, the patch, its motion and its friction.
#[derive(Clone)]
pub struct Setup {
    /// The bodies.
    pub bodies: HalfSpaces,
    /// Spacing of the grid (m).
    pub spacing: f64,
    /// The pressure.
    pub patch: Ellipse,
    /// Distance of the line of points nearest to y = 0 from it, over the spacing.
    pub offset: f64,
    /// Rolling speed V (m/s).
    pub speed: f64,
    /// Place of the patch's centre at t = 0 (m).
    pub start: f64,
    /// Time step (s).
    pub step: f64,
    /// Whether the half-spaces have inertia.
    pub inertia: Inertia,
    /// The law of friction.
    pub law: Arc<dyn NodeFriction>,
}

/// What is prescribed of the rigid motion of the upper body against the lower one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// Along x: the creepage, positive when driving.
    pub along: Along,
    /// Lateral velocity of the upper body over V, positive along +y.
    pub lateral: f64,
    /// Angular velocity about +z over V (rad/m).
    pub spin: f64,
}

impl Rigid {
    /// Velocity (m/s) of the upper body against the lower one at a point relative to the centre (m), at the speed V, but for
    /// the creepage along x.
    fn carried(&self, v: f64, [x, y]: [f64; 2]) -> [f64; 2] {
        [-v * self.spin * y, v * (self.lateral + self.spin * x)]
    }
}

/// What is prescribed along x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// The upper body's surface slips backward at this share of V.
    Creepage(f64),
    /// The force on the upper body (N; N/m in plane strain).
    Force(f64),
}

/// Why a patch cannot be set up, or cannot go on from a state.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RollingError {
    /// There are no weights.
    #[error(transparent)]
    Kernel(#[from] KernelError),
    /// The patch has too few points.
    #[error("the patch is {points:.1} spacings long")]
    Coarse {
        /// Its length over the spacing.
        points: f64,
    },
    /// A step in which the patch passes more than a spacing.
    #[error("the patch moves by {stride:.2} spacings in a time step")]
    LongStep {
        /// By so many spacings.
        stride: f64,
    },
    /// A patch that is not slow beside waves.
    #[error(
        "the speed is {speed:.1} m/s, and Rayleigh waves run at {rayleigh:.1} m/s: the pressure would not be Hertz's"
    )]
    Fast {
        /// Rolling speed (m/s).
        speed: f64,
        /// Speed of Rayleigh waves (m/s).
        rayleigh: f64,
    },
    /// A state of another model.
    #[error("the state is that of another grid or memory")]
    State,
}

/// Sums over the patch at one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepSums {
    /// Number n of the step.
    pub step: usize,
    /// Its time (s).
    pub time: f64,
    /// Place of the patch's centre (m).
    pub centre: f64,
    /// Normal force (N; N/m in plane strain).
    pub normal: f64,
    /// Shear force on the upper body along x and y (same units).
    pub shear: [f64; 2],
    /// The creepage along x.
    pub creepage: f64,
    /// Points in contact, and those of them that slip.
    pub points: usize,
    /// Points that slip.
    pub slipping: usize,
    /// Points where adhesion and slip both were solutions.
    pub non_unique: usize,
    /// Iterations, and the change of slip velocity in the last one over the largest velocity, where that is above the
    /// tolerance.
    pub iterations: usize,
    /// See `iterations`.
    pub unconverged: f64,
    /// Power of friction, and of the tractions on the elastic surfaces (W; W/m in plane strain).
    pub dissipated: f64,
    /// See `dissipated`.
    pub stored: f64,
    /// Power of what prescribes the rigid motion (same units).
    pub driven: f64,
}

/// Fields at the points of the patch, at the end of a step.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Fields {
    /// Traction on the upper body (Pa).
    pub(crate) shear: [Vec<f64>; 2],
    /// Displacement of the upper surface against the lower one (m), now, one and two steps ago.
    pub(crate) moved: [[Vec<f64>; 2]; 3],
    pub(crate) slip_velocity: [Vec<f64>; 2],
    /// Slip since the point came into contact (m).
    pub(crate) slip: [Vec<f64>; 2],
    pub(crate) pressure: Vec<f64>,
    pub(crate) mu: Vec<f64>,
    /// State of the friction law.
    pub(crate) state: Vec<[f64; 2]>,
    /// 0 open, 1 stick, 2 slip.
    pub(crate) contact: Vec<u8>,
}

impl Fields {
    /// Rate of the displacement `c` of a point (m/s), by the backward difference of second order over the step `dt` (s).
    fn rate(&self, c: usize, i: usize, dt: f64) -> f64 {
        let [now, one, two] = &self.moved;
        (1.5 * now[c][i] - 2.0 * one[c][i] + 0.5 * two[c][i]) / dt
    }
}

/// Everything that a patch needs to roll on with the same bits.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RollingState {
    steps: usize,
    centre: f64,
    backward: f64,
    fields: Fields,
    past: Vec<f64>,
    done: usize,
}

/// A patch that travels over two half-spaces.
pub struct Rolling {
    pub(crate) setup: Setup,
    pub(crate) kernel: KernelFacts,
    pub(crate) plane: Plane,
    pub(crate) history: History,
    steps: usize,
    centre: f64,
    /// Rigid slip of the upper body backward (m/s).
    pub(crate) backward: f64,
    pub(crate) fields: Fields,
    /// Points of the patch: grid index, place relative to the centre (m).
    pub(crate) points: Vec<(usize, [f64; 2])>,
    pub(crate) work: Work,
}

/// What stays of the kernel once the history has its weights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KernelFacts {
    pub(crate) bounds: [f64; 2],
    memory: usize,
    static_tail: f64,
}

/// Buffers of a step.
pub(crate) struct Work {
    pub(crate) spectra: [[Vec<Complex64>; 2]; 2],
    pub(crate) field: Vec<f64>,
    /// Displacement that the past leaves (m).
    pub(crate) left: [Vec<f64>; 2],
    /// Displacement by the present tractions (m).
    pub(crate) now: [Vec<f64>; 2],
    /// Tractions of the iteration before (Pa), and the point from which the next one starts.
    pub(crate) before: [Vec<f64>; 2],
    pub(crate) from: [Vec<f64>; 2],
    /// Free velocity of each point of the patch (m/s), rigid slip included.
    pub(crate) free: Vec<[f64; 2]>,
    pub(crate) found: Vec<Friction>,
    pub(crate) slid: Vec<Slid>,
}

impl Rolling {
    /// A patch at rest, without shear.
    ///
    /// # Errors
    /// A patch of too few points, more weights than fit into memory.
    pub fn new(setup: Setup) -> Result<Self, RollingError> {
        let h = setup.spacing;
        let Ellipse { half_length, half_width, .. } = setup.patch;
        let narrow = 2.0 * half_width.map_or(half_length, |b| b.min(half_length)) / h;
        if narrow.is_nan() || narrow < 4.0 {
            return Err(RollingError::Coarse { points: narrow });
        }
        let stride = setup.speed * setup.step / h;
        if stride.is_nan() || stride > 1.0 {
            return Err(RollingError::LongStep { stride });
        }
        let slowest = setup.bodies.rayleigh_speed();
        if setup.speed > FASTEST * slowest {
            return Err(RollingError::Fast { speed: setup.speed, rayleigh: slowest });
        }
        // squares that the patch touches bear pressure, too
        let reach = |half: f64| (2.0 * half / h).floor() as usize + 2;
        // the Rayleigh wave of the rear reaches a front that goes on
        let diameter = 2.0 * half_width.map_or(half_length, |b| b.max(half_length))
            / (1.0 - setup.speed / slowest);
        let extent = |columns: usize| Extent {
            spacing: h,
            reach: (reach(half_length) + SLACK + columns, half_width.map(reach)),
            diameter,
        };
        // columns by which the patch moves on within its memory, and that of the two steps before
        let lags = match setup.inertia {
            Inertia::Dynamic => Kernel::lags(&setup.bodies, &extent(0), setup.step),
            Inertia::Static => 0,
        };
        let extent = extent((stride * (lags + 2) as f64 * CARRIED).ceil() as usize);
        let kernel = match setup.inertia {
            Inertia::Dynamic => Kernel::new(&setup.bodies, &extent, setup.step)?,
            // the weights of any step have the same sum
            Inertia::Static => {
                Kernel::new(&setup.bodies, &extent, 0.5 * h / setup.bodies.pressure_speed)?
                    .without_inertia(&setup.bodies, h)
            }
        };
        let plane = Plane::new(kernel.grid[0], kernel.grid[1]);
        let (points, modes) = (plane.points(), plane.modes());
        let zeros = || vec![0.0; points];
        let pair = || [zeros(), zeros()];
        let spectra = || [vec![Complex64::ZERO; modes], vec![Complex64::ZERO; modes]];
        let fields = Fields {
            shear: pair(),
            moved: [pair(), pair(), pair()],
            slip_velocity: pair(),
            slip: pair(),
            pressure: zeros(),
            mu: vec![setup.law.mu_static(); points],
            state: vec![[0.0; 2]; points],
            contact: vec![0; points],
        };
        let facts = KernelFacts {
            bounds: kernel.bounds,
            memory: kernel.memory(),
            static_tail: kernel.static_tail,
        };
        Ok(Self {
            kernel: facts,
            history: History::new(&kernel),
            work: Work {
                spectra: [spectra(), spectra()],
                field: zeros(),
                left: pair(),
                now: pair(),
                before: pair(),
                from: pair(),
                free: Vec::with_capacity(points),
                found: Vec::with_capacity(points),
                slid: Vec::with_capacity(points),
            },
            plane,
            steps: 0,
            centre: setup.start,
            backward: 0.0,
            fields,
            points: Vec::with_capacity(points),
            setup,
        })
    }

    /// Takes a step: the patch moves on by V dt (not at all where `speed` is zero), and friction is solved at its end.
    pub fn step(&mut self, rigid: Rigid) -> StepSums {
        let step = self.setup.step;
        self.steps += 1;
        self.centre += self.setup.speed * step;
        self.list_points();
        self.advance_friction();
        let Self { fields, history, plane, work, .. } = self;
        // the displacement of two steps ago makes room for the present one
        fields.moved.rotate_right(1);
        history.left(&mut work.spectra[0]);
        for c in 0..2 {
            plane.inverse(&mut work.spectra[0][c], &mut work.left[c]);
        }
        self.free_velocities(rigid);
        let (backward, iterations, unconverged) = self.solve(rigid);
        self.backward = backward;
        let sums = self.take_over(rigid);
        // a force that no creepage gives, as where the law lets go of more at once
        let missed = match rigid.along {
            Along::Force(force) if force != 0.0 => (sums.shear[0] / force - 1.0).abs(),
            _ => 0.0,
        };
        let unconverged = if missed > MISSED { missed.max(unconverged) } else { unconverged };
        StepSums { iterations, unconverged, ..sums }
    }

    /// Lists the points of the patch at its present place, and opens those that it has left.
    fn list_points(&mut self) {
        let (h, ellipse) = (self.setup.spacing, self.setup.patch);
        let a = ellipse.half_length;
        self.points.clear();
        // squares that the patch touches: those of points up to half a spacing beyond it
        let a = a + 0.5 * h;
        let columns =
            ((self.centre - a) / h).ceil() as i64..=((self.centre + a) / h).floor() as i64;
        let offset = self.setup.offset;
        let lines = match ellipse.half_width {
            Some(b) => {
                let b = b / h + 0.5;
                (-b - offset).ceil() as i64..=(b - offset).floor() as i64
            }
            None => 0..=0,
        };
        self.work.field.fill(0.0);
        for j in lines {
            for i in columns.clone() {
                let at = [i as f64 * h - self.centre, (j as f64 + offset) * h];
                let pressure = ellipse.mean_pressure(at, h);
                if pressure > 0.0 {
                    let index = self.index(i, j);
                    self.work.field[index] = pressure;
                    self.points.push((index, at));
                }
            }
        }
        let fields = &mut self.fields;
        for i in 0..fields.pressure.len() {
            let pressure = self.work.field[i];
            if pressure == 0.0 && fields.contact[i] != 0 {
                fields.contact[i] = 0;
                fields.mu[i] = self.setup.law.mu_static();
                for c in 0..2 {
                    fields.shear[c][i] = 0.0;
                    fields.slip_velocity[c][i] = 0.0;
                    fields.slip[c][i] = 0.0;
                }
            }
            fields.pressure[i] = pressure;
        }
    }

    /// Grid index of a point of the material (columns and lines from x = 0 and y = 0).
    fn index(&self, column: i64, line: i64) -> usize {
        let (nx, ny) = (self.plane.nx as i64, self.plane.ny as i64);
        (column.rem_euclid(nx) + nx * line.rem_euclid(ny)) as usize
    }

    pub(crate) fn place(&self, index: usize, at: [f64; 2]) -> Place {
        Place {
            position: [at[0] + self.centre, at[1], 0.0],
            time: self.time(),
            pressure: self.fields.pressure[index],
        }
    }

    /// Brings the states of the friction law to this step.
    fn advance_friction(&mut self) {
        let mut slid = std::mem::take(&mut self.work.slid);
        slid.clear();
        for &(i, at) in &self.points {
            let s = [0, 1].map(|c| self.fields.slip_velocity[c][i]);
            slid.push(Slid {
                state: self.fields.state[i],
                slip_speed: libm::hypot(s[0], s[1]),
                at: self.place(i, at),
            });
        }
        // a law that is expensive to call is called once
        let old = |i: &(usize, [f64; 2])| self.fields.contact[i.0] != 0;
        if self.points.iter().all(old) {
            self.setup.law.advance_all(&mut slid, self.setup.step);
            for (&(i, _), s) in self.points.iter().zip(&slid) {
                self.fields.state[i] = s.state;
            }
        } else {
            let mut some: Vec<Slid> =
                self.points.iter().zip(&slid).filter(|(p, _)| old(p)).map(|(_, s)| *s).collect();
            self.setup.law.advance_all(&mut some, self.setup.step);
            let mut next = some.into_iter();
            for (&(i, _), s) in self.points.iter().zip(&slid) {
                self.fields.state[i] = if self.fields.contact[i] == 0 {
                    self.setup.law.begin(&s.at)
                } else {
                    next.next().map_or(s.state, |s| s.state)
                };
            }
        }
        self.work.slid = slid;
    }

    /// The velocities that the points would have without the present tractions (m/s), but for the creepage along x.
    fn free_velocities(&mut self, rigid: Rigid) {
        let (v, step) = (self.setup.speed, self.setup.step);
        let [_, one, two] = &self.fields.moved;
        self.work.free.clear();
        for &(i, at) in &self.points {
            let elastic =
                |c: usize| (1.5 * self.work.left[c][i] - 2.0 * one[c][i] + 0.5 * two[c][i]) / step;
            let carried = rigid.carried(v, at);
            self.work.free.push([0, 1].map(|c| elastic(c) + carried[c]));
        }
    }

    pub(crate) fn point(&self, i: usize, at: [f64; 2]) -> Point<'_> {
        Point {
            law: &*self.setup.law,
            state: self.fields.state[i],
            at: self.place(i, at),
            slipped: self.fields.contact[i] == 2,
        }
    }

    /// Takes over the tractions that were found, and sums them up.
    fn take_over(&mut self, rigid: Rigid) -> StepSums {
        for c in 0..2 {
            let (from, to) = (&self.work.before[c], &mut self.work.from[c]);
            to.copy_from_slice(from);
        }
        self.displace();
        let cell = self.cell();
        let mut sums = StepSums {
            step: self.steps,
            time: self.time(),
            centre: self.centre,
            creepage: self.backward / self.setup.speed,
            points: self.points.len(),
            ..StepSums::default()
        };
        for c in 0..2 {
            let (left, now) = (&self.work.left[c], &self.work.now[c]);
            for (to, (left, now)) in self.fields.moved[0][c].iter_mut().zip(left.iter().zip(now)) {
                *to = left + now;
            }
        }
        let step = self.setup.step;
        for (k, &(i, at)) in self.points.iter().enumerate() {
            let found = self.work.found[k];
            let mut carried = rigid.carried(self.setup.speed, at);
            carried[0] -= self.backward;
            let compliance = self.local_compliance();
            let free = [0, 1].map(|c| found.slip_velocity[c] - compliance * found.shear[c]);
            let many = is_non_unique(&self.point(i, at), free, compliance);
            sums.non_unique += usize::from(many);
            let fields = &mut self.fields;
            fields.mu[i] = found.mu;
            fields.contact[i] = if found.slips { 2 } else { 1 };
            sums.normal += cell * fields.pressure[i];
            sums.slipping += usize::from(found.slips);
            for c in 0..2 {
                fields.shear[c][i] = found.shear[c];
                fields.slip_velocity[c][i] = found.slip_velocity[c];
                fields.slip[c][i] += step * found.slip_velocity[c];
                sums.shear[c] += cell * found.shear[c];
                sums.dissipated -= cell * found.shear[c] * found.slip_velocity[c];
                sums.stored += cell * found.shear[c] * fields.rate(c, i, step);
                sums.driven -= cell * found.shear[c] * carried[c];
            }
        }
        self.history.push(&self.work.spectra[0]);
        sums
    }

    /// Area of a point (m^2); in plane strain its length (m).
    pub(crate) fn cell(&self) -> f64 {
        let h = self.setup.spacing;
        if self.setup.patch.half_width.is_some() { h * h } else { h }
    }

    /// Time of the last step (s).
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.setup.step
    }

    /// Steps of memory, and the share of the static compliance that is felt at its static value from the memory's
    /// end on.
    pub fn memory(&self) -> (usize, f64) {
        (self.kernel.memory, self.kernel.static_tail)
    }

    /// Points of the grid along x and y.
    pub fn grid(&self) -> [usize; 2] {
        [self.plane.nx, self.plane.ny]
    }

    /// The points in contact: column and line of the material, and what holds there.
    pub fn patch(&self) -> impl Iterator<Item = PatchPoint> + '_ {
        let h = self.setup.spacing;
        self.points.iter().map(move |&(i, at)| PatchPoint {
            column: ((at[0] + self.centre) / h).round() as i64,
            line: (at[1] / h - self.setup.offset).round() as i64,
            at,
            pressure: self.fields.pressure[i],
            shear: [0, 1].map(|c| self.fields.shear[c][i]),
            slip_velocity: [0, 1].map(|c| self.fields.slip_velocity[c][i]),
            slip: [0, 1].map(|c| self.fields.slip[c][i]),
            displacement: [0, 1].map(|c| self.fields.moved[0][c][i]),
            rate: [0, 1].map(|c| self.fields.rate(c, i, self.setup.step)),
            mu: self.fields.mu[i],
            slips: self.fields.contact[i] == 2,
        })
    }

    /// The state, to roll on from with the same bits.
    pub fn snapshot(&self) -> RollingState {
        let (past, done) = self.history.snapshot();
        let Self { steps, centre, backward, fields, .. } = self;
        RollingState {
            steps: *steps,
            centre: *centre,
            backward: *backward,
            fields: fields.clone(),
            past,
            done,
        }
    }

    /// Takes over the state of a patch of the same setup.
    ///
    /// # Errors
    /// A state of another grid or memory.
    pub fn restore(&mut self, state: &RollingState) -> Result<(), RollingError> {
        let n = self.plane.points();
        let Fields { shear, moved, slip_velocity, slip, pressure, mu, state: law, contact } =
            &state.fields;
        let pairs = [shear, slip_velocity, slip].into_iter().chain(moved);
        let fits = pairs.flatten().chain([pressure, mu]).all(|values| values.len() == n)
            && law.len() == n
            && contact.len() == n;
        if !fits || !self.history.restore(&state.past, state.done) {
            return Err(RollingError::State);
        }
        (self.steps, self.centre, self.backward) = (state.steps, state.centre, state.backward);
        self.fields = state.fields.clone();
        Ok(())
    }

    /// Place of the patch's centre (m).
    pub fn centre(&self) -> f64 {
        self.centre
    }

    /// The law's coefficient of friction at rest.
    pub fn mu_static(&self) -> f64 {
        self.setup.law.mu_static()
    }

    /// Steps taken.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Time step (s).
    pub fn step_length(&self) -> f64 {
        self.setup.step
    }

    /// Bytes of the memory of past tractions and its weights.
    pub fn bytes(&self) -> usize {
        self.history.bytes()
    }

    /// Changes the rolling speed (m/s), from the next step on.
    pub fn set_speed(&mut self, speed: f64) {
        self.setup.speed = speed;
    }
}

/// What holds at a point of the patch; tractions act on the upper body, and motion is its against the lower one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchPoint {
    /// Column of the material, x over the spacing.
    pub column: i64,
    /// Line of the material, y over the spacing.
    pub line: i64,
    /// Place relative to the patch's centre (m).
    pub at: [f64; 2],
    /// Pressure (Pa).
    pub pressure: f64,
    /// Shear traction (Pa).
    pub shear: [f64; 2],
    /// Slip velocity (m/s).
    pub slip_velocity: [f64; 2],
    /// Slip since the point came into contact (m).
    pub slip: [f64; 2],
    /// Elastic displacement (m) and its rate (m/s).
    pub displacement: [f64; 2],
    /// See `displacement`.
    pub rate: [f64; 2],
    /// Coefficient of friction.
    pub mu: f64,
    /// Whether it slips.
    pub slips: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use friction::{Coulomb, Exponential, Implicit, Memory, Remembering};

    const LAW: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };

    fn setup(width: Option<f64>, law: Arc<dyn NodeFriction>) -> Setup {
        let bodies = HalfSpaces::new(210e9, 0.3, 7850.0);
        let spacing = 1e-3;
        Setup {
            bodies,
            spacing,
            patch: Ellipse { half_length: 6e-3, half_width: width, peak_pressure: 1e9 },
            offset: 0.0,
            speed: 40.0,
            start: 0.0,
            step: 0.5 * spacing / bodies.pressure_speed,
            inertia: Inertia::Dynamic,
            law,
        }
    }

    fn driven(creepage: f64) -> Rigid {
        Rigid { along: Along::Creepage(creepage), lateral: 0.5 * creepage, spin: 0.0 }
    }

    #[test]
    fn friction_holds_at_every_point_and_spends_what_the_drive_gives() {
        let memory = Memory { distance: 3e-6, floor: 1e-2 };
        let laws: [Arc<dyn NodeFriction>; 3] = [
            Arc::new(Coulomb { mu: 0.4 }),
            Arc::new(Implicit(LAW)),
            Arc::new(Remembering { steady: LAW, memory }),
        ];
        for law in laws {
            for width in [Some(4e-3), None] {
                let mut rolling = Rolling::new(setup(width, Arc::clone(&law))).unwrap();
                let (mut slipped, mut balance, mut driven_by) = (false, 0.0, 0.0);
                for _ in 0..3000 {
                    let sums = rolling.step(driven(0.01));
                    assert_eq!(sums.unconverged, 0.0);
                    balance += sums.driven - sums.stored - sums.dissipated;
                    driven_by += sums.driven;
                    for p in rolling.patch() {
                        let size = |v: [f64; 2]| libm::hypot(v[0], v[1]);
                        let (tau, bound) = (size(p.shear), p.mu * p.pressure);
                        assert!(tau <= bound * (1.0 + 1e-14), "{p:?}");
                        let power =
                            p.shear[0] * p.slip_velocity[0] + p.shear[1] * p.slip_velocity[1];
                        let full = -tau * size(p.slip_velocity);
                        assert!((power - full).abs() <= 1e-13 * full.abs(), "{p:?}");
                        assert!(p.slips || p.slip_velocity == [0.0; 2]);
                        slipped |= p.slips;
                    }
                }
                assert!(slipped && driven_by > 0.0);
                assert!(balance.abs() < 1e-7 * driven_by, "{balance} {driven_by}");
            }
        }
    }

    #[test]
    fn a_patch_goes_on_from_its_state_with_the_same_bits() {
        let law =
            Arc::new(Remembering { steady: LAW, memory: Memory { distance: 1e-6, floor: 1e-2 } });
        let mut whole = Rolling::new(setup(Some(4e-3), law.clone())).unwrap();
        let mut parted = Rolling::new(setup(Some(4e-3), law.clone())).unwrap();
        for _ in 0..700 {
            whole.step(driven(0.01));
            parted.step(driven(0.01));
        }
        let state = parted.snapshot();
        let mut parted = Rolling::new(setup(Some(4e-3), law)).unwrap();
        parted.restore(&state).unwrap();
        for _ in 0..700 {
            assert_eq!(whole.step(driven(0.01)), parted.step(driven(0.01)));
        }
        assert!(whole.patch().eq(parted.patch()));
        let mut other = Rolling::new(setup(None, Arc::new(Coulomb { mu: 0.4 }))).unwrap();
        assert_eq!(other.restore(&state), Err(RollingError::State));
    }

    #[test]
    fn the_number_of_threads_changes_no_bit() {
        let sums = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut rolling =
                    Rolling::new(setup(Some(4e-3), Arc::new(Coulomb { mu: 0.4 }))).unwrap();
                (0..400).map(|_| rolling.step(driven(0.01))).next_back().unwrap()
            })
        };
        assert_eq!(sums(1), sums(3));
    }

    #[test]
    fn a_force_is_met_at_every_step() {
        let mut rolling = Rolling::new(setup(Some(4e-3), Arc::new(Coulomb { mu: 0.4 }))).unwrap();
        for n in 1..=500 {
            let force = 2.0 * f64::from(n);
            let rigid = Rigid { along: Along::Force(force), lateral: 0.0, spin: 0.0 };
            let sums = rolling.step(rigid);
            assert!((sums.shear[0] / force - 1.0).abs() < 1e-7, "{sums:?}");
        }
    }

    #[test]
    fn a_patch_of_few_points_is_refused() {
        let coarse = Setup { spacing: 4e-3, ..setup(Some(4e-3), Arc::new(Coulomb { mu: 0.4 })) };
        assert!(matches!(Rolling::new(coarse), Err(RollingError::Coarse { .. })));
    }
}
