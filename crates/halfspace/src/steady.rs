//! Steady rolling without inertia under Coulomb's friction.

use crate::compliance::HalfSpaces;
use crate::ellipse::Ellipse;
use crate::rolling::{Inertia, Rigid, Rolling, RollingError, Setup};
use friction::Coulomb;
use std::sync::Arc;

/// Spacings in the half axis of the circle of the patch's area, which holds 800 points. The error is of first order in the
/// spacing: at a/b = 1.33 the force is larger than CONTACT's by 0.9 and 0.4 % at T/(mu N) = 0.56 and 0.80.
const SPACINGS: f64 = 16.0;
/// Rolling is steady when the force changes by less than this part of mu N over a spacing.
const STEADY: f64 = 1e-6;
/// Lengths of the patch within which it must become so.
const LENGTHS: f64 = 30.0;

/// Steady rolling of two half-spaces.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyRolling {
    /// Spacing of the points (m).
    pub spacing: f64,
    /// Force on the upper body along x and y over the normal force.
    pub traction: [f64; 2],
    /// The points on y = 0 by x: x from the patch's centre (m), magnitude of the shear (Pa).
    pub centreline: Vec<[f64; 2]>,
}

/// Why there is no steady rolling.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SteadyError {
    /// The patch cannot be set up.
    #[error(transparent)]
    Rolling(#[from] RollingError),
    /// The force still changes.
    #[error("after {steps} steps the force still changes by {change:.1e} of mu N")]
    Unsteady {
        /// Steps taken.
        steps: usize,
        /// Change in the last one, over mu N.
        change: f64,
    },
}

/// Steady rolling of a patch, in three dimensions, at a creepage (`along` of `rigid`) with the coefficient of friction `mu`: rolled
/// from rest, by a spacing a step, until nothing changes.
///
/// # Errors
/// A patch that cannot be set up; a force that does not become steady.
pub fn steady(
    bodies: HalfSpaces,
    patch: Ellipse,
    mu: f64,
    rigid: Rigid,
) -> Result<SteadyRolling, SteadyError> {
    let spacing =
        (patch.half_length * patch.half_width.unwrap_or(patch.half_length)).sqrt() / SPACINGS;
    let mut rolling = Rolling::new(Setup {
        bodies,
        spacing,
        patch: patch.into(),
        offset: 0.0,
        // without inertia and with a constant coefficient no result depends on the speed
        speed: 1.0,
        start: 0.0,
        step: spacing,
        inertia: Inertia::Static,
        law: Arc::new(Coulomb { mu }),
        pressure_factor: None,
    })?;
    let most = (LENGTHS * 2.0 * patch.half_length / spacing) as usize;
    let (mut before, mut change) = ([0.0; 2], f64::INFINITY);
    for _ in 0..most {
        let sums = rolling.step(rigid);
        let traction = sums.shear.map(|force| force / sums.normal);
        change = libm::hypot(traction[0] - before[0], traction[1] - before[1]) / mu;
        if change < STEADY && sums.unconverged == 0.0 {
            return Ok(SteadyRolling { spacing, traction, centreline: centreline(&rolling) });
        }
        before = traction;
    }
    Err(SteadyError::Unsteady { steps: most, change })
}

fn centreline(rolling: &Rolling) -> Vec<[f64; 2]> {
    let points = rolling.patch().filter(|point| point.line == 0);
    let mut line: Vec<_> =
        points.map(|point| [point.at[0], libm::hypot(point.shear[0], point.shear[1])]).collect();
    line.sort_by(|a, b| a[0].total_cmp(&b[0]));
    line
}
