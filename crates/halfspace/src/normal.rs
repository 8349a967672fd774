//! Frictionless contact of two half-spaces with a given gap, by the method of conjugate gradients of Polonsky and Keer (1999),
//! "A numerical method for solving rough contact problems based on the multi-level multi-summation and conjugate gradient
//! techniques", Wear 231.

use crate::compliance::HalfSpaces;
use crate::kernel::even_length;
use crate::patch::PressureField;
use crate::plane::Plane;
use realfft::num_complex::Complex64;
use std::f64::consts::PI;

/// Iterations at most, and the change of the pressure over the load in the last one.
const MOST_ITERATIONS: usize = 2000;
const CONVERGED: f64 = 1e-9;

/// The gap of the undeformed surfaces at the points of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Spacing (m).
    pub spacing: f64,
    /// The first point along x and y, in spacings from the point of reference.
    pub first: [i64; 2],
    /// Points along x and y.
    pub points: [usize; 2],
    /// Gap (m), x fastest; points with an infinite one never touch.
    pub gap: Vec<f64>,
}

/// Half-spaces pressed together.
#[derive(Clone, Debug, PartialEq)]
pub struct Pressed {
    /// Pressure at the points of the gap.
    pub field: PressureField,
    /// Rigid approach (m).
    pub approach: f64,
    /// Whether a point at an end of the grid bears pressure: the grid is then too small.
    pub cut: bool,
}

/// Why half-spaces cannot be pressed together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PressError {
    /// No point can touch.
    #[error("no point of the grid of the patch can touch")]
    Open,
    /// The pressure still changes.
    #[error(
        "the pressure still changed by {change:.1e} of the load after {MOST_ITERATIONS} iterations"
    )]
    Unconverged {
        /// Change in the last iteration.
        change: f64,
    },
}

/// Presses half-spaces together with the force `load` (N): gap + displacement - approach >= 0, pressure >= 0, one of them zero at
/// each point.
///
/// # Errors
/// A gap that is nowhere finite, pressures that do not converge.
pub fn press(bodies: &HalfSpaces, gap: &Gap, load: f64) -> Result<Pressed, PressError> {
    let (n, cell) = (gap.gap.len(), gap.spacing * gap.spacing);
    let mut influence = Influence::new(bodies, gap);
    let least = gap.gap.iter().fold(f64::INFINITY, |least, g| g.min(least));
    if !least.is_finite() {
        return Err(PressError::Open);
    }
    let reachable: Vec<bool> = gap.gap.iter().map(|g| g.is_finite()).collect();
    let open: Vec<f64> = gap.gap.iter().map(|g| if g.is_finite() { *g } else { least }).collect();
    // begins with the same pressure at all points that can touch
    let many = reachable.iter().filter(|r| **r).count() as f64;
    let mut pressure: Vec<f64> =
        reachable.iter().map(|r| if *r { load / cell / many } else { 0.0 }).collect();
    let (mut direction, mut moved, mut left) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let (mut before, mut keep, mut change) = (1.0, 0.0, f64::INFINITY);
    for _ in 0..MOST_ITERATIONS {
        influence.displacement(&pressure, &mut moved);
        let touching: Vec<usize> = (0..n).filter(|&i| pressure[i] > 0.0).collect();
        let count = touching.len() as f64;
        let approach = touching.iter().map(|&i| open[i] + moved[i]).sum::<f64>() / count;
        (0..n).for_each(|i| left[i] = open[i] + moved[i] - approach);
        let squares: f64 = touching.iter().map(|&i| left[i] * left[i]).sum();
        if change < CONVERGED {
            return Ok(pressed(gap, pressure, approach));
        }
        let conjugate = keep * squares / before;
        before = squares;
        let mut next = vec![0.0; n];
        touching.iter().for_each(|&i| next[i] = left[i] + conjugate * direction[i]);
        direction = next;
        influence.displacement(&direction, &mut moved);
        let mean = touching.iter().map(|&i| moved[i]).sum::<f64>() / count;
        let (mut up, mut down) = (0.0, 0.0);
        for &i in &touching {
            up += left[i] * direction[i];
            down += (moved[i] - mean) * direction[i];
        }
        let length = up / down;
        let last = pressure.clone();
        touching.iter().for_each(|&i| pressure[i] = (last[i] - length * direction[i]).max(0.0));
        keep = 1.0;
        for i in (0..n).filter(|&i| reachable[i]) {
            if pressure[i] == 0.0 && left[i] < 0.0 {
                pressure[i] = -length * left[i];
                keep = 0.0;
            }
        }
        let scale = load / (cell * pressure.iter().sum::<f64>());
        pressure.iter_mut().for_each(|p| *p *= scale);
        let moved_on = pressure.iter().zip(&last).map(|(a, b)| (a - b).abs()).sum::<f64>();
        change = cell * moved_on / load;
        if !change.is_finite() {
            break;
        }
    }
    Err(PressError::Unconverged { change })
}

fn pressed(gap: &Gap, pressure: Vec<f64>, approach: f64) -> Pressed {
    let [nx, ny] = gap.points;
    let at_end = |i: usize| {
        let (column, line) = (i % nx, i / nx);
        [0, nx - 1].contains(&column) || [0, ny - 1].contains(&line)
    };
    let cut = (0..pressure.len()).any(|i| pressure[i] > 0.0 && at_end(i));
    let Gap { spacing, first, points, .. } = *gap;
    Pressed { field: PressureField { spacing, first, points, pressure }, approach, cut }
}

