//! Convolution quadrature: the weights of a convolution in time from the transform of its kernel.

use realfft::num_complex::Complex64;
use realfft::{ComplexToReal, RealFftPlanner};
use std::sync::Arc;

/// Points of the contour per weight, and the size of what the contour's finite number of points folds back, relative to
/// the weights.
const POINTS_PER_LAG: usize = 4;
const FOLDED: f64 = 1e-14;

/// Lubich's convolution quadrature with the backward difference formula of second order (Lubich 1988, Numer. Math. 52,
/// 129-145).
///
/// With the kernel's Laplace transform F(s) the weights w_m are the coefficients of F(delta(z)/dt) in powers of z, with
/// delta(z) = 3/2 - 2z + z^2/2. The formula is A-stable: weights of a passive F are passive for
/// every time step, so that free surfaces, whose Rayleigh waves nothing damps, stay bounded.
#[derive(Clone)]
pub struct Quadrature {
    /// Frequencies (1/s) on the upper half of the contour, ends included.
    frequencies: Vec<Complex64>,
    /// Radius of the contour.
    radius: f64,
    lags: usize,
    inverse: Arc<dyn ComplexToReal<f64>>,
}

impl Quadrature {
    /// For the weights of the lags 0 to `lags - 1` with the step `dt` (s).
    pub fn new(lags: usize, dt: f64) -> Self {
        let points = (POINTS_PER_LAG * lags.max(2)).next_power_of_two();
        let radius = libm::pow(FOLDED, 1.0 / points as f64);
        let frequency = |j: usize| {
            let angle = 2.0 * std::f64::consts::PI * j as f64 / points as f64;
            let z = Complex64::new(libm::cos(angle), -libm::sin(angle)) * radius;
            (z * z * 0.5 - z * 2.0 + 1.5) / dt
        };
        let inverse = RealFftPlanner::new().plan_fft_inverse(points);
        Self { frequencies: (0..=points / 2).map(frequency).collect(), radius, lags, inverse }
    }

    /// The frequencies (1/s) at which the transform is asked for.
    pub fn frequencies(&self) -> &[Complex64] {
        &self.frequencies
    }

    /// The weights, from the transform at [`frequencies`](Self::frequencies).
    pub fn weights(&self, mut transform: Vec<Complex64>) -> Vec<f64> {
        let points = self.inverse.len();
        // the kernel is real: so is its transform at real frequencies
        transform[0].im = 0.0;
        transform[points / 2].im = 0.0;
        let mut weights = vec![0.0; points];
        // fails for lengths alone, which are those of the plan
        let done = self.inverse.process(&mut transform, &mut weights);
        debug_assert!(done.is_ok());
        weights.truncate(self.lags);
        let mut scale = 1.0 / points as f64;
        for w in &mut weights {
            *w *= scale;
            scale /= self.radius;
        }
        weights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_of_an_integral_are_those_of_the_backward_difference_formula() {
        let (lags, dt) = (50, 0.1);
        let quadrature = Quadrature::new(lags, dt);
        let weights =
            quadrature.weights(quadrature.frequencies().iter().map(|s| 1.0 / s).collect());
        // 3/2 u_n - 2 u_(n-1) + 1/2 u_(n-2) = dt f_n with f an impulse: u_n = dt (1 - 3^-(n+1))
        for (n, w) in weights.iter().enumerate() {
            let exact = dt * (1.0 - libm::pow(3.0, -(n as f64 + 1.0)));
            assert!((w - exact).abs() < 1e-12, "{n}: {w} {exact}");
        }
    }

    #[test]
    fn an_oscillator_that_nothing_damps_keeps_within_its_amplitude_and_converges_at_second_order() {
        let error = |lags: usize| {
            let dt = 20.0 / lags as f64;
            let quadrature = Quadrature::new(lags, dt);
            let transform = quadrature.frequencies().iter().map(|s| 1.0 / (s * s + 1.0)).collect();
            let weights = quadrature.weights(transform);
            let exact = |n: usize| libm::sin(n as f64 * dt);
            // away from the start, where the kernel is not smooth
            (lags / 4..lags).map(|n| (weights[n] / dt - exact(n)).abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(400), error(800));
        assert!(coarse < 0.05 && (coarse / fine - 4.0).abs() < 0.2, "{coarse} {fine}");
    }
}
