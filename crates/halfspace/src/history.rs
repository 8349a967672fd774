//! What past tractions leave of displacement: the convolution in time, wavenumber by wavenumber.
//!
//! Steps come in blocks of B. Within a block the tractions of its own steps are summed one by one. Those of earlier blocks
//! are summed once for all steps of the block, by Fourier transforms over time: between two blocks the weights are a Toeplitz
//! matrix, which is part of a circulant one of twice the size (Hairer, Lubich and Schlichte 1985).

use crate::kernel::{Kernel, Weights};
use rayon::prelude::*;
use realfft::num_complex::Complex64;
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// Wavenumbers that are summed side by side.
const LANES: usize = 8;
/// Which component of displacement comes from which of traction, by which weight: in three dimensions, and in plane
/// strain, where nothing couples them.
const COUPLED: [Product; 4] = [[0, 0, XX], [0, 1, XY], [1, 0, XY], [1, 1, YY]];
const UNCOUPLED: [Product; 2] = [[0, 0, XX], [1, 1, YY]];
const XX: usize = 0;
const XY: usize = 1;
const YY: usize = 2;

/// Displacement, traction, weight.
type Product = [usize; 3];

/// What tractions have in common with their mirror images.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Symmetry {
    /// Nothing.
    None,
    /// Along x they are even in x and in y, along y odd in both: all spectra are real, and those of opposite wavenumbers
    /// alike but for the sign. A quarter of the plane of wavenumbers and, over time, half of the frequencies tell all.
    Mirrored,
}

/// Complex numbers at some wavenumbers.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    re: [f64; LANES],
    im: [f64; LANES],
}

