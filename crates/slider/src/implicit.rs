//! The implicit method: backward Euler, Eqs (19)-(24), by Picard iteration, Eqs (25) and (27).

use crate::{Parameters, State};

/// How many iterations a step took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Iterations {
    /// Picard iterations.
    pub picard: u32,
    /// Iterations of the bracketing fallback; zero where Picard converged.
    pub bracketing: u32,
}

/// Picard iterations after which the bracketing fallback takes over.
const MOST_PICARD: u32 = 2000;

/// Imbalance at which Eq (24) counts as solved, relative to the sum of its terms.
const TOLERANCE: f64 = 1e-14;

/// Eq (24) of one step, with the slip velocity as the unknown: a slip velocity far below the belt's then keeps its
/// digits, which v^{n+1} = v_ref + s would lose.
#[derive(Clone, Copy, Debug)]
pub struct ImplicitEquation {
    /// m + c dt + k dt^2 (kg).
    inertia: f64,
    /// m v^n - dt k x^n (kg m/s).
    known: f64,
    /// dt mu_S F_n/s_adhes (kg), the linear term of Eq (26).
    adhesion: f64,
}

impl ImplicitEquation {
    /// The equation of the step from `state`.
    pub fn new(p: &Parameters, state: &State) -> Self {
        Self {
            inertia: p.mass + p.damping * p.dt + p.spring * p.dt * p.dt,
            known: p.mass * state.v - p.dt * p.spring * state.x,
            adhesion: p.dt * p.mu_static() * p.normal_force / p.adhesion,
        }
    }

    /// Right-hand minus left-hand side of Eq (24) at a slip velocity (m/s), and the sum of the magnitudes of its terms,
    /// the scale of its rounding error (both kg m/s).
    pub fn imbalance(&self, p: &Parameters, slip: f64) -> [f64; 2] {
        let (friction, left) = (p.dt * p.friction(slip), self.inertia * (p.belt + slip));
        let scale = self.known.abs() + friction.abs() + left.abs() + self.inertia * slip.abs();
        [self.known + friction - left, scale]
    }
}

/// One step, and the iterations it took.
///
/// In sliding, Picard iteration uses Eq (25), `s += imbalance/inertia`. In adhesion, where friction is
/// nearly linear in the slip velocity, it uses Eq (27), `s += imbalance/(inertia + adhesion)`. An iterate that jumps
/// over the whole adhesion zone is replaced by v = v_ref, as in the paper. Where Picard iteration does not converge,
/// the root is found by bisection.
pub fn implicit_step(p: &Parameters, state: State) -> (State, Iterations) {
    let equation = ImplicitEquation::new(p, &state);
    let mut count = Iterations::default();
    let mut slip = state.v - p.belt;
    let mut adhesive = slip.abs() <= p.adhesion;
    while count.picard < MOST_PICARD {
        count.picard += 1;
        let [imbalance, scale] = equation.imbalance(p, slip);
        if imbalance.abs() <= TOLERANCE * scale {
            return (advanced(p, &state, slip), count);
        }
        let weight = equation.inertia + if adhesive { equation.adhesion } else { 0.0 };
        let next = slip + imbalance / weight; // (25), (27)
        if next == slip {
            return (advanced(p, &state, slip), count); // converged to the last bit
        }
        let next_adhesive = next.abs() <= p.adhesion;
        let skips = !adhesive && !next_adhesive && slip * next < 0.0;
        (slip, adhesive) = if skips { (0.0, true) } else { (next, next_adhesive) };
    }
    slip = bracketed(p, &equation, &mut count);
    (advanced(p, &state, slip), count)
}

/// A root of Eq (24) by bisection: friction is bounded, so that the imbalance is positive far to
/// the left and negative far to the right.
fn bracketed(p: &Parameters, equation: &ImplicitEquation, count: &mut Iterations) -> f64 {
    let positive = |slip: f64| equation.imbalance(p, slip)[0] > 0.0;
    let centre = equation.known / equation.inertia - p.belt;
    let mut width = p.dt * p.mu_static() * p.normal_force / equation.inertia + p.adhesion;
    let brackets = |width: f64| positive(centre - width) && !positive(centre + width);
    while count.bracketing < 1000 && !brackets(width) {
        count.bracketing += 1;
        width *= 2.0;
    }
    let (mut low, mut high) = (centre - width, centre + width);
    loop {
        count.bracketing += 1;
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if positive(middle) { low = middle } else { high = middle }
    }
    let size = |slip: f64| equation.imbalance(p, slip)[0].abs();
    if size(low) <= size(high) { low } else { high }
}

/// Eqs (19), (21)-(23) with the slip velocity found.
fn advanced(p: &Parameters, state: &State, slip: f64) -> State {
    let v = p.belt + slip;
    State { x: state.x + p.dt * v, v, slip, friction: p.friction(slip), mu: p.mu(slip) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use friction::Exponential;
    use proptest::prelude::*;
    use std::sync::Arc;

    prop_compose! {
        fn parameters()(
            belt in -5.0..5.0f64,
            normal_force in 0.0..200.0f64,
            mass in -5.0..1.0f64,
            spring in 0.0..1e3f64,
            damping in 0.0..2.0f64,
            adhesion in -5.0..-1.0f64,
            mu_static in 0.0..1.0f64,
            fall in 0.0..1.0f64,
            decay in 0.0..50.0f64,
            dt in -6.0..-2.0f64,
            x0 in -1.0..1.0f64,
            v0 in -10.0..10.0f64,
        ) -> Parameters {
            let mu_dynamic = mu_static * fall;
            Parameters {
                belt,
                normal_force,
                mass: libm::pow(10f64, mass),
                spring,
                damping,
                adhesion: libm::pow(10f64, adhesion),
                law: Arc::new(Exponential { mu_static, mu_dynamic, decay }),
                dt: libm::pow(10f64, dt),
                x0,
                v0,
                ..Parameters::default()
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]
        #[test]
        fn every_step_ends_finite_and_satisfies_the_discrete_equations(p in parameters()) {
            let mut state = p.start();
            for _ in 0..200 {
                let (next, count) = implicit_step(&p, state);
                prop_assert!(count.picard <= MOST_PICARD && count.bracketing < 3000);
                prop_assert!(next.x.is_finite() && next.v.is_finite());
                // Eqs (19), (20), (23) as printed, in terms of velocities
                let (dt, m) = (p.dt, p.mass);
                let moved = (next.x - state.x) - dt * next.v;
                prop_assert!(moved.abs() <= 1e-9 * (next.x.abs() + state.x.abs()), "(19): {moved}");
                let mu = p.mu(next.slip);
                let friction = -mu * p.normal_force * next.slip / p.adhesion.max(next.slip.abs());
                let terms = [
                    m * next.v, -m * state.v, dt * p.damping * next.v, dt * p.spring * next.x,
                    -dt * friction,
                ];
                let (sum, size) =
                    terms.iter().fold((0.0, 0.0), |(a, b), t| (a + t, f64::max(b, t.abs())));
                prop_assert!(f64::abs(sum) <= 1e-9 * size, "(20): {sum:e} of {size:e}");
                state = next;
            }
        }
    }
}
