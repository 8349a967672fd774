//! Second moments of a mass: its inertia against turns about any axis.

use nalgebra::Vector3;

/// Sums of mass times products of the arms in x, y and z (kg m^2).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SecondMoments {
    pub(crate) xx: f64,
    pub(crate) yy: f64,
    pub(crate) zz: f64,
    pub(crate) xy: f64,
    pub(crate) yz: f64,
    pub(crate) xz: f64,
}

impl SecondMoments {
    /// Of masses (kg) with these arms (m).
    pub(crate) fn of(masses: impl Iterator<Item = (f64, Vector3<f64>)> + Clone) -> Self {
        let sum =
            |i: usize, j: usize| exact_sum::sum(masses.clone().map(|(m, arm)| m * arm[i] * arm[j]));
        let [xx, yy, zz] = [0, 1, 2].map(|i| sum(i, i));
        Self { xx, yy, zz, xy: sum(0, 1), yz: sum(1, 2), xz: sum(0, 2) }
    }

    /// Adds a solid cylinder about y of this mass (kg), radius and length (m).
    pub(crate) fn add_cylinder(&mut self, mass: f64, radius: f64, length: f64) {
        self.xx += 0.25 * mass * radius * radius;
        self.zz += 0.25 * mass * radius * radius;
        self.yy += mass * length * length / 12.0;
    }

    /// Those of the mass turned about +y by the angle of this sine and cosine.
    pub(crate) fn turned(&self, sin: f64, cos: f64) -> Self {
        let Self { xx, yy, zz, xy, yz, xz } = *self;
        let (ss, cc, sc) = (sin * sin, cos * cos, sin * cos);
        Self {
            xx: cc * xx + 2.0 * sc * xz + ss * zz,
            yy,
            zz: cc * zz - 2.0 * sc * xz + ss * xx,
            xy: cos * xy + sin * yz,
            yz: cos * yz - sin * xy,
            xz: (cc - ss) * xz + sc * (zz - xx),
        }
    }
}
