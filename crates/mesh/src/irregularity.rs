//! Irregularities of running surfaces: corrugation, rough rails, flats and wheels out of round.
//!
//! They change the surface of a body and not its mesh: neither mass nor stiffness.

use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::fmt::Debug;
use std::sync::Arc;
use thiserror::Error;

/// Largest height above or below the smooth surface (m). Larger ones are taken for millimetres.
pub const HIGHEST: f64 = 5e-3;
/// Longest span of a table along x (m).
const LONGEST: f64 = 1e3;
/// Angles may exceed a turn by this part of it: 6.2832 is a turn.
const TURN: f64 = 1e-4;
/// What a wheel's height after a turn may differ from that before it (m).
pub const CLOSED: f64 = 1e-8;

/// Heights over the material (m).
pub trait Heights: Debug + Send + Sync {
    /// Height at a coordinate along the surface, in m or rad, and at y across it (m).
    fn at(&self, coordinate: f64, y: f64) -> f64;
}

/// The coordinate along a surface that an irregularity depends on, beside y across it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// x (m); heights are along z.
    X,
    /// The angle about the axis along y through this point (rad): zero below it, positive towards +x, where material touches
    /// later if the body rolls towards +x. Heights are along the radius.
    Around(Vector3<f64>),
}

impl Along {
    /// The coordinate of a place of the undeformed body (m or rad).
    pub fn coordinate(&self, at: Vector3<f64>) -> f64 {
        match self {
            Self::X => at.x,
            Self::Around(axis) => libm::atan2(at.x - axis.x, axis.z - at.z),
        }
    }

    /// The unit vector along which the height at a place of the undeformed body is measured.
    pub fn outward(&self, at: Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::X => Vector3::z(),
            Self::Around(axis) => {
                let arm = Vector3::new(at.x - axis.x, 0.0, at.z - axis.z);
                arm / libm::hypot(arm.x, arm.z).max(f64::MIN_POSITIVE)
            }
        }
    }
}

/// What a surface has beyond its smooth shape.
#[derive(Clone, Debug)]
pub struct Irregularity {
    /// Its coordinate.
    pub along: Along,
    /// Its heights.
    pub heights: Arc<dyn Heights>,
}

/// Heights that are linear between points.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightTable {
    /// Coordinate and height (m), coordinates rising.
    points: Vec<[f64; 2]>,
    /// After which they repeat (rad).
    period: Option<f64>,
}

/// Heights on a grid of places x, y, bilinear between them. Beyond its edges those there go on.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightGrid {
    /// Places along and across, rising (m).
    places: [Vec<f64>; 2],
    /// Of each x those of all y (m).
    heights: Vec<f64>,
}

/// Why points give no heights.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum HeightError {
    /// There is no line between them.
    #[error("there must be two points or more")]
    Few,
    /// A coordinate that is not finite, or absurd.
    #[error("point {number} lies at {at}, which must be finite and at most {LONGEST} in size")]
    Place {
        /// Number of the point, from 1.
        number: usize,
        /// Its coordinate.
        at: f64,
    },
    /// A height that is not finite, or absurd.
    #[error(
        "point {number}, at {at}, has the height {height} m, which must be finite and at most {HIGHEST} m in size: \
         is it in mm or um?"
    )]
    Height {
        /// Number of the point, from 1.
        number: usize,
        /// Its coordinate.
        at: f64,
        /// Its height.
        height: f64,
    },
    /// Points that do not fill a grid.
    #[error(
        "{points} points have {along} different x and {across} different y: a grid has one point at each x and y, two or more of both"
    )]
    Grid {
        /// Their number.
        points: usize,
        /// Different places along.
        along: usize,
        /// Different places across.
        across: usize,
    },
    /// Coordinates do not rise.
    #[error("point {number} lies at {at}, which must be above that of the point before, {before}")]
    Order {
        /// Number of the point, from 1.
        number: usize,
        /// Its coordinate.
        at: f64,
        /// That of the point before.
        before: f64,
    },
    /// More than a turn.
    #[error("the angles span {span} rad, more than a turn: are they in degrees?")]
    Turn {
        /// Number of the last point, from 1.
        number: usize,
        /// What they span.
        span: f64,
    },
    /// A whole turn after which the height is another one.
    #[error("after a turn the height is {last} m, at its beginning {first} m: they must be equal")]
    Open {
        /// Number of the last point, from 1.
        number: usize,
        /// First height (m).
        first: f64,
        /// Last height (m).
        last: f64,
    },
}

