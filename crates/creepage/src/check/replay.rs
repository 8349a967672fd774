//! The law's coefficient of friction, recomputed from the records independently of the solver's coefficient.
//!
//! At each node the law's state starts with its value at the beginning of contact and is advanced step by step
//! with the law's own update, from the recorded slip velocity, pressure, position and time. Where every step
//! since then is recorded, this is the law's coefficient to round-off.
//!
//! # Uncertainty
//! Over steps without a record the state is not known, and four states are carried. Two bound it by an estimate:
//! the law's update over that time at half the slower and at twice the faster of the slip speeds at both ends.
//! The interval between their coefficients is the uncertainty. Two assume nothing about that time: contact that
//! has just begun, and contact that has slipped for long. Where later steps are all recorded and the law forgets, the
//! four states become equal, and the coefficient is known. A history that begins later than the run starts with
//! the last two.

use crate::check::basis::Basis;
use crate::check::frames::{ContactHistory, Frame};
use crate::check::projection::Pair;
use crate::check::recorded_law::RecordedLaw;
use crate::check::surface::Surface;
use friction::{NodeConditions, NodeFriction, Remembers};
use rayon::prelude::*;
use std::sync::Arc;

/// The coefficients of friction that the law allows at a node at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Allowed {
    /// Smallest coefficient.
    pub low: f64,
    /// Largest coefficient.
    pub high: f64,
    /// Whether the records determine the interval; else it is an estimate.
    pub known: bool,
}

impl Allowed {
    /// The allowed coefficient nearest to `mu`.
    pub fn nearest(&self, mu: f64) -> f64 {
        mu.max(self.low).min(self.high)
    }
}

/// The pressure and the slip with which a method of enforcement evaluates the law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Method {
    /// Exact enforcement: the nodes of body `slaves` are slaves. A record holds the slip of the step that begins
    /// there; the law's state is advanced with the pressure of the step before, zero where contact begins.
    Exact { slaves: u8 },
    /// Penalty in two passes: the nodes of each body are slaves in one, and a node's coefficient is the mean over
    /// all pairs that load it. A record holds the slip of the step that ends there; the law's state is advanced
    /// with the pressure at the end of the step.
    Passes,
}

/// Follows the law along the records.
pub(crate) struct Replay {
    law: Arc<dyn NodeFriction>,
    method: Method,
    dt: f64,
    /// Round-off of recorded slip speeds (m/s).
    noise: f64,
    /// Relative accuracy of the law's coefficient.
    known_to: f64,
    nodes: Vec<NodeState>,
    /// Time of the last record (s).
    time: Option<f64>,
    /// Closest-point projections of the slaves of both passes; `None` where the law needs none.
    projections: Option<[Pair; 2]>,
}

/// The four states of the law at a node, as [`NodeState::states`] lists them.
type States = [[f64; 2]; 4];

/// Data of a node that are kept from record to record.
#[derive(Clone, Copy, Debug, Default)]
struct NodeState {
    closed: bool,
    slip: f64,
    pressure: f64,
    position: [f64; 3],
    /// Of contact that has just begun, that has slipped for long, at the slower slip, at the faster slip.
    states: States,
}

/// Relative difference of coefficients below which they are equal.
const SAME_MU: f64 = 1e-10;
/// Factor by which slip speeds between two records are assumed to leave the range of both.
const SPEED_MARGIN: f64 = 2.0;
/// Most updates of the state over steps without a record.
const SUBSTEPS: u64 = 16;
/// Round-off of recorded slip over the rolling speed: the residual of the Gauss-Seidel sweeps of exact
/// enforcement.
const ROUND_OFF: f64 = 1e-11;
/// Error of the weights of a mean over the relative mismatch of the forces of the passes.
const WEIGHT_ERROR_FACTOR: f64 = 10.0;
/// Smallest error of the weights that is allowed for.
const LEAST_WEIGHT_ERROR: f64 = 1e-6;

