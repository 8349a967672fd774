//! Measures of a contact patch: size, peak pressure and shear, stick.

use crate::reference::{Adhesion, Influence, Pressed, Rolling};
use faer::Mat;
use faer::linalg::solvers::Solve;

/// Points with less than this fraction of the largest pressure are left out of the fit of an
/// ellipsoid: the edge of the patch may cut through their area.
const FITTED: f64 = 0.3;

/// Hertz's ellipsoid of pressure, centred at x = y = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Largest pressure (Pa).
    pub p0: f64,
    /// Half axis along x (m).
    pub a: f64,
    /// Half axis along y (m); infinite where the pressure does not depend on y.
    pub b: f64,
}

/// Fits p^2 = p0^2 (1 - x^2/a^2 - y^2/b^2) to the pressures at the inner points of the patch by least squares. The
/// half axes resolve the size of the patch more finely than the grid does.
///
/// `None` where the points do not determine the ellipsoid.
pub fn ellipsoid(influence: &Influence, pressed: &Pressed) -> Option<Ellipsoid> {
    let pressure = pressed.pressure(influence);
    let peak = pressure.iter().fold(0.0f64, |m, p| m.max(*p));
    let points = influence.points();
    let line = points.iter().all(|p| p.at[1] == points[0].at[1]);
    let unknowns = if line { 2 } else { 3 };
    let scale = points.iter().fold(0.0f64, |m, p| m.max(p.at[0].abs()).max(p.at[1].abs()));
    let mut normal = Mat::<f64>::zeros(unknowns, unknowns);
    let mut right = Mat::<f64>::zeros(unknowns, 1);
    let mut used = 0;
    for (p, point) in pressure.iter().zip(points).filter(|(p, _)| **p > FITTED * peak) {
        let [x, y, _] = (point.at / scale).into();
        let row = [1.0, -x * x, -y * y];
        for i in 0..unknowns {
            right[(i, 0)] += row[i] * (p / peak).powi(2);
            for j in 0..unknowns {
                normal[(i, j)] += row[i] * row[j];
            }
        }
        used += 1;
    }
    if used < unknowns {
        return None;
    }
    let fit = normal.partial_piv_lu().solve(&right);
    let axis = |k: usize| scale * (fit[(0, 0)] / fit[(k, 0)]).sqrt();
    let b = if line { f64::INFINITY } else { axis(2) };
    let found = Ellipsoid { p0: peak * fit[(0, 0)].sqrt(), a: axis(1), b };
    (found.p0.is_finite() && found.a.is_finite() && !found.b.is_nan()).then_some(found)
}

/// Largest shear traction of a patch (Pa), force over area of a point.
pub fn peak_shear(influence: &Influence, rolling: &Rolling<'_>) -> f64 {
    let shear = rolling.contact().iter().zip(rolling.force());
    shear.map(|(&i, f)| libm::hypot(f[0], f[1]) / influence.points()[i].area).fold(0.0, f64::max)
}

/// Fraction of the contact area that sticks (dimensionless).
pub fn stick_fraction(influence: &Influence, rolling: &Rolling<'_>) -> f64 {
    let (mut stick, mut all) = (0.0, 0.0);
    for (&i, state) in rolling.contact().iter().zip(rolling.adhesion()) {
        let area = influence.points()[i].area;
        all += area;
        if state == Adhesion::Stick {
            stick += area;
        }
    }
    stick / all
}

/// The x at which stick ends on the line of points nearest to y = 0 (m): that of its rearmost sticking point.
///
/// The slip of a step belongs to the middle of the pitch ahead of its point. So the border
/// lies between the middles ahead of the last slipping and of the first sticking point, around that x. `None` if
/// the whole line slips.
pub fn stick_border(influence: &Influence, rolling: &Rolling<'_>) -> Option<f64> {
    let points = influence.points();
    let nearest = points.iter().fold(f64::INFINITY, |m, p| m.min(p.at[1].abs()));
    let on_line = |i: usize| points[i].at[1].abs() <= nearest + 0.1 * rolling.pitch();
    let states = rolling.contact().iter().zip(rolling.adhesion());
    let sticking = states.filter(|(i, s)| *s == Adhesion::Stick && on_line(**i));
    sticking.map(|(&i, _)| points[i].at[0]).min_by(f64::total_cmp)
}
