//! Vectors of elements: one type per instruction set, all with the trait [`Lanes`].
//!
//! The kernels are generic over [`Lanes`] and are instantiated once per level inside a function that enables the
//! level's instructions; nothing else in the workspace needs special compiler flags. The methods for vector
//! instructions are `#[inline(always)]` and free of closures: a call that is not inlined would lose the enabled
//! instructions and most of the speed.

use mesh::Padded;

/// The instruction set of the kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// AVX-512F, 8 lanes.
    Avx512,
    /// AVX2 with FMA, 4 lanes.
    Avx2,
    /// Plain Rust with the bits of [`Level::Avx2`]; slow where the machine has no fused multiply-add.
    Fused,
    /// Plain Rust, one lane, no fused multiply-add; on any machine.
    Portable,
}

impl Level {
    /// All levels, the widest first.
    pub const ALL: [Self; 4] = [Self::Avx512, Self::Avx2, Self::Fused, Self::Portable];

    /// The level whose bits every machine can give: [`Level::Avx2`] where available, else [`Level::Fused`].
    pub fn pinned() -> Self {
        if Self::Avx2.available() { Self::Avx2 } else { Self::Fused }
    }

    /// The level of this [`name`](Self::name), if there is one.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.name() == name)
    }

    /// A level available on this machine that gives the bits of this one, if there is one.
    pub fn with_the_same_bits(self) -> Option<Self> {
        match self {
            Self::Avx2 | Self::Fused => Some(Self::pinned()),
            level => level.available().then_some(level),
        }
    }

    /// The widest level that this machine has instructions for; never [`Level::Fused`].
    pub fn detect() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            // what the kernels are compiled for; a virtual machine may hide any of them
            if std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma") {
                let wide = std::is_x86_feature_detected!("avx512f");
                return if wide { Self::Avx512 } else { Self::Avx2 };
            }
        }
        Self::Portable
    }

    /// Whether this machine can run this level.
    pub fn available(self) -> bool {
        match (Self::detect(), self) {
            (_, Self::Portable | Self::Fused) | (Self::Avx512, _) => true,
            (best, level) => best == level,
        }
    }

    /// `"avx512"`, `"avx2"`, `"fused"` or `"portable"`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Fused => "fused",
            Self::Portable => "portable",
        }
    }
}

/// One number for each of `N` elements.
///
/// # Safety
/// Every method may only run where the instructions of the implementing type are available.
pub(crate) trait Lanes: Copy {
    /// Number of lanes; divides eight.
    const N: usize;

    unsafe fn splat(v: f64) -> Self;
    unsafe fn add(self, o: Self) -> Self;
    unsafe fn sub(self, o: Self) -> Self;
    unsafe fn mul(self, o: Self) -> Self;
    unsafe fn div(self, o: Self) -> Self;
    unsafe fn min(self, o: Self) -> Self;
    unsafe fn sqrt(self) -> Self;
    /// `self * b + c`
    unsafe fn mul_add(self, b: Self, c: Self) -> Self;
    /// `c - self * b`
    unsafe fn neg_mul_add(self, b: Self, c: Self) -> Self;
    /// x, y and z of the nodes `index[0..N]`.
    ///
    /// `index` must be readable for `N` entries and each must be a valid index into `base`.
    unsafe fn gather(base: *const Padded, index: *const u32) -> [Self; 3];
    /// Subtracts the first `count` lanes from the nodes `index[0..count]`, in lane order, so that
    /// lanes may share nodes.
    ///
    /// As [`gather`](Self::gather), and nobody else may access these nodes meanwhile.
    unsafe fn scatter_sub(base: *mut Padded, index: *const u32, v: [Self; 3], count: usize);
    /// Sum of the first `count` lanes in lane order.
    unsafe fn sum(self, count: usize) -> f64;
}

