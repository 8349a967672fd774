//! Vectors of elements: one type per instruction set, all with the trait [`Lanes`].
//!
//! The kernels are generic over [`Lanes`] and are instantiated once per level inside a function that enables the
//! level's instructions; nothing else in the workspace needs special compiler flags. The methods for vector
//! instructions are `#[inline(always)]` and free of closures: a call that is not inlined would lose the enabled
//! instructions and most of the speed.

use mesh::Padded;
use std::ops::{Add, Div, Mul, Sub};
use std::str::FromStr;

#[cfg(target_arch = "aarch64")]
pub(crate) mod neon;
#[cfg(target_arch = "x86_64")]
pub(crate) mod x86;

/// The instruction set of the kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// AVX-512F, 8 lanes.
    Avx512,
    /// AVX2 with FMA, 4 lanes.
    Avx2,
    /// NEON, of every aarch64 machine: two lanes, taken in pairs, with the bits of [`Level::Avx2`].
    Neon,
    /// Plain Rust with the bits of [`Level::Avx2`]; slow where the machine has no fused multiply-add.
    Fused,
    /// Plain Rust, one lane, no fused multiply-add; on any machine.
    Portable,
}

impl Level {
    /// All levels, the widest first.
    pub const ALL: [Self; 5] = [Self::Avx512, Self::Avx2, Self::Neon, Self::Fused, Self::Portable];

    /// The level whose bits every machine can give: [`Level::Avx2`] or [`Level::Neon`] where available, else
    /// [`Level::Fused`].
    pub fn pinned() -> Self {
        let vectors = [Self::Avx2, Self::Neon].into_iter().find(|level| level.available());
        vectors.unwrap_or(Self::Fused)
    }

    /// The level of this [`name`](Self::name), if there is one.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|level| level.name() == name)
    }

    /// A level available on this machine that gives the bits of this one, if there is one.
    pub fn with_the_same_bits(self) -> Option<Self> {
        match self {
            Self::Avx2 | Self::Neon | Self::Fused => Some(Self::pinned()),
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
        if cfg!(target_arch = "aarch64") { Self::Neon } else { Self::Portable }
    }

    /// Whether this machine can run this level.
    pub fn available(self) -> bool {
        match (Self::detect(), self) {
            (_, Self::Portable | Self::Fused) | (Self::Avx512, Self::Avx2) => true,
            (best, level) => best == level,
        }
    }

    /// `"avx512"`, `"avx2"`, `"neon"`, `"fused"` or `"portable"`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Neon => "neon",
            Self::Fused => "fused",
            Self::Portable => "portable",
        }
    }
}

impl FromStr for Level {
    type Err = &'static str;

    fn from_str(name: &str) -> Result<Self, Self::Err> {
        Self::named(name).ok_or("one of avx512, avx2, neon, fused, portable is needed")
    }
}

/// One number for each of `N` elements.
///
/// [`splat`](Self::splat) and [`gather`](Self::gather) may only run where the instructions of the type are available.
/// All values come from these two, so that a value proves that its arithmetic, which is safe, may run.
pub(crate) trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Div<Output = Self>
{
    /// Number of lanes; divides eight.
    const N: usize;

    /// # Safety
    /// The instructions of the type are available.
    unsafe fn splat(v: f64) -> Self;
    /// `v` in every lane; `self` proves that the instructions are available.
    #[inline(always)]
    fn like(self, v: f64) -> Self {
        // SAFETY: `self` exists.
        unsafe { Self::splat(v) }
    }
    fn min(self, o: Self) -> Self;
    fn sqrt(self) -> Self;
    /// `self * b + c`, fused.
    fn fma(self, b: Self, c: Self) -> Self;
    /// `c - self * b`, fused.
    fn fnma(self, b: Self, c: Self) -> Self;
    /// Sum of the first `count` lanes in lane order.
    fn sum(self, count: usize) -> f64;
    /// x, y and z of the nodes `index[0..N]`.
    ///
    /// # Safety
    /// The instructions of the type are available; `index` is readable for `N` entries and each is a valid index into
    /// `base`.
    unsafe fn gather(base: *const Padded, index: *const u32) -> [Self; 3];
    /// Subtracts the first `count` lanes from the nodes `index[0..count]`, in lane order, so that
    /// lanes may share nodes.
    ///
    /// # Safety
    /// As [`gather`](Self::gather), and nobody else accesses these nodes meanwhile.
    unsafe fn scatter_sub(base: *mut Padded, index: *const u32, v: [Self; 3], count: usize);
}

/// The operators of a type of lanes, each with its trait, its method and its value for `a` and `b`, and the product with
/// a number.
macro_rules! operators {
    ($lanes:ident: $($operator:ident $method:ident |$a:ident, $b:ident| $value:expr;)+) => {
        $(impl std::ops::$operator for $lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, b: Self) -> Self {
                let ($a, $b) = (self, b);
                $value
            }
        })+
        impl std::ops::Mul<f64> for $lanes {
            type Output = Self;
            #[inline(always)]
            fn mul(self, b: f64) -> Self {
                self * crate::lanes::Lanes::like(self, b)
            }
        }
    };
}
pub(crate) use operators;

impl Lanes for f64 {
    const N: usize = 1;
    #[inline(always)]
    unsafe fn splat(v: f64) -> Self {
        v
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        if self < o { self } else { o }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    /// Rounds twice: a fused multiply-add without hardware support would be a slow library call.
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        self * b + c
    }
    #[inline(always)]
    fn fnma(self, b: Self, c: Self) -> Self {
        c - self * b
    }
    #[inline(always)]
    fn sum(self, count: usize) -> f64 {
        if count == 1 { self } else { 0.0 }
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

operators! { Four:
    Add add |a, b| a.with(b, |a, b| a + b);
    Sub sub |a, b| a.with(b, |a, b| a - b);
    Mul mul |a, b| a.with(b, |a, b| a * b);
    Div div |a, b| a.with(b, |a, b| a / b);
}

impl Lanes for Four {
    const N: usize = 4;
    #[inline(always)]
    unsafe fn splat(v: f64) -> Self {
        Self([v; 4])
    }
    #[inline(always)]
    fn min(self, o: Self) -> Self {
        self.with(o, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn fma(self, b: Self, c: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].mul_add(b.0[i], c.0[i])))
    }
    #[inline(always)]
    fn fnma(self, b: Self, c: Self) -> Self {
        Self(std::array::from_fn(|i| (-self.0[i]).mul_add(b.0[i], c.0[i])))
    }
    #[inline(always)]
    fn sum(self, count: usize) -> f64 {
        ordered_sum(&self.0, count)
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
