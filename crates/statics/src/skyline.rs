//! Cholesky factor of a sparse symmetric matrix in its envelope.

/// A lower triangle stored row by row from the first entry of each row to the diagonal.
#[derive(Clone, Debug, Default)]
pub(crate) struct Skyline {
    /// Column of the first entry of each row.
    first: Vec<usize>,
    /// Where the row's entries start, less `first`: entry (i, j) is `values[start[i] + j]`.
    start: Vec<usize>,
    values: Vec<f64>,
}

/// A pivot below this part of its diagonal entry belongs to a dependent unknown.
const DEPENDENT: f64 = 1e-10;

impl Skyline {
    /// A zero matrix with rows that begin at the columns `first`.
    pub(crate) fn zero(first: Vec<usize>) -> Self {
        let mut start = Vec::with_capacity(first.len());
        let mut length = 0_usize;
        for (i, &f) in first.iter().enumerate() {
            // Entry (i, j) at length + j - first; wrapping, since start may be below zero.
            start.push(length.wrapping_sub(f));
            length += i + 1 - f;
        }
        Self { first, start, values: vec![0.0; length] }
    }

    /// The entry (i, j), `j <= i` within the envelope.
    pub(crate) fn entry(&mut self, i: usize, j: usize) -> &mut f64 {
        &mut self.values[self.start[i].wrapping_add(j)]
    }

    fn row(&self, i: usize, from: usize, to: usize) -> &[f64] {
        &self.values[self.start[i].wrapping_add(from)..self.start[i].wrapping_add(to)]
    }

    /// Replaces the matrix by its Cholesky factor. Dependent unknowns are left out: their solution
    /// is zero.
    pub(crate) fn factorise(&mut self) {
        for i in 0..self.first.len() {
            for j in self.first[i]..i {
                let from = self.first[i].max(self.first[j]);
                let sum =
                    if from < j { dot(self.row(i, from, j), self.row(j, from, j)) } else { 0.0 };
                let pivot = *self.entry(j, j);
                let entry = self.entry(i, j);
                *entry = (*entry - sum) / pivot;
            }
            let row = self.row(i, self.first[i], i);
            let squares = dot(row, row);
            let diagonal = self.entry(i, i);
            let rest = *diagonal - squares;
            let independent = rest > DEPENDENT * *diagonal;
            *diagonal = if independent { rest.sqrt() } else { f64::INFINITY };
        }
    }

    /// Solves with the factor, in place.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        for i in 0..self.first.len() {
            let sum = dot(self.row(i, self.first[i], i), &x[self.first[i]..i]);
            x[i] = (x[i] - sum) / self.values[self.start[i].wrapping_add(i)];
        }
        for i in (0..self.first.len()).rev() {
            let value = x[i] / self.values[self.start[i].wrapping_add(i)];
            x[i] = value;
            for (x, l) in x[self.first[i]..i].iter_mut().zip(self.row(i, self.first[i], i)) {
                *x -= l * value;
            }
        }
    }
}

/// A dot product in eight lanes.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let mut sums = [0.0; LANES];
    let (mut left, mut right) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    for (a, b) in left.by_ref().zip(right.by_ref()) {
        for i in 0..LANES {
            sums[i] += a[i] * b[i];
        }
    }
    let rest: f64 = left.remainder().iter().zip(right.remainder()).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_solves_and_leaves_dependent_unknowns_out() {
        // 2x2 block, a coupled third unknown, a fourth equal to the second, and an empty fifth.
        let full = [
            [4.0, 1.0, 0.0, 1.0, 0.0],
            [1.0, 3.0, 0.5, 3.0, 0.0],
            [0.0, 0.5, 2.0, 0.5, 0.0],
            [1.0, 3.0, 0.5, 3.0, 0.0],
            [0.0; 5],
        ];
        let mut matrix = Skyline::zero(vec![0, 0, 1, 0, 4]);
        for (i, first) in [0, 0, 1, 0, 4].into_iter().enumerate() {
            for j in first..=i {
                *matrix.entry(i, j) = full[i][j];
            }
        }
        matrix.factorise();
        let wanted = [1.0, -2.0, 3.0, 0.0, 0.0];
        let mut x = full.map(|row| row.iter().zip(&wanted).map(|(a, b)| a * b).sum::<f64>());
        matrix.solve(&mut x);
        for (x, wanted) in x.iter().zip(wanted) {
            assert!((x - wanted).abs() < 1e-14, "{x} {wanted}");
        }
    }
}
