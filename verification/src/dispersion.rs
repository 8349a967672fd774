//! How a small disturbance of steady sliding grows under falling friction with memory.
//!
//! Two equal elastic half-spaces slide past one another at V under the pressure p, out of the plane of
//! the disturbance (mode III). Friction follows Eq. (8) with a memory, above its floor,
//! `d(mu)/dt = -(s/d_c)(mu - mu_steady(s))`. The displacement of the disturbance is
//! `±(D/2) exp(i k x + q t - a |z|)` with `a^2 = k^2 + q^2/c_s^2`, Re a > 0. The shear stress of the bodies
//! at the interface falls by `(G/2) a D`, and friction rises by `p dmu`. To first order
//! `q dmu = -(V/d_c)(dmu - mu' q D)`, so that
//!
//! `(G/2) sqrt(k^2 + q^2/c_s^2) + p mu'(V) q/(1 + q d_c/V) = 0`,
//!
//! where the term of the half-spaces is that of Geubelle and Rice (1995), J. Mech. Phys. Solids 43: 1791–1824. With
//! `w = k c_s`, `R = -p mu'/Z`, `Z = rho c_s/2`, `T = d_c/V` and q, T in units of w this reads
//!
//! `sqrt(1 + q^2) (1 + T q) = R q`.
//!
//! Consequences:
//!
//! - For T = 0 and R > 1, `q = 1/sqrt(R^2 - 1)`: the growth rate rises with k without bound, and the law without
//!   memory is ill-posed. For R < 1, `q = ±i/sqrt(1 - R^2)`: waves that neither grow nor decay.
//! - With memory the growth rate is bounded. That of long waves tends to `(R - 1)/T`; that of short ones, `T >> R`,
//!   falls as `R^2/T^3`.
//! - But *disturbances never decay*. On the imaginary axis the square root is real for |q| < 1 and imaginary beyond
//!   (with the sign of q, by radiation). In neither case can the left-hand side equal the right-hand side for T > 0: no
//!   root crosses the axis. As T goes to 0 there are two roots to the right of it, for R > 1 and for R < 1 (where the
//!   pair above grows at `T R^2/(1 - R^2)^2`), hence for every T. Without inertia the equation would be
//!   `1 + T q = R q`, whose root decays for T > R; with inertia waves along the interface grow instead.

use faer::c64 as Complex;
use faer::mat;

/// The parameters of the stability of steady sliding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sliding {
    /// Shear wave speed `c_s` (m/s).
    pub wave_speed: f64,
    /// Impedance `Z = rho c_s/2` of both bodies in series (Pa s/m).
    pub impedance: f64,
    /// `-p mu'(V)`, by which the friction stress falls with slip speed (Pa s/m).
    pub falling: f64,
    /// `d_c/V` (s).
    pub delay: f64,
}

impl Sliding {
    /// The fastest growing root q (1/s) at the wave number `k > 0` (1/m); of a conjugate pair the one with Im >= 0.
    pub fn growth(&self, k: f64) -> Option<Complex> {
        let w = k * self.wave_speed;
        let q = fastest(self.falling / self.impedance, self.delay * w)?;
        Some(q * w)
    }

    /// The decay `a` into either body (1/m) of a disturbance with wave number `k` (1/m) and growth `q` (1/s).
    pub fn decay(&self, k: f64, q: Complex) -> Complex {
        (k * k + (q / self.wave_speed).powi(2)).sqrt()
    }
}

/// The root of `sqrt(1 + q^2) (1 + T q) = R q` with the largest real part, with Re sqrt > 0 and Im q >= 0. The squared
/// equation has four roots; those that solve the equation itself are kept.
fn fastest(r: f64, t: f64) -> Option<Complex> {
    let c = [2.0 / t, (1.0 + t * t - r * r) / (t * t), 2.0 / t, 1.0 / (t * t)];
    let companion = mat![
        [-c[0], -c[1], -c[2], -c[3]],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
    ];
    let solves = |q: &Complex| {
        let left = (1.0 + q * q).sqrt() * (1.0 + t * q);
        (left - r * q).norm() < (left + r * q).norm()
    };
    let roots = companion.eigenvalues().ok()?;
    let growing = roots.iter().filter(|q| q.re > 0.0 && q.im >= 0.0 && solves(q));
    growing.max_by(|a, b| a.re.total_cmp(&b.re)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn misfit(r: f64, t: f64, q: Complex) -> f64 {
        ((1.0 + q * q).sqrt() * (1.0 + t * q) - r * q).norm() / (r * q).norm()
    }

    #[test]
    fn the_root_solves_the_equation_for_every_memory_and_never_decays() {
        for r in [0.3, 0.9, 1.5, 8.0, 80.0] {
            for t in [1e-2, 0.3, 1.0, 3.0, 10.0, 50.0] {
                let q = fastest(r, t).unwrap();
                assert!(misfit(r, t, q) < 1e-9, "{r} {t}: {q}");
                assert!(q.re > 0.0, "{r} {t}: {q}");
            }
        }
    }

    #[test]
    fn long_waves_grow_as_uniform_sliding_and_short_ones_as_the_memory_to_the_third() {
        assert!((fastest(8.0, 1e-3).unwrap().re * 1e-3 - 7.0).abs() < 1e-3);
        let (r, t) = (2.0, 200.0);
        let q = fastest(r, t).unwrap();
        assert!((q.re / (r * r / t.powi(3)) - 1.0).abs() < 1e-3, "{q}");
        assert!((q.im - 1.0).abs() < 1e-4, "{q}");
    }

    #[test]
    fn weakly_falling_friction_grows_with_a_little_memory_and_not_without() {
        let (r, t) = (0.6, 1e-3);
        let q = fastest(r, t).unwrap();
        assert!((q.im - 1.25).abs() < 1e-4, "{q}");
        assert!((q.re / (t * 0.36 / 0.64f64.powi(2)) - 1.0).abs() < 1e-2, "{q}");
    }
}
