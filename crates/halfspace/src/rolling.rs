//! A patch that travels over two half-spaces, with friction.

#[cfg(test)]
mod tests;

use crate::compliance::HalfSpaces;
use crate::history::{History, Symmetry};
use crate::kernel::{Extent, Kernel, KernelError};
use crate::patch::Patch;
use crate::plane::Plane;
use crate::return_mapping::{Friction, TrialPoint, is_non_unique};
use friction::{NodeConditions, NodeFriction, NodeHistory};
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

/// Whether the half-spaces have inertia.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inertia {
    /// Waves.
    Dynamic,
    /// The quasi-static limit on the same grid.
    Static,
}

/// Factor of the pressure at a column and a line of the material.
pub type PressureFactor = Arc<dyn Fn([i64; 2]) -> f64 + Send + Sync>;

/// The bodies, the patch, its motion and its friction.
#[derive(Clone)]
pub struct Setup {
    /// The bodies.
    pub bodies: HalfSpaces,
    /// Spacing of the grid (m).
    pub spacing: f64,
    /// The pressure.
    pub patch: Patch,
    /// Distance of the line of points nearest to y = 0 from it, over the spacing.
    pub offset: f64,
    /// Rolling speed V (m/s).
    pub speed: f64,
    /// NodeConditions of the patch's centre at t = 0 (m).
    pub start: f64,
    /// Time step (s).
    pub step: f64,
    /// Whether the half-spaces have inertia.
    pub inertia: Inertia,
    /// The law of friction.
    pub law: Arc<dyn NodeFriction>,
    /// Disturbs the pressure of each point of the material; none leaves it as the patch's.
    pub pressure_factor: Option<PressureFactor>,
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
    /// NodeConditions of the patch's centre (m).
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
    /// Those that begin to slip although adhesion is a solution: the iteration settled without perfect delay.
    pub undelayed: usize,
    /// Iterations, and the change of slip velocity in the last one over the largest trial velocity where that is above the
    /// tolerance, or the part of a prescribed force that is missed.
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
    /// Rate of the displacement `c` of a point (m/s), by the rates per displacement (1/s) of [`Rolling::difference`].
    fn rate(&self, c: usize, i: usize, by: [f64; 3]) -> f64 {
        by.iter().zip(&self.moved).map(|(by, moved)| by * moved[c][i]).sum()
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
    /// Coefficients of friction that stand for the law's; none while it is evaluated at every point.
    pub(crate) coefficients: Vec<f64>,
    pub(crate) slid: Vec<NodeHistory>,
}

impl Rolling {
    /// A patch at rest, without shear.
    ///
    /// # Errors
    /// A patch of too few points, more weights than fit into memory.
    pub fn new(setup: Setup) -> Result<Self, RollingError> {
        let h = setup.spacing;
        let long = |[low, high]: [f64; 2]| high - low;
        let (length, width) = (long(setup.patch.along()), setup.patch.across().map(long));
        let narrow = width.map_or(length, |width| width.min(length)) / h;
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
        let reach = |length: f64| (length / h).floor() as usize + 2;
        // the Rayleigh wave of the rear reaches a front that goes on
        let longest = width.map_or(length, |width| width.max(length));
        let diameter = longest / (1.0 - setup.speed / slowest);
        let extent = |columns: usize| Extent {
            spacing: h,
            reach: (reach(length) + SLACK + columns, width.map(reach)),
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
            history: History::new(&kernel, Symmetry::None),
            work: Work {
                spectra: [spectra(), spectra()],
                field: zeros(),
                left: pair(),
                now: pair(),
                before: pair(),
                from: pair(),
                free: Vec::with_capacity(points),
                found: Vec::with_capacity(points),
                coefficients: Vec::with_capacity(points),
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
        let h = self.setup.spacing;
        self.points.clear();
        // squares that the patch touches: those of points up to half a spacing beyond it
        let [rear, front] = self.setup.patch.along();
        let columns = ((self.centre + (rear - 0.5 * h)) / h).ceil() as i64
            ..=((self.centre + (front + 0.5 * h)) / h).floor() as i64;
        let offset = self.setup.offset;
        let lines = match self.setup.patch.across() {
            Some([right, left]) => {
                (right / h - 0.5 - offset).ceil() as i64..=(left / h + 0.5 - offset).floor() as i64
            }
            None => 0..=0,
        };
        self.work.field.fill(0.0);
        for j in lines {
            for i in columns.clone() {
                let at = [i as f64 * h - self.centre, (j as f64 + offset) * h];
                let factor = self.setup.pressure_factor.as_ref().map_or(1.0, |of| of([i, j]));
                let pressure = factor * self.setup.patch.mean_pressure(at, h);
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

    pub(crate) fn place(&self, index: usize, at: [f64; 2]) -> NodeConditions {
        NodeConditions {
            position: [at[0] + self.centre, at[1], 0.0],
            time: self.time(),
            pressure: self.fields.pressure[index],
        }
    }

    /// Brings the states of the friction law to this step; those of points that come into contact begin.
    fn advance_friction(&mut self) {
        let mut slid = std::mem::take(&mut self.work.slid);
        slid.clear();
        for &(i, at) in &self.points {
            let at = self.place(i, at);
            if self.fields.contact[i] == 0 {
                self.fields.state[i] = self.setup.law.begin(&at);
                continue;
            }
            let s = [0, 1].map(|c| self.fields.slip_velocity[c][i]);
            let slip_speed = libm::hypot(s[0], s[1]);
            slid.push(NodeHistory { state: self.fields.state[i], slip_speed, at });
        }
        self.setup.law.advance_all(&mut slid, self.setup.step);
        let Fields { contact, state, .. } = &mut self.fields;
        let touched = self.points.iter().filter(|(i, _)| contact[*i] != 0);
        touched.zip(&slid).for_each(|(&(i, _), s)| state[i] = s.state);
        self.work.slid = slid;
    }

    /// The backward difference in time, as rates (1/s) per displacement now, one and two steps ago. It is of second order but in
    /// the first step: nothing moved before, so that a motion that begins suddenly would begin half a step late.
    pub(crate) fn difference(&self) -> [f64; 3] {
        let of_step = if self.steps == 1 { [1.0, -1.0, 0.0] } else { [1.5, -2.0, 0.5] };
        of_step.map(|weight| weight / self.setup.step)
    }

    /// The velocities that the points would have without the present tractions (m/s), but for the creepage along x.
    fn free_velocities(&mut self, rigid: Rigid) {
        let v = self.setup.speed;
        let [of_now, of_one, of_two] = self.difference();
        let [_, one, two] = &self.fields.moved;
        self.work.free.clear();
        for &(i, at) in &self.points {
            let elastic =
                |c: usize| of_now * self.work.left[c][i] + of_one * one[c][i] + of_two * two[c][i];
            let carried = rigid.carried(v, at);
            self.work.free.push([0, 1].map(|c| elastic(c) + carried[c]));
        }
    }

    pub(crate) fn point(&self, i: usize, at: [f64; 2]) -> TrialPoint<'_> {
        TrialPoint {
            law: &*self.setup.law,
            state: self.fields.state[i],
            at: self.place(i, at),
            slipped: self.fields.contact[i] == 2,
            coefficient: None,
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
        let (step, difference) = (self.setup.step, self.difference());
        let compliance = self.local_compliance();
        for (k, &(i, at)) in self.points.iter().enumerate() {
            let found = self.work.found[k];
            let mut carried = rigid.carried(self.setup.speed, at);
            carried[0] -= self.backward;
            let free = [0, 1].map(|c| found.slip_velocity[c] - compliance * found.shear[c]);
            let point = self.point(i, at);
            let many = is_non_unique(&point, free, compliance);
            sums.non_unique += usize::from(many);
            sums.undelayed += usize::from(many && found.slips && !point.slipped);
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
                sums.stored += cell * found.shear[c] * fields.rate(c, i, difference);
                sums.driven -= cell * found.shear[c] * carried[c];
            }
        }
        self.history.push(&self.work.spectra[0]);
        sums
    }

    /// Area of a point (m^2); in plane strain its length (m).
    pub(crate) fn cell(&self) -> f64 {
        let h = self.setup.spacing;
        if self.setup.patch.across().is_some() { h * h } else { h }
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
        let (h, difference) = (self.setup.spacing, self.difference());
        self.points.iter().map(move |&(i, at)| PatchPoint {
            column: ((at[0] + self.centre) / h).round() as i64,
            line: (at[1] / h - self.setup.offset).round() as i64,
            at,
            pressure: self.fields.pressure[i],
            shear: [0, 1].map(|c| self.fields.shear[c][i]),
            slip_velocity: [0, 1].map(|c| self.fields.slip_velocity[c][i]),
            slip: [0, 1].map(|c| self.fields.slip[c][i]),
            displacement: [0, 1].map(|c| self.fields.moved[0][c][i]),
            rate: [0, 1].map(|c| self.fields.rate(c, i, difference)),
            mu: self.fields.mu[i],
            slips: self.fields.contact[i] == 2,
        })
    }

    /// The state, to roll on from with the same bits.
    pub fn snapshot(&self) -> RollingState {
        let Self { steps, centre, backward, fields, .. } = self;
        RollingState {
            steps: *steps,
            centre: *centre,
            backward: *backward,
            fields: fields.clone(),
            past: self.history.snapshot(),
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
        if !fits || !self.history.restore(&state.past, state.steps) {
            return Err(RollingError::State);
        }
        (self.steps, self.centre, self.backward) = (state.steps, state.centre, state.backward);
        self.fields = state.fields.clone();
        Ok(())
    }

    /// NodeConditions of the patch's centre (m).
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
    /// NodeConditions relative to the patch's centre (m).
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