/// Some wavenumbers, side by side.
struct Group {
    /// Weights `xx`, `xy`, `yy` of the lags 1 to B - 1.
    near: Vec<[[f64; LANES]; 3]>,
    /// Their transforms between a block and the q-th before it, q from one: by weight, `[q, frequency 0 to B]`.
    far: [Vec<Row>; 3],
    /// Transforms of the tractions of the blocks before this one: by component, `[index of the ring, frequency 0 to 2B - 1]`,
    /// to B alone of tractions whose spectra are real.
    past: [Vec<Row>; 2],
    /// Tractions of the steps of this block, by component.
    present: [Vec<Row>; 2],
    /// What the blocks before leave at each step of this one, by component: the first B of 2B.
    old: [Vec<Row>; 2],
    /// A transform, and what it needs.
    buffer: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

/// The spectra of past tractions, and what they leave.
pub(crate) struct History {
    groups: Vec<Group>,
    grid: [usize; 2],
    symmetry: Symmetry,
    products: &'static [Product],
    lengths: Lengths,
    /// Steps done.
    steps: usize,
    /// Whether tractions along x, along y were ever other than zero.
    loaded: [bool; 2],
    /// Over time, forward and back.
    transforms: [Arc<dyn Fft<f64>>; 2],
    now: Weights,
}

/// The weight of a wavenumber of a spectrum of `[nx/2 + 1, ny]` in weights of `[nx/2 + 1, ny/2 + 1]`, and the sign of
/// odd fields there.
fn folded([nx, ny]: [usize; 2], mode: usize) -> (usize, f64) {
    let width = nx / 2 + 1;
    let (i, j) = (mode % width, mode / width);
    if j <= ny / 2 { (mode, 1.0) } else { (i + width * (ny - j), -1.0) }
}

/// The wavenumbers beyond ny/2 along y of a spectrum of `[nx/2 + 1, ny]`, from those below: `sign` times them.
fn unfold([nx, ny]: [usize; 2], sign: f64, spectrum: &mut [Complex64]) {
    let width = nx / 2 + 1;
    for j in ny / 2 + 1..ny {
        let (below, beyond) = spectrum.split_at_mut(width * j);
        let from = &below[width * (ny - j)..][..width];
        beyond[..width].iter_mut().zip(from).for_each(|(to, from)| *to = sign * from);
    }
}

impl Symmetry {
    /// Frequencies of a block of `block` steps that tell all.
    fn frequencies(self, block: usize) -> usize {
        match self {
            Self::None => 2 * block,
            Self::Mirrored => block + 1,
        }
    }
}

/// Steps of a block, blocks in memory, and frequencies that are kept of a block.
#[derive(Clone, Copy, Debug)]
struct Lengths {
    block: usize,
    blocks: usize,
    frequencies: usize,
}

impl History {
    pub(crate) fn new(kernel: &Kernel, symmetry: Symmetry) -> Self {
        let [width, ny] = [kernel.grid[0] / 2 + 1, kernel.grid[1]];
        let modes = match symmetry {
            Symmetry::None => width * ny,
            Symmetry::Mirrored => width * (ny / 2 + 1),
        };
        let at = |weights: &Weights, mode: usize| {
            let (i, sign) = folded(kernel.grid, mode);
            let xy = weights.xy.get(i).map_or(0.0, |xy| sign * xy);
            [weights.xx[i], xy, weights.yy[i]]
        };
        let last = kernel.lags.len() - 1;
        // sums within a block cost as its length does, those over blocks as their number
        let block = (2.0 * (last as f64).sqrt()) as usize;
        let block = block.max(1).next_power_of_two();
        let blocks = last.div_ceil(block);
        let mut planner = FftPlanner::new();
        let transforms = [planner.plan_fft_forward(2 * block), planner.plan_fft_inverse(2 * block)];
        let products: &[Product] = if kernel.grid[1] > 1 { &COUPLED } else { &UNCOUPLED };
        let weight = |lag: usize, mode: usize| {
            let none = lag > last || mode >= modes;
            if none { [0.0; 3] } else { at(&kernel.lags[lag], mode) }
        };
        let lengths = Lengths { block, blocks, frequencies: symmetry.frequencies(block) };
        let group = |g: usize| Group::new(g, &transforms, lengths, products, &weight);
        let groups = if last == 0 { 0 } else { modes.div_ceil(LANES) };
        let groups = (0..groups).into_par_iter().map(group).collect();
        let mut now = Weights::default();
        for mode in 0..width * ny {
            let [xx, xy, yy] = at(&kernel.lags[0], mode);
            now.xx.push(xx);
            now.xy.push(xy);
            now.yy.push(yy);
        }
        let loaded = [false; 2];
        let grid = kernel.grid;
        Self { groups, grid, symmetry, products, lengths, steps: 0, loaded, transforms, now }
    }

    /// The spectra (x and y) of the displacement (m) that past tractions leave now.
    pub(crate) fn left(&mut self, out: &mut [Vec<Complex64>; 2]) {
        let Self { groups, products, lengths, steps, loaded, transforms, .. } = self;
        let Lengths { block, blocks, frequencies } = *lengths;
        let (inside, ended) = (*steps % block, *steps / block);
        let products = products.iter().filter(|[_, by, _]| loaded[*by]).copied();
        groups.par_iter_mut().with_min_len(4).for_each(|group| {
            if inside == 0 && ended > 0 {
                for by in (0..2).filter(|&by| loaded[by]) {
                    let index = (ended - 1) % blocks;
                    group.end_block(by, &*transforms[0], index, frequencies);
                }
                group.old.iter_mut().for_each(|old| old.fill(Row::default()));
                for product in products.clone() {
                    group.sum_blocks(product, ended, *lengths);
                }
                for of in (0..2).filter(|&of| products.clone().any(|p| p[0] == of)) {
                    group.transform_back(of, &*transforms[1], frequencies);
                }
            }
            for product in products.clone() {
                group.sum_within(product, inside);
            }
        });
        for (c, out) in out.iter_mut().enumerate() {
            out.fill(Complex64::ZERO);
            for (group, out) in self.groups.iter().zip(out.chunks_mut(LANES)) {
                let row = &group.old[c][inside];
                out.iter_mut().enumerate().for_each(|(i, o)| *o = row.at(i));
            }
            if self.symmetry == Symmetry::Mirrored {
                unfold(self.grid, if c == 0 { 1.0 } else { -1.0 }, out);
            }
        }
    }