impl Lanes for f64 {
    const N: usize = 1;
    #[inline(always)]
    unsafe fn splat(v: f64) -> Self {
        v
    }
    #[inline(always)]
    unsafe fn add(self, o: Self) -> Self {
        self + o
    }
    #[inline(always)]
    unsafe fn sub(self, o: Self) -> Self {
        self - o
    }
    #[inline(always)]
    unsafe fn mul(self, o: Self) -> Self {
        self * o
    }
    #[inline(always)]
    unsafe fn div(self, o: Self) -> Self {
        self / o
    }
    #[inline(always)]
    unsafe fn min(self, o: Self) -> Self {
        if self < o { self } else { o }
    }
    #[inline(always)]
    unsafe fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    unsafe fn mul_add(self, b: Self, c: Self) -> Self {
        // Rounds twice: a fused multiply-add without hardware support would be a slow library call.
        self * b + c
    }
    #[inline(always)]
    unsafe fn neg_mul_add(self, b: Self, c: Self) -> Self {
        c - self * b
    }
    #[inline(always)]
    unsafe fn gather(base: *const Padded, index: *const u32) -> [Self; 3] {
        // SAFETY: both pointers are valid by the caller's contract.
        unsafe { (*base.add(*index as usize)).xyz() }
    }
    #[inline(always)]
    unsafe fn scatter_sub(base: *mut Padded, index: *const u32, v: [Self; 3], count: usize) {
        if count == 1 {
            // SAFETY: the caller vouches for both pointers and for exclusive access.
            let node = unsafe { &mut *base.add(*index as usize) };
            node.0[0] -= v[0];
            node.0[1] -= v[1];
            node.0[2] -= v[2];
        }
    }
    #[inline(always)]
    unsafe fn sum(self, count: usize) -> f64 {
        if count == 1 { self } else { 0.0 }
    }
}

/// The arithmetic of AVX2 in plain Rust: the same operations in the same order, fused where AVX2 fuses.
#[derive(Clone, Copy)]
pub(crate) struct Four([f64; 4]);

impl Four {
    #[inline(always)]
    fn with(self, o: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| of(self.0[i], o.0[i])))
    }
}

impl Lanes for Four {
    const N: usize = 4;
    #[inline(always)]
    unsafe fn splat(v: f64) -> Self {
        Self([v; 4])
    }
    #[inline(always)]
    unsafe fn add(self, o: Self) -> Self {
        self.with(o, |a, b| a + b)
    }
    #[inline(always)]
    unsafe fn sub(self, o: Self) -> Self {
        self.with(o, |a, b| a - b)
    }
    #[inline(always)]
    unsafe fn mul(self, o: Self) -> Self {
        self.with(o, |a, b| a * b)
    }
    #[inline(always)]
    unsafe fn div(self, o: Self) -> Self {
        self.with(o, |a, b| a / b)
    }
    #[inline(always)]
    unsafe fn min(self, o: Self) -> Self {
        self.with(o, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    unsafe fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    unsafe fn mul_add(self, b: Self, c: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].mul_add(b.0[i], c.0[i])))
    }
    #[inline(always)]
    unsafe fn neg_mul_add(self, b: Self, c: Self) -> Self {
        Self(std::array::from_fn(|i| (-self.0[i]).mul_add(b.0[i], c.0[i])))
    }
    #[inline(always)]
    unsafe fn gather(base: *const Padded, index: *const u32) -> [Self; 3] {
        // SAFETY: the caller vouches for both pointers.
        let nodes: [[f64; 3]; 4] =
            std::array::from_fn(|i| unsafe { (*base.add(*index.add(i) as usize)).xyz() });
        std::array::from_fn(|axis| Self(nodes.map(|x| x[axis])))
    }
    #[inline(always)]
    unsafe fn scatter_sub(base: *mut Padded, index: *const u32, v: [Self; 3], count: usize) {
        for lane in 0..count.min(4) {
            // SAFETY: the caller vouches for both pointers and for exclusive access.
            let node = unsafe { &mut *base.add(*index.add(lane) as usize) };
            for (axis, v) in v.iter().enumerate() {
                node.0[axis] -= v.0[lane];
            }
        }
    }
    #[inline(always)]
    unsafe fn sum(self, count: usize) -> f64 {
        ordered_sum(&self.0, count)
    }
}

