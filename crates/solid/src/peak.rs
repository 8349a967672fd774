//! A loop of multiply-additions by which the peak of this machine's vector units is measured, for a roofline.

use crate::lanes::{Lanes, Level};

/// Independent chains of operations: enough to hide the latency of the instruction on two units, few enough for
/// sixteen registers.
const CHAINS: usize = 12;

/// Does at least `flops` floating-point operations on the calling thread, as multiply-additions (two operations each)
/// with the instructions of `level`; returns how many it did.
///
/// # Panics
/// If this machine cannot run the level.
pub fn multiply_additions(level: Level, flops: usize) -> usize {
    assert!(level.available());
    let (lanes, chains): (usize, unsafe fn(usize, f64) -> f64) = match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => (8, avx512),
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => (4, avx2),
        #[cfg(target_arch = "aarch64")]
        Level::Neon => (4, neon),
        Level::Fused => (4, fused),
        _ => (1, portable),
    };
    let rounds = flops.div_ceil(2 * CHAINS * lanes);
    // SAFETY: the machine has the level's instructions.
    std::hint::black_box(unsafe { chains(rounds, std::hint::black_box(1e-9)) });
    rounds * 2 * CHAINS * lanes
}

#[inline(always)]
unsafe fn run<L: Lanes>(rounds: usize, small: f64) -> f64 {
    // SAFETY: as the caller's.
    let one = unsafe { L::splat(1.0) };
    let (factor, term) = (one.like(1.0 - small), one.like(2.0 * small));
    let mut chains = [one; CHAINS];
    for _ in 0..rounds {
        for i in 0..CHAINS {
            chains[i] = chains[i].fma(factor, term);
        }
    }
    let mut total = chains[0];
    for i in 1..CHAINS {
        total = total + chains[i];
    }
    total.sum(L::N)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx2,fma")]
unsafe fn avx512(rounds: usize, small: f64) -> f64 {
    // SAFETY: the instructions are enabled here and available by the caller's contract.
    unsafe { run::<crate::lanes::x86::F64x8>(rounds, small) }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn avx2(rounds: usize, small: f64) -> f64 {
    // SAFETY: as above.
    unsafe { run::<crate::lanes::x86::F64x4>(rounds, small) }
}

#[cfg(target_arch = "aarch64")]
#[target_feature(enable = "neon")]
unsafe fn neon(rounds: usize, small: f64) -> f64 {
    // SAFETY: as above.
    unsafe { run::<crate::lanes::neon::F64x2x2>(rounds, small) }
}

unsafe fn fused(rounds: usize, small: f64) -> f64 {
    // SAFETY: plain Rust.
    unsafe { run::<crate::lanes::Four>(rounds, small) }
}

unsafe fn portable(rounds: usize, small: f64) -> f64 {
    // SAFETY: plain Rust.
    unsafe { run::<f64>(rounds, small) }
}
