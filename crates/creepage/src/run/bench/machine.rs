//! The most that the machine can do: memory bandwidth and arithmetic.

use super::median;
use rayon::prelude::*;
use solid::Level;

/// STREAM triad a = b + s c over arrays far larger than the caches (GB/s).
pub(super) fn triad() -> f64 {
    const N: usize = 1 << 24;
    const CHUNK: usize = 1 << 16;
    let (b, c) = (vec![1.0f64; N], vec![2.0f64; N]);
    let mut a = vec![0.0f64; N];
    let seconds = median(|| {
        a.par_chunks_mut(CHUNK).zip(b.par_chunks(CHUNK)).zip(c.par_chunks(CHUNK)).for_each(
            |((a, b), c)| {
                a.iter_mut().zip(b).zip(c).for_each(|((a, b), c)| *a = b + 0.5 * c);
            },
        );
    });
    // Three streams; the read for ownership of the written one is not counted, as is the custom.
    assert!(a[N - 1] == 2.0);
    24.0 * N as f64 / seconds / 1e9
}

/// Multiply-additions in registers by the instructions of `level`, all threads (GFLOP/s).
pub(super) fn peak(level: Level, threads: usize) -> f64 {
    const FLOPS: usize = 1 << 28;
    let mut done = 0;
    let seconds = median(|| {
        done = (0..threads)
            .into_par_iter()
            .with_max_len(1)
            .map(|_| solid::multiply_additions(level, FLOPS))
            .sum();
    });
    done as f64 / seconds / 1e9
}
