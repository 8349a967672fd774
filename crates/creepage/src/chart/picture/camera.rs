//! Parallel projection.

type Vec3 = [f64; 3];

/// A camera infinitely far away: lengths across its direction are true, so that a scale bar holds everywhere.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    centre: Vec3,
    right: Vec3,
    up: Vec3,
    toward: Vec3,
    span: f64,
}

impl Camera {
    /// A camera that looks in the direction `toward` with z upwards (y where it looks along z); `centre` is in
    /// the middle of the picture, whose shorter side shows `span` (m).
    pub fn new(centre: Vec3, toward: Vec3, span: f64) -> Self {
        let toward = unit(toward).unwrap_or([0.0, 1.0, 0.0]);
        let level = unit(cross(toward, [0.0, 0.0, 1.0]));
        let right =
            level.unwrap_or_else(|| unit(cross(toward, [0.0, 1.0, 0.0])).unwrap_or_default());
        Self { centre, right, up: cross(right, toward), toward, span }
    }

    /// Length that the shorter side of the picture shows (m).
    pub(super) fn span(&self) -> f64 {
        self.span
    }

    /// Right, up and away from the viewer, from the centre of the picture (m).
    pub fn project(&self, point: Vec3) -> Vec3 {
        self.turned([0, 1, 2].map(|i| point[i] - self.centre[i]))
    }

    /// The same for a direction.
    pub(super) fn turned(&self, vector: Vec3) -> Vec3 {
        [self.right, self.up, self.toward].map(|axis| dot(axis, vector))
    }
}

fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector with length 1; `None` where it has no direction.
fn unit(a: Vec3) -> Option<Vec3> {
    let length = dot(a, a).sqrt();
    (length > 1e-12).then(|| a.map(|x| x / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Vec3, b: Vec3) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn seen_along_y_the_picture_is_x_and_z_and_depth_is_y() {
        let camera = Camera::new([1.0, 2.0, 3.0], [0.0, 5.0, 0.0], 1.0);
        assert!(near(camera.project([1.0, 2.0, 3.0]), [0.0; 3]));
        assert!(near(camera.project([2.0, 4.0, 6.0]), [1.0, 3.0, 2.0]));
    }

    #[test]
    fn lengths_are_kept_from_any_side_and_z_points_up() {
        for toward in [[-0.35, 1.0, -0.3], [0.2, -1.0, 0.9], [0.0, 0.0, -1.0], [0.0; 3]] {
            let camera = Camera::new([0.0; 3], toward, 1.0);
            let [x, y, z] = camera.project([0.3, -0.4, 1.2]);
            assert!((x * x + y * y + z * z - 1.69).abs() < 1e-12, "{toward:?}");
            let up = camera.turned([0.0, 0.0, 1.0]);
            assert!(up[0].abs() < 1e-12 && up[1] >= 0.0, "{toward:?}");
        }
    }
}
