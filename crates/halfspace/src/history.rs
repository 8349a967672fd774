//! What past tractions leave of displacement: the convolution in time, wavenumber by wavenumber.

use crate::kernel::{Kernel, Weights};
use rayon::prelude::*;
use realfft::num_complex::Complex64;

/// Wavenumbers that are summed side by side.
const LANES: usize = 8;
/// Steps whose old part is summed at once, so that each weight is read once for all of them.
const BATCH: usize = 8;

/// Real and imaginary parts of a vector along x and y at some wavenumbers.
type Spectra = [[f64; LANES]; 4];
/// Weights `xx`, `xy`, `yy` at some wavenumbers.
type Tensor = [[f64; LANES]; 3];

/// The memory of some wavenumbers.
struct Block {
    /// Of lag 1 and on.
    weights: Vec<Tensor>,
    /// The spectra of the tractions of the last steps, oldest first: those before the batch, then those within it.
    past: Vec<Spectra>,
    /// What those before the batch leave at each of its steps.
    old: [Spectra; BATCH],
}

/// The spectra of past tractions, and what they leave.
pub(crate) struct History {
    blocks: Vec<Block>,
    modes: usize,
    /// Weights beyond lag 0.
    lags: usize,
    /// Steps of the batch that are done.
    done: usize,
    now: Weights,
}

/// The weight of a wavenumber of a spectrum of `[nx/2 + 1, ny]` in weights of `[nx/2 + 1, ny/2 + 1]`, and the sign of
/// odd fields there.
fn folded([nx, ny]: [usize; 2], mode: usize) -> (usize, f64) {
    let width = nx / 2 + 1;
    let (i, j) = (mode % width, mode / width);
    if j <= ny / 2 { (mode, 1.0) } else { (i + width * (ny - j), -1.0) }
}

impl History {
    pub(crate) fn new(kernel: &Kernel) -> Self {
        let modes = (kernel.grid[0] / 2 + 1) * kernel.grid[1];
        let at = |weights: &Weights, mode: usize| {
            let (i, sign) = folded(kernel.grid, mode);
            let xy = weights.xy.get(i).map_or(0.0, |xy| sign * xy);
            [weights.xx[i], xy, weights.yy[i]]
        };
        let lags = kernel.lags.len() - 1;
        let block = |b: usize| {
            let tensor = |weights: &Weights| {
                let mut tensor = [[0.0; LANES]; 3];
                for lane in (0..LANES).filter(|lane| b * LANES + lane < modes) {
                    let values = at(weights, b * LANES + lane);
                    (0..3).for_each(|c| tensor[c][lane] = values[c]);
                }
                tensor
            };
            Block {
                weights: kernel.lags[1..].iter().map(tensor).collect(),
                past: vec![[[0.0; LANES]; 4]; lags + BATCH],
                old: [[[0.0; LANES]; 4]; BATCH],
            }
        };
        let blocks = (0..modes.div_ceil(LANES)).into_par_iter().map(block).collect();
        let mut now = Weights::default();
        for mode in 0..modes {
            let [xx, xy, yy] = at(&kernel.lags[0], mode);
            now.xx.push(xx);
            now.xy.push(xy);
            now.yy.push(yy);
        }
        Self { blocks, modes, lags, done: 0, now }
    }

    /// The spectra (x and y) of the displacement (m) that past tractions leave now.
    pub(crate) fn left(&mut self, out: &mut [Vec<Complex64>; 2]) {
        let (lags, done) = (self.lags, self.done);
        if lags == 0 {
            out.iter_mut().for_each(|o| o.fill(Complex64::ZERO));
            return;
        }
        self.blocks.par_iter_mut().with_min_len(4).for_each(|block| {
            if done == 0 {
                sum_old(block, lags);
            }
            // the steps of this batch
            let mut sum = block.old[done];
            for i in 0..done.min(lags) {
                let (w, t) = (&block.weights[i], &block.past[lags + done - 1 - i]);
                add(&mut sum, w, t);
            }
            block.old[done] = sum;
        });
        for mode in 0..self.modes {
            let (sum, lane) = (&self.blocks[mode / LANES].old[done], mode % LANES);
            out[0][mode] = Complex64::new(sum[0][lane], sum[1][lane]);
            out[1][mode] = Complex64::new(sum[2][lane], sum[3][lane]);
        }
    }

    /// Takes the spectra of the tractions of this step (Pa).
    pub(crate) fn push(&mut self, [x, y]: &[Vec<Complex64>; 2]) {
        if self.lags == 0 {
            return;
        }
        let (row, modes) = (self.lags + self.done, self.modes);
        for mode in 0..modes {
            let (block, lane) = (&mut self.blocks[mode / LANES], mode % LANES);
            let past = &mut block.past[row];
            past[0][lane] = x[mode].re;
            past[1][lane] = x[mode].im;
            past[2][lane] = y[mode].re;
            past[3][lane] = y[mode].im;
        }
        self.done += 1;
        if self.done == BATCH {
            self.blocks.par_iter_mut().with_min_len(4).for_each(|b| b.past.copy_within(BATCH.., 0));
            self.done = 0;
        }
    }

    /// What tractions of this instant add to the displacement.
    pub(crate) fn now(&self, [x, y]: &[Vec<Complex64>; 2], out: &mut [Vec<Complex64>; 2]) {
        let Weights { xx, xy, yy } = &self.now;
        for mode in 0..self.modes {
            let (tx, ty) = (x[mode], y[mode]);
            out[0][mode] = tx * xx[mode] + ty * xy[mode];
            out[1][mode] = tx * xy[mode] + ty * yy[mode];
        }
    }

    /// Bytes of spectra and weights.
    pub(crate) fn bytes(&self) -> usize {
        let per_lag = size_of::<Tensor>() + size_of::<Spectra>();
        self.blocks.len() * self.lags * per_lag
    }

