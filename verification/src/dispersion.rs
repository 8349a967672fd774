//! How a small disturbance of steady sliding grows under falling friction with memory.
//!
//! Two equal elastic half-spaces slide past one another at V under the pressure p, across the wave of the disturbance
//! (mode III) or along it (mode II, which does not change the pressure between equal bodies). Friction follows
//! Eq. (8) with a memory, above its floor, `d(mu)/dt = -(s/d_c)(mu - mu_steady(s))`. The slip of the disturbance is
//! `D exp(i k x + q t)`. The shear stress of the bodies at the interface falls by `D/Y(k, q)`, where Y is their
//! compliance (Geubelle and Rice 1995, J. Mech. Phys. Solids 43: 1791–1824), and friction rises by `p dmu`. To first
//! order `q dmu = -(V/d_c)(dmu - mu' q D)`, so that
//!
//! `1/Y(k, q) + p mu'(V) q/(1 + q d_c/V) = 0`,
//!
//! in mode III with `1/Y = (G/2) sqrt(k^2 + q^2/c_s^2)`. With `w = k c_s`, `R = -p mu'/Z`, `Z = rho c_s/2`,
//! `T = d_c/V` and q, T in units of w this reads
//!
//! `sqrt(1 + q^2) (1 + T q) = R q`.
//!
//! Consequences in mode III:
//!
//! - For T = 0 and R > 1, `q = 1/sqrt(R^2 - 1)`: the growth rate rises with k without bound, and the law without
//!   memory is ill-posed. For R < 1, `q = ±i/sqrt(1 - R^2)`: waves that neither grow nor decay.
//! - With memory the growth rate is bounded. That of long waves tends to `(R - 1)/T`; that of short ones, `T >> R`,
//!   falls as `R^2/T^3`.
//! - But *disturbances never decay*. On the imaginary axis the square root is real for |q| < 1 and imaginary beyond
//!   (with the sign of q, by radiation). In neither case can the left-hand side equal the right-hand side for T > 0: no
//!   root crosses the axis. As T goes to 0 there are two roots to the right of it, for R > 1 and for R < 1 (where the
//!   pair above grows at `T R^2/(1 - R^2)^2`), hence for every T. Without inertia the equation would be
//!   `1 + T q = R q`, whose root decays for T > R, that is for waves shorter than `pi G d_c/(p V |mu'|)`; with
//!   inertia waves along the interface grow instead, by `(R/T)^2` e-folds per distance d_c of slip.
//!
//! In mode II `1/Y` vanishes for Rayleigh waves, near which waves of slip grow however small R is, (T36).

use faer::c64 as Complex;
use faer::mat;
use halfspace::HalfSpaces;

/// How slip lies to the wave of the disturbance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Mode {
    /// Mode II: along it, in plane strain.
    InPlane,
    /// Mode III: across it.
    Antiplane,
}

/// The parameters of the stability of steady sliding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sliding {
    pub bodies: HalfSpaces,
    pub mode: Mode,
    /// `-p mu'(V)`, by which the friction stress falls with slip speed (Pa s/m).
    pub falling: f64,
    /// `d_c/V` (s).
    pub delay: f64,
}

impl Sliding {
    /// The fastest growing root q (1/s) at the wave number `k > 0` (1/m); of a conjugate pair the one with Im >= 0.
    pub fn growth(&self, k: f64) -> Option<Complex> {
        let HalfSpaces { shear_modulus, shear_speed, .. } = self.bodies;
        let (w, impedance) = (k * shear_speed, 0.5 * shear_modulus / shear_speed);
        let (r, t) = (self.falling / impedance, self.delay * w);
        let antiplane = growing(r, t)?.into_iter().map(|q| q * w);
        let roots: Vec<_> = match self.mode {
            Mode::Antiplane => antiplane.collect(),
            Mode::InPlane => {
                // near the roots of mode III, of uniform sliding and of Rayleigh waves, whose speed is 0.93 c_s
                let rayleigh = Complex::new(0.01 * r.min(1.0), 0.93);
                let others = [Complex::from(w * (r - 1.0).abs() / t), rayleigh * w];
                antiplane.chain(others).filter_map(|q| self.root_near(k, q)).collect()
            }
        };
        roots.into_iter().max_by(|a, b| a.re.total_cmp(&b.re))
    }

