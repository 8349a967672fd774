//! What the steps of a run will take.

use std::time::{Duration, Instant};

use crate::case::schema::Case;
use crate::run::disk::Disk;
use crate::scenario::{Cost, InitialState, Model, ScenarioError, restart_without_moves};
use dynamics::Simulation;
use friction::Kind;
use mesh::Padded;

/// The cost of a run that is about to roll: its first steps are taken with a copy, and timed.
///
/// None for implicit steps, whose time depends on what comes, and with a law in Python, which would be asked for steps that
/// are not those of the run.
///
/// # Errors
/// A copy that cannot be set up.
pub(crate) fn cost(
    case: &Case,
    model: &Model,
    facts: &InitialState,
    simulation: &Simulation,
) -> Result<Option<Cost>, ScenarioError> {
    if case.theta().is_some() || case.friction.law == Kind::Python {
        return Ok(None);
    }
    let snapshot = simulation.snapshot();
    let mut copy = restart_without_moves(case, model, facts.found(), &snapshot)?.simulation;
    let each = seconds_each(|| {
        copy.step(false);
    });
    let steps = facts.steps;
    Ok(Some(Cost {
        elements: model.mesh.hexes.len(),
        steps,
        dt: simulation.dt(),
        seconds: steps as f64 * each,
        disk: Disk::of(case, model, steps as f64).total(),
    }))
}

/// Wall time of an internal force and a sweep over the nodes (s).
pub(crate) fn step_seconds(solid: &mut solid::Solid, nodes: usize) -> f64 {
    let mut u = vec![Padded::ZERO; nodes];
    let mut force = u.clone();
    seconds_each(|| {
        solid.subtract_internal_force(&u, &force.clone(), &mut force, false);
        u.iter_mut().zip(&mut force).for_each(|(u, f)| {
            u.0[0] += 1e-30 * f.0[0];
            *f = Padded::ZERO;
        });
    })
}

/// Most steps that are timed, and the time after which no further one is.
const MOST: u32 = 100;
const LONG_ENOUGH: Duration = Duration::from_millis(200);

/// Mean wall time of a step (s) over the first ones, but for the very first, which finds nothing in the caches.
fn seconds_each(mut step: impl FnMut()) -> f64 {
    step();
    let clock = Instant::now();
    let mut count = 0;
    while count < MOST && (count < 2 || clock.elapsed() < LONG_ENOUGH) {
        step();
        count += 1;
    }
    clock.elapsed().as_secs_f64() / f64::from(count)
}