impl HeightError {
    /// What is wrong with the height at a place, whatever the other points are.
    fn of(number: usize, at: f64, height: f64) -> Result<(), Self> {
        if !(at.is_finite() && at.abs() <= LONGEST) {
            return Err(Self::Place { number, at });
        }
        if !(height.is_finite() && height.abs() <= HIGHEST) {
            return Err(Self::Height { number, at, height });
        }
        Ok(())
    }

    /// Number of the point that is wrong, from 1.
    pub fn number(&self) -> usize {
        match *self {
            Self::Few | Self::Grid { .. } => 1,
            Self::Place { number, .. }
            | Self::Height { number, .. }
            | Self::Order { number, .. }
            | Self::Turn { number, .. }
            | Self::Open { number, .. } => number,
        }
    }
}

impl HeightTable {
    /// Heights (m) over x (m). Beyond the ends those there go on.
    ///
    /// # Errors
    /// Points that are too few, not finite, in no order, or too high.
    pub fn along(points: Vec<[f64; 2]>) -> Result<Self, HeightError> {
        if points.len() < 2 {
            return Err(HeightError::Few);
        }
        for (i, (&[at, height], number)) in points.iter().zip(1..).enumerate() {
            HeightError::of(number, at, height)?;
            if i > 0 && at <= points[i - 1][0] {
                return Err(HeightError::Order { number, at, before: points[i - 1][0] });
            }
        }
        Ok(Self { points, period: None })
    }

    /// Heights (m) over the angle (rad), which repeat after a turn. They are linear also from the last point to the first of
    /// the next turn.
    ///
    /// # Errors
    /// As those of [`Self::along`], and angles that span more than a turn, or one after which the height is another one.
    pub fn around(points: Vec<[f64; 2]>) -> Result<Self, HeightError> {
        let Self { points, .. } = Self::along(points)?;
        let (number, [start, first], [end, last]) =
            (points.len(), points[0], points[points.len() - 1]);
        let span = end - start;
        if span > TAU * (1.0 + TURN) {
            return Err(HeightError::Turn { number, span });
        }
        if span > TAU * (1.0 - TURN) && (last - first).abs() > CLOSED {
            return Err(HeightError::Open { number, first, last });
        }
        Ok(Self { points, period: Some(TAU) })
    }

    /// The first coordinate and the last.
    pub fn ends(&self) -> [f64; 2] {
        [self.points[0][0], self.points[self.points.len() - 1][0]]
    }
}

impl HeightGrid {
    /// Heights from points [x, y, height] (m) in any order.
    ///
    /// # Errors
    /// Points that are not finite, too high, or do not fill a grid.
    pub fn new(points: &[[f64; 3]]) -> Result<Self, HeightError> {
        for (&[x, y, height], number) in points.iter().zip(1..) {
            HeightError::of(number, x, height)?;
            HeightError::of(number, y, height)?;
        }
        let places = [0, 1].map(|axis| {
            let mut all: Vec<f64> = points.iter().map(|point| point[axis]).collect();
            all.sort_by(f64::total_cmp);
            all.dedup();
            all
        });
        let [along, across] = [0, 1].map(|axis| places[axis].len());
        let none = HeightError::Grid { points: points.len(), along, across };
        // scattered points would need the square of their number
        if along < 2 || across < 2 || points.len() != along * across {
            return Err(none);
        }
        let mut heights = vec![f64::NAN; points.len()];
        for &[x, y, height] in points {
            let [i, j] =
                [(0, x), (1, y)].map(|(axis, at)| places[axis].partition_point(|p| *p < at));
            heights[i * across + j] = height;
        }
        // a place that is given twice leaves another one without height
        let filled = heights.iter().all(|z| z.is_finite());
        filled.then_some(Self { places, heights }).ok_or(none)
    }

