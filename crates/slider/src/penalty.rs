//! The penalty method: the friction spring of Eqs (10) and (11) in explicit stepping.

use crate::{Parameters, State};

/// One step of the central difference method, v at half steps. The friction spring is stretched by
/// the slip of the step before; its force is limited to mu(s) F_n, with mu at that lagged slip velocity. The adhesion
/// zone of Eq (18) is not used: the spring takes its place.
pub fn penalty_step(p: &Parameters, state: State) -> State {
    let trial = state.friction - p.stiffness * p.dt * state.slip; // (10)
    let mu = p.mu(state.slip);
    let bound = mu * p.normal_force;
    let friction = trial.clamp(-bound, bound); // (11)
    let v = state.v + p.dt / p.mass * (-p.damping * state.v - p.spring * state.x + friction);
    State { x: state.x + p.dt * v, v, slip: v - p.belt, friction, mu }
}

/// Largest stable time step of the sticking block (s): 2/omega of mass, spring and friction spring, without the damper.
pub fn penalty_stable_step(p: &Parameters) -> f64 {
    2.0 * (p.mass / (p.stiffness + p.spring)).sqrt()
}
