//! Cholesky's factor of the coarse level.
//!
//! faer eliminates entry by entry ("simplicial"), in operations that are the same on every processor. By blocks
//! ("supernodal") it would take the processor's vectors, and the bits of the preload would depend on their width.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

/// A pivot below this part of its diagonal entry belongs to a dependent unknown.
const DEPENDENT: f64 = 1e-10;

/// The factor L of `S A S = L L^T`, where the diagonal matrix S makes the diagonal of A one.
pub(crate) struct Factor {
    scale: Vec<f64>,
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
    memory: MemBuffer,
}

impl Factor {
    /// Of the upper triangle of A in compressed columns, which their diagonal entries end. Dependent unknowns are left out:
    /// their pivots are infinite and their solution is zero. `None` for what is not a number, and where memory is short.
    pub(crate) fn new(columns: &[u32], rows: &[u32], mut values: Vec<f64>) -> Option<Self> {
        let n = columns.len() - 1;
        let column = |j: usize| columns[j] as usize..columns[j + 1] as usize;
        let scale: Vec<f64> = (0..n)
            .map(|j| values[column(j).end - 1])
            .map(|diagonal| if diagonal > 0.0 { 1.0 / diagonal.sqrt() } else { 0.0 })
            .collect();
        for j in 0..n {
            for k in column(j) {
                values[k] *= scale[rows[k] as usize] * scale[j];
            }
        }
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, columns, None, rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..Default::default()
        };
        let order = SymmetricOrdering::Amd;
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Upper, order, params).ok()?;
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let mut memory = MemBuffer::try_new(scratch).ok()?;
        let mut factor = vec![0.0; symbolic.len_val()];
        let result = symbolic.factorize_numeric_llt(
            &mut factor,
            SparseColMatRef::new(pattern, &values),
            Side::Upper,
            LltRegularization {
                dynamic_regularization_epsilon: DEPENDENT,
                dynamic_regularization_delta: f64::INFINITY,
            },
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        result.ok()?;
        let memory =
            MemBuffer::try_new(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq)).ok()?;
        Some(Self { scale, symbolic, values: factor, memory })
    }

    /// `x = A^-1 x`.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, self.scale.len(), 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
    }
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
        let (mut columns, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..5 {
            for i in 0..=j {
                rows.push(i as u32);
                values.push(full[i][j]);
            }
            columns.push(rows.len() as u32);
        }
        let mut factor = Factor::new(&columns, &rows, values).unwrap();
        let solution = [1.0, -2.0, 3.0, 0.5, 0.0];
        let right = full.map(|row| row.iter().zip(&solution).map(|(a, b)| a * b).sum::<f64>());
        let mut x = right;
        factor.solve(&mut x);
        // which of two equal unknowns is left out is the order's choice
        assert!(x[4] == 0.0 && (x[1] == 0.0 || x[3] == 0.0), "{x:?}");
        for (row, right) in full.iter().zip(right) {
            let product: f64 = row.iter().zip(&x).map(|(a, b)| a * b).sum();
            assert!((product - right).abs() < 1e-13, "{product} {right}");
        }
    }

    #[test]
    fn what_is_not_a_number_has_no_factor() {
        assert!(Factor::new(&[0, 1, 3], &[0, 0, 1], vec![1.0, f64::NAN, 1.0]).is_none());
    }
}
