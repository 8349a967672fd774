//! A plane between two half-spaces that stands under initial stress, with friction at every point: spontaneous rupture.

use crate::compliance::HalfSpaces;
use crate::history::{History, Symmetry};
use crate::kernel::{Extent, Kernel, KernelError};
use crate::plane::Plane;
use crate::return_mapping::{TrialPoint, return_mapping};
use friction::{NodeConditions, NodeFriction, NodeHistory};
use realfft::num_complex::Complex64;
use std::sync::Arc;

/// Iterations of a step at most, and the change of slip velocity, over the largest trial velocity, at which they end.
const MOST_ITERATIONS: usize = 200;
const CONVERGED: f64 = 1e-10;

/// The bodies, the rectangle that bears stress, and its friction.
///
/// Stress and friction are alike on both sides of x = 0 and of y = 0: then shear and slip along x are even in x and in y, those along y
/// odd in both, and a quarter of the rectangle tells all.
///
/// Beyond the rectangle the change of traction counts as zero: it must reach so far that what this sends back comes late.
#[derive(Clone)]
pub struct FaultSetup {
    /// The bodies.
    pub bodies: HalfSpaces,
    /// Spacing of the points (m).
    pub spacing: f64,
    /// Points from the middle to an edge of the rectangle along x and y, the middle one excluded.
    pub reach: [usize; 2],
    /// Time step (s).
    pub step: f64,
    /// Time up to which waves are remembered (s).
    pub end: f64,
    /// Pressure (Pa), which shear does not change.
    pub pressure: f64,
    /// Initial shear traction on the upper body along x at a place (Pa).
    pub shear: fn([f64; 2], f64) -> f64,
    /// The law of friction.
    pub law: Arc<dyn NodeFriction>,
}

/// Fields at the points of the quarter `x >= 0`, `y >= 0` of the rectangle, x fastest.
#[derive(Clone, Debug, Default)]
struct Fields {
    /// Initial shear along x, and change of shear along x and y since then (Pa).
    initial: Vec<f64>,
    change: [Vec<f64>; 2],
    slip_velocity: [Vec<f64>; 2],
    state: Vec<[f64; 2]>,
    slips: Vec<bool>,
}

/// A fault under way.
pub struct Fault {
    setup: FaultSetup,
    compliance: f64,
    plane: Plane,
    history: History,
    steps: usize,
    fields: Fields,
    /// Grid index and place (m) of each point of the quarter, and its grid indices and signs with those of its mirror images.
    points: Vec<(usize, [f64; 2])>,
    images: [Vec<[(usize, f64); 4]>; 2],
    /// Displacement of the upper surface against the lower one on the grid (m): now, one and two steps ago.
    moved: [[Vec<f64>; 2]; 3],
    /// What the past leaves of it, and tractions on the grid (Pa).
    left: [Vec<f64>; 2],
    tractions: [Vec<f64>; 2],
    spectra: [[Vec<Complex64>; 2]; 2],
    slid: Vec<NodeHistory>,
}

impl Fault {
    /// A fault at rest under its initial stress.
    ///
    /// # Errors
    /// More weights than fit into memory.
    pub fn new(setup: FaultSetup) -> Result<Self, KernelError> {
        let counts = setup.reach.map(|n| 2 * n + 1);
        let extent = Extent {
            spacing: setup.spacing,
            reach: (counts[0] - 1, Some(counts[1] - 1)),
            diameter: setup.end * setup.bodies.rayleigh_speed(),
        };
        let kernel = Kernel::new(&setup.bodies, &extent, setup.step)?;
        let plane = Plane::new(kernel.grid[0], kernel.grid[1]);
        let quarter: Vec<_> =
            (0..=setup.reach[1]).flat_map(|j| (0..=setup.reach[0]).map(move |i| [i, j])).collect();
        let place = |at: [usize; 2]| at.map(|i| setup.spacing * i as f64);
        let points: Vec<_> =
            quarter.iter().map(|&at| (at[0] + plane.nx * at[1], place(at))).collect();
        let images = [0, 1].map(|c| quarter.iter().map(|&at| plane.images(at, c)).collect());
        let n = points.len();
        let fields = Fields {
            initial: points.iter().map(|(_, at)| (setup.shear)(*at, setup.spacing)).collect(),
            change: [vec![0.0; n], vec![0.0; n]],
            slip_velocity: [vec![0.0; n], vec![0.0; n]],
            state: points
                .iter()
                .map(|(_, at)| setup.law.begin(&whereabouts(&setup, *at, 0.0)))
                .collect(),
            slips: vec![false; n],
        };
        let [least, most] = kernel.bounds;
        let grid = || [0, 1].map(|_| vec![0.0; plane.points()]);
        let spectra = || [0, 1].map(|_| vec![Complex64::ZERO; plane.modes()]);
        Ok(Self {
            compliance: 0.5 * 1.5 / setup.step * (least + most),
            history: History::new(&kernel, Symmetry::Mirrored),
            steps: 0,
            fields,
            moved: [grid(), grid(), grid()],
            left: grid(),
            tractions: grid(),
            spectra: [spectra(), spectra()],
            slid: Vec::with_capacity(n),
            points,
            images,
            plane,
            setup,
        })
    }

