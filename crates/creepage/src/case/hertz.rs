//! Hertz's contact of two bodies with aligned principal curvatures: the scale of a case.
//!
//! Source: Johnson (1985), *Contact Mechanics*, sections 4.1 and 4.2.

use std::f64::consts::PI;

use crate::case::schema::{BodyModel, Case};
use contact::patch::PatchShape;
use mesh::profile::ContactPoint;

/// Patch and pressure of Hertz's elliptic contact, or of its line contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hertz {
    /// Half axis in the rolling direction (m).
    pub a: f64,
    /// Half axis across (m); half the common width for a line contact.
    pub b: f64,
    /// Largest pressure (Pa).
    pub p0: f64,
    /// Approach of the two bodies (m); zero for a line contact, where it is not defined.
    pub approach: f64,
}

impl Hertz {
    /// Area of the patch (m^2): an ellipse's, or a line contact's rectangle.
    pub fn area(&self) -> f64 {
        if self.approach > 0.0 { PI * self.a * self.b } else { 4.0 * self.a * self.b }
    }
}

/// Sums of the curvatures along the rolling direction and across (1/m); with profiles those at the first point of contact,
/// across no less than a hundredth of those along, and no numbers without contact.
fn curvatures(case: &Case) -> [f64; 2] {
    match case.wheel_on_rail() {
        Ok(None) => {
            let across = case.disk.crown_radius.curvature() + case.bar.crown_radius.curvature();
            [1.0 / case.disk.radius, across]
        }
        Ok(Some(pair)) => match pair.first_contact() {
            Ok(ContactPoint { curvature: [along, across], .. }) => {
                [along, across.max(FLATTEST * along)]
            }
            Err(_) => [f64::NAN; 2],
        },
        Err(_) => [f64::NAN; 2],
    }
}

/// See [`curvatures`].
const FLATTEST: f64 = 0.01;

/// Shape of the patch of a case: a rectangle where both bodies are straight across, as in plane strain, else an
/// ellipse.
pub fn patch_shape(case: &Case) -> PatchShape {
    let across = case.disk.crown_radius.curvature() + case.bar.crown_radius.curvature();
    if case.has_profiles() || across > 0.0 { PatchShape::Ellipse } else { PatchShape::Rectangle }
}

/// Hertz's contact of a case's disk on its bar under `load.normal`. A line contact has the width of the narrower
/// body, or that of the fine zone on half-spaces.
pub fn hertz(case: &Case) -> Hertz {
    let compliance = |m: crate::case::schema::Material| (1.0 - m.poisson * m.poisson) / m.young;
    let modulus = 1.0 / (compliance(case.disk_material()) + compliance(case.bar_material()));
    let [along, across] = curvatures(case);
    let load = case.load.normal;
    if patch_shape(case) == PatchShape::Rectangle {
        let width = match case.model {
            BodyModel::FiniteElements => case.disk.width.min(case.bar.width),
            BodyModel::HalfSpace => case.mesh.zone.width,
        };
        return line(load / width, along, modulus, width);
    }
    // Half the sum of the curvatures in each direction, the gap being A x^2 + B y^2.
    of_gap(load, [along / 2.0, across / 2.0], modulus)
}

/// Hertz's contact of bodies with the gap A x^2 + B y^2, A and B in 1/m, under a load (N); `modulus` (Pa) is E*.
pub(crate) fn of_gap(load: f64, [along, across]: [f64; 2], modulus: f64) -> Hertz {
    let ellipse = ellipse(load, along.min(across), along.max(across), modulus);
    if along <= across { ellipse } else { Hertz { a: ellipse.b, b: ellipse.a, ..ellipse } }
}

/// The gap whose patch has these half axes along x and y (m): the inverse of [`of_gap`].
pub(crate) fn gap_of_axes(load: f64, axes: [f64; 2], modulus: f64) -> [f64; 2] {
    let (long, short) = (axes[0].max(axes[1]), axes[0].min(axes[1]));
    // a circle has the limit (K - E)/m = pi/4
    let m = (1.0 - (short / long).powi(2)).max(1e-9);
    let (k, e) = elliptic(m);
    let low = 1.5 * load * (k - e) / (PI * modulus * m * long.powi(3));
    let high = low * (e / (1.0 - m) - k) / (k - e);
    if axes[0] >= axes[1] { [low, high] } else { [high, low] }
}

