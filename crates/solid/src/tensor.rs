//! Vectors and matrices in three dimensions, each component in [`Lanes`].
//!
//! A fused sum adds its terms in the order of the indices, after what it is added to: the bits of a run depend on it.

use crate::lanes::Lanes;
use std::ops::{Add, Index, IndexMut, Mul, Sub};

#[derive(Clone, Copy)]
pub(crate) struct Vector<L>(pub(crate) [L; 3]);

/// Its rows.
#[derive(Clone, Copy)]
pub(crate) struct Matrix<L>(pub(crate) [Vector<L>; 3]);

impl<L: Lanes> Vector<L> {
    #[inline(always)]
    pub(crate) fn dot(self, b: Self) -> L {
        self[2].fma(b[2], self[1].fma(b[1], self[0] * b[0]))
    }

    /// a . b + c.
    #[inline(always)]
    pub(crate) fn dot_add(self, b: Self, c: L) -> L {
        self[2].fma(b[2], self[1].fma(b[1], self[0].fma(b[0], c)))
    }

    /// a x b.
    #[inline(always)]
    pub(crate) fn cross(self, b: Self) -> Self {
        let mut out = self;
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            out[i] = self[k].fnma(b[j], self[j] * b[k]);
        }
        out
    }

    /// a x b + c.
    #[inline(always)]
    pub(crate) fn cross_add(self, b: Self, c: Self) -> Self {
        let mut out = self;
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            out[i] = self[j].fma(b[k], self[k].fnma(b[j], c[i]));
        }
        out
    }

    /// a s + c.
    #[inline(always)]
    pub(crate) fn fma(self, s: L, c: Self) -> Self {
        Self([self[0].fma(s, c[0]), self[1].fma(s, c[1]), self[2].fma(s, c[2])])
    }

    /// c - a s.
    #[inline(always)]
    pub(crate) fn fnma(self, s: L, c: Self) -> Self {
        Self([self[0].fnma(s, c[0]), self[1].fnma(s, c[1]), self[2].fnma(s, c[2])])
    }

    /// a b^T.
    #[inline(always)]
    pub(crate) fn dyad(self, b: Self) -> Matrix<L> {
        Matrix([b * self[0], b * self[1], b * self[2]])
    }

    /// a b^T + C.
    #[inline(always)]
    pub(crate) fn dyad_add(self, b: Self, c: Matrix<L>) -> Matrix<L> {
        Matrix([b.fma(self[0], c[0]), b.fma(self[1], c[1]), b.fma(self[2], c[2])])
    }

    /// C - a b^T.
    #[inline(always)]
    pub(crate) fn dyad_sub(self, b: Self, c: Matrix<L>) -> Matrix<L> {
        Matrix([b.fnma(self[0], c[0]), b.fnma(self[1], c[1]), b.fnma(self[2], c[2])])
    }
}

impl<L: Lanes> Matrix<L> {
    /// A b + c.
    #[inline(always)]
    pub(crate) fn fma(&self, b: Vector<L>, c: Vector<L>) -> Vector<L> {
        let a = self;
        Vector([a[0].dot_add(b, c[0]), a[1].dot_add(b, c[1]), a[2].dot_add(b, c[2])])
    }

    /// c - A b.
    #[inline(always)]
    pub(crate) fn fnma(&self, b: Vector<L>, c: Vector<L>) -> Vector<L> {
        let column = self.transposed();
        column[2].fnma(b[2], column[1].fnma(b[1], column[0].fnma(b[0], c)))
    }

    #[inline(always)]
    pub(crate) fn transposed(&self) -> Self {
        let [a, b, c] = self.0;
        Self([Vector([a[0], b[0], c[0]]), Vector([a[1], b[1], c[1]]), Vector([a[2], b[2], c[2]])])
    }

    #[inline(always)]
    pub(crate) fn trace(&self) -> L {
        self[0][0] + self[1][1] + self[2][2]
    }

    /// A : B of symmetric matrices.
    #[inline(always)]
    pub(crate) fn contract(&self, b: &Self) -> L {
        let a = self;
        let shear = a[1][2].fma(b[1][2], a[0][2].fma(b[0][2], a[0][1] * b[0][1]));
        let sum = a[1][1].fma(b[1][1], a[0][0].fma(b[0][0], shear + shear));
        a[2][2].fma(b[2][2], sum)
    }
}

/// By a scalar in lanes or one for all of them.
impl<S: Copy, L: Lanes + Mul<S, Output = L>> Mul<S> for Vector<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: S) -> Self {
        Self([self[0] * s, self[1] * s, self[2] * s])
    }
}

impl<L: Lanes> Mul<L> for Matrix<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: L) -> Self {
        Self([self[0] * s, self[1] * s, self[2] * s])
    }
}

impl<L: Lanes> Mul<Vector<L>> for Matrix<L> {
    type Output = Vector<L>;
    #[inline(always)]
    fn mul(self, b: Vector<L>) -> Vector<L> {
        Vector([self[0].dot(b), self[1].dot(b), self[2].dot(b)])
    }
}

/// Sum and difference of two vectors or matrices, and the access to components or rows.
macro_rules! linear {
    ($tensor:ident of $part:ty) => {
        impl<L: Lanes> Add for $tensor<L> {
            type Output = Self;
            #[inline(always)]
            fn add(self, b: Self) -> Self {
                Self([self[0] + b[0], self[1] + b[1], self[2] + b[2]])
            }
        }
        impl<L: Lanes> Sub for $tensor<L> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, b: Self) -> Self {
                Self([self[0] - b[0], self[1] - b[1], self[2] - b[2]])
            }
        }
        impl<L> Index<usize> for $tensor<L> {
            type Output = $part;
            #[inline(always)]
            fn index(&self, i: usize) -> &$part {
                &self.0[i]
            }
        }
        impl<L> IndexMut<usize> for $tensor<L> {
            #[inline(always)]
            fn index_mut(&mut self, i: usize) -> &mut $part {
                &mut self.0[i]
            }
        }
    };
}

linear!(Vector of L);
linear!(Matrix of Vector<L>);
