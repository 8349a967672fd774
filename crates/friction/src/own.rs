//! A friction law that the caller of the program supplies: `friction.law = "python"`.

use crate::declaration::{Make, no_defaults};
use crate::{
    Coulomb, Declaration, Memory, Mode, NodeConditions, NodeFriction, NodeHistory, Remembers,
};
use std::fmt::Debug;
use std::sync::{Arc, Mutex, PoisonError};

pub(crate) const DECLARATION: Declaration = Declaration {
    word: "python",
    sentence: "A coefficient by a function that is handed over with the run.",
    coefficient: "a function that the Python package hands over with the run",
    numbers: &[],
    needs: &["source"],
    takes: &["mode", "memory"],
    write_defaults: no_defaults,
    make: Make::AtNode(|p, beside| match beside.own {
        Some(own) => {
            let implicit = p.memory.is_none() && p.mode == Some(Mode::Exact);
            Box::new(Own::new(Arc::clone(own), p.memory, implicit))
        }
        None => Box::new(Coulomb { mu: 0.0 }),
    }),
};

/// A user's coefficient of friction as a function of the slip speed. It is not part of this program and is expensive to
/// call, so that it is evaluated for all contact nodes at once.
///
/// A node's coefficient must be a function of its own slip speed alone: only then does a run have the same bits for any
/// number of threads, and after it is resumed.
pub trait OwnLaw: Send + Sync + Debug {
    /// Writes the coefficients of friction at `slip_speeds >= 0` (m/s) into `mu`, a slice of the same length.
    ///
    /// A law that fails writes finite numbers and reports the failure by [`failure`](Self::failure).
    fn mu(&self, slip_speeds: &[f64], mu: &mut [f64]);

    /// Why an evaluation failed, if one did: this ends the run.
    fn failure(&self) -> Option<String>;
}

/// A user's law at the contact nodes. With the slip speed of the step before, or with memory, the first number of the
/// state is the coefficient, and the law is evaluated once per step and surface. With the slip speed of the same
/// instant it has no state, and is evaluated in every iteration of every node.
#[derive(Debug)]
pub struct Own {
    law: Arc<dyn OwnLaw>,
    memory: Option<Memory>,
    implicit: bool,
    at_rest: f64,
    /// Slip speeds and coefficients of a step, kept to avoid allocations.
    buffers: Mutex<[Vec<f64>; 2]>,
}

impl Own {
    /// The law, with `memory` if given; `implicit` selects the slip speed of the same instant, and is not meant to be
    /// combined with memory. Evaluates the law once, at rest.
    pub fn new(law: Arc<dyn OwnLaw>, memory: Option<Memory>, implicit: bool) -> Self {
        let mut at_rest = [0.0];
        law.mu(&[0.0], &mut at_rest);
        let [at_rest] = at_rest;
        Self { law, memory, implicit, at_rest, buffers: Mutex::default() }
    }

    fn at<const N: usize>(&self, slip_speeds: [f64; N]) -> [f64; N] {
        let mut mu = [0.0; N];
        self.law.mu(&slip_speeds, &mut mu);
        mu
    }

    /// The state after a step towards the coefficient `steady`.
    fn follow(&self, before: f64, steady: f64, slip_speed: f64, dt: f64) -> [f64; 2] {
        let mu = match self.memory {
            Some(memory) => memory.advance(before, steady, slip_speed, dt),
            None => steady,
        };
        [mu, 0.0]
    }
}

impl NodeFriction for Own {
    fn begin(&self, _at: &NodeConditions) -> [f64; 2] {
        [self.at_rest, 0.0]
    }

    fn advance(&self, state: [f64; 2], slip_speed: f64, _at: &NodeConditions, dt: f64) -> [f64; 2] {
        if self.implicit {
            return state;
        }
        let [steady] = self.at([slip_speed]);
        self.follow(state[0], steady, slip_speed, dt)
    }

    fn advance_all(&self, nodes: &mut [NodeHistory], dt: f64) {
        if self.implicit || nodes.is_empty() {
            return;
        }
        let mut buffers = self.buffers.lock().unwrap_or_else(PoisonError::into_inner);
        let [slip_speeds, mu] = &mut *buffers;
        slip_speeds.clear();
        slip_speeds.extend(nodes.iter().map(|node| node.slip_speed));
        mu.resize(nodes.len(), 0.0);
        self.law.mu(slip_speeds, mu);
        for (node, &steady) in nodes.iter_mut().zip(&*mu) {
            node.state = self.follow(node.state[0], steady, node.slip_speed, dt);
        }
    }

