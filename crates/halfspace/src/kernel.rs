//! The weights of the compliance on the grid of the patch: cut to where the patch can feel itself.

use crate::compliance::HalfSpaces;
use crate::quadrature::Quadrature;
use rayon::prelude::*;
use realfft::num_complex::Complex64;
use std::f64::consts::PI;

/// The extent of a patch on its grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Spacing of the grid (m).
    pub spacing: f64,
    /// The farthest that a point of the patch and one that bore traction within the memory lie apart, along x and y, in
    /// spacings; `None` along y: plane strain.
    pub reach: (usize, Option<usize>),
    /// The farthest that two points of the patch lie apart (m).
    pub diameter: f64,
}

/// Why there are no weights.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KernelError {
    /// More weights than memory can be expected to hold.
    #[error("the weights of {lags} steps at {points} wavenumbers take {gigabytes:.1} GB")]
    TooMany {
        /// Time steps of memory.
        lags: usize,
        /// Wavenumbers.
        points: usize,
        /// Their size (GB).
        gigabytes: f64,
    },
}

/// Weights take no more than this (bytes).
const MOST_BYTES: f64 = 12e9;

/// How much longer than a Rayleigh wave crosses the patch the memory lasts: in plane strain, where the field decays as
/// 1/t, and in three dimensions, where nothing is left but what the quadrature spreads.
const MARGIN: [f64; 2] = [2.0, 1.15];
const MARGIN_LAGS: usize = 24;
/// The part of the memory of plane strain after which it fades.
const FADES: f64 = 0.6;

/// The weights `w_m` in the space of wavenumbers of a periodic grid, real and even (`xx`, `yy`) or odd along both axes
/// (`xy`): m/Pa.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Points of the grid along x and y.
    pub grid: [usize; 2],
    /// Per lag, then per wavenumber: those from 0 to nx/2 along x, fastest, and from 0 to ny/2 along y.
    pub(crate) lags: Vec<Weights>,
    /// Bounds of the compliance at lag 0 over all tractions on the patch (m/Pa).
    pub(crate) bounds: [f64; 2],
    /// What is felt at its static value as the memory fades, over the difference of the static compliance across the patch
    /// (plane strain, along x); zero in three dimensions.
    pub static_tail: f64,
}

/// Weights of one lag.
#[derive(Clone, Debug, Default)]
pub(crate) struct Weights {
    pub(crate) xx: Vec<f64>,
    pub(crate) xy: Vec<f64>,
    pub(crate) yy: Vec<f64>,
}

