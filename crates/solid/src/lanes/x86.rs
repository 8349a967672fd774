//! Vectors of x86-64: eight lanes with AVX-512F, four with AVX2 and FMA.

use super::{Lanes, Padded, operators, ordered_sum};
use std::arch::x86_64::*;

/// The methods of [`Lanes`] that are one instruction.
macro_rules! arithmetic {
    ($splat:ident $min:ident $sqrt:ident $fma:ident $fnma:ident) => {
        #[inline(always)]
        unsafe fn splat(v: f64) -> Self {
            unsafe { Self($splat(v)) }
        }
        #[inline(always)]
        fn min(self, o: Self) -> Self {
            unsafe { Self($min(self.0, o.0)) }
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            unsafe { Self($sqrt(self.0)) }
        }
        #[inline(always)]
        fn fma(self, b: Self, c: Self) -> Self {
            unsafe { Self($fma(self.0, b.0, c.0)) }
        }
        #[inline(always)]
        fn fnma(self, b: Self, c: Self) -> Self {
            unsafe { Self($fnma(self.0, b.0, c.0)) }
        }
    };
}

#[derive(Clone, Copy)]
pub(crate) struct F64x8(__m512d);

// SAFETY: a value proves that the instructions are available (see `Lanes`).
operators! { F64x8:
    Add add |a, b| unsafe { F64x8(_mm512_add_pd(a.0, b.0)) };
    Sub sub |a, b| unsafe { F64x8(_mm512_sub_pd(a.0, b.0)) };
    Mul mul |a, b| unsafe { F64x8(_mm512_mul_pd(a.0, b.0)) };
    Div div |a, b| unsafe { F64x8(_mm512_div_pd(a.0, b.0)) };
}

// SAFETY of the whole impl: the trait's contract gives AVX-512F; pointers as its methods say.
// `Padded` is 32 bytes on a 32-byte boundary, so aligned 256-bit access is right.
impl Lanes for F64x8 {
    const N: usize = 8;
    arithmetic! { _mm512_set1_pd _mm512_min_pd _mm512_sqrt_pd _mm512_fmadd_pd _mm512_fnmadd_pd }
    #[inline(always)]
    unsafe fn gather(base: *const Padded, index: *const u32) -> [Self; 3] {
        unsafe {
            // Rows [x y z 0] of the nodes (i, i + 4), then a transpose within each half.
            let r0 = pair(base, index, 0);
            let r1 = pair(base, index, 1);
            let r2 = pair(base, index, 2);
            let r3 = pair(base, index, 3);
            let xz01 = _mm512_unpacklo_pd(r0, r1);
            let y01 = _mm512_unpackhi_pd(r0, r1);
            let xz23 = _mm512_unpacklo_pd(r2, r3);
            let y23 = _mm512_unpackhi_pd(r2, r3);
            let even = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
            let odd = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
            [
                Self(_mm512_permutex2var_pd(xz01, even, xz23)),
                Self(_mm512_permutex2var_pd(y01, even, y23)),
                Self(_mm512_permutex2var_pd(xz01, odd, xz23)),
            ]
        }
    }
    #[inline(always)]
    unsafe fn scatter_sub(base: *mut Padded, index: *const u32, v: [Self; 3], count: usize) {
        unsafe {
            let zero = _mm512_setzero_pd();
            let xy_even = _mm512_unpacklo_pd(v[0].0, v[1].0);
            let xy_odd = _mm512_unpackhi_pd(v[0].0, v[1].0);
            let z_even = _mm512_unpacklo_pd(v[2].0, zero);
            let z_odd = _mm512_unpackhi_pd(v[2].0, zero);
            let even = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
            let odd = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
            let r04 = _mm512_permutex2var_pd(xy_even, even, z_even);
            let r15 = _mm512_permutex2var_pd(xy_odd, even, z_odd);
            let r26 = _mm512_permutex2var_pd(xy_even, odd, z_even);
            let r37 = _mm512_permutex2var_pd(xy_odd, odd, z_odd);
            if count == 8 {
                subtract(base, index, 0, _mm512_castpd512_pd256(r04));
                subtract(base, index, 1, _mm512_castpd512_pd256(r15));
                subtract(base, index, 2, _mm512_castpd512_pd256(r26));
                subtract(base, index, 3, _mm512_castpd512_pd256(r37));
                subtract(base, index, 4, _mm512_extractf64x4_pd::<1>(r04));
                subtract(base, index, 5, _mm512_extractf64x4_pd::<1>(r15));
                subtract(base, index, 6, _mm512_extractf64x4_pd::<1>(r26));
                subtract(base, index, 7, _mm512_extractf64x4_pd::<1>(r37));
            } else {
                let rows = [
                    _mm512_castpd512_pd256(r04),
                    _mm512_castpd512_pd256(r15),
                    _mm512_castpd512_pd256(r26),
                    _mm512_castpd512_pd256(r37),
                    _mm512_extractf64x4_pd::<1>(r04),
                    _mm512_extractf64x4_pd::<1>(r15),
                    _mm512_extractf64x4_pd::<1>(r26),
                    _mm512_extractf64x4_pd::<1>(r37),
                ];
                let mut lane = 0;
                while lane < count {
                    subtract(base, index, lane, rows[lane]);
                    lane += 1;
                }
            }
        }
    }
    #[inline(always)]
    fn sum(self, count: usize) -> f64 {
        let mut lanes = [0.0; 8];
        unsafe { _mm512_storeu_pd(lanes.as_mut_ptr(), self.0) };
        ordered_sum(&lanes, count)
    }
}