    /// The root (1/s) that the secant method finds from `q`, if it grows.
    fn root_near(&self, k: f64, q: Complex) -> Option<Complex> {
        let (mut before, mut q) = (q, 1.01 * q);
        let mut residual = self.residual(k, before);
        for _ in 0..100 {
            let next = self.residual(k, q);
            let step = next * (q - before) / (next - residual);
            (before, residual, q) = (q, next, q - step);
            if q.re <= 0.0 || !q.is_finite() {
                return None;
            }
            if step.norm() < 1e-12 * q.norm() {
                return Some(q);
            }
        }
        None
    }

    /// The left-hand side of the dispersion equation times `1 + q d_c/V` (Pa/m).
    fn residual(&self, k: f64, q: Complex) -> Complex {
        (1.0 + self.delay * q) / self.compliance(k, q) - self.falling * q
    }

    /// Slip over the shear between the bodies (m/Pa) at the wave number `k` (1/m) and the frequency `q` (1/s).
    pub fn compliance(&self, k: f64, q: Complex) -> Complex {
        let both = self.bodies.compliance(k, q);
        match self.mode {
            Mode::InPlane => both.in_plane,
            Mode::Antiplane => both.antiplane,
        }
    }

    /// The decay `a` into either body (1/m) of an antiplane disturbance with wave number `k` (1/m) and growth `q` (1/s).
    pub fn decay(&self, k: f64, q: Complex) -> Complex {
        (k * k + (q / self.bodies.shear_speed).powi(2)).sqrt()
    }
}

/// The roots of `sqrt(1 + q^2) (1 + T q) = R q` with Re q > 0, Im q >= 0 and Re sqrt > 0. The squared equation has
/// four roots; those that solve the equation itself are kept.
fn growing(r: f64, t: f64) -> Option<Vec<Complex>> {
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
    Some(roots.into_iter().filter(|q| q.re > 0.0 && q.im >= 0.0 && solves(q)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fastest(r: f64, t: f64) -> Option<Complex> {
        growing(r, t)?.into_iter().max_by(|a, b| a.re.total_cmp(&b.re))
    }

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

    /// (T36)
    #[test]
    fn in_plane_waves_of_slip_grow_near_those_of_rayleigh_however_weakly_friction_falls() {
        let bodies = HalfSpaces::new(210e9, 0.3, 7800.0);
        let k = 1e3;
        let w = k * bodies.shear_speed;
        let impedance = 0.5 * bodies.shear_modulus / bodies.shear_speed;
        let rayleigh = bodies.rayleigh_speed() / bodies.shear_speed;
        let growth = |r: f64, t: f64| {
            let (falling, delay) = (r * impedance, t / w);
            Sliding { bodies, mode: Mode::InPlane, falling, delay }.growth(k).unwrap() / w
        };
        // D(e) = 2/(G k Y), with its zero at -c_R^2/c_s^2
        let d = |e: f64| {
            let q = Complex::new(0.0, (-e).sqrt()) * w;
            (2.0 / (bodies.shear_modulus * k * bodies.compliance(k, q).in_plane)).re
        };
        let (e, by) = (-rayleigh * rayleigh, 1e-5);
        let g = by / (d(e + by) - d(e - by));
        assert!((g - 0.0616).abs() < 1e-4, "{g}");
        for t in [1e-3, 0.5, 1.0, 3.0] {
            let (r, q) = (1e-2, growth(1e-2, t));
            let theory = g * r / (1.0 + (rayleigh * t).powi(2));
            assert!((q.re / theory - 1.0).abs() < r, "{t}: {q} {theory}");
            assert!((q.im - rayleigh).abs() < r, "{t}: {q}");
        }
        for r in [0.1, 0.3, 0.64, 0.9] {
            let q = growth(r, 1e-3);
            assert!(q.re > 0.7 * g * r, "{r}: {q}");
        }
    }

    #[test]
    fn weakly_falling_friction_grows_with_a_little_memory_and_not_without() {
        let (r, t) = (0.6, 1e-3);
        let q = fastest(r, t).unwrap();
        assert!((q.im - 1.25).abs() < 1e-4, "{q}");
        assert!((q.re / (t * 0.36 / 0.64f64.powi(2)) - 1.0).abs() < 1e-2, "{q}");
    }
}
