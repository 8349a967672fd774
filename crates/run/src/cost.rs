//! What the steps of a run will take.

use std::time::Instant;

use crate::disk::Disk;
use case::schema::Case;
use mesh::Padded;
use scenario::{Cost, Facts, Model, ScenarioError};

/// The cost of a run that is about to roll, with steps of `dt` (s); none for implicit steps, of which nobody knows how
/// often each asks for the internal force.
///
/// # Errors
/// Elements that cannot be set up.
pub(crate) fn cost(
    case: &Case,
    model: &Model,
    facts: &Facts,
    dt: f64,
) -> Result<Option<Cost>, ScenarioError> {
    if case.theta().is_some() {
        return Ok(None);
    }
    // not those of the run, which have a history
    let mut solid = model.solid(case)?;
    let steps = facts.steps;
    Ok(Some(Cost {
        elements: model.mesh.hexes.len(),
        steps,
        dt,
        seconds: steps as f64 * step_seconds(&mut solid, model.mesh.nodes.len()),
        disk: Disk::of(case, model, steps as f64).total(),
    }))
}

/// Wall time of an internal force and a sweep over the nodes (s), the best of a few.
pub(crate) fn step_seconds(solid: &mut solid::Solid, nodes: usize) -> f64 {
    let mut u = vec![Padded::ZERO; nodes];
    let mut force = u.clone();
    (0..5)
        .map(|_| {
            let clock = Instant::now();
            solid.subtract_internal_force(&u, &force.clone(), &mut force, false);
            u.iter_mut().zip(&mut force).for_each(|(u, f)| {
                u.0[0] += 1e-30 * f.0[0];
                *f = Padded::ZERO;
            });
            clock.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}