/// Sum of the first `count` lanes, in lane order.
#[inline(always)]
fn ordered_sum(lanes: &[f64], count: usize) -> f64 {
    let mut sum = 0.0;
    let mut lane = 0;
    while lane < count {
        sum += lanes[lane];
        lane += 1;
    }
    sum
}

#[cfg(target_arch = "x86_64")]
pub(crate) mod x86 {
    use super::{Lanes, Padded, ordered_sum};
    use std::arch::x86_64::*;

    #[derive(Clone, Copy)]
    pub(crate) struct F64x8(__m512d);

    // SAFETY of the whole impl: the trait's contract gives AVX-512F; pointers as its methods say.
    // `Padded` is 32 bytes on a 32-byte boundary, so aligned 256-bit access is right.
    impl Lanes for F64x8 {
        const N: usize = 8;
        #[inline(always)]
        unsafe fn splat(v: f64) -> Self {
            unsafe { Self(_mm512_set1_pd(v)) }
        }
        #[inline(always)]
        unsafe fn add(self, o: Self) -> Self {
            unsafe { Self(_mm512_add_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn sub(self, o: Self) -> Self {
            unsafe { Self(_mm512_sub_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn mul(self, o: Self) -> Self {
            unsafe { Self(_mm512_mul_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn div(self, o: Self) -> Self {
            unsafe { Self(_mm512_div_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn min(self, o: Self) -> Self {
            unsafe { Self(_mm512_min_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn sqrt(self) -> Self {
            unsafe { Self(_mm512_sqrt_pd(self.0)) }
        }
        #[inline(always)]
        unsafe fn mul_add(self, b: Self, c: Self) -> Self {
            unsafe { Self(_mm512_fmadd_pd(self.0, b.0, c.0)) }
        }
        #[inline(always)]
        unsafe fn neg_mul_add(self, b: Self, c: Self) -> Self {
            unsafe { Self(_mm512_fnmadd_pd(self.0, b.0, c.0)) }
        }
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
        unsafe fn sum(self, count: usize) -> f64 {
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

    // SAFETY of the whole impl: the trait's contract gives AVX2 and FMA; the rest as above.
    impl Lanes for F64x4 {
        const N: usize = 4;
        #[inline(always)]
        unsafe fn splat(v: f64) -> Self {
            unsafe { Self(_mm256_set1_pd(v)) }
        }
        #[inline(always)]
        unsafe fn add(self, o: Self) -> Self {
            unsafe { Self(_mm256_add_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn sub(self, o: Self) -> Self {
            unsafe { Self(_mm256_sub_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn mul(self, o: Self) -> Self {
            unsafe { Self(_mm256_mul_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn div(self, o: Self) -> Self {
            unsafe { Self(_mm256_div_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn min(self, o: Self) -> Self {
            unsafe { Self(_mm256_min_pd(self.0, o.0)) }
        }
        #[inline(always)]
        unsafe fn sqrt(self) -> Self {
            unsafe { Self(_mm256_sqrt_pd(self.0)) }
        }
        #[inline(always)]
        unsafe fn mul_add(self, b: Self, c: Self) -> Self {
            unsafe { Self(_mm256_fmadd_pd(self.0, b.0, c.0)) }
        }
        #[inline(always)]
        unsafe fn neg_mul_add(self, b: Self, c: Self) -> Self {
            unsafe { Self(_mm256_fnmadd_pd(self.0, b.0, c.0)) }
        }
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
        unsafe fn sum(self, count: usize) -> f64 {
            let mut lanes = [0.0; 4];
            unsafe { _mm256_storeu_pd(lanes.as_mut_ptr(), self.0) };
            ordered_sum(&lanes, count)
        }
    }
}