impl Replay {
    /// A replay of the law along `history`; `dt` is the time step (s).
    ///
    /// # Errors
    /// The reason why the law cannot be followed, as half a sentence.
    pub fn new(history: &ContactHistory, basis: &Basis, dt: Option<f64>) -> Result<Self, String> {
        let RecordedLaw { law, known_to } = basis.friction.clone()?;
        let constant = law.remembers() == Remembers::Nothing && !law.is_implicit();
        if history.follows && law.remembers() != Remembers::Nothing {
            return Err("the fine zone follows the contact, and the law remembers".into());
        }
        let method = match history.enforced_on {
            Some(slaves) => Method::Exact { slaves },
            None if history.has.pass_pressure && history.has.gap => Method::Passes,
            // a constant coefficient depends neither on pressure nor on slip
            None if constant => Method::Passes,
            None => {
                return Err(
                    "the file does not say which pressure and which slip the law of each node was given \
                            (no enforced_on, no pass_pressure)"
                        .into(),
                );
            }
        };
        let dt = match dt {
            Some(dt) => dt,
            None if constant => f64::MIN_POSITIVE,
            None => return Err("the time step is not known (--scale dt=S)".into()),
        };
        let surface = &history.surface;
        let two = method == Method::Passes && !constant && surface.bodies() == [0, 1];
        if method == Method::Passes && !constant && !(two && history.has.motion) {
            return Err("two passes need two bodies and their displacement".into());
        }
        Ok(Self {
            law,
            known_to,
            method,
            dt,
            noise: ROUND_OFF * basis.scale("speed").map_or(1.0, f64::abs),
            nodes: vec![NodeState::default(); surface.points.len()],
            time: None,
            projections: two.then(|| [0, 1].map(|slave| Pair::over_convex_edges(surface, slave))),
        })
    }

    /// Index of the first record that must be followed before record `first`.
    pub fn start(&self, first: usize) -> usize {
        match self.law.remembers() {
            Remembers::Nothing => first,
            Remembers::LastStep => first.saturating_sub(1),
            Remembers::Contact => 0,
        }
    }

    /// The law's coefficient at the slip speed `speed` (m/s) of the same instant; `None` for a law that remembers
    /// more than one step.
    pub fn at_once(&self, speed: f64, at: &NodeConditions) -> Option<f64> {
        (self.law.remembers() != Remembers::Contact).then(|| {
            let state = self.law.advance(self.law.begin(at), speed, at, self.dt);
            self.law.mu(state, speed, at)
        })
    }

    /// Follows the law to the next record. Returns what the law allows at each node; `None` for nodes out of
    /// contact or where the coefficient is not known.
    pub fn follow(&mut self, surface: &Surface, frame: &Frame) -> Vec<Option<Allowed>> {
        let steps = self.time.map(|before| (frame.time - before) / self.dt);
        let first = steps.is_none() && frame.index == 0 && frame.time.abs() < 0.5 * self.dt;
        let elapsed = match steps {
            None if first => Elapsed::Start,
            None => Elapsed::Unknown,
            Some(steps) if (steps - 1.0).abs() < 0.01 => Elapsed::Step,
            Some(steps) => Elapsed::Steps(steps.round().max(2.0) as u64),
        };
        let interval = self.time.map_or(self.dt, |before| frame.time - before);
        let update = NodeUpdate {
            law: &*self.law,
            method: self.method,
            in_passes: self.projections.is_some(),
            dt: self.dt,
            noise: self.noise,
            known_to: self.known_to,
            interval,
        };
        let own: Vec<Option<Allowed>> = self
            .nodes
            .par_iter_mut()
            .with_min_len(256)
            .enumerate()
            .map(|(row, node)| update.advance(node, row, surface, frame, elapsed))
            .collect();
        self.time = Some(frame.time);
        match self.method {
            Method::Exact { .. } => own,
            Method::Passes => self.means(surface, frame, own),
        }
    }

    /// Of two passes: the mean of `own` over the pairs that load a node, weighted with their normal forces.
    fn means(
        &mut self,
        surface: &Surface,
        frame: &Frame,
        own: Vec<Option<Allowed>>,
    ) -> Vec<Option<Allowed>> {
        let Some((projections, [displacement, _])) =
            self.projections.as_mut().zip(frame.motion.as_ref())
        else {
            return own;
        };
        let pass = frame.pass_pressure.as_deref().unwrap_or(&frame.pressure);
        let mut means = vec![PairMean::default(); own.len()];
        for (row, own) in own.iter().enumerate() {
            if let Some(own) = own {
                means[row].add(pass[row] * surface.area[row], own);
            }
        }
        for pair in projections {
            let closed = |&row: &usize| surface.body[row] == pair.slave && own[row].is_some();
            let slaves: Vec<usize> = (0..own.len()).filter(closed).collect();
            for (&row, projection) in
                slaves.iter().zip(pair.projections(surface, displacement, &slaves))
            {
                let (Some((face, projection)), Some(own)) = (projection, &own[row]) else {
                    continue;
                };
                let force = pass[row] * surface.area[row];
                for (node, weight) in
                    surface.faces[face as usize].into_iter().zip(projection.within())
                {
                    means[node as usize].add(weight * force, own);
                }
            }
        }
        let forces = frame.pressure.iter().zip(&surface.area).map(|(p, a)| p * a);
        means.iter().zip(forces).map(|(mean, force)| mean.allowed(force)).collect()
    }
}