impl Kernel {
    /// The weights of the time step `step` (s) on the smallest grid for the extent.
    ///
    /// They come from a periodic box so large that no wave comes around before the memory ends, are brought back to
    /// points of the grid, cut beyond `reach`, and transformed again. In three dimensions a surface is at rest once the
    /// Rayleigh wave of a past impulse has passed: the memory ends by itself. In plane strain a displacement remains
    /// that fades as 1/t, uniform and thus without consequence for contact, and a curvature that fades as 1/t^3: what
    /// is left of the latter when the memory ends is felt at its static value, from the tractions at its end.
    ///
    /// # Errors
    /// More weights than fit into memory.
    pub fn new(bodies: &HalfSpaces, extent: &Extent, step: f64) -> Result<Self, KernelError> {
        let plane = extent.reach.1.is_some();
        let lags = Self::lags(bodies, extent, step);
        let h = extent.spacing;
        let grid = [even_length(extent.reach.0), extent.reach.1.map_or(1, even_length)];
        let far = extent.reach.0.max(extent.reach.1.unwrap_or(0));
        let waves = bodies.pressure_speed * lags as f64 * step / h;
        let big = 2 * (far as f64 + 1.05 * waves).div_euclid(2.0) as usize + 8;
        let half = big / 2 + 1;
        let across = if plane { half } else { 1 };
        // the weights of the box, then those of the grid, with its tractions and their copy in a checkpoint
        let modes = (grid[0] / 2 + 1) * grid[1];
        let bytes = lags as f64 * (16 * half * across).max(200 * modes) as f64;
        if bytes > MOST_BYTES {
            let (points, gigabytes) = (modes, 1e-9 * bytes);
            return Err(KernelError::TooMany { lags, points, gigabytes });
        }
        let quadrature = Quadrature::new(lags, step);
        let unit = 2.0 * PI / (big as f64 * h);
        // rows of the quarter plane of wavenumbers: mode II and mode III weights, lag fastest
        let rows: Vec<Vec<[Vec<f64>; 2]>> = (0..half)
            .into_par_iter()
            .map(|i| {
                (0..across)
                    .map(|j| {
                        let k = unit * libm::hypot(i as f64, j as f64);
                        let of = quadrature.frequencies().iter().map(|&s| bodies.compliance(k, s));
                        let (two, three): (Vec<Complex64>, Vec<Complex64>) =
                            of.map(|c| (c.in_plane, c.antiplane)).unzip();
                        [two, three].map(|transform| quadrature.weights(transform))
                    })
                    .collect()
            })
            .collect();
        let cut = [Cut::new(grid[0], extent.reach.0, big), {
            let reach = extent.reach.1.unwrap_or(0);
            if plane { Cut::new(grid[1], reach, big) } else { Cut::identity() }
        }];
        let mut weights: Vec<Weights> = (0..lags)
            .into_par_iter()
            .map(|m| {
                let tensor = |of: fn(f64, f64, [f64; 2]) -> f64| -> Vec<f64> {
                    let value = |i: usize, j: usize| {
                        let [two, three] = &rows[i][j];
                        let (x, y) = (i as f64, j as f64);
                        let square = (x * x + y * y).max(f64::MIN_POSITIVE);
                        // uniform: both modes are alike
                        let (xx, xy) =
                            if i + j == 0 { (1.0, 0.0) } else { (x * x / square, x * y / square) };
                        of(xx, xy, [two[m], three[m]])
                    };
                    (0..across)
                        .flat_map(|j| (0..half).map(move |i| (i, j)))
                        .map(|(i, j)| value(i, j))
                        .collect()
                };
                let xx = tensor(|xx, _, [two, three]| xx * two + (1.0 - xx) * three);
                let yy = tensor(|xx, _, [two, three]| (1.0 - xx) * two + xx * three);
                let xy = tensor(|_, xy, [two, three]| xy * (two - three));
                Weights {
                    xx: cut_both(&cut, 0, &xx),
                    yy: cut_both(&cut, 0, &yy),
                    xy: if plane { cut_both(&cut, 1, &xy) } else { Vec::new() },
                }
            })
            .collect();
        let static_tail =
            if plane { 0.0 } else { fade(bodies, extent, grid[0], step, &mut weights) };
        let highest = PI / h * if plane { std::f64::consts::SQRT_2 } else { 1.0 };
        let bounds = bounds(bodies, &weights[0], highest, Complex64::from(1.5 / step));
        Ok(Self { grid, lags: weights, bounds, static_tail })
    }

    /// Time steps of memory that an extent needs: what the slowest wave takes across it, with a margin.
    pub fn lags(bodies: &HalfSpaces, extent: &Extent, step: f64) -> usize {
        let plane = extent.reach.1.is_some();
        // in plane strain what is felt late must be late at all points that are felt
        let reach = extent.reach.0 as f64 * extent.spacing;
        let longest = if plane { extent.diameter } else { extent.diameter.max(reach) };
        let crossing = longest / bodies.rayleigh_speed() / step;
        (MARGIN[usize::from(plane)] * crossing).ceil() as usize + MARGIN_LAGS
    }

    /// The weight of the quasi-static limit: the sum of all, as one lag.
    #[must_use]
    pub fn without_inertia(mut self, bodies: &HalfSpaces, spacing: f64) -> Self {
        let mut sum = Weights::default();
        let fields: [fn(&mut Weights) -> &mut Vec<f64>; 3] =
            [|w| &mut w.xx, |w| &mut w.xy, |w| &mut w.yy];
        for field in fields {
            let mut total = std::mem::take(field(&mut self.lags[0]));
            for w in &mut self.lags[1..] {
                total.iter_mut().zip(field(w).iter()).for_each(|(t, w)| *t += w);
            }
            *field(&mut sum) = total;
        }
        let across = if self.grid[1] > 1 { std::f64::consts::SQRT_2 } else { 1.0 };
        let slow = Complex64::from(1e-6 * bodies.shear_speed / spacing);
        self.bounds = bounds(bodies, &sum, PI / spacing * across, slow);
        self.lags = vec![sum];
        self
    }

