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