    fn mu(&self, [mu, _]: [f64; 2], slip_speed: f64, _at: &NodeConditions) -> f64 {
        if self.implicit { self.at([slip_speed])[0] } else { mu }
    }

    /// By central difference, one-sided at rest.
    fn slope(&self, _state: [f64; 2], slip_speed: f64, _at: &NodeConditions) -> f64 {
        if !self.implicit {
            return 0.0;
        }
        let step = 1e-6 * (1.0 + slip_speed);
        let speeds = [(slip_speed - step).max(0.0), slip_speed + step];
        let mu = self.at(speeds);
        (mu[1] - mu[0]) / (speeds[1] - speeds[0])
    }

    fn is_implicit(&self) -> bool {
        self.implicit
    }

    fn mu_static(&self) -> f64 {
        self.at_rest
    }

    fn remembers(&self) -> Remembers {
        match self.memory {
            Some(_) => Remembers::Contact,
            None if self.implicit => Remembers::Nothing,
            None => Remembers::LastStep,
        }
    }
}

/// Slip speeds per decade at which a user's law is sampled.
const PER_DECADE: u32 = 100;

/// A user's law as points (slip speed in m/s, coefficient): at rest, and from 1e-6 to 1e2 m/s with 100 points per
/// decade. `None` if the law failed.
pub fn sampled(law: &dyn OwnLaw) -> Option<Vec<[f64; 2]>> {
    if law.failure().is_some() {
        return None;
    }
    let decades = f64::from(PER_DECADE);
    let speeds = (0..=8 * PER_DECADE).map(|i| libm::pow(10f64, -6.0 + f64::from(i) / decades));
    let speeds: Vec<f64> = std::iter::once(0.0).chain(speeds).collect();
    let mut mu = vec![0.0; speeds.len()];
    law.mu(&speeds, &mut mu);
    let points = speeds.into_iter().zip(mu).map(|(speed, mu)| [speed, mu]);
    law.failure().is_none().then(|| points.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Exponential, FrictionLaw, Implicit, Lagged, Remembering};

    const PAPER: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };

    /// Eq. (8) brought along.
    #[derive(Debug)]
    struct Brought;

    impl OwnLaw for Brought {
        fn mu(&self, slip_speeds: &[f64], mu: &mut [f64]) {
            mu.iter_mut().zip(slip_speeds).for_each(|(mu, s)| *mu = PAPER.mu(*s));
        }

        fn failure(&self) -> Option<String> {
            None
        }
    }

    /// The coefficients of three nodes over steps, asked one by one or all at once.
    fn coefficients(law: &dyn NodeFriction, together: bool) -> Vec<f64> {
        let at = NodeConditions::default();
        let mut nodes =
            [0.0, 0.3, 2.0].map(|slip_speed| NodeHistory { state: law.begin(&at), slip_speed, at });
        let mut found = Vec::new();
        for _ in 0..3 {
            if together {
                law.advance_all(&mut nodes, 1e-7);
            } else {
                for node in &mut nodes {
                    node.state = law.advance(node.state, node.slip_speed, &at, 1e-7);
                }
            }
            found.extend(nodes.iter().map(|node| law.mu(node.state, node.slip_speed, &at)));
        }
        found
    }

    #[test]
    fn a_law_brought_along_has_the_bits_of_the_same_law_built_in() {
        let memory = Memory { distance: 1e-6, floor: 1e-2 };
        let own = |memory, implicit| Own::new(Arc::new(Brought), memory, implicit);
        let built: [(Own, Box<dyn NodeFriction>); 3] = [
            (own(None, false), Box::new(Lagged(PAPER))),
            (own(Some(memory), false), Box::new(Remembering { steady: PAPER, memory })),
            (own(None, true), Box::new(Implicit(PAPER))),
        ];
        for (own, built) in &built {
            assert_eq!(own.mu_static(), built.mu_static());
            for together in [false, true] {
                assert_eq!(coefficients(own, together), coefficients(&**built, together));
            }
        }
    }

    #[test]
    fn the_slope_at_the_same_instant_is_that_of_the_law() {
        let own = Own::new(Arc::new(Brought), None, true);
        for s in [0.0, 0.01, 0.3, 2.0] {
            let slope = own.slope([0.0; 2], s, &NodeConditions::default());
            assert!((slope - PAPER.slope(s)).abs() < 1e-5, "{s}: {slope}");
        }
    }
}