    /// Takes the spectra of the tractions of this step (Pa).
    pub(crate) fn push(&mut self, tractions: &[Vec<Complex64>; 2]) {
        let inside = self.steps % self.lengths.block;
        for (c, spectrum) in tractions.iter().enumerate() {
            self.loaded[c] |= spectrum.iter().any(|t| *t != Complex64::ZERO);
            for (group, spectrum) in self.groups.iter_mut().zip(spectrum.chunks(LANES)) {
                let row = &mut group.present[c][inside];
                for (i, t) in spectrum.iter().enumerate() {
                    // round-off alone makes spectra of mirrored fields complex
                    let im = if self.symmetry == Symmetry::None { t.im } else { 0.0 };
                    row.set(i, Complex64::new(t.re, im));
                }
            }
        }
        self.steps += 1;
    }

    /// What tractions of this instant add to the displacement.
    pub(crate) fn now(&self, [x, y]: &[Vec<Complex64>; 2], out: &mut [Vec<Complex64>; 2]) {
        let Weights { xx, xy, yy } = &self.now;
        for mode in 0..xx.len() {
            let (tx, ty) = (x[mode], y[mode]);
            out[0][mode] = tx * xx[mode] + ty * xy[mode];
            out[1][mode] = tx * xy[mode] + ty * yy[mode];
        }
    }

    /// Bytes of spectra and weights.
    pub(crate) fn bytes(&self) -> usize {
        let rows =
            |rows: &[Vec<Row>]| rows.iter().map(|r| r.len() * size_of::<Row>()).sum::<usize>();
        let of = |g: &Group| {
            let fields = rows(&g.far) + rows(&g.past) + rows(&g.present) + rows(&g.old);
            fields + size_of_val(&g.near[..])
        };
        self.groups.iter().map(of).sum()
    }

    /// The spectra of past tractions and what those before the block leave, group by group.
    pub(crate) fn snapshot(&self) -> Vec<f64> {
        let rows = self.groups.iter().flat_map(Group::state).flatten();
        rows.flat_map(|row| row.re.iter().chain(&row.im).copied()).collect()
    }

    /// Takes over a [`snapshot`](Self::snapshot) after `steps` steps; whether it fits.
    pub(crate) fn restore(&mut self, numbers: &[f64], steps: usize) -> bool {
        let rows: usize = self.groups.iter().flat_map(Group::state).map(Vec::len).sum();
        if numbers.len() != rows * 2 * LANES {
            return false;
        }
        self.loaded = [false; 2];
        let mut from = numbers.iter().copied();
        for group in &mut self.groups {
            let Group { past: [px, py], present: [tx, ty], old: [ox, oy], .. } = group;
            for (c, rows) in [(0, px), (1, py), (0, tx), (1, ty), (0, ox), (1, oy)] {
                for to in rows.iter_mut().flat_map(|row| row.re.iter_mut().chain(&mut row.im)) {
                    *to = from.next().unwrap_or(0.0);
                    self.loaded[c] |= *to != 0.0;
                }
            }
        }
        self.steps = steps;
        true
    }
}

impl Row {
    fn at(&self, lane: usize) -> Complex64 {
        Complex64::new(self.re[lane], self.im[lane])
    }