    /// Displacement (m) at the point `[i, j]` of the grid by a unit traction (Pa) at the origin, `lag` steps before: along
    /// x by one along x, along x by one along y, along y by one along y. Points farther than the patch is long have no
    /// meaning.
    pub fn response(&self, lag: usize, [i, j]: [usize; 2]) -> [f64; 3] {
        let [nx, ny] = self.grid;
        let Some(weights) = self.lags.get(lag) else { return [0.0; 3] };
        let mut sum = [0.0; 3];
        for (mode, xx) in weights.xx.iter().enumerate() {
            let (k, l) = (mode % (nx / 2 + 1), mode / (nx / 2 + 1));
            let images = |k: usize, n: usize| if k == 0 || 2 * k == n { 1.0 } else { 2.0 };
            let angle = |k: usize, i: usize, n: usize| 2.0 * PI * ((k * i) % n) as f64 / n as f64;
            let (x, y) = (angle(k, i, nx), angle(l, j, ny));
            let share = images(k, nx) * images(l, ny) / (nx * ny) as f64;
            sum[0] += share * libm::cos(x) * libm::cos(y) * xx;
            sum[2] += share * libm::cos(x) * libm::cos(y) * weights.yy[mode];
            // odd along both axes: i times i
            let xy = weights.xy.get(mode).copied().unwrap_or(0.0);
            sum[1] -= share * libm::sin(x) * libm::sin(y) * xy;
        }
        sum
    }

    /// Time steps of memory.
    pub fn memory(&self) -> usize {
        self.lags.len()
    }
}

/// Bounds of a weight on the patch: below by the compliance at the highest wavenumber, which falls with the wavenumber,
/// above by the largest of the weights on the grid, of which the patch is a part.
fn bounds(bodies: &HalfSpaces, weights: &Weights, highest: f64, s: Complex64) -> [f64; 2] {
    let least = bodies.compliance(highest, s);
    let largest = (0..weights.xx.len()).map(|i| {
        let [xx, yy] = [weights.xx[i], weights.yy[i]];
        let xy = weights.xy.get(i).copied().unwrap_or(0.0);
        0.5 * (xx + yy) + libm::hypot(0.5 * (xx - yy), xy)
    });
    [least.in_plane.re.min(least.antiplane.re), largest.fold(0.0, f64::max)]
}