/// The time from the previous record to this one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Elapsed {
    /// This is the first record and the run starts with it: contact begins.
    Start,
    /// This is the first record, but the run started earlier.
    Unknown,
    /// One step.
    Step,
    /// This number of steps.
    Steps(u64),
}

/// The update of the law's state at a node from one record to the next.
struct NodeUpdate<'a> {
    law: &'a dyn NodeFriction,
    method: Method,
    /// Whether the pairs of each pass have coefficients of their own.
    in_passes: bool,
    dt: f64,
    noise: f64,
    known_to: f64,
    /// Time since the previous record (s).
    interval: f64,
}

impl NodeUpdate<'_> {
    fn advance(
        &self,
        node: &mut NodeState,
        row: usize,
        surface: &Surface,
        frame: &Frame,
        elapsed: Elapsed,
    ) -> Option<Allowed> {
        let closed = match self.method {
            Method::Exact { slaves } => surface.body[row] == slaves && frame.pressure[row] > 0.0,
            Method::Passes => match &frame.gap {
                Some(gap) if self.in_passes => gap[row] < 0.0,
                _ => frame.pressure[row] > 0.0,
            },
        };
        let before = std::mem::replace(&mut node.closed, closed);
        if !closed {
            return None;
        }
        let position = frame.position(surface, row).into();
        let pressure = frame.pass_pressure.as_ref().unwrap_or(&frame.pressure)[row];
        let slip = frame.slip_velocity[row].norm();
        let at = NodeConditions { position, time: frame.time, pressure };
        let old = *node;
        (node.slip, node.pressure, node.position) = (slip, pressure, position);

        let begun = self.begin(&at);
        // in a pair that has just closed, the first slip counts for the coefficient now and for the state later
        let mut new_contact = None;
        node.states = match elapsed {
            // the pressure of the preload lacks the part of the dampers, which is not known
            Elapsed::Start if self.method == Method::Passes => [0.0, 2.0, 1.0, 1.0].map(|part| {
                let preload = NodeConditions { pressure: part * pressure, ..at };
                self.law.advance(self.law.begin(&preload), 0.0, &at, self.dt)
            }),
            Elapsed::Start => [begun; 4],
            Elapsed::Step if before => {
                let inputs = self.state_inputs(&at, old.pressure);
                old.states.map(|state| self.law.advance(state, old.slip, &inputs, self.dt))
            }
            Elapsed::Step => {
                if self.method == Method::Passes {
                    new_contact = Some([self.law.advance(begun, slip, &at, self.dt); 4]);
                }
                [begun; 4]
            }
            Elapsed::Steps(steps) if before => {
                let [slow, fast] =
                    [old.slip.min(slip) / SPEED_MARGIN, old.slip.max(slip) * SPEED_MARGIN];
                let [_, _, a, b] = old.states;
                let along = |state, speed| self.along(state, speed, &old, &at, steps);
                let [new, long_slipped] = self.extremes(&at);
                [new, long_slipped, along(a, slow), along(b, fast)]
            }
            Elapsed::Steps(steps) => {
                let [new, long_slipped] = self.extremes(&at);
                let outset = NodeState { pressure: 0.0, position, ..old };
                [new, long_slipped, begun, self.along(begun, slip, &outset, &at, steps)]
            }
            Elapsed::Unknown => {
                let [new, long_slipped] = self.extremes(&at);
                [new, long_slipped, new, long_slipped]
            }
        };
        self.allowed(new_contact.as_ref().unwrap_or(&node.states), slip, &at)
    }

    /// The state at the beginning of contact.
    fn begin(&self, at: &NodeConditions) -> [f64; 2] {
        match self.method {
            Method::Exact { .. } => self.law.begin(&NodeConditions { pressure: 0.0, ..*at }),
            Method::Passes => self.law.begin(at),
        }
    }

    /// The arguments of the law's update over a step that ends at `at`; `before` is the pressure (Pa) at its
    /// beginning.
    fn state_inputs(&self, at: &NodeConditions, before: f64) -> NodeConditions {
        match self.method {
            Method::Exact { .. } => NodeConditions { pressure: before, ..*at },
            Method::Passes => *at,
        }
    }

    /// The states of contact that has just begun, and of contact that has slipped fast, for long and under more
    /// pressure.
    fn extremes(&self, at: &NodeConditions) -> [[f64; 2]; 2] {
        let new = self.law.begin(&NodeConditions { pressure: 0.0, ..*at });
        let more = NodeConditions { pressure: 4.0 * at.pressure, ..*at };
        [new, self.law.advance(new, FAST_SLIP, &more, LONG_TIME)]
    }

    /// The state after `steps` steps at the slip speed `speed` (m/s), with position and pressure interpolated
    /// linearly.
    fn along(
        &self,
        mut state: [f64; 2],
        speed: f64,
        from: &NodeState,
        to: &NodeConditions,
        steps: u64,
    ) -> [f64; 2] {
        let parts = steps.min(SUBSTEPS);
        for part in 1..=parts {
            let left = 1.0 - part as f64 / parts as f64;
            let between = |a: f64, b: f64| b + left * (a - b);
            let at = NodeConditions {
                position: [0, 1, 2].map(|i| between(from.position[i], to.position[i])),
                time: to.time - left * self.interval,
                pressure: between(from.pressure, to.pressure),
            };
            state = self.law.advance(state, speed, &at, self.interval / parts as f64);
        }
        state
    }

    fn allowed(&self, states: &States, slip: f64, at: &NodeConditions) -> Option<Allowed> {
        // `min` and `max` alone would hide a NaN
        let widened = |[low, high]: [f64; 2], mu: f64| {
            if mu.is_nan() || low.is_nan() { [f64::NAN; 2] } else { [mu.min(low), mu.max(high)] }
        };
        let ends = |states: &[[f64; 2]]| {
            let mu = states.iter().map(|state| self.law.mu(*state, slip, at));
            mu.fold([f64::INFINITY, f64::NEG_INFINITY], widened)
        };
        let [low, high] = ends(states);
        let known = high - low <= SAME_MU * high;
        let [mut low, mut high] = if known { [low, high] } else { ends(&states[2..]) };
        if self.law.is_implicit() {
            // at the slip velocity of the same instant, which is known to round-off
            for state in if known { &states[..] } else { &states[2..] } {
                for speed in [(slip - self.noise).max(0.0), slip + self.noise] {
                    let mu = self.law.mu(*state, speed, at);
                    [low, high] = widened([low, high], mu);
                }
            }
        }
        (low.is_finite() && high.is_finite()).then_some(Allowed {
            low: low * (1.0 - self.known_to),
            high: high * (1.0 + self.known_to),
            known,
        })
    }
}

