//! The limits of the guards, from the case and its mesh.

use crate::model::{BAR, Model};
use case::hertz::hertz;
use case::schema::Case;
use dynamics::GuardLimits;

/// Energies below this part of load times approach (Hertz) are too small for the guard of hourglass energy.
const LEAST_ENERGY: f64 = 0.01;
/// A normal force below this part of the load counts as no contact.
const LEAST_FORCE: f64 = 1e-3;

/// The limits of the guards of a case, in SI units.
pub fn limits(case: &Case, model: &Model) -> GuardLimits {
    let guards = &case.guards;
    let along = model.mesh.nodes[model.mesh.bodies[BAR].nodes.clone()].iter().map(|x| x[0]);
    GuardLimits {
        hourglass: guards.hourglass,
        least_energy: LEAST_ENERGY * case.load.normal * hertz(case).approach,
        penetration: guards.penetration * case.mesh.zone.size,
        without_contact: case.longest_parted().unwrap_or(f64::INFINITY),
        least_force: LEAST_FORCE * case.load.normal,
        friction: case.largest_friction().unwrap_or(f64::INFINITY),
        track: along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]),
    }
}
