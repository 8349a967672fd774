//! The tangential compliance of two equal half-spaces at one wavenumber and frequency.

use realfft::num_complex::Complex64;

/// Two equal elastic half-spaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpaces {
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
    /// Speed of shear waves c_s (m/s).
    pub shear_speed: f64,
    /// Speed of pressure waves c_p (m/s).
    pub pressure_speed: f64,
}

/// Displacement of one surface against the other over the traction between them (m/Pa).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compliance {
    /// Along the wavenumber (mode II, plane strain).
    pub in_plane: Complex64,
    /// Across the wavenumber (mode III, antiplane).
    pub antiplane: Complex64,
}

impl HalfSpaces {
    /// Half-spaces of Young's modulus (Pa), Poisson's ratio and density (kg/m^3).
    pub fn new(young: f64, poisson: f64, density: f64) -> Self {
        let shear_modulus = young / (2.0 * (1.0 + poisson));
        let shear_speed = (shear_modulus / density).sqrt();
        let ratio = (2.0 * (1.0 - poisson) / (1.0 - 2.0 * poisson)).sqrt();
        Self { shear_modulus, shear_speed, pressure_speed: ratio * shear_speed }
    }

    /// The squared ratio (c_s/c_p)^2.
    fn slowness_ratio(&self) -> f64 {
        (self.shear_speed / self.pressure_speed).powi(2)
    }

    /// The compliance at the wavenumber `k >= 0` (1/m) and the complex frequency `s` (1/s, fields as e^(st)) with a
    /// positive real part.
    ///
    /// With e = (s/(k c_s))^2, q = (c_s/c_p)^2, a^2 = 1 + e and b^2 = 1 + q e the impedances of a half-space for shear
    /// traction are G k a (antiplane) and G k [(1 + a^2)^2 - 4ab]/(e a) (plane strain, Rayleigh's function: Geubelle and
    /// Rice 1995, Eqs 16 and 21; Achenbach 1973, Sec. 7.4). Two half-spaces in series have twice the compliance
    /// of one. Rayleigh's function is written without the difference of near numbers that small e makes of it.
    pub fn compliance(&self, k: f64, s: Complex64) -> Compliance {
        let two_over_g = 2.0 / self.shear_modulus;
        if k == 0.0 {
            let uniform = Complex64::from(two_over_g * self.shear_speed) / s;
            return Compliance { in_plane: uniform, antiplane: uniform };
        }
        let q = self.slowness_ratio();
        let root = s / (k * self.shear_speed);
        let e = root * root;
        let a = sqrt(e + 1.0);
        let b = sqrt(e * q + 1.0);
        let rayleigh = e + 4.0 - (e * q + (1.0 + q)) * 4.0 / (a * b + 1.0);
        let scale = Complex64::from(two_over_g / k);
        Compliance { in_plane: scale * a / rayleigh, antiplane: scale / a }
    }

    /// What an impulse of force along a line (N s/m), along x and along y on the line x = 0, leaves of relative
    /// displacement at x after the time t, times t (m s per N s/m), where `v = |x|/(c_s t)`: the late part, after
    /// the Rayleigh waves of the line have passed (`v < c_R/c_s`).
    ///
    /// The field is self-similar, and the compliance at the slowness t/x is its transform (Cagniard 1962): t u =
    /// (2/(pi G))/Q(e = -v^2), Q as in [`compliance`](Self::compliance) over k.
    pub fn late_line_impulse(&self, v: f64) -> [f64; 2] {
        let q = self.slowness_ratio();
        let e = -v * v;
        let (a, b) = ((1.0 + e).sqrt(), (1.0 + q * e).sqrt());
        let rayleigh = e + 4.0 - (e * q + (1.0 + q)) * 4.0 / (a * b + 1.0);
        let scale = 2.0 / (std::f64::consts::PI * self.shear_modulus);
        [scale * a / rayleigh, scale / a]
    }

    /// Speed of Rayleigh waves (m/s): the zero of Rayleigh's function, by bisection.
    pub fn rayleigh_speed(&self) -> f64 {
        let q = self.slowness_ratio();
        let rayleigh = |v: f64| {
            let e = -v * v;
            let (a, b) = ((1.0 + e).sqrt(), (1.0 + q * e).sqrt());
            e + 4.0 - 4.0 * (e * q + (1.0 + q)) / (a * b + 1.0)
        };
        let (mut low, mut high) = (0.5, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if rayleigh(middle) > 0.0 { low = middle } else { high = middle }
        }
        low * self.shear_speed
    }
}

/// The square root with a positive real part, by square roots of real numbers alone.
fn sqrt(z: Complex64) -> Complex64 {
    let size = (z.re * z.re + z.im * z.im).sqrt();
    if z.re >= 0.0 {
        let re = (0.5 * (size + z.re)).sqrt();
        Complex64::new(re, if re > 0.0 { 0.5 * z.im / re } else { 0.0 })
    } else {
        let im = (0.5 * (size - z.re)).sqrt();
        Complex64::new(0.5 * z.im.abs() / im, im.copysign(z.im))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steel() -> HalfSpaces {
        HalfSpaces::new(210e9, 0.3, 7850.0)
    }

    #[test]
    fn slow_changes_meet_the_static_compliance_and_fast_ones_the_impedance_of_shear_waves() {
        let steel = steel();
        let (k, g, c) = (1e3, steel.shear_modulus, steel.shear_speed);
        let slow = steel.compliance(k, Complex64::from(1e-6 * k * c));
        // plane strain: (1 - nu)/(G k) for one half-space, antiplane 1/(G k)
        assert!((slow.in_plane.re * g * k / 1.4 - 1.0).abs() < 1e-10);
        assert!((slow.antiplane.re * g * k / 2.0 - 1.0).abs() < 1e-10);
        let s = Complex64::from(1e6 * k * c);
        let fast = steel.compliance(k, s);
        for y in [fast.in_plane, fast.antiplane] {
            assert!(((y * s).re * g / (2.0 * c) - 1.0).abs() < 2e-6);
        }
    }

    #[test]
    fn the_rayleigh_speed_of_steel_is_that_of_the_tables() {
        let steel = steel();
        assert!((steel.rayleigh_speed() / steel.shear_speed - 0.92741).abs() < 1e-5);
    }

    #[test]
    fn rayleighs_function_has_no_cancellation() {
        let steel = steel();
        let k = 1.0;
        // by definition, where that loses no more than four digits
        let s = Complex64::new(3e-3, 4e-3) * steel.shear_speed;
        let e = (s / steel.shear_speed).powi(2);
        let (a, b) = ((e + 1.0).sqrt(), (e * steel.slowness_ratio() + 1.0).sqrt());
        let plain = ((a * a + 1.0).powi(2) - a * b * 4.0) / (e * a);
        let found = 2.0 / (steel.compliance(k, s).in_plane * steel.shear_modulus);
        assert!((found - plain).norm() < 1e-10 * plain.norm(), "{found} {plain}");
    }
}