/// A slip speed (m/s) and a duration (s) larger than those of any contact.
const FAST_SLIP: f64 = 10.0;
const LONG_TIME: f64 = 10.0;

/// Sums for the mean over the pairs that load a node.
#[derive(Clone, Copy, Debug)]
struct PairMean {
    /// Sum of the normal forces (N).
    force: f64,
    /// Sums of the ends of the intervals, weighted with these.
    low: f64,
    high: f64,
    /// Smallest and largest end.
    least: f64,
    most: f64,
    known: bool,
}

impl Default for PairMean {
    fn default() -> Self {
        let (least, most) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { force: 0.0, low: 0.0, high: 0.0, least, most, known: true }
    }
}

impl PairMean {
    fn add(&mut self, force: f64, own: &Allowed) {
        if force > 0.0 {
            self.force += force;
            self.low += force * own.low;
            self.high += force * own.high;
            self.least = self.least.min(own.low);
            self.most = self.most.max(own.high);
            self.known &= own.known;
        }
    }

    /// The mean for a node that carries `force` (N). The weights come from projections recomputed here; their error
    /// is estimated from the mismatch of the forces, whose sum must be `force`.
    fn allowed(&self, force: f64) -> Option<Allowed> {
        if !(self.force > 0.0 && force > 0.0) {
            return None;
        }
        let off = (WEIGHT_ERROR_FACTOR * (self.force / force - 1.0).abs()).max(LEAST_WEIGHT_ERROR);
        let slack = off * (self.most - self.least);
        let [low, high] = [self.low, self.high].map(|sum| sum / self.force);
        Some(Allowed {
            low: (low - slack).max(self.least),
            high: (high + slack).min(self.most),
            known: self.known,
        })
    }
}
