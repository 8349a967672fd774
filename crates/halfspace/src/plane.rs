//! Fourier transform of fields on the grid of the plane of contact.

use realfft::num_complex::Complex64;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};
use std::sync::Arc;

/// The transform of real fields on a periodic grid of `nx` times `ny` points, x fastest; `ny` is one in plane strain.
///
/// Spectra have the wavenumbers 0 to nx/2 along x, fastest, and all ny along y.
pub(crate) struct Plane {
    pub(crate) nx: usize,
    pub(crate) ny: usize,
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    along_y: [Arc<dyn Fft<f64>>; 2],
    row: Vec<f64>,
    line: Vec<Complex64>,
    column: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

impl Plane {
    pub(crate) fn new(nx: usize, ny: usize) -> Self {
        let mut real = RealFftPlanner::new();
        let mut complex = FftPlanner::new();
        let (forward, inverse) = (real.plan_fft_forward(nx), real.plan_fft_inverse(nx));
        let along_y = [complex.plan_fft_forward(ny), complex.plan_fft_inverse(ny)];
        let scratch = [forward.get_scratch_len(), inverse.get_scratch_len()]
            .into_iter()
            .chain(along_y.iter().map(|f| f.get_inplace_scratch_len()))
            .max()
            .unwrap_or(0);
        Self {
            nx,
            ny,
            forward,
            inverse,
            along_y,
            row: vec![0.0; nx],
            line: vec![Complex64::ZERO; nx / 2 + 1],
            column: vec![Complex64::ZERO; ny],
            scratch: vec![Complex64::ZERO; scratch],
        }
    }

    /// Number of points.
    pub(crate) fn points(&self) -> usize {
        self.nx * self.ny
    }

    /// Number of wavenumbers of a spectrum.
    pub(crate) fn modes(&self) -> usize {
        (self.nx / 2 + 1) * self.ny
    }

    /// Grid indices of the point `at`, counted from the origin, and of its mirror images at x = 0, at y = 0 and at both, with the
    /// signs there of the component `c` of a field that is even in x and y along x (`c` = 0), odd in both along y (1). On
    /// a line of symmetry the latter is zero.
    pub(crate) fn images(&self, at: [usize; 2], c: usize) -> [(usize, f64); 4] {
        let [i, j] = at;
        let [left, below] = [(self.nx - i) % self.nx, (self.ny - j) % self.ny];
        let odd = if c == 0 { 1.0 } else { -1.0 };
        let here = if c == 1 && (i == 0 || j == 0) { 0.0 } else { 1.0 };
        [(i, j, here), (left, j, odd * here), (i, below, odd * here), (left, below, here)]
            .map(|(i, j, sign)| (i + self.nx * j, sign))
    }

    /// The spectrum of a field.
    pub(crate) fn forward(&mut self, field: &[f64], spectrum: &mut [Complex64]) {
        // rows without traction, and in a slice the component that nothing moves, need no transform
        let width = self.nx / 2 + 1;
        let mut nothing = true;
        for (from, to) in field.chunks_exact(self.nx).zip(spectrum.chunks_exact_mut(width)) {
            if from.iter().all(|f| *f == 0.0) {
                to.fill(Complex64::ZERO);
                continue;
            }
            nothing = false;
            self.row.copy_from_slice(from);
            let length = self.forward.get_scratch_len();
            let scratch = &mut self.scratch[..length];
            let done = self.forward.process_with_scratch(&mut self.row, to, scratch);
            debug_assert!(done.is_ok());
        }
        if !nothing {
            self.columns(spectrum, 0);
        }
    }

    /// The field of a spectrum, which is overwritten; scaled so that it undoes [`forward`](Self::forward).
    pub(crate) fn inverse(&mut self, spectrum: &mut [Complex64], field: &mut [f64]) {
        if spectrum.iter().all(|u| *u == Complex64::ZERO) {
            field.fill(0.0);
            return;
        }
        self.columns(spectrum, 1);
        let (width, scale) = (self.nx / 2 + 1, 1.0 / self.points() as f64);
        for (from, to) in spectrum.chunks_exact(width).zip(field.chunks_exact_mut(self.nx)) {
            self.line.copy_from_slice(from);
            self.line[0].im = 0.0;
            self.line[width - 1].im = 0.0;
            let length = self.inverse.get_scratch_len();
            let scratch = &mut self.scratch[..length];
            let done = self.inverse.process_with_scratch(&mut self.line, to, scratch);
            debug_assert!(done.is_ok());
            to.iter_mut().for_each(|u| *u *= scale);
        }
    }

    fn columns(&mut self, spectrum: &mut [Complex64], direction: usize) {
        if self.ny == 1 {
            return;
        }
        let width = self.nx / 2 + 1;
        let fft = &self.along_y[direction];
        let scratch = &mut self.scratch[..fft.get_inplace_scratch_len()];
        for k in 0..width {
            for (j, c) in self.column.iter_mut().enumerate() {
                *c = spectrum[k + width * j];
            }
            fft.process_with_scratch(&mut self.column, scratch);
            for (j, c) in self.column.iter().enumerate() {
                spectrum[k + width * j] = *c;
            }
        }
    }
}
