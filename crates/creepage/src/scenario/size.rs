//! How large the model of a case is, and how long its steps are.

use crate::case::schema::{BodyModel, Case};
use crate::scenario::disk_on_bar;
use crate::scenario::error::ScenarioError;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Number of elements of the mesh of a case, or of squares between the points of half-spaces.
///
/// # Errors
/// A mesh that cannot be made or read.
pub fn elements(case: &Case) -> Result<usize, ScenarioError> {
    match case.model {
        BodyModel::FiniteElements => disk_on_bar::elements(case),
        BodyModel::HalfSpace => {
            let [rear, front] = case.mesh.zone_along();
            let zone = &case.mesh.zone;
            let across = if case.mesh.plane_strain { zone.size } else { zone.width };
            Ok([front - rear, across].map(|l| (l / zone.size).round() as usize).iter().product())
        }
    }
}

/// The time (s) of which a case's `time.factor` is a fraction: the stability limit of the preloaded model, or what waves
/// take from point to point of half-spaces. Preloads are kept in `cache`, if there is one; `stop` ends them.
///
/// # Errors
/// A mesh, contact or friction law that cannot be set up; no preload found.
pub fn stable_limit(
    case: &Case,
    cache: Option<&Path>,
    stop: &AtomicBool,
) -> Result<f64, ScenarioError> {
    match case.model {
        BodyModel::FiniteElements => disk_on_bar::stable_limit(case, cache, stop),
        BodyModel::HalfSpace => Ok(case.wave_time()),
    }
}
