//! The compliance of half-spaces in time and space: single modes, Lamb's problem of a line, the static tail of a point,
//! and the growth of a disturbance of sliding with friction that falls and remembers.

use crate::body::STEEL;
use crate::convergence::Convergence;
use crate::dispersion::{Mode, Sliding};
use crate::perturbation_growth::prony;
use crate::problem::{Outcome, Size};
use crate::row::Row;
use friction::{Exponential, FrictionLaw, Memory};
use halfspace::{Extent, HalfSpaces, Kernel, Quadrature};
use nalgebra::Complex;

/// Distance (m) across which patches are felt in these problems.
const REACH: f64 = 0.016;

fn steel() -> HalfSpaces {
    HalfSpaces::new(STEEL.young, STEEL.poisson, STEEL.density)
}

pub(crate) fn run(size: Size) -> Outcome {
    let mut rows = mode(size);
    rows.extend(line(size)?);
    rows.extend(point(size)?);
    rows.extend(growth(size)?);
    Ok(rows)
}

/// An antiplane mode after an impulse: 2 c_s/G J_0(k c_s t).
fn mode(size: Size) -> Vec<Row> {
    let steel = steel();
    let unit = 1.0 / steel.shear_speed;
    let steps: &[usize] = match size {
        Size::Quick => &[40, 80, 160],
        Size::Full => &[40, 80, 160, 320, 640],
    };
    // k c_s t at which it is looked at; the mode has k = 1/m
    let at = |t: f64| {
        let values = steps.iter().map(|&n| {
            let dt = unit / n as f64;
            let lag = (t * n as f64).round() as usize;
            let quadrature = Quadrature::new(lag + 1, dt);
            let transform = quadrature.frequencies().iter();
            let weights = quadrature
                .weights(transform.map(|&s| steel.compliance(1.0, s).antiplane).collect());
            let scale = 2.0 * steel.shear_speed / steel.shear_modulus;
            (dt, weights[lag] / dt / scale)
        });
        Convergence::by_theory(values, 2.0)
    };
    [1.0, 5.0, 12.0]
        .map(|t| {
            let quantity = format!("antiplane mode after k c_s t = {t}, over 2 c_s/G");
            let source = "J_0(k c_s t): Lapusta, Rice, Ben-Zion and Zheng (2000), Eq. 6";
            Row::extrapolated(&quantity, libm::j0(t), &at(t), (0.0, ""), source)
        })
        .into()
}

/// Sliding at 0.4 m/s under 0.9 GPa with the law of the reference case: memory (m) and wavelength (m).
const DISTURBANCES: [[f64; 2]; 4] = [[1e-6, 30e-3], [2e-6, 30e-3], [3e-6, 60e-3], [5e-6, 60e-3]];
const LAW: Exponential = Exponential { mu_static: 0.5, mu_dynamic: 0.32, decay: 6.0 };
const SPEED: f64 = 0.4;
const PRESSURE: f64 = 0.9e9;
/// Largest relative error of a growth rate that passes.
const REQUIRED: f64 = 0.01;

/// Growth of a mode between the half-spaces, beside the root of its dispersion equation.
fn growth(size: Size) -> Outcome {
    let steps: &[f64] = if size == Size::Quick { &[0.02, 0.01] } else { &[0.02, 0.01, 0.005] };
    let falling = -PRESSURE * LAW.slope(SPEED);
    let mut rows = Vec::new();
    for (mode, name) in [(Mode::InPlane, "plane strain"), (Mode::Antiplane, "antiplane")] {
        for [distance, wavelength] in DISTURBANCES {
            let sliding = Sliding { bodies: steel(), mode, falling, delay: distance / SPEED };
            let k = 2.0 * std::f64::consts::PI / wavelength;
            let root = sliding.growth(k).ok_or("no mode grows")?;
            let found = steps.iter().map(|step| {
                let dt = step / root.norm();
                // so many of the root's own times that the fastest mode alone is left
                let history = marched(&sliding, k, distance, dt, (30.0 / step) as usize);
                (dt, prony(&history[2 * history.len() / 3..], root, dt).re)
            });
            let study = Convergence::by_theory(found, 1.0);
            let quantity = format!(
                "{name}, memory {} um, wavelength {} mm: growth rate (1/s)",
                1e6 * distance,
                1e3 * wavelength
            );
            let source = "linear stability of sliding between half-spaces (dispersion.rs)";
            let row = Row::extrapolated(&quantity, root.re, &study, (0.0, ""), source);
            rows.push(row.at_most(REQUIRED));
        }
    }
    Ok(rows)
}