    fn set(&mut self, lane: usize, value: Complex64) {
        (self.re[lane], self.im[lane]) = (value.re, value.im);
    }
}

impl Group {
    /// The group `g`, with the weights (`xx`, `xy`, `yy`) of a lag and a wavenumber.
    fn new(
        g: usize,
        transforms: &[Arc<dyn Fft<f64>>; 2],
        lengths: Lengths,
        products: &[Product],
        weight: &impl Fn(usize, usize) -> [f64; 3],
    ) -> Self {
        let Lengths { block, blocks, frequencies } = lengths;
        let lanes = |lag: usize| {
            let mut near = [[0.0; LANES]; 3];
            for lane in 0..LANES {
                let values = weight(lag, g * LANES + lane);
                near.iter_mut().zip(values).for_each(|(n, v)| n[lane] = v);
            }
            near
        };
        let longest = transforms.iter().map(|t| t.get_inplace_scratch_len()).max().unwrap_or(0);
        let mut scratch = vec![Complex64::ZERO; longest];
        let mut buffer = vec![Complex64::ZERO; 2 * block];
        let mut far = [Vec::new(), Vec::new(), Vec::new()];
        for (c, far) in far.iter_mut().enumerate() {
            if !products.iter().any(|p| p[2] == c) {
                continue;
            }
            far.resize(blocks * (block + 1), Row::default());
            for (q, far) in far.chunks_exact_mut(block + 1).enumerate() {
                for lane in 0..LANES {
                    // from step k of the block q + 1 before to step i of this one the lag is (q + 1) B + i - k
                    for (d, b) in buffer.iter_mut().enumerate() {
                        let lag =
                            if d < block { (q + 1) * block + d } else { q * block + d - block };
                        let known = d != block;
                        let w = if known { weight(lag, g * LANES + lane)[c] } else { 0.0 };
                        *b = Complex64::from(w);
                    }
                    transforms[0].process_with_scratch(&mut buffer, &mut scratch);
                    far.iter_mut().zip(&buffer).for_each(|(row, b)| row.set(lane, *b));
                }
            }
        }
        let rows = |n: usize| [0, 1].map(|_| vec![Row::default(); n]);
        Self {
            near: (1..block).map(lanes).collect(),
            far,
            past: rows(frequencies * blocks),
            present: rows(block),
            old: rows(2 * block),
            buffer,
            scratch,
        }
    }

    /// What a checkpoint must hold.
    fn state(&self) -> impl Iterator<Item = &Vec<Row>> {
        self.past.iter().chain(&self.present).chain(&self.old)
    }

    /// Transforms the tractions `by` of the block that ends, as the block `index` of the ring.
    fn end_block(&mut self, by: usize, transform: &dyn Fft<f64>, index: usize, frequencies: usize) {
        let Self { past, present, buffer, scratch, .. } = self;
        let past = &mut past[by][index * frequencies..][..frequencies];
        for lane in 0..LANES {
            buffer.fill(Complex64::ZERO);
            buffer.iter_mut().zip(&present[by]).for_each(|(b, row)| *b = row.at(lane));
            transform.process_with_scratch(buffer, scratch);
            past.iter_mut().zip(&*buffer).for_each(|(row, b)| row.set(lane, *b));
        }
    }

    /// Adds the transforms of what the `ended` blocks before this one leave.
    fn sum_blocks(&mut self, [of, by, weight]: Product, ended: usize, lengths: Lengths) {
        let Lengths { block, blocks, frequencies } = lengths;
        for q in 0..blocks.min(ended) {
            let index = (ended - 1 - q) % blocks;
            let past = &self.past[by][index * frequencies..][..frequencies];
            let far = &self.far[weight][q * (block + 1)..][..=block];
            widest(|| add_transforms(&mut self.old[of], far, past));
        }
    }

    /// Brings the sums of all blocks back to steps.
    fn transform_back(&mut self, of: usize, transform: &dyn Fft<f64>, frequencies: usize) {
        let Self { old, buffer, scratch, .. } = self;
        let length = buffer.len();
        let scale = 1.0 / length as f64;
        for lane in 0..LANES {
            buffer.iter_mut().zip(&old[of]).for_each(|(b, row)| *b = row.at(lane));
            // steps of real numbers: conjugate at opposite frequencies
            for f in frequencies..length {
                buffer[f] = buffer[length - f].conj();
            }
            transform.process_with_scratch(buffer, scratch);
            old[of].iter_mut().zip(&*buffer).for_each(|(row, b)| row.set(lane, b * scale));
        }
    }

