//! How x_min and the slip in adhesion depend on the time step.

use crate::{Method, Parameters, penalty_stable_step, run, unobserved};
use rayon::prelude::*;

/// The run at one time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPoint {
    /// Time step (s).
    pub dt: f64,
    /// Smallest position (m).
    pub x_min: f64,
    /// Root mean square of the slip velocity in the first adhesion (m/s), as in [`crate::Outcome`].
    pub adhesion_slip: f64,
}

/// Smallest time step of the map (s).
pub const SMALLEST_STEP: f64 = 1e-7;

/// End of the map's runs (s): just after the first collapse.
pub fn map_end(p: &Parameters) -> f64 {
    p.end.min(1.2 * p.reach() / p.belt.abs())
}

/// Points of the map per decade of dt.
const PER_DECADE: i32 = 24;

/// Runs up to the first collapse, with time steps from `10^from` to `10^to` s, 24 per decade, in rising order.
///
/// Time steps at which the run blows up, or the friction spring of the penalty method is unstable, are left out.
pub fn map(p: &Parameters, method: Method, from: i32, to: i32) -> Vec<MapPoint> {
    let end = map_end(p);
    (from * PER_DECADE..=to * PER_DECADE)
        .into_par_iter()
        .filter_map(|i| {
            let dt = libm::pow(10f64, f64::from(i) / f64::from(PER_DECADE));
            let p = Parameters { dt, end, ..p.clone() };
            if method == Method::Penalty && dt > penalty_stable_step(&p) {
                return None;
            }
            let out = run(&p, method, unobserved).ok()?;
            Some(MapPoint { dt, x_min: out.x_min, adhesion_slip: out.adhesion_slip })
        })
        .collect()
}
