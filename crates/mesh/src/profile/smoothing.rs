//! A smoothing spline through measured points.
//!
//! Both coordinates are cubic splines over the length of the points' polygon, so that a steep flank is as smooth as a flat
//! tread. Of all functions whose points miss the measured ones by a given rms distance they have the least integral of the
//! squared second derivative (Reinsch 1967, "Smoothing by spline functions", Numer. Math. 10).

use super::file::check;
use super::{Profile, ProfileError, Shape};

/// The rms distance (m) of the smooth curve from the measured points.
pub const TOLERANCE: f64 = 1e-6;

/// Halvings of the bracket of the smoothing parameter's logarithm.
const HALVINGS: usize = 40;

/// The smooth curve through points (y, z) with y rising (m).
///
/// # Errors
/// Points that are too few, do not rise in y, or have a kink.
pub fn smoothed(points: &[[f64; 2]]) -> Result<Profile, ProfileError> {
    check(points, true)?;
    Ok(Profile { shape: Shape::Measured(SmoothCurve::through(points)) })
}

/// A parametric cubic spline with natural ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SmoothCurve {
    /// Length of the polygon up to each point (m).
    length: Vec<f64>,
    /// y and z at the points, and their second derivatives.
    value: [Vec<f64>; 2],
    bend: [Vec<f64>; 2],
}

impl SmoothCurve {
    fn through(points: &[[f64; 2]]) -> Self {
        let mut length = vec![0.0];
        for pair in points.windows(2) {
            let step = libm::hypot(pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]);
            length.push(length[length.len() - 1] + step);
        }
        let given = [0, 1].map(|i| points.iter().map(|p| p[i]).collect::<Vec<f64>>());
        let fitted = |log: f64| {
            let parts = [0, 1].map(|i| smooth(&length, &given[i], libm::pow(10.0, log)));
            let squares = |i: usize| {
                parts[i].0.iter().zip(&given[i]).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
            };
            let rms = ((squares(0) + squares(1)) / points.len() as f64).sqrt();
            (parts, rms)
        };
        // the distance grows with the parameter (m^3)
        let (mut low, mut high) = (-18.0, 0.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if fitted(middle).1 < TOLERANCE { low = middle } else { high = middle }
        }
        let ([(y, y_bend), (z, z_bend)], _) = fitted(low);
        Self { length, value: [y, z], bend: [y_bend, z_bend] }
    }

    pub(super) fn ends(&self) -> [f64; 2] {
        [self.value[0][0], self.value[0][self.length.len() - 1]]
    }

    /// z, dz/dy and d2z/dy2 at y between the ends.
    pub(super) fn at(&self, y: f64) -> [f64; 3] {
        let last = self.length.len() - 2;
        let cell = self.value[0].partition_point(|v| *v <= y).saturating_sub(1).min(last);
        // y rises along the curve: bisection, then Newton's method
        let (mut low, mut high) = (self.length[cell], self.length[cell + 1]);
        let mut s = 0.5 * (low + high);
        for _ in 0..60 {
            let [value, slope, _] = self.part(0, cell, s);
            if value > y {
                high = s
            } else {
                low = s
            }
            let next = s - (value - y) / slope;
            let newton = next > low && next < high;
            let moved = if newton { next } else { 0.5 * (low + high) };
            if (moved - s).abs() <= 1e-15 * self.length[last + 1] {
                break;
            }
            s = moved;
        }
        let [[_, dy, ddy], [z, dz, ddz]] = [0, 1].map(|i| self.part(i, cell, s));
        [z, dz / dy, (ddz * dy - dz * ddy) / (dy * dy * dy)]
    }

    /// Coordinate `i` and its derivatives by the length at `s` in a cell.
    fn part(&self, i: usize, cell: usize, s: f64) -> [f64; 3] {
        let h = self.length[cell + 1] - self.length[cell];
        let pair = |of: &[f64]| [of[cell], of[cell + 1]];
        part(h, (s - self.length[cell]) / h, pair(&self.value[i]), pair(&self.bend[i]))
    }
}

/// A cubic and its first two derivatives at the part `b` of a cell of the length `h`, from its values and second derivatives at
/// both ends.
pub(super) fn part(h: f64, b: f64, value: [f64; 2], bend: [f64; 2]) -> [f64; 3] {
    let a = 1.0 - b;
    let [left, right] = bend;
    [
        a * value[0]
            + b * value[1]
            + h * h / 6.0 * ((a * a * a - a) * left + (b * b * b - b) * right),
        (value[1] - value[0]) / h
            + h / 6.0 * ((1.0 - 3.0 * a * a) * left + (3.0 * b * b - 1.0) * right),
        a * left + b * right,
    ]
}