    /// Adds what the earlier steps of the block leave at its step `inside`.
    fn sum_within(&mut self, [of, by, weight]: Product, inside: usize) {
        let Self { near, present, old, .. } = self;
        let past = present[by][..inside].iter().rev();
        widest(|| add_steps(&mut old[of][inside], near, past, weight));
    }
}

/// Adds to the transforms `sum` (frequencies 0 to 2B - 1, or as far as `past` goes) those of a block convolved with real
/// weights, whose transform `far` (0 to B) is conjugate at opposite frequencies.
#[inline(always)]
fn add_transforms(sum: &mut [Row], far: &[Row], past: &[Row]) {
    let block = far.len() - 1;
    add(&mut sum[0], &far[0], &past[0], 1.0);
    add(&mut sum[block], &far[block], &past[block], 1.0);
    for f in 1..block {
        add(&mut sum[f], &far[f], &past[f], 1.0);
        let opposite = 2 * block - f;
        if let Some(past) = past.get(opposite) {
            add(&mut sum[opposite], &far[f], past, -1.0);
        }
    }
}

/// Adds the product of `weight`, or its conjugate where `sign` is -1, and `value`.
#[inline(always)]
fn add(sum: &mut Row, weight: &Row, value: &Row, sign: f64) {
    for l in 0..LANES {
        let (re, im) = (weight.re[l], sign * weight.im[l]);
        sum.re[l] += re * value.re[l] - im * value.im[l];
        sum.im[l] += re * value.im[l] + im * value.re[l];
    }
}

/// Adds the steps of the block so far, latest first, times the weights `c` of their lags.
#[inline(always)]
fn add_steps<'a>(
    sum: &mut Row,
    near: &[[[f64; LANES]; 3]],
    past: impl Iterator<Item = &'a Row>,
    c: usize,
) {
    for (weights, value) in near.iter().zip(past) {
        for l in 0..LANES {
            sum.re[l] += weights[c][l] * value.re[l];
            sum.im[l] += weights[c][l] * value.im[l];
        }
    }
}