    /// The spectra of past tractions, oldest first and lane by lane, with the steps of the batch that are done.
    pub(crate) fn snapshot(&self) -> (Vec<f64>, usize) {
        let past = self.blocks.iter().flat_map(|b| b.past.iter().flatten().flatten().copied());
        let old = self.blocks.iter().flat_map(|b| b.old.iter().flatten().flatten().copied());
        (past.chain(old).collect(), self.done)
    }

    /// Takes over a [`snapshot`](Self::snapshot); whether it fits.
    pub(crate) fn restore(&mut self, numbers: &[f64], done: usize) -> bool {
        let per_block = 4 * LANES * (self.lags + BATCH);
        if numbers.len() != self.blocks.len() * (per_block + 4 * LANES * BATCH) || done >= BATCH {
            return false;
        }
        let mut from = numbers.iter().copied();
        let mut fill = |to: &mut [Spectra]| {
            to.iter_mut().flatten().flatten().zip(&mut from).for_each(|(to, x)| *to = x);
        };
        self.blocks.iter_mut().for_each(|b| fill(&mut b.past));
        self.blocks.iter_mut().for_each(|b| fill(&mut b.old));
        self.done = done;
        true
    }
}

/// Sums what the steps before the batch leave at each of its steps, with the widest vectors of the machine: products and
/// sums are rounded alike with any.
fn sum_old(block: &mut Block, lags: usize) {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2
        unsafe { sum_old_avx2(block, lags) };
        return;
    }
    block.sum_old(lags);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn sum_old_avx2(block: &mut Block, lags: usize) {
    block.sum_old(lags);
}

impl Block {
    #[inline(always)]
    fn sum_old(&mut self, lags: usize) {
        self.old = [[[0.0; LANES]; 4]; BATCH];
        for (row, past) in self.past[..lags].iter().enumerate() {
            // at step j of the batch this row is lags - row + j steps old
            let reach = BATCH.min(row + 1);
            let weights = &self.weights[lags - row - 1..][..reach];
            for (old, w) in self.old.iter_mut().zip(weights) {
                add(old, w, past);
            }
        }
    }
}

#[inline(always)]
fn add(sum: &mut Spectra, [xx, xy, yy]: &Tensor, [xr, xi, yr, yi]: &Spectra) {
    for l in 0..LANES {
        sum[0][l] += xx[l] * xr[l] + xy[l] * yr[l];
        sum[1][l] += xx[l] * xi[l] + xy[l] * yi[l];
        sum[2][l] += xy[l] * xr[l] + yy[l] * yr[l];
        sum[3][l] += xy[l] * xi[l] + yy[l] * yi[l];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::Plane;
    use crate::{Extent, HalfSpaces};

    /// Numbers between -1 and 1 that look random (Steele, Lea and Flood 2014).
    fn noise(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// Work of random tractions on a patch of `[a, b]` points, the least of it on the way, and the sum of its sizes. The
    /// tractions of a point keep their value for a random number of steps, `longest` at most.
    fn work(reach: (usize, Option<usize>), patch: [usize; 2], longest: f64) -> [f64; 3] {
        let steel = HalfSpaces::new(210e9, 0.3, 7850.0);
        let h = 1e-3;
        let dt = 0.5 * h / steel.pressure_speed;
        let diameter = h * libm::hypot(patch[0] as f64, patch[1] as f64);
        let kernel = Kernel::new(&steel, &Extent { spacing: h, reach, diameter }, dt).unwrap();
        let mut plane = Plane::new(kernel.grid[0], kernel.grid[1]);
        let mut history = History::new(&kernel);
        let spectra = || [0, 1].map(|_| vec![Complex64::ZERO; plane.modes()]);
        let (mut taus, mut left, mut now) = (spectra(), spectra(), spectra());
        let zeros = || [0, 1].map(|_| vec![0.0; plane.points()]);
        let (mut tau, mut moved) = (zeros(), [zeros(), zeros(), zeros()]);
        let (mut seed, mut sums) = (7, [0.0, f64::INFINITY, 0.0]);
        for _ in 0..4 * kernel.memory() {
            for (i, j) in (0..patch[0]).flat_map(|i| (0..patch[1]).map(move |j| (i, j))) {
                for c in 0..2 {
                    if noise(&mut seed).abs() * longest < 1.0 {
                        tau[c][i + plane.nx * j] = 1e8 * noise(&mut seed);
                    }
                }
            }
            (0..2).for_each(|c| plane.forward(&tau[c], &mut taus[c]));
            history.left(&mut left);
            history.now(&taus, &mut now);
            moved.rotate_right(1);
            for c in 0..2 {
                now[c].iter_mut().zip(&left[c]).for_each(|(n, l)| *n += l);
                plane.inverse(&mut now[c], &mut moved[0][c]);
                for (i, t) in tau[c].iter().enumerate() {
                    let [u, one, two] = [0, 1, 2].map(|k| moved[k][c][i]);
                    let part = h * h * t * (1.5 * u - 2.0 * one + 0.5 * two);
                    sums[0] += part;
                    sums[2] += part.abs();
                }
            }
            sums[1] = f64::min(sums[1], sums[0]);
            history.push(&taus);
        }
        sums
    }

    #[test]
    fn no_tractions_get_back_more_work_than_they_put_in() {
        for longest in [1.0, 10.0, 100.0] {
            for (reach, patch) in [((10, Some(8)), [8, 6]), ((40, None), [38, 1])] {
                let [total, least, sizes] = work(reach, patch, longest);
                assert!(total > 0.0 && least > -1e-9 * sizes, "{patch:?}: {total} {least} {sizes}");
            }
        }
    }
}
