//! The vector type of nodal arrays.

use nalgebra::Vector3;
use std::ops::{AddAssign, Index, IndexMut, SubAssign};

/// A vector `[x, y, z, 0]` on a 32-byte boundary: one aligned load per node in the kernels.
///
/// The fourth entry is padding: zero, unless the documentation of an array says otherwise. Indices 0, 1 and 2 are
/// x, y and z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(32))]
pub struct Padded(pub [f64; 4]);

impl Padded {
    /// The zero vector.
    pub const ZERO: Self = Self([0.0; 4]);

    /// The padded form of `v`.
    #[inline(always)]
    pub const fn new(v: [f64; 3]) -> Self {
        Self([v[0], v[1], v[2], 0.0])
    }

    /// The three components.
    #[inline(always)]
    pub const fn xyz(self) -> [f64; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }

    /// The vector.
    #[inline(always)]
    pub const fn vector(self) -> Vector3<f64> {
        Vector3::new(self.0[0], self.0[1], self.0[2])
    }
}

impl From<Vector3<f64>> for Padded {
    #[inline(always)]
    fn from(v: Vector3<f64>) -> Self {
        Self([v.x, v.y, v.z, 0.0])
    }
}

impl AddAssign<Vector3<f64>> for Padded {
    #[inline(always)]
    fn add_assign(&mut self, v: Vector3<f64>) {
        for i in 0..3 {
            self[i] += v[i];
        }
    }
}

impl SubAssign<Vector3<f64>> for Padded {
    #[inline(always)]
    fn sub_assign(&mut self, v: Vector3<f64>) {
        for i in 0..3 {
            self[i] -= v[i];
        }
    }
}

impl Index<usize> for Padded {
    type Output = f64;
    #[inline(always)]
    fn index(&self, i: usize) -> &f64 {
        &self.0[i]
    }
}

impl IndexMut<usize> for Padded {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut f64 {
        &mut self.0[i]
    }
}
