//! The rigid motion of a body.

use crate::check::vector::{Vec3, axpy, sub};

/// A motion in the plane of rolling: a turn from x towards z and a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rigid {
    sine: f64,
    cosine: f64,
    centre: Vec3,
    moved: Vec3,
}

impl Rigid {
    /// The motion that brings `before` nearest to `after`, by least squares; what is left of the
    /// difference is deformation. `None` where there is no point.
    pub(super) fn fit(before: &[Vec3], after: &[Vec3]) -> Option<Self> {
        let count = before.len().min(after.len());
        if count == 0 {
            return None;
        }
        let mean = |points: &[Vec3]| {
            points.iter().take(count).fold([0.0; 3], |sum, p| axpy(sum, 1.0 / count as f64, *p))
        };
        let (centre, moved) = (mean(before), mean(after));
        let (mut along, mut across) = (0.0, 0.0);
        for (p, q) in before.iter().zip(after) {
            let (p, q) = (sub(*p, centre), sub(*q, moved));
            along += p[0] * q[0] + p[2] * q[2];
            across += p[0] * q[2] - p[2] * q[0];
        }
        let size = libm::hypot(along, across);
        let [cosine, sine] = if size > 0.0 { [along / size, across / size] } else { [1.0, 0.0] };
        Some(Self { sine, cosine, centre, moved })
    }

    /// The rows of its matrix: three numbers of the rotation, and what is added (m).
    pub(super) fn rows(self) -> [f64; 12] {
        let [x, y, z] = self.of([0.0; 3]);
        let (c, s) = (self.cosine, self.sine);
        [c, 0.0, -s, x, 0.0, 1.0, 0.0, y, s, 0.0, c, z]
    }

    /// Where the motion brings a point.
    pub(super) fn of(&self, point: Vec3) -> Vec3 {
        let [x, y, z] = sub(point, self.centre);
        let turned = [self.cosine * x - self.sine * z, y, self.sine * x + self.cosine * z];
        axpy(self.moved, 1.0, turned)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wheel() -> Vec<Vec3> {
        let ring = |r: f64| (0..24).map(move |i| (r, f64::from(i) * 0.2618));
        let both = ring(0.1).chain(ring(0.46));
        both.map(|(r, a)| [r * libm::cos(a), 0.01 * a, 0.46 + r * libm::sin(a)]).collect()
    }

    /// The wheel after it has rolled over `s` without slip, about the axis at (0, 0.46).
    fn rolled(s: f64) -> Vec<Vec3> {
        let (sine, cosine) = libm::sincos(-s / 0.46);
        let turn = |p: &Vec3| {
            let [x, z] = [p[0], p[2] - 0.46];
            [cosine * x - sine * z + s, p[1], sine * x + cosine * z + 0.46]
        };
        wheel().iter().map(turn).collect()
    }

    #[test]
    fn a_wheel_that_only_rolled_has_no_deformation() {
        for s in [0.0, 0.06, 1.0, 3.0] {
            let after = rolled(s);
            let rigid = Rigid::fit(&wheel(), &after).unwrap();
            for (p, q) in wheel().iter().zip(&after) {
                let left = sub(*q, rigid.of(*p));
                assert!(left.iter().all(|x| x.abs() < 1e-14), "{s}: {left:?}");
            }
        }
    }

    #[test]
    fn a_dent_is_what_remains() {
        let mut after = rolled(0.3);
        after[40][2] += 1e-4;
        let rigid = Rigid::fit(&wheel(), &after).unwrap();
        let left = sub(after[40], rigid.of(wheel()[40]));
        assert!((left[2] / 1e-4 - 1.0).abs() < 0.1 && left[0].abs() < 1e-5, "{left:?}");
    }

    #[test]
    fn no_points_and_a_single_point_have_no_turn() {
        assert_eq!(Rigid::fit(&[], &[]), None);
        let rigid = Rigid::fit(&[[1.0, 0.0, 0.0]], &[[2.0, 0.0, 0.0]]).unwrap();
        assert_eq!(rigid.of([1.0, 1.0, 1.0]), [2.0, 1.0, 1.0]);
    }
}
