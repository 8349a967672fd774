//! Speed of the element kernel and of a whole step on this machine, against its bandwidth.

use std::sync::atomic::AtomicBool;
use std::time::Instant;

use crate::hertz::hertz;
use crate::model::Model;
use crate::run_error::RunError;
use crate::schema::{Case, PreloadMethod};
use crate::start::start;
use mesh::Padded;
use rayon::prelude::*;
use serde_json::json;
use solid::Level;

/// Steps or kernel calls per sample, and samples, of which the median counts.
const REPEATS: usize = 40;
const SAMPLES: usize = 7;

/// The reference case at 1 mm, without stress output.
const REFERENCE: &str = "
[load]
normal = 1e5
[drive]
speed = 38.89
creepage = 2.4e-3
[friction]
static = 0.5
[preload]
method = \"none\"
";

/// Measures kernel, whole step and memory bandwidth with the given number of threads, on the
/// reference disk and bar at 1 mm, with the given kernels (by default the machine's best).
pub fn bench(threads: usize, kernels: Option<Level>) -> Result<serde_json::Value, RunError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    pool.install(|| measure(threads, kernels.unwrap_or_else(Level::detect)))
}

fn measure(threads: usize, kernels: Level) -> Result<serde_json::Value, RunError> {
    let mut case = Case::from_text(REFERENCE, std::path::Path::new("reference.toml"), &[])?;
    debug_assert_eq!(case.preload.method, PreloadMethod::None);
    // Pressed rigidly by Hertz's approach, contact is as busy as after a preload.
    case.disk.lift = -hertz(&case).approach;
    let mut model = Model::build(&case)?;
    model.kernels = kernels;
    let elements = model.mesh.hexes.len() as f64;
    let nodes = model.mesh.nodes.len();
    let bandwidth = triad();

    let mut solid = model.solid(&case)?;
    let u = vec![Padded::ZERO; nodes];
    let mut force = u.clone();
    let kernel = median(|| {
        (0..REPEATS).for_each(|_| {
            solid.subtract_internal_force(&u, &u, &mut force, false);
        });
    });
    let mut begun =
        start(&case, &model, None, &AtomicBool::new(false), &mut |_| {}, &mut |_| Ok(()))?;
    let simulation = &mut begun.simulation;
    let mut contact = 0.0;
    let step = median(|| {
        let before = simulation.timers().contact;
        (0..REPEATS).for_each(|n| {
            simulation.step(n % 10 == 0);
        });
        contact = (simulation.timers().contact - before).as_secs_f64() / REPEATS as f64;
    });
    // What a step must move at least once: connectivity and reference of the elements; of the
    // nodes displacement, velocity and force read and written, inverse mass read.
    let bytes =
        (solid.bytes() as f64 + nodes as f64 * (6.0 * size_of::<Padded>() as f64 + 8.0)) / elements;
    let per = |seconds: f64| seconds / REPEATS as f64 / elements * 1e9;
    let roofline = bytes / bandwidth; // ns: bytes over GB/s
    Ok(json!({
        "threads": threads,
        "kernels": kernels.name(),
        "elements": elements as u64,
        "bandwidth_gb_s": bandwidth,
        "kernel_ns_per_element": per(kernel),
        "step_ns_per_element": per(step),
        "contact_fraction": contact * REPEATS as f64 / step,
        "bytes_per_element": bytes,
        "roofline_fraction": roofline / per(step),
    }))
}

/// Median wall time of `work` (s).
fn median(mut work: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..SAMPLES)
        .map(|_| {
            let clock = Instant::now();
            work();
            clock.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[SAMPLES / 2]
}

/// STREAM triad a = b + s c over arrays far larger than the caches (GB/s).
fn triad() -> f64 {
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
