//! The case against itself: choices that agree, sizes that fit, a path that stays in the fine zone.

mod choices;
mod friction;
mod geometry;
mod half_space;
mod irregularity;
mod path;
mod position;
mod records;
mod rules;
mod sideways;
mod warnings;

use std::fmt::Display;

use crate::case::error::{CaseError, KeyError, raise};
use crate::case::name;
use crate::case::places::Places;
use crate::case::schema::{BodyModel, Case};
use crate::case::value::{digits, number};

pub use records::below_the_step;
pub use warnings::warnings;

/// More steps than these are taken for a typing mistake.
const MOST_STEPS: f64 = 1e9;

/// Findings about a case as a whole.
struct Findings<'a> {
    places: &'a Places,
    errors: Vec<KeyError>,
}

impl Findings<'_> {
    /// Refuses the case unless `fine`. The message points at the first of `keys` that an option gives, or else at
    /// the first that a file gives: keys with their defaults are not in the user's sight.
    fn require(&mut self, fine: bool, keys: &[&str], problem: impl Display, remedy: &str) {
        if fine {
            return;
        }
        let written = || {
            let keys = keys.iter().copied();
            keys.filter_map(|key| Some((key, self.places.origins.get(key)?)))
        };
        let by_option = written().find(|(_, at)| self.places.source(at).file.is_none());
        let key = by_option.or_else(|| written().next()).map_or(keys[0], |(key, _)| key);
        self.errors.push(self.places.error(key, &problem.to_string(), remedy));
    }
}

/// Checks the case against itself: choices that agree, sizes that fit, a path that stays in the fine zone.
///
/// # Errors
/// All contradictions found, the first with the others in [`KeyError::others`].
pub fn check(case: &Case) -> Result<(), CaseError> {
    let mut found = Findings { places: &case.written.places, errors: Vec::new() };
    let refused = name::refused(&case.name);
    found.require(refused.is_none(), &["name"], refused.unwrap_or_default(), name::REMEDY);
    rules::check(case, &mut found);
    friction::check(&case.friction, &mut found);
    match case.model {
        BodyModel::FiniteElements => sideways::check(case, &mut found),
        BodyModel::HalfSpace => half_space::check(case, &mut found),
    }
    position::check(case, &mut found);
    choices::check(case, &mut found);
    match case.model {
        BodyModel::FiniteElements => geometry::check(case, &mut found),
        BodyModel::HalfSpace => half_space::check_zone(case, &mut found),
    }
    records::check(case, &mut found);
    // The path is judged only for a case whose shape makes sense.
    if found.errors.is_empty() {
        path::check(case, &mut found);
        irregularity::check(case, &mut found);
        if !case.is_half_space() {
            sideways::check_drift(case, &mut found);
        }
        friction::check_formula(case, &mut found);
        check_length(case, &mut found);
        records::check_records(case, &mut found);
    }
    raise(found.errors)
}

/// Time steps of the run, roughly: the smallest element over the speed of pressure waves. The
/// stable step of the mesh is not known before the mesh is.
fn steps(case: &Case) -> f64 {
    case.duration() / case.step().under(case.wave_time())
}

/// The run does not need more steps than anybody waits for.
fn check_length(case: &Case, found: &mut Findings<'_>) {
    let steps = steps(case);
    found.require(
        steps <= MOST_STEPS,
        &["time.duration", "time.factor", "time.step", "drive.speed", "mesh.zone.size", "time.roll"],
        format_args!(
            "the run of {} s needs about {steps:.1e} time steps, more than {MOST_STEPS:.0e}: at a millisecond each that \
             is {:.0} days",
            digits(case.duration()),
            steps * 1e-3 / 86400.0
        ),
        "roll faster (drive.speed) or less (time.roll, time.duration), or use larger elements \
         (mesh.zone.size)",
    );
}

/// A length in millimetres.
fn mm(x: f64) -> String {
    digits(1e3 * x)
}

/// A length in metres, rounded to nanometres, so that a sum such as -0.01 + 0.08 is shown as it was meant.
fn metres(x: f64) -> String {
    number((x * 1e9).round() / 1e9)
}