/// Slip speeds (m/s) of a disturbance with the wave number `k` (1/m) after a change of friction, after each of `steps`
/// steps of `dt` (s), by the law with the memory `distance` (m) and the convolution of the half-spaces.
fn marched(sliding: &Sliding, k: f64, distance: f64, dt: f64, steps: usize) -> Vec<f64> {
    let quadrature = Quadrature::new(steps, dt);
    let transform = quadrature.frequencies().iter().map(|&s| sliding.compliance(k, s));
    let weights = quadrature.weights(transform.collect());
    let memory = Memory { distance, floor: 0.5 * SPEED };
    let (mut slip, mut shear, mut speeds) = ([0.0; 2], Vec::new(), Vec::new());
    // the change of friction (Pa)
    let mut friction = 1.0;
    for _ in 0..steps {
        let past: f64 = shear.iter().rev().zip(&weights[1..]).map(|(t, w)| t * w).sum();
        // friction at the end of a step is linear in the slip speed of the step, and the reverse
        let speed = |friction: f64| {
            (3.0 * (past - weights[0] * friction) - 4.0 * slip[0] + slip[1]) / (2.0 * dt)
        };
        let after = |speed: f64| memory.advance(friction, -sliding.falling * speed, SPEED, dt);
        let rate = (speed(1.0) - speed(0.0)) * (after(1.0) - after(0.0));
        let change = speed(after(0.0)) / (1.0 - rate);
        friction = after(change);
        shear.push(-friction);
        slip = [past - weights[0] * friction, slip[0]];
        speeds.push(change);
    }
    speeds
}

/// Spacings (m) of the grids.
fn spacings(size: Size) -> &'static [f64] {
    match size {
        // at 1 mm the fronts still ring where the displacement is looked at
        Size::Quick => &[0.5e-3, 0.25e-3, 0.125e-3],
        Size::Full => &[0.25e-3, 0.125e-3, 0.0625e-3, 0.03125e-3],
    }
}

/// The time step (s) at a spacing h.
fn step(h: f64) -> f64 {
    0.25 * h / steel().pressure_speed
}

/// The mean of a field about a point, in which the highest wavenumber of the grid has no part.
fn smoothed(field: impl Fn(usize, usize) -> f64, [i, j]: [usize; 2]) -> f64 {
    let parts = [(-1, 0.25), (0, 0.5), (1, 0.25)];
    // the fields are even about the origin
    let near = |i: usize, step: i64| (i as i64 + step).unsigned_abs() as usize;
    let both = parts.iter().flat_map(|a| parts.iter().map(move |b| (a, b)));
    both.map(|((di, wi), (dj, wj))| wi * wj * field(near(i, *di), near(j, *dj))).sum()
}

/// Displacement that an impulse along a line leaves: between the arrivals of P and S waves, and after the Rayleigh wave.
fn line(size: Size) -> Outcome {
    let steel = steel();
    let x = 0.012;
    let kernels = spacings(size)
        .iter()
        .map(|&h| {
            let reach = (REACH / h).round() as usize;
            let extent = Extent { spacing: h, reach: (reach, None), diameter: REACH };
            Ok((h, Kernel::new(&steel, &extent, step(h))?))
        })
        .collect::<Result<Vec<_>, halfspace::KernelError>>()?;
    let mut rows = Vec::new();
    for (when, late) in [("between P and S waves", 0.75), ("after the Rayleigh wave", 1.35)] {
        // a step of the coarsest grid, and thus of all: interpolation in time would differ from grid to grid
        let coarsest = step(spacings(size)[0]);
        let arrival = coarsest * (late * x / steel.shear_speed / coarsest).round();
        for (c, what) in ["plane strain", "antiplane"].into_iter().enumerate() {
            let exact = line_impulse(&steel, x, arrival)[c];
            // before its waves there is nothing to compare
            if exact == 0.0 {
                continue;
            }
            let values = kernels.iter().map(|(h, kernel)| {
                let dt = step(*h);
                let place = (x / h).round() as usize;
                let lag = (arrival / dt).round() as usize;
                let response = |i: usize, _| kernel.response(lag, [i, 0])[2 * c];
                (*h, smoothed(response, [place, 1]) / (h * dt) / exact)
            });
            let study = Convergence::with_known_order(values, 2.0);
            let quantity = format!("line impulse in {what}, {when}, over the closed form");
            let source = "Lamb (1904) for shear, by Cagniard's method";
            rows.push(Row::extrapolated(&quantity, 1.0, &study, (0.0, ""), source));
        }
    }
    Ok(rows)
}

