//! The limits of the guards, from the case and its mesh.

use crate::case::hertz::hertz;
use crate::case::schema::Case;
use crate::scenario::model::{BAR, Model};
use dynamics::GuardLimits;

/// Energies below this part of load times the depth to which the bodies approach are too small for the guard of
/// hourglass energy.
const LEAST_ENERGY: f64 = 0.01;
/// A normal force below this part of the load counts as no contact.
const LEAST_FORCE: f64 = 1e-3;

/// The limits of the guards of a case, in SI units.
pub fn limits(case: &Case, model: &Model) -> GuardLimits {
    let guards = &case.guards;
    let along = model.mesh.nodes[model.mesh.bodies[BAR].nodes.clone()].iter().map(|x| x[0]);
    GuardLimits {
        hourglass: guards.hourglass,
        least_energy: least_energy(case),
        penetration: guards.penetration * case.mesh.zone.size,
        without_contact: case.longest_parted().unwrap_or(f64::INFINITY),
        least_force: LEAST_FORCE * case.load.normal,
        friction: case.largest_friction().unwrap_or(f64::INFINITY),
        track: along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]),
    }
}

/// The energy (J) below which hourglass energy is not judged. A line contact has no approach: its scale is `a^2/R`,
/// what Hertz's approach is on a circle of radius `a`.
fn least_energy(case: &Case) -> f64 {
    let hertz = hertz(case);
    let approach = match hertz.approach {
        0.0 => hertz.a * hertz.a / case.disk.radius,
        approach => approach,
    };
    LEAST_ENERGY * case.load.normal * approach
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use std::path::Path;

    #[test]
    fn line_contact_too_has_an_energy_too_small_to_judge() {
        let text = "load.normal = 1e5\ndrive = {speed = 38.89, creepage = 2.4e-3}\n\
                    friction.static = 0.5\nmesh.zone.width = 0.06\n";
        let least = |crown: &str| {
            let sets = [format!("disk.crown_radius={crown}"), format!("bar.crown_radius={crown}")];
            least_energy(&Case::from_text(text, Path::new("case.toml"), &sets).unwrap())
        };
        let [round, flat] = ["1.0", "'flat'"].map(least);
        assert!(flat > 0.05 * round && flat < round, "{flat} J, {round} J");
    }
}