/// Lets the memory of plane strain fade towards its end, and spreads over the time in which it fades the static value of what is
/// lost, but for what is uniform. Returns its share of what differs in the static compliance between the ends of the patch.
///
/// An end without fading, or a static value felt at one instant, feeds waves of the shortest periods.
fn fade(
    bodies: &HalfSpaces,
    extent: &Extent,
    nx: usize,
    step: f64,
    weights: &mut [Weights],
) -> f64 {
    let reach = extent.reach.0;
    let end = weights.len() as f64 * step;
    let begin = FADES * end;
    // 1 at `begin` and before, 0 at the end, smooth
    let left = |t: f64| {
        let x = ((t - begin) / (end - begin)).clamp(0.0, 1.0);
        1.0 - x * x * (3.0 - 2.0 * x)
    };
    let uniform = bodies.late_line_impulse(0.0);
    // integral of (1 - left(t)) (f(v) - f(0))/t over t > begin, v = x/(c_s t), f even: dt/t = -dv/v
    let lost = |j: usize| {
        let x = j as f64 * extent.spacing / bodies.shear_speed;
        let top = x / begin;
        let value = |i: usize| {
            let v = top * i as f64 / SIMPSON as f64;
            let late = bodies.late_line_impulse(v);
            let part = if v == 0.0 { 0.0 } else { (1.0 - left(x / v)) / v };
            [0, 1].map(|c| part * (late[c] - uniform[c]))
        };
        let mut sum = [0.0; 2];
        for i in 0..=SIMPSON {
            let ends = i == 0 || i == SIMPSON;
            let weight = if ends { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
            let found = value(i);
            (0..2).for_each(|c| sum[c] += weight * found[c]);
        }
        // a traction on one cell of the line
        sum.map(|s| s * top / SIMPSON as f64 / 3.0 * extent.spacing)
    };
    let lost: Vec<[f64; 2]> = (0..=reach).map(lost).collect();
    let bump = |m: usize| {
        let part = left(m as f64 * step);
        part * (1.0 - part)
    };
    let bumps: f64 = (0..weights.len()).map(bump).sum();
    for k in 0..=nx / 2 {
        let mut sum = [0.0; 2];
        for (j, lost) in lost.iter().enumerate() {
            let images = if j == 0 { 1.0 } else { 2.0 };
            let c = images * libm::cos(2.0 * PI * ((k * j) % nx) as f64 / nx as f64);
            (0..2).for_each(|i| sum[i] += c * lost[i]);
        }
        for (m, w) in weights.iter_mut().enumerate() {
            let (left, share) = (left(m as f64 * step), bump(m) / bumps);
            w.xx[k] = left * w.xx[k] + share * sum[0];
            w.yy[k] = left * w.yy[k] + share * sum[1];
        }
    }
    let across = libm::log(reach as f64) * uniform[0] * extent.spacing;
    lost.iter().map(|t| t[0].abs()).fold(0.0, f64::max) / across
}

/// Intervals of Simpson's rule.
const SIMPSON: usize = 128;

/// The smallest length of a grid, even and with small factors, on which points up to `reach` apart meet without the
/// others across the seam.
pub(crate) fn even_length(reach: usize) -> usize {
    let least = 2 * reach + 2;
    let smooth = |mut n: usize| {
        for f in [2, 3, 5] {
            while n.is_multiple_of(f) {
                n /= f;
            }
        }
        n == 1
    };
    (least..).step_by(2).find(|&n| smooth(n)).unwrap_or(least)
}

/// From the wavenumbers of the large box to those of the grid, by way of the points up to `reach` from the origin:
/// matrices for even and for odd fields.
struct Cut {
    /// Wavenumbers of the grid and of the box.
    to: usize,
    from: usize,
    /// Row by row of the grid's wavenumbers.
    matrices: [Vec<f64>; 2],
}

impl Cut {
    fn new(n: usize, reach: usize, big: usize) -> Self {
        let (to, from) = (n / 2 + 1, big / 2 + 1);
        let turn = |k: usize, j: usize, n: usize| 2.0 * PI * ((k * j) % n) as f64 / n as f64;
        let matrix = |odd: bool| {
            let wave = |k: usize, j: usize, n: usize| {
                let angle = turn(k, j, n);
                if odd { libm::sin(angle) } else { libm::cos(angle) }
            };
            let table = |n: usize, modes: usize| -> Vec<f64> {
                (0..modes).flat_map(|k| (0..=reach).map(move |j| wave(k, j, n))).collect()
            };
            let (near, far) = (table(n, to), table(big, from));
            let width = reach + 1;
            let mut matrix = Vec::with_capacity(to * from);
            for k in 0..to {
                for q in 0..from {
                    let images = if q == 0 || q == big / 2 { 1.0 } else { 2.0 };
                    let (a, b) = (&near[k * width..][..width], &far[q * width..][..width]);
                    let sum: f64 = (1..width).map(|j| a[j] * b[j]).sum();
                    matrix.push(images / big as f64 * (a[0] * b[0] + 2.0 * sum));
                }
            }
            matrix
        };
        Self { to, from, matrices: [matrix(false), matrix(true)] }
    }

    /// Of the one point across a slice.
    fn identity() -> Self {
        Self { to: 1, from: 1, matrices: [vec![1.0], vec![1.0]] }
    }
}

/// A field over the box's wavenumbers, x fastest, on the grid's; `parity` 0 for even, 1 for odd fields.
fn cut_both([x, y]: &[Cut; 2], parity: usize, field: &[f64]) -> Vec<f64> {
    let (a, b) = (&x.matrices[parity], &y.matrices[parity]);
    let mut along = vec![0.0; x.to * y.from];
    for (row, out) in field.chunks_exact(x.from).zip(along.chunks_exact_mut(x.to)) {
        for (line, out) in a.chunks_exact(x.from).zip(out) {
            *out = line.iter().zip(row).map(|(m, f)| m * f).sum();
        }
    }
    let mut both = vec![0.0; x.to * y.to];
    for (line, out) in b.chunks_exact(y.from).zip(both.chunks_exact_mut(x.to)) {
        for (weight, row) in line.iter().zip(along.chunks_exact(x.to)) {
            out.iter_mut().zip(row).for_each(|(o, r)| *o += weight * r);
        }
    }
    both
}