    /// The first and the last place along (0) or across (1) the surface.
    pub fn ends(&self, axis: usize) -> [f64; 2] {
        let places = &self.places[axis];
        [places[0], places[places.len() - 1]]
    }

    /// The place before `at`, and which part of the way to the next one `at` lies.
    fn before(places: &[f64], at: f64) -> (usize, f64) {
        let next = places.partition_point(|place| *place <= at).clamp(1, places.len() - 1);
        let [low, high] = [places[next - 1], places[next]];
        (next - 1, ((at - low) / (high - low)).clamp(0.0, 1.0))
    }
}

impl Heights for HeightGrid {
    fn at(&self, x: f64, y: f64) -> f64 {
        let ((i, s), (j, t)) = (Self::before(&self.places[0], x), Self::before(&self.places[1], y));
        let across = self.places[1].len();
        let [near, far] = [j, j + 1].map(|j| {
            let [z0, z1] = [i, i + 1].map(|i| self.heights[i * across + j]);
            z0 + (z1 - z0) * s
        });
        near + (far - near) * t
    }
}

impl Heights for HeightTable {
    fn at(&self, coordinate: f64, _: f64) -> f64 {
        let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
        let (s, after) = match self.period {
            Some(turn) => {
                let turns = ((coordinate - first[0]) / turn).floor();
                (coordinate - turns * turn, [first[0] + turn, first[1]])
            }
            None => (coordinate, [f64::INFINITY, last[1]]),
        };
        let next = self.points.partition_point(|point| point[0] <= s);
        let [s0, z0] = next.checked_sub(1).map_or(first, |before| self.points[before]);
        let [s1, z1] = self.points.get(next).copied().unwrap_or(after);
        if s <= s0 || s1 <= s0 || z0 == z1 {
            return z0;
        }
        z0 + (z1 - z0) * ((s - s0) / (s1 - s0)).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn heights_are_linear_between_points_and_go_on_beyond_them() {
        let table = HeightTable::along(vec![[-1.0, 1e-3], [0.0, 0.0], [2.0, -2e-3]]).unwrap();
        for (x, z) in
            [(-9.0, 1e-3), (-1.0, 1e-3), (-0.5, 5e-4), (0.0, 0.0), (1.0, -1e-3), (7.0, -2e-3)]
        {
            assert!((table.at(x, 0.0) - z).abs() < 1e-18, "{x}");
        }
        assert_eq!(table.ends(), [-1.0, 2.0]);
        assert!(table.at(f64::NAN, 0.0).is_finite());
    }

    #[test]
    fn heights_of_a_wheel_repeat_after_a_turn_and_join_the_last_point_to_the_first() {
        let flat = HeightTable::around(vec![[-0.1, 0.0], [0.0, -1e-3], [0.1, 0.0]]).unwrap();
        for turn in -2..=2 {
            let at = |angle: f64| flat.at(angle + f64::from(turn) * TAU, 0.0);
            assert!((at(0.0) + 1e-3).abs() < 1e-15 && (at(0.05) + 5e-4).abs() < 1e-15);
            assert!(at(3.0) == 0.0 && at(-0.2) == 0.0);
        }
        let open = HeightTable::around(vec![[0.0, 0.0], [5.0, 1e-3]]).unwrap();
        assert!((open.at(0.5 * (5.0 + TAU), 0.0) - 5e-4).abs() < 1e-15);
        assert!(HeightTable::around(vec![[0.0, 1e-4], [3.0, 0.0], [6.2834, 1e-4]]).is_ok());
    }

    #[test]
    fn a_grid_is_bilinear_and_has_the_bits_of_a_table_where_heights_are_the_same_across() {
        let bilinear = |x: f64, y: f64| 1e-3 * (1.0 + 2.0 * x - 3.0 * y + 4.0 * x * y);
        let places = [[0.0, 0.3], [0.0, -0.1], [0.5, 0.3], [0.2, -0.1], [0.5, -0.1], [0.2, 0.3]];
        let grid = HeightGrid::new(&places.map(|[x, y]| [x, y, bilinear(x, y)])).unwrap();
        assert_eq!([grid.ends(0), grid.ends(1)], [[0.0, 0.5], [-0.1, 0.3]]);
        for x in [-1.0_f64, 0.0, 0.1, 0.2, 0.33, 0.5, 2.0] {
            for y in [-1.0_f64, -0.1, 0.07, 0.3, 9.0] {
                let expected = bilinear(x.clamp(0.0, 0.5), y.clamp(-0.1, 0.3));
                assert!((grid.at(x, y) - expected).abs() < 1e-17, "{x} {y}");
            }
        }
        let points = [[-0.1, 1e-4], [0.03, -2e-4], [0.2, 3.3e-4]];
        let rows = points.map(|[x, z]| [[x, -0.1, z], [x, 0.2, z]]).concat();
        let (table, grid) =
            (HeightTable::along(points.to_vec()).unwrap(), HeightGrid::new(&rows).unwrap());
        for i in 0..100 {
            let x = -0.13 + 0.00391 * f64::from(i);
            assert_eq!(grid.at(x, 0.0317).to_bits(), table.at(x, 0.0).to_bits());
        }
    }

    #[test]
    fn points_that_fill_no_grid_are_told() {
        let square = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]];
        let mut twice = square;
        twice[3] = square[2];
        let mut high = square;
        high[2][2] = 0.1;
        for (points, number, words) in [
            (&[][..], 1, "0 points have 0 different x and 0 different y"),
            (&square[..2], 1, "2 points have 1 different x and 2 different y"),
            (&square[..3], 1, "3 points have 2 different x and 2 different y"),
            (&twice, 1, "4 points have 2 different x and 2 different y"),
            (&high, 3, "in mm or um?"),
        ] {
            let error = HeightGrid::new(points).unwrap_err();
            assert!(error.number() == number && error.to_string().contains(words), "{error}");
        }
    }

    #[test]
    fn points_that_give_no_heights_are_told_with_their_number() {
        let along = |points: &[[f64; 2]]| HeightTable::along(points.to_vec()).unwrap_err();
        let around = |points: &[[f64; 2]]| HeightTable::around(points.to_vec()).unwrap_err();
        for (error, number, words) in [
            (along(&[]), 1, "two points"),
            (along(&[[0.0, 0.0]]), 1, "two points"),
            (along(&[[0.0, 0.0], [1.0, f64::NAN]]), 2, "height NaN"),
            (along(&[[0.0, 0.0], [1.0, 0.02]]), 2, "in mm or um?"),
            (along(&[[0.0, 0.0], [0.0, 1e-3]]), 2, "above that of the point before"),
            (along(&[[0.0, 0.0], [f64::INFINITY, 1e-3]]), 2, "finite"),
            (around(&[[0.0, 0.0], [360.0, 0.0]]), 2, "degrees"),
            (around(&[[0.0, 0.0], [6.2829, 1e-4]]), 2, "must be equal"),
        ] {
            assert!(error.number() == number && error.to_string().contains(words), "{error}");
        }
    }

    #[test]
    fn the_angle_counts_towards_the_material_that_touches_later() {
        let along = Along::Around(Vector3::new(0.0, 0.0, 0.5));
        let at = Vector3::new(0.5 * libm::sin(0.1), 0.2, 0.5 - 0.5 * libm::cos(0.1));
        assert!((along.coordinate(at) - 0.1).abs() < 1e-15);
        let outward = Vector3::new(libm::sin(0.1), 0.0, -libm::cos(0.1));
        assert!((along.outward(at) - outward).norm() < 1e-15);
    }
}
