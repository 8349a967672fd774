//! Friction laws of a contact node, whose state is kept from step to step.

use crate::{Coulomb, FrictionLaw, Memory, NodeConditions};
use std::fmt::Debug;

/// A node that was already in contact in the step before, whose state is to be advanced.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeHistory {
    /// State of the step before; [`NodeFriction::advance_all`] overwrites it with that of this step.
    pub state: [f64; 2],
    /// Slip speed of the step before (m/s).
    pub slip_speed: f64,
    /// Its position, time and pressure now.
    pub at: NodeConditions,
}

/// How much of a node's history the coefficient of a law depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remembers {
    /// This instant alone.
    Nothing,
    /// The step before.
    LastStep,
    /// Everything since contact began.
    Contact,
}

/// Friction law of a contact node: the bound `|p_tau| <= mu p_n` with a coefficient that may depend on
/// the slip speed of the same instant, on position, time and pressure, and on a state of two numbers.
/// Each law defines their meaning and unit.
///
/// The enforcement of contact stores the state of each node. In the step in which a node comes into contact the state
/// is [`begin`](Self::begin). In every later step it is first advanced with the slip speed of the step
/// before; then [`mu`](Self::mu) gives the coefficient of this step.
pub trait NodeFriction: Send + Sync + Debug {
    /// State at the beginning of contact; zero for laws that do not need another.
    fn begin(&self, _at: &NodeConditions) -> [f64; 2] {
        [0.0; 2]
    }

    /// State after a step `dt` (s) in which the node slipped at `slip_speed >= 0` (m/s); the same for laws without a
    /// state.
    fn advance(
        &self,
        state: [f64; 2],
        _slip_speed: f64,
        _at: &NodeConditions,
        _dt: f64,
    ) -> [f64; 2] {
        state
    }

    /// [`advance`](Self::advance) for all nodes of a step at once, for laws that are expensive to call, such as a
    /// Python function. The order of the nodes does not depend on the number of threads.
    fn advance_all(&self, nodes: &mut [NodeHistory], dt: f64) {
        for node in nodes {
            node.state = self.advance(node.state, node.slip_speed, &node.at, dt);
        }
    }

    /// Coefficient of friction in this state at the slip speed `slip_speed >= 0` (m/s) of the same
    /// instant. Does not depend on the latter unless [`is_implicit`](Self::is_implicit).
    fn mu(&self, state: [f64; 2], slip_speed: f64, at: &NodeConditions) -> f64;

    /// Derivative of [`mu`](Self::mu) with respect to the slip speed (s/m).
    fn slope(&self, _state: [f64; 2], _slip_speed: f64, _at: &NodeConditions) -> f64 {
        0.0
    }

    /// Whether the coefficient depends on the slip speed of the same instant.
    fn is_implicit(&self) -> bool {
        false
    }

    /// Coefficient of friction of a node that has always been at rest; a law without one, such as rate and state,
    /// documents what it returns.
    fn mu_static(&self) -> f64;

    /// How much of the node's history the coefficient depends on.
    fn remembers(&self) -> Remembers {
        Remembers::Contact
    }
}

impl NodeFriction for Coulomb {
    fn mu(&self, _state: [f64; 2], _slip_speed: f64, _at: &NodeConditions) -> f64 {
        self.mu
    }

    fn mu_static(&self) -> f64 {
        self.mu
    }

    fn remembers(&self) -> Remembers {
        Remembers::Nothing
    }
}

/// `mu(|s|)` with the slip speed of the step before, as explicit codes evaluate Eq. (8) of Vollebregt (2017).
/// The first number of the state is that speed (m/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lagged<L>(pub L);

impl<L: FrictionLaw> NodeFriction for Lagged<L> {
    fn advance(
        &self,
        _state: [f64; 2],
        slip_speed: f64,
        _at: &NodeConditions,
        _dt: f64,
    ) -> [f64; 2] {
        [slip_speed, 0.0]
    }

    fn mu(&self, state: [f64; 2], _slip_speed: f64, at: &NodeConditions) -> f64 {
        self.0.mu_at(state[0], at)
    }

    fn mu_static(&self) -> f64 {
        self.0.mu_static()
    }

    fn remembers(&self) -> Remembers {
        Remembers::LastStep
    }
}

/// `mu(|s|)` at the slip speed of the same instant, as in Eq. (8) of Vollebregt (2017). It has no state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Implicit<L>(pub L);

impl<L: FrictionLaw> NodeFriction for Implicit<L> {
    fn mu(&self, _state: [f64; 2], slip_speed: f64, at: &NodeConditions) -> f64 {
        self.0.mu_at(slip_speed, at)
    }

    fn slope(&self, _state: [f64; 2], slip_speed: f64, at: &NodeConditions) -> f64 {
        self.0.slope_at(slip_speed, at)
    }

    fn is_implicit(&self) -> bool {
        true
    }

    fn mu_static(&self) -> f64 {
        self.0.mu_static()
    }

    fn remembers(&self) -> Remembers {
        Remembers::Nothing
    }
}

/// A law with memory: the coefficient, which is the first number of the state, follows the steady one over a distance
/// of slip. A node that comes into contact starts with the coefficient at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remembering<L> {
    /// The steady law.
    pub steady: L,
    /// How the coefficient follows the steady law.
    pub memory: Memory,
}

impl<L: FrictionLaw> NodeFriction for Remembering<L> {
    fn begin(&self, at: &NodeConditions) -> [f64; 2] {
        [self.steady.mu_at(0.0, at), 0.0]
    }

    fn advance(
        &self,
        [mu, _]: [f64; 2],
        slip_speed: f64,
        at: &NodeConditions,
        dt: f64,
    ) -> [f64; 2] {
        [self.memory.advance(mu, self.steady.mu_at(slip_speed, at), slip_speed, dt), 0.0]
    }

    fn mu(&self, [mu, _]: [f64; 2], _slip_speed: f64, _at: &NodeConditions) -> f64 {
        mu
    }

    fn mu_static(&self) -> f64 {
        self.steady.mu_static()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Exponential;

    const PAPER: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };

    #[test]
    fn lagged_friction_is_that_of_the_speed_before() {
        let (law, at) = (Lagged(PAPER), NodeConditions::default());
        let state = law.begin(&at);
        assert_eq!(law.mu(state, 3.0, &at), 0.5);
        let state = law.advance(state, 0.2, &at, 1e-7);
        assert_eq!(law.mu(state, 3.0, &at), PAPER.mu(0.2));
    }

    #[test]
    fn implicit_friction_has_the_slope_of_its_law() {
        let (law, at) = (Implicit(PAPER), NodeConditions::default());
        let state = law.begin(&at);
        for s in [0.01, 0.3, 2.0] {
            let by_difference = (PAPER.mu(s + 1e-6) - PAPER.mu(s - 1e-6)) / 2e-6;
            assert!((law.slope(state, s, &at) - by_difference).abs() < 1e-9);
        }
    }

    #[test]
    fn remembered_friction_begins_at_rest_and_ends_at_the_steady_coefficient() {
        let memory = Memory { distance: 1e-6, floor: 1e-2 };
        let (law, at) = (Remembering { steady: PAPER, memory }, NodeConditions::default());
        let mut state = law.begin(&at);
        assert_eq!(law.mu(state, 0.7, &at), 0.5);
        for _ in 0..1000 {
            state = law.advance(state, 0.7, &at, 1e-7);
        }
        assert!((law.mu(state, 0.0, &at) - PAPER.mu(0.7)).abs() < 1e-15);
    }
}
