//! Penalty contact: semismooth Newton with a line search.

use crate::error::StaticsError;
use crate::link::Link;
use crate::problem::{Ending, Equilibrium, Iteration, NewtonReport};
use crate::springs::{Pressed, Springs};
use crate::system::StaticSystem;
use mesh::Padded;
use solid::linear::{Vector, inner};

/// Accuracy of the linear steps (Eisenstat and Walker 1996, choice 2): GAMMA times the square of
/// the last reduction, between these bounds. The tangent of the undeformed state gains no more than
/// about two digits per step, so that a finer solution would be wasted.
pub(crate) const COARSEST: f64 = 0.1;
pub(crate) const FINEST: f64 = 3e-3;
const GAMMA: f64 = 0.9;

/// A step is too long where the slope of the energy along it has turned to more than this part of
/// what it was.
const OVERSHOOT: f64 = 0.5;
const TRIALS: usize = 30;

/// A residual above this part of the one before counts as stalled.
const STALLED: f64 = 0.5;

/// Below this residual a stall is put down to normals that jump: where a slave lies over the edge of
/// two facets, dented by the load, the normal leaps from one facet's to the other's and no
/// displacement balances it. From then on projections and normals are held.
const KINKED: f64 = 1e-2;

/// A residual that is this small and falls no further is round-off.
const ROUND_OFF: f64 = 1e-7;

/// Accuracy of the next linear step; no finer than what ends the iteration, with room for what the
/// tangent leaves.
pub(crate) fn forcing(residual: f64, before: f64, wanted: f64) -> f64 {
    let enough = (0.3 * wanted / residual).min(COARSEST);
    (GAMMA * (residual / before).powi(2)).clamp(FINEST, COARSEST).max(enough)
}

/// Equilibrium with the normal springs of the contact from `u`.
pub(crate) fn solve(
    system: &mut StaticSystem<'_>,
    springs: &mut Springs<'_>,
    mut u: Vec<Padded>,
    observe: &mut dyn FnMut(&Iteration) -> bool,
) -> Result<Equilibrium, StaticsError> {
    let n = u.len();
    let zero = || vec![Padded::ZERO; n];
    let (mut force, mut d, mut trial, mut r) = (zero(), zero(), zero(), zero());
    let mut at = Iteration::default();
    let mut total = 0;
    let mut before = f64::INFINITY;
    let mut energy = system.force(&u, &mut force, true);
    let mut sums = system.add_spring_force(springs, &u, &mut force);
    loop {
        at.residual = system.space.residual_norm(&force) / system.scale(&force);
        (at.normal_force, at.closed) = (sums.normal_force, sums.closed);
        system.not_inverted(&u)?;
        if !observe(&at) {
            return Err(StaticsError::Interrupted);
        }
        let stalled = at.residual > STALLED * before;
        let found = at.residual <= system.problem.tolerance;
        system.set_springs(springs.closed(&u));
        let links: Vec<Link> = system.springs.iter().map(|(link, _)| link.clone()).collect();
        let drift = system.unresisted(&links);
        if (found || stalled && at.residual < ROUND_OFF) && drift.is_none() {
            system.is_pressed(&at, &force)?;
            let ending = if found { Ending::Tolerance } else { Ending::RoundOff };
            let held = springs.are_held();
            let same = !held || release(system, springs, &u, &mut force);
            if same {
                let facets = system.space.residual_norm(&force) / system.scale(&force);
                let facets = if held { facets } else { 0.0 };
                let report = NewtonReport {
                    last: at,
                    cg_iterations: total,
                    ending,
                    facets,
                    internal: energy,
                };
                return Ok(Equilibrium { displacement: u, force, pressed: Vec::new(), report });
            }
            before = f64::INFINITY;
            continue;
        }
        if stalled && at.residual < KINKED && !springs.are_held() {
            springs.hold(&u);
        }
        if at.iteration >= system.problem.max_iterations || at.residual.is_nan() {
            return Err(system.slow(at, &force));
        }
        at.iteration += 1;
        if let Some(drift) = drift {
            let closed = |system: &mut StaticSystem<'_>, u: &[Padded]| {
                system.add_spring_force(springs, u, &mut r);
                springs.closed(u).into_iter().map(|(link, _)| link).collect()
            };
            system.close(&drift, &mut u, &force, closed)?;
            (at.cg_iterations, at.step) = (0, 0.0);
            energy = system.force(&u, &mut force, true);
            sums = system.add_spring_force(springs, &u, &mut force);
            before = f64::INFINITY;
            continue;
        }
        let tolerance = forcing(at.residual, before, system.problem.tolerance);
        before = at.residual;
        r.copy_from_slice(&force);
        at.cg_iterations = system.step(&mut r, &mut d, tolerance, &at)?;
        total += at.cg_iterations;
        let slope = inner(&force, &d);
        (at.step, energy, sums) = search(system, springs, &u, &d, slope, &mut trial, &mut force);
        std::mem::swap(&mut u, &mut trial);
    }
}

/// Lets projections and normals of the springs go; whether those closed at `u` are those closed while held.
/// Sets `force` to the force at `u` with the present projections and normals.
fn release(
    system: &mut StaticSystem<'_>,
    springs: &mut Springs<'_>,
    u: &[Padded],
    force: &mut [Padded],
) -> bool {
    let slaves = |springs: &[(Link, f64)]| -> Vec<usize> {
        springs.iter().map(|(link, _)| link.slave).collect()
    };
    let before = slaves(&springs.closed(u));
    springs.release();
    system.force(u, force, false);
    system.add_spring_force(springs, u, force);
    system.set_springs(springs.closed(u));
    slaves(&system.springs) == before
}

/// The step along `d` from `u`: Newton's, or a shorter one where that leads beyond the least energy.
///
/// The energy of bodies and springs is convex but for the bodies' rotations, and minus its slope
/// along `d` is `force . d`. Contact that opens or closes makes it kink in its second derivative;
/// a full step from one state of contact may then overshoot. The root of the slope is sought by
/// regula falsi in its Illinois form, from forces alone, since energies lose their last digits.
fn search(
    system: &mut StaticSystem<'_>,
    springs: &mut Springs<'_>,
    u: &[Padded],
    d: &Vec<Padded>,
    slope: f64,
    trial: &mut Vec<Padded>,
    force: &mut [Padded],
) -> (f64, f64, Pressed) {
    let mut evaluate = |alpha: f64| {
        trial.copy_from_slice(u);
        trial.add(alpha, d);
        let energy = system.force(trial, force, true);
        let sums = system.add_spring_force(springs, trial, force);
        (inner(force, d), energy, sums)
    };
    let mut alpha = 1.0;
    let mut found = evaluate(alpha);
    let (mut low, mut high) = ((0.0, slope), (alpha, found.0));
    // NaN, from a step that is far too long, passes no test.
    let mut good = found.0 >= -OVERSHOOT * slope;
    for _ in 0..TRIALS {
        if good {
            break;
        }
        let root = low.1 / (low.1 - high.1);
        let root = if root > 0.1 { root.min(0.9) } else { 0.1 };
        alpha = low.0 + root * (high.0 - low.0);
        found = evaluate(alpha);
        good = found.0.abs() <= OVERSHOOT * slope;
        if found.0 > 0.0 {
            low = (alpha, found.0);
            high.1 *= 0.5;
        } else {
            high = (alpha, found.0);
            low.1 *= 0.5;
        }
    }
    (alpha, found.1, found.2)
}
