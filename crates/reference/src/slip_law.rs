//! Friction that depends on the slip velocity and on what the particles that roll through the contact remember.

use crate::Point;
use friction::{NodeFriction, Place};
use std::sync::Arc;

/// A friction law and the speed of rolling, which turns the slip of a step into a slip velocity.
#[derive(Clone, Debug)]
pub struct SlipLaw {
    /// The law.
    pub law: Arc<dyn NodeFriction>,
    /// Speed of rolling (m/s), above zero.
    pub speed: f64,
}

/// The states of the particles of a contact.
///
/// A step of one pitch h takes dt = h/V. The particle at point i was at the point upstream before it, and its state
/// moves with it. The state is advanced with the slip velocity of the same step, s_i = |slip_i|/dt, and so is
/// the bound at the end of the step: mu(state_i, s_i) N_i. This is CONTACT's scheme for friction with memory
/// (Vollebregt). A particle that comes into contact in the step has the state at the beginning of contact.
pub(crate) struct Particles {
    law: Arc<dyn NodeFriction>,
    /// Duration of a step (s), and the time now (s).
    dt: f64,
    time: f64,
    /// By point of the grid; `None` out of contact.
    states: Vec<Option<[f64; 2]>>,
}

impl Particles {
    /// Particles that come into contact now, on `contact`, with the normal forces `normal` (N).
    pub fn new(
        law: SlipLaw,
        pitch: f64,
        points: &[Point],
        contact: &[usize],
        normal: &[f64],
    ) -> Self {
        let mut states = vec![None; points.len()];
        for (&i, &n) in contact.iter().zip(normal) {
            states[i] = Some(law.law.begin(&place(&points[i], n, 0.0)));
        }
        Self { dt: pitch / law.speed, law: law.law, time: 0.0, states }
    }

    /// Friction bounds of particles that do not slip (N).
    pub fn at_rest(&self, points: &[Point], contact: &[usize], normal: &[f64]) -> Vec<f64> {
        let bound = |(&i, &n): (&usize, &f64)| {
            let at = place(&points[i], n, self.time);
            let state = self.states[i].unwrap_or_else(|| self.law.begin(&at));
            n * self.law.mu(state, 0.0, &at)
        };
        contact.iter().zip(normal).map(bound).collect()
    }

    /// The step over which the particle at contact point k comes from the point `upstream(contact[k])`.
    pub fn step(
        &self,
        points: &[Point],
        contact: &[usize],
        normal: &[f64],
        upstream: impl Fn(usize) -> usize,
    ) -> Step {
        let time = self.time + self.dt;
        let particle = |(&i, &normal): (&usize, &f64)| Particle {
            at: place(&points[i], normal, time),
            normal,
            before: self.states[upstream(i)],
        };
        let particles = contact.iter().zip(normal).map(particle).collect();
        Step { law: Arc::clone(&self.law), dt: self.dt, particles }
    }

    /// Takes the states at the end of `step`, in which the contact points slipped by `slip` (m; by point, then t1, t2).
    pub fn take(&mut self, step: &Step, contact: &[usize], slip: &[f64]) {
        self.time += self.dt;
        self.states.fill(None);
        for (k, &i) in contact.iter().enumerate() {
            let slip = libm::hypot(slip[2 * k], slip[2 * k + 1]);
            self.states[i] = Some(step.state(k, slip / step.dt));
        }
    }
}

fn place(point: &Point, normal: f64, time: f64) -> Place {
    Place { position: point.at, time, pressure: normal / point.area }
}

/// A particle at the end of a step, with its state before it, if it was in contact then.
struct Particle {
    at: Place,
    normal: f64,
    before: Option<[f64; 2]>,
}

/// The particles in contact at the end of a step.
pub(crate) struct Step {
    law: Arc<dyn NodeFriction>,
    dt: f64,
    particles: Vec<Particle>,
}

impl Step {
    /// State at the end of the step of the particle at contact point k, which slipped at `speed` (m/s).
    fn state(&self, k: usize, speed: f64) -> [f64; 2] {
        let Particle { at, before, .. } = &self.particles[k];
        match before {
            Some(state) => self.law.advance(*state, speed, at, self.dt),
            None => self.law.begin(at),
        }
    }

    /// Friction bound of contact point k (N) after a slip (m) over the step.
    pub fn bound(&self, k: usize, slip: f64) -> f64 {
        let speed = slip / self.dt;
        let Particle { at, normal, .. } = &self.particles[k];
        normal * self.law.mu(self.state(k, speed), speed, at)
    }

    /// Derivative of [`bound`](Self::bound) with respect to the slip (N/m), by central difference, one-sided at rest.
    /// Newton's method alone uses it: its error changes the number of iterations, not the solution.
    pub fn slope(&self, k: usize, slip: f64) -> f64 {
        let step = 1e-6 * (self.dt + slip);
        let low = (slip - step).max(0.0);
        (self.bound(k, slip + step) - self.bound(k, low)) / (slip + step - low)
    }
}
