//! Lamb's problem: a vertical load suddenly applied at a point of a half-space.
//!
//! Lamb (1904), Phil. Trans. R. Soc. A 203: 1–42. For a load P applied as a step in time, the surface at the
//! distance r moves vertically by w = (1 - nu) P/(2 pi G r) U(tau), tau = c_s t/r, with
//! (Pekeris 1955, Proc. Natl. Acad. Sci. 41: 469–480, for nu = 1/4; Mooney 1974, Bull. Seismol. Soc.
//! Am. 64: 473–491; Kausel 2012, Proc. R. Soc. A 468: 3610–3624, for any nu)
//!
//!   U = 0                     before the P wave, tau < a = c_s/c_p
//!   U = (1 - sum_j T_j)/2      a < tau < 1
//!   U = 1 - T_R                1 < tau < gamma = c_s/c_R
//!   U = 1                     after the Rayleigh wave: at once the static solution
//!
//!   T_j = (1 - 2 X_j)^2/(4 prod_(k /= j) (X_j - X_k)) sqrt((a^2 - X_j)/(tau^2 - X_j))
//!
//! where X_j = (c_s/c)^2 are the roots of the rationalised Rayleigh equation,
//! 16 (1 - a^2) X^3 - 8 (3 - 2 a^2) X^2 + 8 X - 1 = 0, and X_R = gamma^2 the real one above 1. In
//! this form the sum is real for any nu. It starts from U(a) = 0, since the sum of the T_j is there the divided
//! difference of (1 - 2X)^2/4, which is its leading coefficient, 1.
//!
//! The load here is a pressure on a square patch that rises by a smoothstep: the reference is U averaged
//! over the patch and convolved with the rate of the load.
//!
//! A quarter of the half-space is meshed, with rollers on its planes of symmetry. It is so large that no wave
//! comes back from its far sides in the time of interest: no quiet end is needed.
//!
//! The element and the load on its nodes are of second order. Grid waves behind the fronts scatter
//! the values by some tenths of a per cent, so that the order is taken as known.
//!
//! The wave of the uplift is about as long as S waves run while the load rises, 4 mm, eight and 16 elements at quick size.
//! Of these the coarse mesh does not carry the shape, and the limit that its difference gives would be 18 %. Waves of 16
//! elements lag by (k h)^2/24 = 0.64 % of their way, on the 9 mm to the farther receiver by 1.4 % of their length; with
//! the scatter by grid waves 2 % are asked of the uplift.
//!
//! *Rayleigh speed.* The surface rises before the Rayleigh wave and falls with it. The time at which
//! it passes the middle is taken at two distances. The distance over the difference of the times is an
//! apparent speed. So close to the load it is some per cent below c_R, since the near field decays faster
//! than the Rayleigh wave. The closed form under the same load has the same apparent speed; the ratio
//! of the two, times c_R, is the speed that is compared with the root of Rayleigh's equation.

use crate::body::{STEEL, at_rest, rollers};
use crate::convergence::Convergence;
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use dynamics::Simulation;
use mesh::quad_corner_areas;
use nalgebra::Vector3;

/// Half the edge of the loaded patch (m): the unit of all lengths.
const PATCH: f64 = 1e-3;
/// Distances of the two receivers.
const NEAR: f64 = 6.0 * PATCH;
const FAR: f64 = 9.0 * PATCH;
/// Edges of the quarter block in half patch edges: P waves to the far sides and back to the farther
/// receiver, by 2 x 20 - 10 and 2 sqrt(15^2 + 4.5^2) of them, take longer than the run.
const BLOCK: [usize; 3] = [20, 15, 15];
/// Total load (N).
const LOAD: f64 = 1.0;
/// Largest error of the uplift that passes.
const UPLIFT: f64 = 0.02;
const SOURCE: &str = "Lamb (1904), closed form of Pekeris, Mooney and Kausel";

