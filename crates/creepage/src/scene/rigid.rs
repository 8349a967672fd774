//! The rigid motion of a body.

use nalgebra::Vector3;

/// A motion in the plane of rolling: a turn from x towards z and a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rigid {
    sine: f64,
    cosine: f64,
    centre: Vector3<f64>,
    moved: Vector3<f64>,
}

impl Rigid {
    /// The motion that brings `before` nearest to `after`, by least squares; what is left of the
    /// difference is deformation. `None` where there is no point.
    pub(super) fn fit(before: &[Vector3<f64>], after: &[Vector3<f64>]) -> Option<Self> {
        let count = before.len().min(after.len());
        if count == 0 {
            return None;
        }
        let mean = |points: &[Vector3<f64>]| {
            points.iter().take(count).map(|p| 1.0 / count as f64 * p).sum::<Vector3<f64>>()
        };
        let (centre, moved) = (mean(before), mean(after));
        let (mut along, mut across) = (0.0, 0.0);
        for (p, q) in before.iter().zip(after) {
            let (p, q) = (p - centre, q - moved);
            along += p[0] * q[0] + p[2] * q[2];
            across += p[0] * q[2] - p[2] * q[0];
        }
        let size = libm::hypot(along, across);
        let [cosine, sine] = if size > 0.0 { [along / size, across / size] } else { [1.0, 0.0] };
        Some(Self { sine, cosine, centre, moved })
    }

    /// The rows of its matrix: three numbers of the rotation, and what is added (m).
    pub(super) fn rows(self) -> [f64; 12] {
        let [x, y, z] = self.of(Vector3::zeros()).into();
        let (c, s) = (self.cosine, self.sine);
        [c, 0.0, -s, x, 0.0, 1.0, 0.0, y, s, 0.0, c, z]
    }

    /// Where the motion brings a point.
    pub(super) fn of(&self, point: Vector3<f64>) -> Vector3<f64> {
        let arm = point - self.centre;
        let (x, z) =
            (self.cosine * arm.x - self.sine * arm.z, self.sine * arm.x + self.cosine * arm.z);
        self.moved + Vector3::new(x, arm.y, z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wheel() -> Vec<Vector3<f64>> {
        let ring = |r: f64| (0..24).map(move |i| (r, f64::from(i) * 0.2618));
        let both = ring(0.1).chain(ring(0.46));
        both.map(|(r, a)| Vector3::new(r * libm::cos(a), 0.01 * a, 0.46 + r * libm::sin(a)))
            .collect()
    }

    /// The wheel after it has rolled over `s` without slip, about the axis at (0, 0.46).
    fn rolled(s: f64) -> Vec<Vector3<f64>> {
        let (sine, cosine) = libm::sincos(-s / 0.46);
        let turn = |p: &Vector3<f64>| {
            let [x, z] = [p[0], p[2] - 0.46];
            Vector3::new(cosine * x - sine * z + s, p[1], sine * x + cosine * z + 0.46)
        };
        wheel().iter().map(turn).collect()
    }

    #[test]
    fn a_wheel_that_only_rolled_has_no_deformation() {
        for s in [0.0, 0.06, 1.0, 3.0] {
            let after = rolled(s);
            let rigid = Rigid::fit(&wheel(), &after).unwrap();
            for (p, q) in wheel().iter().zip(&after) {
                let left = q - rigid.of(*p);
                assert!(left.iter().all(|x| x.abs() < 1e-14), "{s}: {left:?}");
            }
        }
    }

    #[test]
    fn a_dent_is_what_remains() {
        let mut after = rolled(0.3);
        after[40][2] += 1e-4;
        let rigid = Rigid::fit(&wheel(), &after).unwrap();
        let left = after[40] - rigid.of(wheel()[40]);
        assert!((left[2] / 1e-4 - 1.0).abs() < 0.1 && left[0].abs() < 1e-5, "{left:?}");
    }

    #[test]
    fn no_points_and_a_single_point_have_no_turn() {
        assert_eq!(Rigid::fit(&[], &[]), None);
        let rigid = Rigid::fit(&[Vector3::x()], &[2.0 * Vector3::x()]).unwrap();
        assert_eq!(rigid.of(Vector3::repeat(1.0)), Vector3::new(2.0, 1.0, 1.0));
    }
}
