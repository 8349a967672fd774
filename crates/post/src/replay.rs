//! The coefficient of friction that the law gives, made again from the records.
//!
//! Apart from what the solver says of its coefficient: from the recorded slip velocity, pressure, position and
//! time, node by node and from the state with which the law begins contact, with the law's own update over a
//! step. Where every step since then is recorded, this is the law's coefficient to round-off.
//!
//! # Blur
//! Over steps without a record four states are carried: the law's update over that time at half the
//! slower and at twice the faster of the slip speeds at both ends, which tell how far the coefficient is blurred, and two
//! that know nothing of that time: contact that has just begun, and contact that has slipped for long. Where
//! later steps are all recorded and the law forgets, the four become one again, and the coefficient is
//! known. A history that begins later than the run begins with the last two.

use crate::basis::Basis;
use crate::frames::{ContactHistory, Frame};
use crate::projection::Pair;
use crate::recorded_law::RecordedLaw;
use crate::surface::Surface;
use crate::vector::{Vec3, axpy, norm};
use friction::{NodeFriction, Place, Remembers};
use rayon::prelude::*;
use std::sync::Arc;

/// What the law allows at a node at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Allowed {
    /// The coefficient lies between these.
    pub low: f64,
    pub high: f64,
    /// Whether the records say so with certainty; else the ends are those of an estimate.
    pub known: bool,
}

impl Allowed {
    /// The coefficient allowed that is nearest to `mu`.
    pub fn nearest(&self, mu: f64) -> f64 {
        mu.max(self.low).min(self.high)
    }
}

/// When a method tells the law what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Method {
    /// Nodes of one body are slaves. A record holds the slip of the step that leaves; a step is told the
    /// pressure of the step before, and of none where contact begins.
    Exact { slaves: u8 },
    /// Nodes of both bodies are slaves in a pass of their own, and a node's coefficient is the mean over all
    /// pairs that load it. A record holds the slip of the step that led there; a step is told the
    /// pressure of its own end.
    Passes,
}

/// Follows the law along the records.
pub(crate) struct Replay {
    law: Arc<dyn NodeFriction>,
    method: Method,
    dt: f64,
    /// Slip speed (m/s) below which recorded slip is round-off.
    noise: f64,
    /// Part of the coefficient to which the law itself is known.
    known_to: f64,
    nodes: Vec<NodeState>,
    time: Option<f64>,
    /// Projections of the slaves of both passes.
    projections: Option<[Pair; 2]>,
}

/// States of the law that a node may be in.
type States = [[f64; 2]; 4];

/// What is kept of a node from record to record.
#[derive(Clone, Copy, Debug, Default)]
struct NodeState {
    closed: bool,
    slip: f64,
    pressure: f64,
    position: Vec3,
    /// Contact just begun, slipped for long, the slower way, the faster way.
    states: States,
}

/// Part of the coefficient within which states are one.
const ONE: f64 = 1e-10;
/// Slip speeds between two records are taken to go so much beyond those of both.
const SPEED_MARGIN: f64 = 2.0;
/// Parts at most into which steps without a record are cut.
const PARTS: u64 = 16;
/// Round-off of recorded slip over the rolling speed: what the sweeps of exact enforcement leave.
const ROUND_OFF: f64 = 1e-11;
/// By how much more than the forces of the passes fail to add up the weights of a mean may be off.
const PROJECTIONS: f64 = 10.0;
/// The least such part.
const LEAST: f64 = 1e-6;