/// The second derivatives of the cubic spline over `x` through `y`, with natural ends.
pub(super) fn interpolated(x: &[f64], y: &[f64]) -> Vec<f64> {
    smooth(x, y, 0.0).1
}

/// The values and second derivatives of the smoothing spline over `x` through `y` that minimises the sum of squared distances
/// plus `parameter` times the integral of the squared second derivative: with Reinsch's band matrices Q (second differences)
/// and R, (R + parameter Q^T Q) bend = Q^T y and value = y - parameter Q bend.
fn smooth(x: &[f64], y: &[f64], parameter: f64) -> (Vec<f64>, Vec<f64>) {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|p| p[1] - p[0]).collect();
    // column k of Q, at the points k, k + 1, k + 2
    let column = |k: usize| [1.0 / h[k], -1.0 / h[k] - 1.0 / h[k + 1], 1.0 / h[k + 1]];
    let inner = n - 2;
    let mut band: Vec<[f64; 3]> = (0..inner)
        .map(|k| {
            let here = column(k);
            let dot = |shift: usize| -> f64 {
                if k + shift >= inner {
                    return 0.0;
                }
                let other = column(k + shift);
                (shift..3).map(|i| here[i] * other[i - shift]).sum()
            };
            let mass = if k + 1 < inner { h[k + 1] / 6.0 } else { 0.0 };
            [
                (h[k] + h[k + 1]) / 3.0 + parameter * dot(0),
                mass + parameter * dot(1),
                parameter * dot(2),
            ]
        })
        .collect();
    let mut bend: Vec<f64> =
        (0..inner).map(|k| (0..3).map(|i| column(k)[i] * y[k + i]).sum()).collect();
    solve_pentadiagonal(&mut band, &mut bend);
    let mut value = y.to_vec();
    for (k, bend) in bend.iter().enumerate() {
        (0..3).for_each(|i| value[k + i] -= parameter * column(k)[i] * bend);
    }
    let bend = [0.0].into_iter().chain(bend).chain([0.0]).collect();
    (value, bend)
}

/// Solves a symmetric positive definite system of five diagonals by L D L^T; a row of `band` holds the diagonal and the two
/// entries right of it.
fn solve_pentadiagonal(band: &mut [[f64; 3]], right: &mut [f64]) {
    let n = band.len();
    for k in 0..n {
        let [diagonal, one, two] = band[k];
        let factors = [one / diagonal, two / diagonal];
        if k + 1 < n {
            band[k + 1][0] -= factors[0] * one;
            band[k + 1][1] -= factors[0] * two;
            right[k + 1] -= factors[0] * right[k];
        }
        if k + 2 < n {
            band[k + 2][0] -= factors[1] * two;
            right[k + 2] -= factors[1] * right[k];
        }
        band[k] = [diagonal, factors[0], factors[1]];
    }
    for k in (0..n).rev() {
        let [diagonal, one, two] = band[k];
        let next = |i: usize| right.get(i).copied().unwrap_or(0.0);
        right[k] = right[k] / diagonal - one * next(k + 1) - two * next(k + 2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(noise: f64) -> Vec<[f64; 2]> {
        let at = |i: usize| {
            let angle = 1e-3 * (i as f64 - 100.0) * 5.0;
            let error = if i.is_multiple_of(2) { noise } else { -noise };
            [0.08 * libm::sin(angle), 0.08 * (1.0 - libm::cos(angle)) + error]
        };
        (0..201).map(at).collect()
    }

    #[test]
    fn a_circle_is_met_with_its_curvature_within_the_tolerance() {
        let profile = smoothed(&circle(0.0)).unwrap();
        for y in [-0.02, -0.001, 0.0, 0.013] {
            let [z, slope, bend] = profile.at(y).unwrap();
            let exact = 0.08 - (0.0064 - y * y).sqrt();
            assert!((z - exact).abs() < 3.0 * TOLERANCE, "{y} {z} {exact}");
            let curvature = bend / libm::pow(1.0 + slope * slope, 1.5);
            assert!((curvature * 0.08 - 1.0).abs() < 0.01, "{y} {curvature}");
        }
    }

    #[test]
    fn noise_of_the_size_of_the_tolerance_is_smoothed_away() {
        let profile = smoothed(&circle(0.9 * TOLERANCE)).unwrap();
        let [.., bend] = profile.at(0.001).unwrap();
        // through the points themselves a curve bends by 4 noise/h^2 = 22/m more
        assert!((bend * 0.08 - 1.0).abs() < 0.05, "{bend}");
    }
}