/// What an impulse of force along a line (1 N s/m), along x and along y on the line x = 0, leaves of relative
/// displacement at `x > 0` (m) after the time t (s): Lamb's problem for shear on two half-spaces (m per N s/m).
///
/// Cagniard's method: Im Y(q)/(pi x) with the compliance Y at the slowness q = t/x and frequency one; roots of
/// negative numbers are -i times a positive one.
fn line_impulse(bodies: &HalfSpaces, x: f64, t: f64) -> [f64; 2] {
    let q = t / x;
    let root = |c: f64| {
        let square = 1.0 / (c * c) - q * q;
        let size = square.abs().sqrt();
        if square > 0.0 { Complex::new(size, 0.0) } else { Complex::new(0.0, -size) }
    };
    let (a, b) = (root(bodies.pressure_speed), root(bodies.shear_speed));
    let square = bodies.shear_speed.powi(-2);
    let scale = 2.0 / bodies.shear_modulus;
    let rayleigh = (square - 2.0 * q * q).powi(2) + a * b * (4.0 * q * q);
    let both = [b * (scale * square) / rayleigh, scale / b];
    both.map(|y| y.im / (std::f64::consts::PI * x))
}

/// Displacement by a force at a point that stays: what is left when its waves have passed.
fn point(size: Size) -> Outcome {
    let steel = steel();
    let all = [2e-3, 1e-3, 0.5e-3];
    let some = if size == Size::Quick { &all[..2] } else { &all[..] };
    let mut kernels = Vec::new();
    for &h in some {
        let reach = (REACH / h).round() as usize;
        let extent = Extent { spacing: h, reach: (reach, Some(reach)), diameter: 2.0 * REACH };
        kernels.push((h, Kernel::new(&steel, &extent, step(h))?));
    }
    let nu = STEEL.poisson;
    let mut rows = Vec::new();
    for [x, y] in [[0.012, 0.0], [0.0, 0.012], [0.008, 0.008]] {
        let r = libm::hypot(x, y);
        let scale = 1.0 / (std::f64::consts::PI * steel.shear_modulus * r);
        let exact = [
            1.0 - nu + nu * (x / r).powi(2),
            nu * x * y / (r * r),
            1.0 - nu + nu * (y / r).powi(2),
        ];
        for (c, name) in ["x by x", "x by y", "y by y"].into_iter().enumerate() {
            if exact[c] == 0.0 {
                continue;
            }
            let values = kernels.iter().map(|(h, kernel)| {
                let place = [x, y].map(|x| (x / h).round() as usize);
                let left = |i: usize, j: usize| -> f64 {
                    (0..kernel.memory()).map(|lag| kernel.response(lag, [i, j])[c]).sum()
                };
                let sum = smoothed(left, place);
                (*h, sum / (h * h) / scale)
            });
            let study = Convergence::with_known_order(values, 2.0);
            let quantity = format!(
                "displacement {name} at ({:.0}, {:.0}) mm, over 1/(pi G r)",
                1e3 * x,
                1e3 * y
            );
            let source = "Cerruti (1882); Johnson (1985), Sec. 3.6";
            rows.push(Row::extrapolated(&quantity, exact[c], &study, (0.0, ""), source));
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn late_and_whole_line_impulses_agree_after_the_rayleigh_wave() {
        let steel = steel();
        for v in [0.1, 0.5, 0.9] {
            let (x, t) = (0.01, 0.01 / (v * steel.shear_speed));
            let (whole, late) = (line_impulse(&steel, x, t), steel.late_line_impulse(v));
            for c in 0..2 {
                assert!((whole[c] * t / late[c] - 1.0).abs() < 1e-12, "{v}: {whole:?} {late:?}");
            }
        }
        assert_eq!(line_impulse(&steel, 0.01, 0.99 * 0.01 / steel.pressure_speed), [0.0; 2]);
    }
}
