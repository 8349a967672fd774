//! Transverse profiles of wheel and rail: a curve z(y).
//!
//! As in the standards and in measured files, y points away from the middle of the track and z down; the origin is
//! that of the profile (the tread datum of a wheel, the crown's apex of a rail of a standard). Lengths in m.

mod error;
mod file;
mod first_contact;
mod section;
mod smoothing;
mod standard;

pub use error::ProfileError;
pub use file::{ProfileBody, read_profile};
pub use first_contact::{ContactPoint, Overlap, RigidSlip, WheelOnRail};
pub use section::{Section, profiled_bar, profiled_disk};
pub use smoothing::{TOLERANCE, smoothed};
pub use standard::{STANDARD_PROFILES, rail_60e1, rail_head, wheel_s1002};

use smoothing::SmoothCurve;

/// A profile: pieces of a standard's drawing, or a smooth curve through measured points.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    shape: Shape,
}

#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Drawn(Vec<Piece>),
    Measured(SmoothCurve),
}

/// A piece of a drawing, from its `from` to the next piece's; the last one ends at `to`.
#[derive(Clone, Debug, PartialEq)]
struct Piece {
    from: f64,
    to: f64,
    curve: Drawn,
}

#[derive(Clone, Debug, PartialEq)]
enum Drawn {
    /// Coefficients of y^0, y^1, ...
    Polynomial(Vec<f64>),
    /// Centre (y, z) and radius; `below` where the curve lies at larger z than the centre.
    Arc { centre: [f64; 2], radius: f64, below: bool },
}

impl Profile {
    /// A circular crown of the radius `radius`, convex upward where positive (rail) and convex downward where negative
    /// (wheel), to `half_width` on either side.
    pub fn crown(radius: f64, half_width: f64) -> Self {
        let curve = Drawn::Arc { centre: [0.0, radius], radius: radius.abs(), below: radius < 0.0 };
        Self { shape: Shape::Drawn(vec![Piece { from: -half_width, to: half_width, curve }]) }
    }

    /// A straight line of the slope dz/dy, to `half_width` on either side: a cone.
    pub fn cone(slope: f64, half_width: f64) -> Self {
        let curve = Drawn::Polynomial(vec![0.0, slope]);
        Self { shape: Shape::Drawn(vec![Piece { from: -half_width, to: half_width, curve }]) }
    }

    /// Its two ends, y.
    pub fn ends(&self) -> [f64; 2] {
        match &self.shape {
            Shape::Drawn(pieces) => {
                [pieces.first().map_or(0.0, |p| p.from), pieces.last().map_or(0.0, |p| p.to)]
            }
            Shape::Measured(curve) => curve.ends(),
        }
    }

    /// z, dz/dy and d2z/dy2 at y; `None` beyond the ends.
    pub fn at(&self, y: f64) -> Option<[f64; 3]> {
        let [low, high] = self.ends();
        if !(low..=high).contains(&y) {
            return None;
        }
        match &self.shape {
            Shape::Drawn(pieces) => {
                let next = pieces.partition_point(|piece| piece.from <= y);
                Some(pieces[next.max(1) - 1].curve.at(y))
            }
            Shape::Measured(curve) => Some(curve.at(y)),
        }
    }
}

impl Drawn {
    fn at(&self, y: f64) -> [f64; 3] {
        match self {
            Self::Polynomial(coefficients) => {
                let mut value = [0.0; 3];
                for c in coefficients.iter().rev() {
                    value =
                        [c + y * value[0], value[0] + y * value[1], 2.0 * value[1] + y * value[2]];
                }
                value
            }
            Self::Arc { centre, radius, below } => {
                let across = y - centre[0];
                let up = (radius * radius - across * across).max(0.0).sqrt();
                let sign = if *below { 1.0 } else { -1.0 };
                let slope = -sign * across / up;
                [centre[1] + sign * up, slope, -sign * radius * radius / (up * up * up)]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_curve() {
        let (h, e) = (1e-6, 1e-5);
        for profile in [rail_60e1(), wheel_s1002(), Profile::crown(-0.3, 0.03)] {
            for y in [-0.028, -0.02, -0.005, 0.004, 0.0271] {
                let [value, slope, bend] = profile.at(y).unwrap();
                let [left, right] = [y - h, y + h].map(|y| profile.at(y).unwrap());
                assert!(((right[0] - left[0]) / (2.0 * h) - slope).abs() < e, "{y} {value}");
                assert!(((right[1] - left[1]) / (2.0 * h) - bend).abs() < e * bend.abs() + e);
            }
            assert_eq!(profile.at(1.0), None);
        }
    }
}
