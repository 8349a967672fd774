//! Why a profile cannot be used.

use super::ProfileBody;
use thiserror::Error;

/// Why a profile, or the position of a wheel on a rail, cannot be used. Places are those of the file, in mm.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ProfileError {
    /// A line that is no point, or says something that is not read.
    #[error("line {line}: {problem}")]
    Line {
        /// Line of the file, from 1.
        line: usize,
        /// What is wrong with it.
        problem: String,
    },
    /// Too few points, or too narrow.
    #[error("the profile is too short: {points} points over {width_mm:.3} mm")]
    Short {
        /// Points.
        points: usize,
        /// Its width (mm).
        width_mm: f64,
    },
    /// Numbers that look like metres.
    #[error(
        "the profile is {width:.4} wide: its numbers look like metres, and the file must be in millimetres"
    )]
    Metres {
        /// Its width in the file's numbers.
        width: f64,
    },
    /// y does not increase.
    #[error(
        "y goes back from {before_mm:.4} to {y_mm:.4} mm at point {point}: an undercut, or points out of order"
    )]
    Undercut {
        /// Point, from 1.
        point: usize,
        /// y of the point before (mm).
        before_mm: f64,
        /// y of the point (mm).
        y_mm: f64,
    },
    /// A corner.
    #[error("the profile has a kink of {degrees:.1} degrees at y = {y_mm:.4} mm, point {point}")]
    Kink {
        /// Point, from 1.
        point: usize,
        /// Its y (mm).
        y_mm: f64,
        /// By how much the polygon of the points turns (degrees).
        degrees: f64,
    },
    /// A file of the other body.
    #[error("this is the profile of a {}, and that of a {} is meant: are wheel and rail swapped?", found.name(), wanted.name())]
    Body {
        /// What it is of.
        found: ProfileBody,
        /// What it should be of.
        wanted: ProfileBody,
    },
    /// Wheel and rail do not lie over one another.
    #[error(
        "there is no contact at this position: the wheel's profile lies from {wheel_mm:?} mm, the rail's from {rail_mm:?} mm"
    )]
    Apart {
        /// The wheel's two ends (mm).
        wheel_mm: [f64; 2],
        /// The rail's two ends (mm).
        rail_mm: [f64; 2],
    },
    /// The profiles come nearest at the end of one of them.
    #[error(
        "wheel and rail come nearest at an end of a profile, y = {wheel_mm:.2} mm of the wheel and {rail_mm:.2} mm of the rail: \
         the position is wrong, a profile too short, or wheel and rail are swapped"
    )]
    AtEnd {
        /// y on the wheel (mm).
        wheel_mm: f64,
        /// y on the rail (mm).
        rail_mm: f64,
    },
}