/// The vectors of the nodes `index[i]` and `index[i + 4]`.
#[inline(always)]
unsafe fn pair(base: *const Padded, index: *const u32, i: usize) -> __m512d {
    unsafe {
        let low = _mm256_load_pd(base.add(*index.add(i) as usize).cast());
        let high = _mm256_load_pd(base.add(*index.add(i + 4) as usize).cast());
        _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(low), high)
    }
}

/// Subtracts `row` from the node `index[i]`.
#[inline(always)]
unsafe fn subtract(base: *mut Padded, index: *const u32, i: usize, row: __m256d) {
    unsafe {
        let node = base.add(*index.add(i) as usize).cast::<f64>();
        _mm256_store_pd(node, _mm256_sub_pd(_mm256_load_pd(node), row));
    }
}

#[derive(Clone, Copy)]
pub(crate) struct F64x4(__m256d);

// SAFETY: a value proves that the instructions are available (see `Lanes`).
operators! { F64x4:
    Add add |a, b| unsafe { F64x4(_mm256_add_pd(a.0, b.0)) };
    Sub sub |a, b| unsafe { F64x4(_mm256_sub_pd(a.0, b.0)) };
    Mul mul |a, b| unsafe { F64x4(_mm256_mul_pd(a.0, b.0)) };
    Div div |a, b| unsafe { F64x4(_mm256_div_pd(a.0, b.0)) };
}

// SAFETY of the whole impl: the trait's contract gives AVX2 and FMA; the rest as above.
impl Lanes for F64x4 {
    const N: usize = 4;
    arithmetic! { _mm256_set1_pd _mm256_min_pd _mm256_sqrt_pd _mm256_fmadd_pd _mm256_fnmadd_pd }
    #[inline(always)]
    unsafe fn gather(base: *const Padded, index: *const u32) -> [Self; 3] {
        unsafe {
            let r0 = _mm256_load_pd(base.add(*index as usize).cast());
            let r1 = _mm256_load_pd(base.add(*index.add(1) as usize).cast());
            let r2 = _mm256_load_pd(base.add(*index.add(2) as usize).cast());
            let r3 = _mm256_load_pd(base.add(*index.add(3) as usize).cast());
            let xz01 = _mm256_unpacklo_pd(r0, r1);
            let y01 = _mm256_unpackhi_pd(r0, r1);
            let xz23 = _mm256_unpacklo_pd(r2, r3);
            let y23 = _mm256_unpackhi_pd(r2, r3);
            [
                Self(_mm256_permute2f128_pd::<0x20>(xz01, xz23)),
                Self(_mm256_permute2f128_pd::<0x20>(y01, y23)),
                Self(_mm256_permute2f128_pd::<0x31>(xz01, xz23)),
            ]
        }
    }
    #[inline(always)]
    unsafe fn scatter_sub(base: *mut Padded, index: *const u32, v: [Self; 3], count: usize) {
        unsafe {
            let zero = _mm256_setzero_pd();
            let xy_even = _mm256_unpacklo_pd(v[0].0, v[1].0);
            let xy_odd = _mm256_unpackhi_pd(v[0].0, v[1].0);
            let z_even = _mm256_unpacklo_pd(v[2].0, zero);
            let z_odd = _mm256_unpackhi_pd(v[2].0, zero);
            let rows = [
                _mm256_permute2f128_pd::<0x20>(xy_even, z_even),
                _mm256_permute2f128_pd::<0x20>(xy_odd, z_odd),
                _mm256_permute2f128_pd::<0x31>(xy_even, z_even),
                _mm256_permute2f128_pd::<0x31>(xy_odd, z_odd),
            ];
            if count == 4 {
                subtract(base, index, 0, rows[0]);
                subtract(base, index, 1, rows[1]);
                subtract(base, index, 2, rows[2]);
                subtract(base, index, 3, rows[3]);
            } else {
                let mut lane = 0;
                while lane < count {
                    subtract(base, index, lane, rows[lane]);
                    lane += 1;
                }
            }
        }
    }
    #[inline(always)]
    fn sum(self, count: usize) -> f64 {
        let mut lanes = [0.0; 4];
        unsafe { _mm256_storeu_pd(lanes.as_mut_ptr(), self.0) };
        ordered_sum(&lanes, count)
    }
}