/// Displacements at the points by pressures on their squares, by Fourier transforms on a grid on which no image is felt.
struct Influence {
    plane: Plane,
    points: [usize; 2],
    kernel: Vec<Complex64>,
    spectrum: Vec<Complex64>,
    field: Vec<f64>,
}

impl Influence {
    fn new(bodies: &HalfSpaces, gap: &Gap) -> Self {
        let [nx, ny] = gap.points.map(even_length);
        let mut plane = Plane::new(nx, ny);
        let distance = |i: usize, n: usize| i.min(n - i) as f64;
        let scale = gap.spacing * bodies.normal_compliance();
        let mut field: Vec<f64> = (0..nx * ny)
            .map(|k| scale * square(distance(k % nx, nx), distance(k / nx, ny)))
            .collect();
        let mut kernel = vec![Complex64::ZERO; plane.modes()];
        plane.forward(&field, &mut kernel);
        field.fill(0.0);
        let spectrum = vec![Complex64::ZERO; plane.modes()];
        Self { plane, points: gap.points, kernel, spectrum, field }
    }

    fn displacement(&mut self, pressure: &[f64], into: &mut [f64]) {
        let [nx, ny] = self.points;
        let width = self.plane.nx;
        self.field.fill(0.0);
        for j in 0..ny {
            self.field[width * j..][..nx].copy_from_slice(&pressure[nx * j..][..nx]);
        }
        self.plane.forward(&self.field, &mut self.spectrum);
        self.spectrum.iter_mut().zip(&self.kernel).for_each(|(u, k)| *u *= k);
        self.plane.inverse(&mut self.spectrum, &mut self.field);
        for j in 0..ny {
            into[nx * j..][..nx].copy_from_slice(&self.field[width * j..][..nx]);
        }
    }
}

/// The integral of 1/r over a unit square, seen from the distance x, y from its centre (Love 1929; Johnson 1985, Eq 3.25).
fn square(x: f64, y: f64) -> f64 {
    let [left, right, below, above] = [x - 0.5, x + 0.5, y - 0.5, y + 0.5];
    let part = |a: f64, b: f64| a * libm::asinh(b / a.abs());
    // each edge's contribution: x ln(y + r) + y ln(x + r) at the corners
    part(right, above) - part(right, below) - part(left, above)
        + part(left, below)
        + part(above, right)
        - part(above, left)
        - part(below, right)
        + part(below, left)
}

impl HalfSpaces {
    /// Displacement of both surfaces at the distance r by a normal force, times r over the force (m^2/N): (1 - nu)/(pi G), with
    /// 1/(1 - nu) = 2 (1 - (c_s/c_p)^2).
    fn normal_compliance(&self) -> f64 {
        let ratio = (self.shear_speed / self.pressure_speed).powi(2);
        1.0 / (2.0 * PI * self.shear_modulus * (1.0 - ratio))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Paraboloids of the curvatures `along` and `across` (1/m) on a grid of `n` points to each side, the apex in the middle
    /// of four points.
    fn paraboloid([along, across]: [f64; 2], h: f64, n: i64) -> Gap {
        let place = |i: i64| (i as f64 - 0.5) * h;
        let side = 1 - n..=n;
        let gap = side.clone().flat_map(|j| side.clone().map(move |i| (i, j)));
        let gap = gap.map(|(i, j)| 0.5 * (along * place(i).powi(2) + across * place(j).powi(2)));
        Gap { spacing: h, first: [1 - n; 2], points: [2 * n as usize; 2], gap: gap.collect() }
    }

    #[test]
    fn a_sphere_has_the_pressure_and_approach_of_hertz() {
        // the sphere of the verification: R 0.1 m, 10 kN
        let steel = HalfSpaces::new(210e9, 0.3, 7850.0);
        let pressed = press(&steel, &paraboloid([10.0; 2], 0.1e-3, 25), 1e4).unwrap();
        let peak = crate::Patch::Field(pressed.field.clone()).peak_pressure();
        assert!((peak / 1.3709e9 - 1.0).abs() < 2e-3, "{peak}");
        assert!((pressed.approach / 34.83e-6 - 1.0).abs() < 1e-3, "{}", pressed.approach);
        let load = pressed.field.pressure.iter().sum::<f64>() * 1e-8;
        assert!(!pressed.cut && (load / 1e4 - 1.0).abs() < 1e-12);
        let field = pressed.field.trimmed();
        // a = 1.866 mm
        assert_eq!((field.points, field.first), ([38; 2], [-18; 2]));
        assert!(press(&steel, &paraboloid([10.0; 2], 0.1e-3, 10), 1e4).unwrap().cut);
    }

    #[test]
    fn the_reference_wheel_has_the_pressure_and_approach_of_hertz() {
        let steel = HalfSpaces::new(210e9, 0.3, 7850.0);
        let gap = paraboloid([1.0 / 0.46, 1.0 / 0.3], 0.25e-3, 40);
        let pressed = press(&steel, &gap, 1e5).unwrap();
        let peak = crate::Patch::Field(pressed.field.clone()).peak_pressure();
        assert!((peak / 1237.6e6 - 1.0).abs() < 2e-3, "{peak}");
        assert!((pressed.approach / 104.1e-6 - 1.0).abs() < 1e-3, "{}", pressed.approach);
        let nowhere = Gap { gap: vec![f64::INFINITY; gap.gap.len()], ..gap };
        assert_eq!(press(&steel, &nowhere, 1e5), Err(PressError::Open));
    }
}