pub(crate) fn run(size: Size) -> Outcome {
    let halves: &[usize] = match size {
        Size::Quick => &[2, 4],
        Size::Full => &[2, 4, 8],
    };
    let exact = Lamb::new();
    let times = Times::new(&exact);
    let reference: [Trace; 2] = [NEAR, FAR].map(|r| exact.trace(r, &times));
    let mut meshes = Vec::new();
    for &n in halves {
        meshes.push((PATCH / n as f64, traces(n, &times)?));
    }
    let study = |value: &dyn Fn(&[Trace; 2]) -> f64| {
        Convergence::with_known_order(meshes.iter().map(|(h, t)| (*h, value(t))), 2.0)
    };
    let mut rows = Vec::new();
    for (k, name) in ["6", "9"].into_iter().enumerate() {
        rows.push(Row::converged(
            format!("static tail at r = {name} mm (m)"),
            reference[k].tail(),
            &study(&|t| t[k].tail()),
            (0.0, ""),
            "(1 - nu) P/(2 pi G r), over the patch",
        ));
        let uplift = Row::converged(
            format!("largest uplift at r = {name} mm (m)"),
            reference[k].dip(),
            &study(&|t| t[k].dip()),
            (0.0, ""),
            SOURCE,
        );
        rows.push(uplift.at_most(UPLIFT));
    }
    let apparent = |t: &[Trace; 2]| (FAR - NEAR) / (t[1].arrival() - t[0].arrival());
    let rayleigh = 1.0 / exact.gamma;
    let near_field = rayleigh / apparent(&reference);
    rows.push(Row::converged(
        "Rayleigh speed c_R over c_s",
        rayleigh,
        &study(&|t| near_field * apparent(t)),
        (0.0, ""),
        "root of Rayleigh's equation; near field by the closed form",
    ));
    Ok(rows)
}

/// When the load has risen and when the run ends (s).
struct Times {
    ramp: f64,
    end: f64,
}

impl Times {
    fn new(lamb: &Lamb) -> Self {
        let ramp = 4.0 * PATCH / STEEL.c_s();
        // the Rayleigh wave of the last of the load, from the far edge of the patch, and a margin
        let end = (FAR + 2.0 * PATCH) * lamb.gamma / STEEL.c_s() + ramp;
        Self { ramp, end }
    }
}

/// Displacement along the load (m) by time (s).
struct Trace(Vec<(f64, f64)>);

impl Trace {
    /// Mean over the last twentieth, after the Rayleigh wave of the last of the load.
    fn tail(&self) -> f64 {
        let last = &self.0[self.0.len() - self.0.len() / 20..];
        last.iter().map(|(_, w)| w).sum::<f64>() / last.len() as f64
    }

    /// The least displacement: the surface rises, against the load, just before the Rayleigh wave.
    fn dip(&self) -> f64 {
        self.0.iter().map(|(_, w)| *w).fold(0.0, f64::min)
    }

    /// The time (s) at which the displacement last passes the middle between dip and tail.
    fn arrival(&self) -> f64 {
        let middle = 0.5 * (self.dip() + self.tail());
        let rises = self.0.windows(2).rev().find(|p| p[0].1 < middle && p[1].1 >= middle);
        rises.map_or(f64::NAN, |p| {
            p[0].0 + (p[1].0 - p[0].0) * (middle - p[0].1) / (p[1].1 - p[0].1)
        })
    }
}

/// The closed form for a point load applied as a step.
struct Lamb {
    /// c_s/c_p.
    a: f64,
    /// c_s/c_R.
    gamma: f64,
    /// T_R = `rayleigh`/sqrt(gamma^2 - tau^2).
    rayleigh: f64,
    /// Integral of U from a to points at equal steps up to 1.
    table: Vec<f64>,
}

/// A complex number.
type Complex = [f64; 2];