/// Dundurs' constant beta of a case's disk and bar (dimensionless), zero for like materials (Johnson 1985, Eq 5.3):
///
/// beta = 1/2 ((1 - 2 nu_1)/G_1 - (1 - 2 nu_2)/G_2)/((1 - nu_1)/G_1 + (1 - nu_2)/G_2)
///
/// It couples slip to pressure: with beta, bodies have shear tractions in free rolling (Bufler 1959; Bentall and
/// Johnson 1967). The disk is body 1.
pub fn dundurs_beta(case: &Case) -> f64 {
    let parts = |m: crate::case::schema::Material| {
        let shear = m.young / (2.0 * (1.0 + m.poisson));
        [(1.0 - 2.0 * m.poisson) / shear, (1.0 - m.poisson) / shear]
    };
    let ([disk, a], [bar, b]) = (parts(case.disk_material()), parts(case.bar_material()));
    0.5 * (disk - bar) / (a + b)
}

/// Line contact (Johnson 1985, section 4.2): a^2 = 4 P R/(pi E*), p0 = 2 P/(pi a), P per width.
fn line(load_per_width: f64, curvature: f64, modulus: f64, width: f64) -> Hertz {
    let a = (4.0 * load_per_width / (PI * curvature * modulus)).sqrt();
    Hertz { a, b: width / 2.0, p0: 2.0 * load_per_width / (PI * a), approach: 0.0 }
}

/// Elliptic contact with gap `low` x^2 + `high` y^2, `low <= high`, so that `a >= b`
/// (Johnson 1985, Eqs 4.26 to 4.28), solved for the eccentricity by bisection.
fn ellipse(load: f64, low: f64, high: f64, modulus: f64) -> Hertz {
    // B/A = ((a/b)^2 E - K)/(K - E), from 1 for a circle to infinity for a line; in the modulus
    // of the complete integrals m = e^2 = 1 - (b/a)^2.
    let ratio = |m: f64| {
        let (k, e) = elliptic(m);
        (e / (1.0 - m) - k) / (k - e)
    };
    let (mut below, mut above) = (1e-9, 1.0 - 1e-12);
    for _ in 0..200 {
        let middle = 0.5 * (below + above);
        if ratio(middle) < high / low { below = middle } else { above = middle }
    }
    let m = 0.5 * (below + above);
    let (k, e) = elliptic(m);
    // low = (p0/E*) b (K - E)/(m a^2) with p0 = 3 P/(2 pi a b): a^3 = 3 P (K - E)/(2 pi E* m low).
    let a = libm::cbrt(1.5 * load * (k - e) / (PI * modulus * m * low));
    let b = a * (1.0 - m).sqrt();
    let p0 = 1.5 * load / (PI * a * b);
    Hertz { a, b, p0, approach: p0 / modulus * b * k }
}

/// Complete elliptic integrals K(m) and E(m), m the squared modulus, by the arithmetic-geometric mean.
fn elliptic(m: f64) -> (f64, f64) {
    let (mut x, mut y, mut power) = (1.0, (1.0 - m).sqrt(), 0.5);
    let mut sum = 0.5 * m;
    for _ in 0..40 {
        let c = 0.5 * (x - y);
        (x, y) = (0.5 * (x + y), (x * y).sqrt());
        power *= 2.0;
        sum += power * c * c;
    }
    let k = PI / (2.0 * x);
    (k, k * (1.0 - sum))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gap_of_given_axes_has_those_axes() {
        for axes in [[8e-3, 4e-3], [3e-3, 5e-3], [5e-3, 5e-3]] {
            let found = of_gap(82e3, gap_of_axes(82e3, axes, 1.1e11), 1.1e11);
            for (found, given) in [found.a, found.b].iter().zip(axes) {
                assert!((found / given - 1.0).abs() < 1e-4, "{found} {given}");
            }
        }
    }
}
