//! Friction that depends on the slip velocity and on what the particles that roll through the contact remember.

use crate::reference::Point;
use crate::reference::friction::SlipBound;
use friction::{NodeConditions, NodeFriction};
use std::sync::Arc;

/// A friction law and the speed of rolling, which turns the slip of a step into a slip velocity.
#[derive(Clone, Debug)]
pub struct SlipLaw {
    /// The law.
    pub law: Arc<dyn NodeFriction>,
    /// Speed of rolling (m/s), above zero.
    pub speed: f64,
}

/// The contact points of a grid.
pub(crate) struct Patch<'a> {
    /// All points of the grid.
    pub points: &'a [Point],
    /// Those in contact, and their normal forces (N).
    pub contact: &'a [usize],
    /// See `contact`.
    pub normal: &'a [f64],
    /// The point upstream of each point of the grid.
    pub upstream: &'a [usize],
}

impl Patch<'_> {
    /// Position, time and pressure of the contact points.
    fn places(&self, time: f64) -> Vec<NodeConditions> {
        let place = |(&i, normal): (&usize, &f64)| {
            let Point { at, area, .. } = self.points[i];
            NodeConditions { position: at.into(), time, pressure: normal / area }
        };
        self.contact.iter().zip(self.normal).map(place).collect()
    }
}

/// The states of the particles of a contact.
///
/// A step of one pitch h takes dt = h/V. The particle at point i was at the point upstream before it, and its state
/// moves with it. The state is advanced with the slip velocity of the same step, s_i = |slip_i|/dt, which also gives
/// the bound at the end of the step, mu(state_i, s_i) N_i: implicit Euler's method along the paths of particles, but
/// that a law may integrate its state exactly. A particle that comes into contact in the step has the state at
/// the beginning of contact.
pub(crate) struct Particles {
    law: Arc<dyn NodeFriction>,
    /// Duration of a step (s), and the time now (s).
    dt: f64,
    time: f64,
    /// By point of the grid; `None` out of contact.
    states: Vec<Option<[f64; 2]>>,
}

impl Particles {
    /// Particles that come into contact now; a step has the length `pitch` (m).
    pub fn new(law: SlipLaw, pitch: f64, patch: &Patch<'_>) -> Self {
        let mut states = vec![None; patch.points.len()];
        for (&i, at) in patch.contact.iter().zip(patch.places(0.0)) {
            states[i] = Some(law.law.begin(&at));
        }
        Self { dt: pitch / law.speed, law: law.law, time: 0.0, states }
    }

    /// Friction bounds of particles that stay where they are and do not slip (N).
    pub fn at_rest(&self, patch: &Patch<'_>) -> Vec<f64> {
        let places = patch.places(self.time);
        let bound = |(k, at): (usize, &NodeConditions)| {
            let state = self.states[patch.contact[k]].unwrap_or_else(|| self.law.begin(at));
            patch.normal[k] * self.law.mu(state, 0.0, at)
        };
        places.iter().enumerate().map(bound).collect()
    }

    /// A step of rolling from the states now.
    pub fn step(&self, patch: &Patch<'_>) -> Step {
        self.steps(patch, |up| self.states[up].map_or(Before::Outside, Before::State))
    }

    /// A step of steady rolling: the states at its end are those at its beginning.
    pub fn steady(&self, patch: &Patch<'_>) -> Step {
        let mut place = vec![Before::Outside; self.states.len()];
        patch.contact.iter().enumerate().for_each(|(k, &i)| place[i] = Before::Upstream(k));
        self.steps(patch, |up| place[up])
    }

    fn steps(&self, patch: &Patch<'_>, before: impl Fn(usize) -> Before) -> Step {
        Step {
            law: Arc::clone(&self.law),
            dt: self.dt,
            places: patch.places(self.time + self.dt),
            normal: patch.normal.to_vec(),
            before: patch.contact.iter().map(|&i| before(patch.upstream[i])).collect(),
        }
    }

    /// Takes the states at the end of `step`, in which the contact points slipped by `slip` (m; by point, then t1, t2).
    pub fn take(&mut self, step: &Step, contact: &[usize], slip: &[f64]) {
        self.time += self.dt;
        self.states.fill(None);
        let size = |k: usize| libm::hypot(slip[2 * k], slip[2 * k + 1]);
        for (k, &i) in contact.iter().enumerate() {
            self.states[i] = Some(step.state(k, &size));
        }
    }
}

/// Where a particle was before a step.
#[derive(Clone, Copy)]
enum Before {
    /// Out of contact.
    Outside,
    /// In contact, in this state.
    State([f64; 2]),
    /// At this contact point, in its state at the end of the step.
    Upstream(usize),
}

/// The particles in contact at the end of a step; lists are by contact point.
pub(crate) struct Step {
    law: Arc<dyn NodeFriction>,
    dt: f64,
    places: Vec<NodeConditions>,
    normal: Vec<f64>,
    before: Vec<Before>,
}

impl Step {
    /// State of contact point k at the end of the step, with the slip (m) of each contact point.
    fn state(&self, k: usize, slip: &impl Fn(usize) -> f64) -> [f64; 2] {
        let at = &self.places[k];
        let before = match self.before[k] {
            Before::Outside => return self.law.begin(at),
            Before::State(state) => state,
            Before::Upstream(up) => self.state(up, slip),
        };
        self.law.advance(before, slip(k) / self.dt, at, self.dt)
    }

    fn bound(&self, k: usize, slip: &impl Fn(usize) -> f64) -> f64 {
        let state = self.state(k, slip);
        self.normal[k] * self.law.mu(state, slip(k) / self.dt, &self.places[k])
    }

    /// Derivative of the bound of contact point k with respect to the slip of point j (N/m), by central difference,
    /// one-sided at rest.
    fn slope(&self, k: usize, j: usize, slip: &[f64]) -> f64 {
        let step = 1e-6 * (self.dt + slip[j]);
        let [low, high] = [(slip[j] - step).max(0.0), slip[j] + step];
        let with = |changed: f64| self.bound(k, &|i| if i == j { changed } else { slip[i] });
        (with(high) - with(low)) / (high - low)
    }
}

impl SlipBound for Step {
    fn bounds(&self, slip: &[f64]) -> Vec<f64> {
        (0..slip.len()).map(|k| self.bound(k, &|i| slip[i])).collect()
    }

    fn slopes(&self, slip: &[f64]) -> Vec<Vec<(usize, f64)>> {
        let of = |k: usize| {
            let mut slopes = vec![(k, self.slope(k, k, slip))];
            let mut j = k;
            while let Before::Upstream(up) = self.before[j] {
                slopes.push((up, self.slope(k, up, slip)));
                j = up;
            }
            slopes
        };
        (0..slip.len()).map(of).collect()
    }
}