fn product([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

fn quotient(x: Complex, [c, d]: Complex) -> Complex {
    product(x, [c / (c * c + d * d), -d / (c * c + d * d)])
}

/// The root with positive real part.
fn root([a, b]: Complex) -> Complex {
    let length = libm::hypot(a, b);
    let (re, im) = ((0.5 * (length + a)).max(0.0).sqrt(), (0.5 * (length - a)).max(0.0).sqrt());
    [re, im.copysign(b)]
}

fn minus([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a - c, b - d]
}

impl Lamb {
    fn new() -> Self {
        let squared = (STEEL.c_s() / STEEL.c_p()).powi(2);
        let roots = rayleigh_roots(squared);
        let term = |j: usize, tau: f64| -> Complex {
            let x = roots[j];
            let [k, l] = [roots[(j + 1) % 3], roots[(j + 2) % 3]];
            let slope = minus([1.0, 0.0], product([2.0, 0.0], x));
            let spread = product([4.0, 0.0], product(minus(x, k), minus(x, l)));
            let ratio = quotient(minus([squared, 0.0], x), minus([tau * tau, 0.0], x));
            product(quotient(product(slope, slope), spread), root(ratio))
        };
        let gamma = roots[2][0].sqrt();
        let a = squared.sqrt();
        let u = |tau: f64| 0.5 * (1.0 - (0..3).map(|j| term(j, tau)[0]).sum::<f64>());
        // Simpson's rule
        let cells = 4000;
        let step = (1.0 - a) / cells as f64;
        let mut table = vec![0.0];
        let mut sum = 0.0;
        for i in 0..cells {
            let tau = a + step * i as f64;
            sum += step / 6.0 * (u(tau) + 4.0 * u(tau + 0.5 * step) + u(tau + step));
            table.push(sum);
        }
        let rayleigh = term(2, 1.0)[0] * (gamma * gamma - 1.0).sqrt();
        Self { a, gamma, rayleigh, table }
    }

    /// Integral of U from 0 to tau.
    fn integral(&self, tau: f64) -> f64 {
        if tau <= self.a {
            return 0.0;
        }
        let cells = self.table.len() - 1;
        if tau < 1.0 {
            let at = (tau - self.a) / (1.0 - self.a) * cells as f64;
            let i = (at as usize).min(cells - 1);
            return self.table[i] + (at - i as f64) * (self.table[i + 1] - self.table[i]);
        }
        let angle = |tau: f64| libm::asin((tau / self.gamma).min(1.0));
        self.table[cells] + (tau - 1.0) - self.rayleigh * (angle(tau) - angle(1.0))
    }

    /// The displacement at the distance `r` (m) under the load on the patch, which rises by a smoothstep S:
    /// int S'(s) w(t - s) ds = int S''(s) int_0^(t - s) w ds, averaged over the patch.
    fn trace(&self, r: f64, times: &Times) -> Trace {
        const STEPS: usize = 400;
        const FOLDS: usize = 360;
        let scale = LOAD * (1.0 - STEEL.poisson) / (2.0 * std::f64::consts::PI * STEEL.shear());
        let distances = patch_distances(r);
        let value = |t: f64| {
            let mut sum = 0.0;
            for k in 0..FOLDS {
                let s = (k as f64 + 0.5) / FOLDS as f64;
                let bend = (6.0 - 12.0 * s) / (times.ramp * FOLDS as f64);
                let since = STEEL.c_s() * (t - s * times.ramp);
                let inner: f64 = distances.iter().map(|d| self.integral(since / d)).sum();
                sum += bend * inner / distances.len() as f64;
            }
            scale / STEEL.c_s() * sum
        };
        let time = |i: usize| times.end * i as f64 / STEPS as f64;
        Trace((0..=STEPS).map(|i| (time(i), value(time(i)))).collect())
    }
}

/// Distances of the receiver from the points of a composite two-point Gauss rule of equal weights
/// on half of the patch.
fn patch_distances(r: f64) -> Vec<f64> {
    const CELLS: usize = 6;
    let h = PATCH / CELLS as f64;
    let points = |from: isize| {
        let point = move |i: isize, g: f64| h * (i as f64 + 0.5 + g / 12f64.sqrt());
        (from..CELLS as isize).flat_map(move |i| [point(i, -1.0), point(i, 1.0)])
    };
    let rows = |x: f64| points(0).map(move |y| libm::hypot(r - x, y));
    points(-(CELLS as isize)).flat_map(rows).collect()
}

/// Roots of 16 (1 - a^2) X^3 - 8 (3 - 2 a^2) X^2 + 8 X - 1, the real one above 1 last.
fn rayleigh_roots(squared: f64) -> [Complex; 3] {
    let lead = 16.0 * (1.0 - squared);
    let [b, c, d] = [-8.0 * (3.0 - 2.0 * squared) / lead, 8.0 / lead, -1.0 / lead];
    let cubic = |x: f64| ((x + b) * x + c) * x + d;
    // rises through its largest root, which lies between 1 and 2 for 0 <= nu < 1/2
    let (mut low, mut high) = (1.0, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if cubic(middle) < 0.0 { low = middle } else { high = middle }
    }
    let x = 0.5 * (low + high);
    // the rest is Y^2 + p Y + q
    let (p, q) = (b + x, -d / x);
    let discriminant = 0.25 * p * p - q;
    let shift = root([discriminant, 0.0]);
    let centre = [-0.5 * p, 0.0];
    [minus(centre, shift), minus(centre, [-shift[0], -shift[1]]), [x, 0.0]]
}

/// The traces of both receivers with `n` elements over half of the patch.
fn traces(n: usize, times: &Times) -> Result<[Trace; 2], Cause> {
    let h = PATCH / n as f64;
    // the half-space is z > 0; the load pushes along +z
    let mesh = mesh::block(BLOCK.map(|b| b * n), BLOCK.map(|b| b as f64 * PATCH));
    let mut setup = at_rest(&mesh, STEEL, 0.67, None)?;
    setup.system.fixed = rollers(&mesh, "x-", 0);
    setup.system.fixed.extend(rollers(&mesh, "y-", 1));
    setup.system.load.ramp = times.ramp;
    let pressure = LOAD / (4.0 * PATCH * PATCH);
    for face in &mesh.bodies[0].surfaces["z-"].faces {
        let corners = face.nodes.map(|n| mesh.at(n));
        let inside = |x: &Vector3<f64>| x.x.max(x.y) < PATCH + 0.5 * h;
        if corners.iter().all(inside) {
            for (&node, area) in face.nodes.iter().zip(quad_corner_areas(&corners)) {
                setup.system.load.forces.push((node, pressure * area * Vector3::z()));
            }
        }
    }
    let receiver = |r: f64| {
        let distance = |i: &usize| {
            let x = mesh.nodes[*i];
            (x.x - r).abs() + x.y + x.z
        };
        (0..mesh.nodes.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).unwrap_or(0)
    };
    let receivers = [NEAR, FAR].map(receiver);
    let mut simulation = Simulation::new(setup);
    let mut traces = [Trace(vec![(0.0, 0.0)]), Trace(vec![(0.0, 0.0)])];
    while simulation.time() < times.end {
        simulation.step(false);
        for (trace, &node) in traces.iter_mut().zip(&receivers) {
            trace.0.push((simulation.time(), simulation.displacement()[node].0[2]));
        }
    }
    Ok(traces)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_closed_form_starts_from_zero_has_the_known_rayleigh_speed_and_is_continuous() {
        let lamb = Lamb::new();
        assert!((1.0 / lamb.gamma - 0.92741).abs() < 5e-6, "{}", 1.0 / lamb.gamma);
        let slope = |tau: f64| (lamb.integral(tau + 1e-4) - lamb.integral(tau)) / 1e-4;
        assert!(slope(lamb.a).abs() < 1e-3);
        assert!((slope(1.0 - 1.5e-4) - slope(1.0)).abs() < 3e-3);
        assert!((slope(1.5) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn at_nu_a_quarter_the_roots_are_those_of_pekeris() {
        let exact = [0.25, 0.75 - 0.75f64.sqrt() / 2.0, 0.75 + 0.75f64.sqrt() / 2.0];
        for (root, exact) in rayleigh_roots(1.0 / 3.0).iter().zip(exact) {
            assert!((root[0] - exact).abs() < 1e-12 && root[1] == 0.0, "{root:?} {exact}");
        }
    }
}