impl Replay {
    /// The law along `history`, or why it cannot be followed.
    pub fn new(history: &ContactHistory, basis: &Basis, dt: Option<f64>) -> Result<Self, String> {
        let RecordedLaw { law, known_to } = basis.friction.clone()?;
        let constant = law.remembers() == Remembers::Nothing && !law.is_implicit();
        let method = match history.enforced_on {
            Some(slaves) => Method::Exact { slaves },
            None if history.has.pass_pressure && history.has.gap => Method::Passes,
            // what depends on nothing needs no timing
            None if constant => Method::Passes,
            None => {
                return Err(
                    "the file does not say which pressure and which slip each node's law was told \
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
            projections: two.then(|| [0, 1].map(|slave| Pair::over_ridges(surface, slave))),
        })
    }

    /// The first record that must be read for those from `first` on to be judged.
    pub fn start(&self, first: usize) -> usize {
        match self.law.remembers() {
            Remembers::Nothing => first,
            Remembers::LastStep => first.saturating_sub(1),
            Remembers::Contact => 0,
        }
    }

    /// The law's coefficient at the same instant at `speed` (m/s), of a law that remembers no more than
    /// a step.
    pub fn at_once(&self, speed: f64, at: &Place) -> Option<f64> {
        (self.law.remembers() != Remembers::Contact).then(|| {
            let state = self.law.advance(self.law.begin(at), speed, at, self.dt);
            self.law.mu(state, speed, at)
        })
    }

    /// Takes in the next record; what the law allows at each node, where the node is in contact.
    pub fn follow(&mut self, surface: &Surface, frame: &Frame) -> Vec<Option<Allowed>> {
        let steps = self.time.map(|before| (frame.time - before) / self.dt);
        let first = steps.is_none() && frame.index == 0 && frame.time.abs() < 0.5 * self.dt;
        let between = match steps {
            None if first => Between::Start,
            None => Between::Unknown,
            Some(steps) if (steps - 1.0).abs() < 0.01 => Between::Step,
            Some(steps) => Between::Steps(steps.round().max(2.0) as u64),
        };
        let interval = self.time.map_or(self.dt, |before| frame.time - before);
        let rule = Rule {
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
            .map(|(row, node)| rule.advance(node, row, surface, frame, between))
            .collect();
        self.time = Some(frame.time);
        match self.method {
            Method::Exact { .. } => own,
            Method::Passes => self.means(surface, frame, own),
        }
    }

    /// Of two passes: the mean over the pairs that load a node, weighted with their normal force.
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
        let mut means = vec![Mean::default(); own.len()];
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

/// How the records reach from the one before to this one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Between {
    /// The start of the run: contact begins.
    Start,
    /// No record before, though the run has begun.
    Unknown,
    /// One step.
    Step,
    /// So many.
    Steps(u64),
}

/// The law at a node from one record to the next.
struct Rule<'a> {
    law: &'a dyn NodeFriction,
    method: Method,
    /// Whether each pass has a law's coefficient of its own.
    in_passes: bool,
    dt: f64,
    noise: f64,
    known_to: f64,
    /// From the record before (s).
    interval: f64,
}

impl Rule<'_> {
    fn advance(
        &self,
        node: &mut NodeState,
        row: usize,
        surface: &Surface,
        frame: &Frame,
        between: Between,
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
        let position = match &frame.motion {
            Some([displacement, _]) => axpy(surface.points[row], 1.0, displacement[row]),
            None => surface.points[row],
        };
        let pressure = frame.pass_pressure.as_ref().unwrap_or(&frame.pressure)[row];
        let slip = norm(frame.slip_velocity[row]);
        let at = Place { position, time: frame.time, pressure };
        let old = *node;
        (node.slip, node.pressure, node.position) = (slip, pressure, position);

        let begun = self.begin(&at);
        // of a pair that has just closed the first slip counts for the coefficient, and then again
        let mut new_contact = None;
        node.states = match between {
            // with the pressure of the preload, which has no dampers yet
            Between::Start if self.method == Method::Passes => [0.0, 2.0, 1.0, 1.0].map(|part| {
                let preload = Place { pressure: part * pressure, ..at };
                self.law.advance(self.law.begin(&preload), 0.0, &at, self.dt)
            }),
            Between::Start => [begun; 4],
            Between::Step if before => {
                let inputs = self.state_inputs(&at, old.pressure);
                old.states.map(|state| self.law.advance(state, old.slip, &inputs, self.dt))
            }
            Between::Step => {
                if self.method == Method::Passes {
                    new_contact = Some([self.law.advance(begun, slip, &at, self.dt); 4]);
                }
                [begun; 4]
            }
            Between::Steps(steps) if before => {
                let [slow, fast] =
                    [old.slip.min(slip) / SPEED_MARGIN, old.slip.max(slip) * SPEED_MARGIN];
                let [_, _, a, b] = old.states;
                let along = |state, speed| self.along(state, speed, &old, &at, steps);
                let [new, worn] = self.extremes(&at);
                [new, worn, along(a, slow), along(b, fast)]
            }
            Between::Steps(steps) => {
                let [new, worn] = self.extremes(&at);
                let outset = NodeState { pressure: 0.0, position, ..old };
                [new, worn, begun, self.along(begun, slip, &outset, &at, steps)]
            }
            Between::Unknown => {
                let [new, worn] = self.extremes(&at);
                [new, worn, new, worn]
            }
        };
        self.allowed(new_contact.as_ref().unwrap_or(&node.states), slip, &at)
    }

