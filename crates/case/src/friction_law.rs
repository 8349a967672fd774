//! The friction law of a case.

use crate::hertz::hertz;
use crate::schema::Case;
use friction::{Domain, Expression, LawError, NodeFriction, OwnLaw};
use std::sync::Arc;

/// Dotted path of a key of `[friction]`.
pub(crate) fn path(key: &str) -> String {
    format!("friction.{key}")
}

/// Where a formula must give a coefficient: pressures up to three times Hertz's, which shocks and
/// coarse meshes may reach, the time of rolling, and the fine zone.
pub(crate) fn domain(case: &Case) -> Domain {
    let zone = &case.mesh.zone;
    Domain {
        pressure: 3.0 * hertz(case).p0,
        duration: case.duration(),
        along: [zone.start, zone.start + zone.length],
    }
}

/// The friction law of a case; `own` is what was handed over with the run.
pub(crate) fn law(
    case: &Case,
    own: Option<&Arc<dyn OwnLaw>>,
) -> Result<Box<dyn NodeFriction>, LawError> {
    let formula = |text: &str| Expression::over(text, &domain(case));
    case.friction.node_friction(formula, own)
}
