//! Vectors of aarch64: two vectors of two lanes make four, so that the sums over elements have the order, and with it
//! the bits, of AVX2.

use super::{Lanes, Padded, operators, ordered_sum};
use std::arch::aarch64::*;

#[derive(Clone, Copy)]
pub(crate) struct F64x2x2(float64x2_t, float64x2_t);

// SAFETY: a value proves that the instructions are available (see `Lanes`).
operators! { F64x2x2:
    Add add |a, b| unsafe { F64x2x2(vaddq_f64(a.0, b.0), vaddq_f64(a.1, b.1)) };
    Sub sub |a, b| unsafe { F64x2x2(vsubq_f64(a.0, b.0), vsubq_f64(a.1, b.1)) };
    Mul mul |a, b| unsafe { F64x2x2(vmulq_f64(a.0, b.0), vmulq_f64(a.1, b.1)) };
    Div div |a, b| unsafe { F64x2x2(vdivq_f64(a.0, b.0), vdivq_f64(a.1, b.1)) };
}

// SAFETY of the whole impl: every aarch64 machine has NEON; pointers as the trait's methods say.
impl Lanes for F64x2x2 {
    const N: usize = 4;
    #[inline(always)]
    unsafe fn splat(v: f64) -> Self {
        unsafe { Self(vdupq_n_f64(v), vdupq_n_f64(v)) }
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        // AVX2 gives the second where one is not a number; `vminq_f64` would not
        unsafe {
            Self(
                vbslq_f64(vcltq_f64(self.0, o.0), self.0, o.0),
                vbslq_f64(vcltq_f64(self.1, o.1), self.1, o.1),
            )
        }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        unsafe { Self(vsqrtq_f64(self.0), vsqrtq_f64(self.1)) }
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        unsafe { Self(vfmaq_f64(c.0, self.0, b.0), vfmaq_f64(c.1, self.1, b.1)) }
    }
    #[inline(always)]
    fn fnma(self, b: Self, c: Self) -> Self {
        unsafe { Self(vfmsq_f64(c.0, self.0, b.0), vfmsq_f64(c.1, self.1, b.1)) }
    }
    #[inline(always)]
    unsafe fn gather(base: *const Padded, index: *const u32) -> [Self; 3] {
        unsafe {
            let [x0, y0, z0] = pair(base, index);
            let [x1, y1, z1] = pair(base, index.add(2));
            [Self(x0, x1), Self(y0, y1), Self(z0, z1)]
        }
    }
    #[inline(always)]
    unsafe fn scatter_sub(base: *mut Padded, index: *const u32, v: [Self; 3], count: usize) {
        unsafe {
            let rows = [
                vtrn1q_f64(v[0].0, v[1].0),
                vtrn2q_f64(v[0].0, v[1].0),
                vtrn1q_f64(v[0].1, v[1].1),
                vtrn2q_f64(v[0].1, v[1].1),
            ];
            let mut z = [0.0; 4];
            vst1q_f64(z.as_mut_ptr(), v[2].0);
            vst1q_f64(z.as_mut_ptr().add(2), v[2].1);
            let mut lane = 0;
            while lane < count && lane < 4 {
                let node = base.add(*index.add(lane) as usize).cast::<f64>();
                vst1q_f64(node, vsubq_f64(vld1q_f64(node), rows[lane]));
                *node.add(2) -= z[lane];
                lane += 1;
            }
        }
    }
    #[inline(always)]
    fn sum(self, count: usize) -> f64 {
        let mut lanes = [0.0; 4];
        unsafe {
            vst1q_f64(lanes.as_mut_ptr(), self.0);
            vst1q_f64(lanes.as_mut_ptr().add(2), self.1);
        }
        ordered_sum(&lanes, count)
    }
}

/// x, y and z of the nodes `index[0]` and `index[1]`.
#[inline(always)]
unsafe fn pair(base: *const Padded, index: *const u32) -> [float64x2_t; 3] {
    unsafe {
        let first = base.add(*index as usize).cast::<f64>();
        let second = base.add(*index.add(1) as usize).cast::<f64>();
        let (xy0, xy1) = (vld1q_f64(first), vld1q_f64(second));
        let (z0, z1) = (vld1q_f64(first.add(2)), vld1q_f64(second.add(2)));
        [vtrn1q_f64(xy0, xy1), vtrn2q_f64(xy0, xy1), vtrn1q_f64(z0, z1)]
    }
}