    /// The state with which contact begins.
    fn begin(&self, at: &Place) -> [f64; 2] {
        match self.method {
            Method::Exact { .. } => self.law.begin(&Place { pressure: 0.0, ..*at }),
            Method::Passes => self.law.begin(at),
        }
    }

    /// What the state of a step to `at` is updated with, after one with the pressure `before`.
    fn state_inputs(&self, at: &Place, before: f64) -> Place {
        match self.method {
            Method::Exact { .. } => Place { pressure: before, ..*at },
            Method::Passes => *at,
        }
    }

    /// Contact that has just begun, and contact that has slipped fast, for long and under more pressure.
    fn extremes(&self, at: &Place) -> [[f64; 2]; 2] {
        let new = self.law.begin(&Place { pressure: 0.0, ..*at });
        let more = Place { pressure: 4.0 * at.pressure, ..*at };
        [new, self.law.advance(new, FAST, &more, LONG)]
    }

    /// The state after steps at one slip speed, while place and pressure go their way evenly.
    fn along(
        &self,
        mut state: [f64; 2],
        speed: f64,
        from: &NodeState,
        to: &Place,
        steps: u64,
    ) -> [f64; 2] {
        let parts = steps.min(PARTS);
        for part in 1..=parts {
            let left = 1.0 - part as f64 / parts as f64;
            let between = |a: f64, b: f64| b + left * (a - b);
            let at = Place {
                position: [0, 1, 2].map(|i| between(from.position[i], to.position[i])),
                time: to.time - left * self.interval,
                pressure: between(from.pressure, to.pressure),
            };
            state = self.law.advance(state, speed, &at, self.interval / parts as f64);
        }
        state
    }

    fn allowed(&self, states: &States, slip: f64, at: &Place) -> Option<Allowed> {
        // not `min` and `max`: what is no number must show
        let widened = |[low, high]: [f64; 2], mu: f64| {
            if mu.is_nan() || low.is_nan() { [f64::NAN; 2] } else { [mu.min(low), mu.max(high)] }
        };
        let ends = |states: &[[f64; 2]]| {
            let mu = states.iter().map(|state| self.law.mu(*state, slip, at));
            mu.fold([f64::INFINITY, f64::NEG_INFINITY], widened)
        };
        let [low, high] = ends(states);
        let known = high - low <= ONE * high;
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

/// A slip speed (m/s) and a time (s) beyond those of any contact.
const FAST: f64 = 10.0;
const LONG: f64 = 10.0;

/// The mean over pairs that load a node.
#[derive(Clone, Copy, Debug)]
struct Mean {
    force: f64,
    low: f64,
    high: f64,
    least: f64,
    most: f64,
    known: bool,
}

impl Default for Mean {
    fn default() -> Self {
        let (least, most) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { force: 0.0, low: 0.0, high: 0.0, least, most, known: true }
    }
}

impl Mean {
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

    /// Of a node that carries `force` (N). The weights come from projections that are found here: how far they may
    /// be off is seen from the forces, which must add up.
    fn allowed(&self, force: f64) -> Option<Allowed> {
        if !(self.force > 0.0 && force > 0.0) {
            return None;
        }
        let off = (PROJECTIONS * (self.force / force - 1.0).abs()).max(LEAST);
        let slack = off * (self.most - self.least);
        let [low, high] = [self.low, self.high].map(|sum| sum / self.force);
        Some(Allowed {
            low: (low - slack).max(self.least),
            high: (high + slack).min(self.most),
            known: self.known,
        })
    }
}
