//! The fine zone: where contact passes.

use crate::MeshError;
use crate::error::positive;

/// The region of uniformly fine elements that contact passes over, and the grading around it.
///
/// It lies under the contacting surface of either body, centred laterally on `y = 0`. On the bar
/// it spans `start <= x <= start + length`; on the disk the arc of the same coordinates, so that
/// in rolling the two zones meet point by point. Its extents are rounded up to whole elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FineZone {
    /// Edge length of the elements in the zone (m).
    pub size: f64,
    /// Extent along the rolling direction (m); the zone begins at `start`.
    pub length: f64,
    /// Lateral extent (m).
    pub width: f64,
    /// Extent below the surface (m).
    pub depth: f64,
    /// `x` of the rear end, relative to the first contact (m).
    pub start: f64,
    /// Ratio of successive element sizes outside the zone.
    pub growth: f64,
    /// Largest element size far from the zone (m).
    pub coarsest: f64,
}

impl FineZone {
    /// Refuses what no body could satisfy.
    pub(crate) fn check(&self) -> Result<(), MeshError> {
        positive("mesh.zone.size", self.size)?;
        positive("mesh.zone.length", self.length)?;
        positive("mesh.zone.width", self.width)?;
        positive("mesh.zone.depth", self.depth)?;
        positive("mesh.zone.coarsest", self.coarsest)?;
        if !self.start.is_finite() {
            return Err(MeshError::range(
                "mesh.zone.start",
                self.start,
                "a finite number",
                "give the x of the zone's rear end in metres",
            ));
        }
        if !(self.growth > 1.0 && self.growth <= 3.0) {
            return Err(MeshError::range(
                "mesh.zone.growth",
                self.growth,
                "above 1 and at most 3",
                "1.35 is a good value",
            ));
        }
        if self.coarsest < self.size {
            return Err(MeshError::range(
                "mesh.zone.coarsest",
                self.coarsest,
                format!("at least mesh.zone.size = {}", self.size),
                "raise it, or lower the size",
            ));
        }
        let least = self.length.min(self.width).min(self.depth);
        if self.size > least {
            return Err(MeshError::range(
                "mesh.zone.size",
                self.size,
                format!("at most {least}, the least of the zone's length, width and depth"),
                "lower it, or enlarge the zone",
            ));
        }
        Ok(())
    }

    /// Refuses a zone that is larger than `room` in one direction.
    pub(crate) fn fits(
        parameter: &'static str,
        value: f64,
        room: f64,
        what: &str,
    ) -> Result<(), MeshError> {
        if value <= room * (1.0 + 1e-12) {
            return Ok(());
        }
        Err(MeshError::range(
            parameter,
            value,
            format!("at most {room}, {what}"),
            "shrink the zone or enlarge the body",
        ))
    }
}

/// Sagitta of a circle of radius `crown` at the distance `y` from its apex (m).
///
/// Written as `y^2/(c + sqrt(c^2 - y^2))`, which keeps its digits where `c` is large.
pub(crate) fn sag(crown: Option<f64>, y: f64) -> f64 {
    match crown {
        None => 0.0,
        Some(c) => y * y / (c + (c * c - y * y).max(0.0).sqrt()),
    }
}

/// Refuses a crown that does not reach across `width`, or that eats half of `thickness`.
pub(crate) fn check_crown(
    parameter: &'static str,
    crown: Option<f64>,
    width: f64,
    thickness: f64,
) -> Result<(), MeshError> {
    let Some(c) = crown else { return Ok(()) };
    positive(parameter, c)?;
    if c < 0.5 * width {
        return Err(MeshError::range(
            parameter,
            c,
            format!("at least {}, half the width", 0.5 * width),
            "raise it, or leave it out for a straight profile",
        ));
    }
    let drop = sag(crown, 0.5 * width);
    if drop > 0.5 * thickness {
        return Err(MeshError::range(
            parameter,
            c,
            format!("large enough to fall by less than {} over the width", 0.5 * thickness),
            format!("it falls by {drop}: raise it, or narrow the body"),
        ));
    }
    Ok(())
}