    /// Takes a step; whether friction was solved.
    pub fn step(&mut self) -> bool {
        self.steps += 1;
        let time = self.time();
        self.advance_friction();
        self.moved.rotate_right(1);
        self.history.left(&mut self.spectra[0]);
        for c in 0..2 {
            self.plane.inverse(&mut self.spectra[0][c], &mut self.left[c]);
        }
        let rate = 1.5 / self.setup.step;
        let compliance = self.compliance;
        for _ in 0..MOST_ITERATIONS {
            self.displace();
            let (mut change, mut largest) = (0.0_f64, 0.0_f64);
            let Self { fields, moved: [now, one, two], setup, .. } = self;
            for (k, &(i, at)) in self.points.iter().enumerate() {
                let free = [0, 1].map(|c| {
                    let moves = rate * now[c][i] - (2.0 * one[c][i] - 0.5 * two[c][i]) / setup.step;
                    let initial = if c == 0 { fields.initial[k] } else { 0.0 };
                    moves - compliance * (fields.change[c][k] + initial)
                });
                let at = whereabouts(setup, at, time);
                let (state, slipped) = (fields.state[k], fields.slips[k]);
                let point = TrialPoint { law: &*setup.law, state, at, slipped, coefficient: None };
                let found = return_mapping(&point, free, compliance);
                for c in 0..2 {
                    let initial = if c == 0 { fields.initial[k] } else { 0.0 };
                    let next = found.shear[c] - initial;
                    change = change.max(compliance * (next - fields.change[c][k]).abs());
                    largest = largest.max(free[c].abs());
                    fields.change[c][k] = next;
                    fields.slip_velocity[c][k] = found.slip_velocity[c];
                }
                fields.slips[k] = found.slips;
            }
            if change <= CONVERGED * largest {
                self.displace();
                self.history.push(&self.spectra[0]);
                return true;
            }
        }
        false
    }

    /// The displacement by the tractions of this instant and by those before.
    fn displace(&mut self) {
        let [tractions, found] = &mut self.spectra;
        for c in 0..2 {
            for (images, change) in self.images[c].iter().zip(&self.fields.change[c]) {
                images.iter().for_each(|&(i, sign)| self.tractions[c][i] = sign * change);
            }
            self.plane.forward(&self.tractions[c], &mut tractions[c]);
        }
        self.history.now(tractions, found);
        for c in 0..2 {
            let now = &mut self.moved[0][c];
            self.plane.inverse(&mut found[c], now);
            now.iter_mut().zip(&self.left[c]).for_each(|(now, left)| *now += left);
        }
    }

    /// Brings the states of the law to this step.
    fn advance_friction(&mut self) {
        let time = self.time();
        let Self { fields, points, slid, setup, .. } = self;
        slid.clear();
        slid.extend(points.iter().enumerate().map(|(k, (_, at))| {
            let [x, y] = [0, 1].map(|c| fields.slip_velocity[c][k]);
            let at = whereabouts(setup, *at, time);
            NodeHistory { state: fields.state[k], slip_speed: libm::hypot(x, y), at }
        }));
        setup.law.advance_all(slid, setup.step);
        fields.state.iter_mut().zip(&*slid).for_each(|(state, slid)| *state = slid.state);
    }

    /// Time of the last step (s).
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.setup.step
    }

    /// NodeConditions (m), slip velocity (m/s) and shear traction on the upper body (Pa) of each point of
    /// the quarter `x >= 0`, `y >= 0`.
    pub fn points(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2], [f64; 2])> + '_ {
        let Fields { initial, change, slip_velocity, .. } = &self.fields;
        self.points.iter().enumerate().map(move |(k, (_, at))| {
            let slip_velocity = [slip_velocity[0][k], slip_velocity[1][k]];
            (*at, slip_velocity, [change[0][k] + initial[k], change[1][k]])
        })
    }
}

/// What the law is told of a point.
fn whereabouts(setup: &FaultSetup, [x, y]: [f64; 2], time: f64) -> NodeConditions {
    NodeConditions { position: [x, y, 0.0], time, pressure: setup.pressure }
}
