//! The longitudinal force of steady rolling on an ellipse in closed form: Kalker's linear theory, and what saturates it.

use std::f64::consts::{FRAC_PI_2, PI};

/// Kalker's C11 at a/b = 0.1, 0.2, ..., 1, then at b/a = 0.1, 0.2, ..., 1, each for Poisson's ratio 0, 1/4 and 1/2 (Kalker 1990,
/// *Three-Dimensional Elastic Bodies in Rolling Contact*, Table E3).
const C11: [[[f64; 3]; 10]; 2] = [
    [
        [2.51, 3.31, 4.85],
        [2.59, 3.37, 4.81],
        [2.68, 3.44, 4.80],
        [2.78, 3.53, 4.82],
        [2.88, 3.62, 4.83],
        [2.98, 3.72, 4.91],
        [3.09, 3.81, 4.97],
        [3.19, 3.91, 5.05],
        [3.29, 4.01, 5.12],
        [3.40, 4.12, 5.20],
    ],
    [
        [10.7, 11.7, 12.9],
        [6.96, 7.78, 8.82],
        [5.57, 6.34, 7.34],
        [4.84, 5.57, 6.57],
        [4.37, 5.10, 6.11],
        [4.06, 4.78, 5.80],
        [3.82, 4.54, 5.58],
        [3.65, 4.36, 5.42],
        [3.51, 4.22, 5.30],
        [3.40, 4.12, 5.20],
    ],
];

/// Kalker's coefficient C11 at a/b and Poisson's ratio, interpolated in its table: linear in the ratio of the axes, and
/// its inverse, a flexibility, by a parabola in Poisson's ratio. `None` where one axis is more than ten times the other.
pub fn c11(shape: f64, poisson: f64) -> Option<f64> {
    let (table, ratio) = if shape <= 1.0 { (&C11[0], shape) } else { (&C11[1], 1.0 / shape) };
    let place = 10.0 * ratio - 1.0;
    if place.is_nan() || place < 0.0 {
        return None;
    }
    let row = (place as usize).min(8);
    let part = place - row as f64;
    let [zero, quarter, half] =
        [0, 1, 2].map(|k| 1.0 / (table[row][k] + part * (table[row + 1][k] - table[row][k])));
    let flexibility = 8.0 * (poisson - 0.25) * (poisson - 0.5) * zero
        - 16.0 * poisson * (poisson - 0.5) * quarter
        + 8.0 * poisson * (poisson - 0.25) * half;
    Some(1.0 / flexibility)
}

/// Forces of pure longitudinal creepage over the bound of friction, T/(mu N): dimensionless, with the sign of the creepage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedForms {
    /// Kalker's linear theory, e = G a b C11 xi/(mu N) (Kalker 1990).
    pub linear: f64,
    /// Kalker's simplified theory (1982), which FASTSIM integrates, without its error of integration.
    pub fastsim: f64,
    /// The cubic of Vermeulen and Johnson (1964) with the slope of the linear theory (Shen, Hedrick and Elkins 1983): e - e^2/3 +
    /// e^3/27, and 1 from e = 3 on.
    pub cubic: f64,
}

impl ClosedForms {
    /// Those of the linear theory's T/(mu N).
    pub fn of(linear: f64) -> Self {
        let e = linear.abs().min(3.0);
        let cubic = e - e * e / 3.0 + e * e * e / 27.0;
        Self { linear, fastsim: fastsim(linear), cubic: cubic.copysign(linear) }
    }
}

/// T/(mu N) of Kalker's simplified theory (Vehicle Syst. Dyn. 11, 1982), which FASTSIM integrates, with exact
/// integration, at that of the linear theory.
///
/// The bound is that of a paraboloid of pressure, the flexibility L = 8 a/(3 G C11). On the strip at y, of half length l,
/// the shear grows from the front as xi (l - x)/L and meets the bound at x = 2 a s - l, with s = 3 pi e/32; so the
/// strip bears in proportion to 2 l^2 (2 a s) - l (2 a s)^2 + (2 a s)^3/6, and where l < a s slips as a whole. With l = a cos t
/// and cos t1 = s the sum over all strips is
///
/// T/(mu N) = 16/pi [s (S - S^3/3) - s^2 (t1 + s S)/2 + s^3 S/3 + (1/3) (integral of cos^4 from t1 to pi/2)], S = sin t1.
fn fastsim(linear: f64) -> f64 {
    let s = 3.0 * PI / 32.0 * linear.abs();
    if s >= 1.0 {
        return 1f64.copysign(linear);
    }
    let (t, sine) = (libm::acos(s), (1.0 - s * s).sqrt());
    let fourth = |t: f64| 0.375 * t + 0.25 * libm::sin(2.0 * t) + libm::sin(4.0 * t) / 32.0;
    let stick =
        s * (sine - sine.powi(3) / 3.0) - 0.5 * s * s * (t + s * sine) + s.powi(3) * sine / 3.0;
    let slip = (fourth(FRAC_PI_2) - fourth(t)) / 3.0;
    (16.0 / PI * (stick + slip)).copysign(linear)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn c11_is_that_of_contact_for_a_circle_and_an_ellipse() {
        // CONTACT (Vollebregt), extrapolated to h = 0; the table has three digits
        for (shape, poisson, reference) in
            [(1.0, 0.25, 4.1125), (1.0, 0.3, 4.2941), (7.1617 / 5.3872, 0.3, 4.6200)]
        {
            let found = c11(shape, poisson).unwrap();
            assert!((found / reference - 1.0).abs() < 5e-3, "{shape} {poisson}: {found}");
        }
        assert_eq!(c11(0.05, 0.3), None);
        assert_eq!(c11(20.0, 0.3), None);
    }

    /// FASTSIM as Kalker (1982) gives it: strips of cells from the front to the rear.
    fn by_cells(linear: f64) -> f64 {
        const N: i32 = 400;
        let mut sum = 0.0;
        for j in 0..N {
            let y = (f64::from(j) + 0.5) / f64::from(N);
            let l = (1.0 - y * y).sqrt();
            let (dx, mut shear) = (2.0 * l / f64::from(N), 0.0f64);
            for i in 0..N {
                let x = l - (f64::from(i) + 0.5) * dx;
                // over mu Z0, whose integral over the ellipse is pi/2; slope of the shear 3 pi e/16
                let bound = l * l - x * x;
                shear = (shear + if i == 0 { 0.5 } else { 1.0 } * dx * 3.0 * PI / 16.0 * linear)
                    .min(bound);
                sum += 2.0 * shear * dx / f64::from(N);
            }
        }
        sum / FRAC_PI_2
    }

    #[test]
    fn the_closed_form_of_the_simplified_theory_is_what_fastsim_adds_up() {
        for linear in [0.01, 0.5, 1.0, 2.0, 3.0, 3.3, 5.0] {
            let (closed, cells) = (fastsim(linear), by_cells(linear));
            assert!((closed - cells).abs() < 2e-4, "{linear}: {closed} {cells}");
            assert_eq!(fastsim(-linear), -closed);
        }
    }
}
