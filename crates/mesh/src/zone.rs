//! The fine zone: the part of both bodies that the contact patch passes over.

use crate::error::{finite, graded, positive, within};
use crate::{Allowed, MeshError, Parameter};

/// The region of uniformly fine elements that the contact patch passes over, and the grading around it.
///
/// It lies under the contact surface of either body, centred laterally on `y = 0`. On the bar
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
    /// Ratio of successive element sizes outside the zone, above 1 and at most 3.
    pub growth: f64,
    /// Largest element size far from the zone (m).
    pub coarsest: f64,
    /// How elements become larger outside the zone.
    pub grading: Grading,
}

/// How elements become larger outside the fine zone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Grading {
    /// Rows and columns run through the whole body, and grow by the ratio `growth`: elements far from the zone are
    /// slender.
    #[default]
    Tensor,
    /// Columns are merged in all three directions, such that sizes grow as those of a series of ratio `growth` do;
    /// elements stay close to cubes. The number of columns of the zone across is rounded up to an even one, and no
    /// element lies across y = 0. Far from the zone, a few columns that fan out may become wider than `coarsest`.
    TwoToOne,
}

impl FineZone {
    /// Refuses a zone that fits no body.
    pub(crate) fn check(&self) -> Result<(), MeshError> {
        positive(Parameter::ZoneSize, self.size)?;
        positive(Parameter::ZoneLength, self.length)?;
        positive(Parameter::ZoneWidth, self.width)?;
        positive(Parameter::ZoneDepth, self.depth)?;
        positive(Parameter::Coarsest, self.coarsest)?;
        finite(Parameter::ZoneStart, self.start)?;
        graded(self.size, self.growth, self.coarsest)?;
        let least = self.length.min(self.width).min(self.depth);
        let allowed = Allowed::AtMost(least, "the least of the zone's length, width and depth");
        within(self.size <= least, Parameter::ZoneSize, self.size, allowed)
    }

    /// Estimate of the number of elements, from those of the tensor product, `tensor`. Of shells, only the zone is
    /// known beforehand: a lower bound.
    pub(crate) fn estimate(&self, tensor: f64) -> f64 {
        match self.grading {
            Grading::Tensor => tensor,
            Grading::TwoToOne => [self.length, self.width, self.depth]
                .map(|l| (l / self.size).max(1.0))
                .iter()
                .product(),
        }
    }

    /// Refuses a zone whose size `value` in one direction is above `most`, that of `what`.
    pub(crate) fn fits(
        parameter: Parameter,
        value: f64,
        most: f64,
        what: &'static str,
    ) -> Result<(), MeshError> {
        within(value <= most * (1.0 + 1e-12), parameter, value, Allowed::AtMost(most, what))
    }
}

/// Sagitta (m) of a circle of radius `crown` at the distance `y` from its apex; zero without a crown.
///
/// Written as `y^2/(c + sqrt(c^2 - y^2))`, which loses no digits where `c` is large.
pub(crate) fn sag(crown: Option<f64>, y: f64) -> f64 {
    match crown {
        None => 0.0,
        Some(c) => y * y / (c + (c * c - y * y).max(0.0).sqrt()),
    }
}

/// Refuses a crown whose radius is below half the `width`, or that falls by more than half the `thickness`.
pub(crate) fn check_crown(
    parameter: Parameter,
    crown: Option<f64>,
    width: f64,
    thickness: f64,
) -> Result<(), MeshError> {
    let Some(c) = crown else { return Ok(()) };
    positive(parameter, c)?;
    let half = 0.5 * width;
    within(c >= half, parameter, c, Allowed::AtLeast(half, "half the width"))?;
    let (fall, most) = (sag(crown, half), 0.5 * thickness);
    within(fall <= most, parameter, c, Allowed::Falls { fall, most })
}