/// Computes with the widest vectors of the machine: products and sums are rounded alike with any.
#[inline(always)]
fn widest(sum: impl FnOnce()) {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2
        unsafe { with_avx2(sum) };
        return;
    }
    sum();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2(sum: impl FnOnce()) {
    sum();
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
        let mut history = History::new(&kernel, Symmetry::None);
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

    #[test]
    fn what_the_past_leaves_is_the_sum_of_its_responses() {
        let steel = HalfSpaces::new(210e9, 0.3, 7850.0);
        let h = 1e-3;
        for (reach, patch) in [((6, Some(5)), [5, 4]), ((12, None), [11, 1])] {
            let dt = 0.5 * h / steel.pressure_speed;
            let extent = Extent { spacing: h, reach, diameter: h * patch[0] as f64 };
            let kernel = Kernel::new(&steel, &extent, dt).unwrap();
            let mut plane = Plane::new(kernel.grid[0], kernel.grid[1]);
            let mut history = History::new(&kernel, Symmetry::None);
            let spectra = || [0, 1].map(|_| vec![Complex64::ZERO; plane.modes()]);
            let (mut taus, mut left) = (spectra(), spectra());
            let points = plane.points();
            let zeros = || [0, 1].map(|_| vec![0.0; points]);
            let mut past: Vec<[Vec<f64>; 2]> = Vec::new();
            let mut found = zeros();
            let mut seed = 3;
            let at = [patch[0] - 1, patch[1] / 2];
            for n in 0..3 * kernel.memory() {
                history.left(&mut left);
                (0..2).for_each(|c| plane.inverse(&mut left[c], &mut found[c]));
                // a point of the patch, now and then
                if n % 17 == 0 {
                    let (mut sum, mut sizes) = ([0.0; 2], 0.0);
                    for (lag, [x, y]) in (1..).zip(past.iter().rev().take(kernel.memory() - 1)) {
                        for (i, j) in (0..patch[0]).flat_map(|i| (0..patch[1]).map(move |j| (i, j)))
                        {
                            let point = i + plane.nx * j;
                            let [dx, dy] = [at[0].abs_diff(i), at[1].abs_diff(j)];
                            let [xx, xy, yy] = kernel.response(lag, [dx, dy]);
                            // odd along both axes
                            let sign = if (at[0] < i) == (at[1] < j) { 1.0 } else { -1.0 };
                            let [tx, ty]: [f64; 2] = [x, y].map(|t: &Vec<f64>| t[point]);
                            sum[0] += xx * tx + sign * xy * ty;
                            sum[1] += sign * xy * tx + yy * ty;
                            sizes += (xx * tx).abs() + (yy * ty).abs();
                        }
                    }
                    let point = at[0] + plane.nx * at[1];
                    for c in 0..2 {
                        let error = (sum[c] - found[c][point]).abs();
                        assert!(error <= 1e-13 * sizes, "{n} {c}: {sum:?} {}", found[c][point]);
                    }
                }
                let mut tau = zeros();
                for (i, j) in (0..patch[0]).flat_map(|i| (0..patch[1]).map(move |j| (i, j))) {
                    (0..2).for_each(|c| tau[c][i + plane.nx * j] = noise(&mut seed));
                }
                (0..2).for_each(|c| plane.forward(&tau[c], &mut taus[c]));
                history.push(&taus);
                past.push(tau);
            }
        }
    }

    #[test]
    fn mirrored_tractions_leave_the_same_by_a_quarter_of_their_wavenumbers() {
        let steel = HalfSpaces::new(210e9, 0.3, 7850.0);
        let h = 1e-3;
        let dt = 0.5 * h / steel.pressure_speed;
        let extent = Extent { spacing: h, reach: (8, Some(6)), diameter: 8.0 * h };
        let kernel = Kernel::new(&steel, &extent, dt).unwrap();
        let mut plane = Plane::new(kernel.grid[0], kernel.grid[1]);
        let both = [Symmetry::None, Symmetry::Mirrored];
        let mut histories = both.map(|symmetry| History::new(&kernel, symmetry));
        assert!(2 * histories[1].bytes() < histories[0].bytes());
        let spectra = || [0, 1].map(|_| vec![Complex64::ZERO; plane.modes()]);
        let (mut taus, mut left) = (spectra(), [spectra(), spectra()]);
        let mut tau = [0, 1].map(|_| vec![0.0; plane.points()]);
        let mut seed = 5;
        for _ in 0..3 * kernel.memory() {
            for (i, j) in (0..=4).flat_map(|i| (0..=3).map(move |j| (i, j))) {
                for (c, tau) in tau.iter_mut().enumerate() {
                    let value = noise(&mut seed);
                    for (k, sign) in plane.images([i, j], c) {
                        tau[k] = sign * value;
                    }
                }
            }
            for (history, left) in histories.iter_mut().zip(&mut left) {
                history.left(left);
            }
            let [all, quarter] = &left;
            for (all, quarter) in all.iter().zip(quarter) {
                let largest = all.iter().map(|u| u.norm()).fold(0.0, f64::max);
                let error = all.iter().zip(quarter).map(|(a, b)| (a - b).norm());
                assert!(error.fold(0.0, f64::max) <= 1e-13 * largest);
            }
            (0..2).for_each(|c| plane.forward(&tau[c], &mut taus[c]));
            histories.iter_mut().for_each(|history| history.push(&taus));
        }
    }
}
