//! Speed of the element kernel and of a whole step on this machine, against what its memory and its
//! arithmetic allow.

mod block;
mod machine;

use std::sync::atomic::AtomicBool;
use std::time::Instant;

pub use block::{BlockBench, BlockElement, bench_block};

use crate::case::CaseError;
use crate::case::hertz::hertz;
use crate::case::schema::{Case, PreloadMethod};
use crate::run::error::RunError;
use crate::scenario::start;
use mesh::Padded;
use serde::Serialize;
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

/// What was measured.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(untagged)]
pub enum BenchResult {
    /// On the reference disk and bar.
    Reference(ReferenceBench),
    /// On a free block.
    Block(BlockBench),
}

/// Speed on the reference disk and bar, and what this machine allows.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct ReferenceBench {
    /// Threads used.
    pub threads: usize,
    /// The instructions that the kernels used.
    pub kernels: &'static str,
    /// Number of elements.
    pub elements: u64,
    /// Bandwidth of the memory, by the triad of STREAM (GB/s).
    pub bandwidth_gb_s: f64,
    /// Multiply-additions in registers (GFLOP/s).
    pub peak_gflop_s: f64,
    /// Internal force alone (ns).
    pub kernel_ns_per_element: f64,
    /// Whole step (ns).
    pub step_ns_per_element: f64,
    /// Share of the step that the internal force takes.
    pub internal_force_fraction: f64,
    /// The same of contact.
    pub contact_fraction: f64,
    /// The same of quiet ends and given forces.
    pub boundary_fraction: f64,
    /// The same of nodes and hub.
    pub nodes_fraction: f64,
    /// What a step must move (B).
    pub bytes_per_element: f64,
    /// What it must compute (flop).
    pub flops_per_element: f64,
    /// The least time that both allow (ns).
    pub roofline_ns_per_element: f64,
    /// That over the time of the step.
    pub roofline_fraction: f64,
    /// Memory of the time loop (B).
    pub time_loop_bytes_per_element: f64,
}

/// The reference case with `sets` laid over it, `KEY=VALUE` as on the command line.
///
/// # Errors
/// Keys that make no case.
pub fn reference(sets: &[String]) -> Result<Case, CaseError> {
    Case::from_text(REFERENCE, std::path::Path::new("reference.toml"), sets)
}

/// Measures the element kernel, a whole step, and the machine's bandwidth and arithmetic, on the reference disk and
/// bar at 1 mm, with so many `threads` and these `kernels` (by default the machine's best). `case` is the
/// [reference case](reference()), or that with other keys.
///
/// # Errors
/// A mesh that cannot be made or that this machine has no memory for; kernels that it cannot
/// run; threads that cannot be started.
pub fn bench(
    threads: usize,
    kernels: Option<Level>,
    case: &Case,
) -> Result<ReferenceBench, RunError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    pool.install(|| measure(threads, kernels.unwrap_or_else(Level::detect), case))
}

fn measure(threads: usize, kernels: Level, case: &Case) -> Result<ReferenceBench, RunError> {
    let mut case = case.clone();
    // With the undeformed disk lowered by Hertz's approach about as many nodes touch as after a preload.
    if case.preload.method == PreloadMethod::None {
        case.disk.lift = -hertz(&case).approach;
    }
    let mut model = crate::scenario::model(&case)?;
    model.kernels = kernels;
    let elements = model.mesh.hexes.len() as f64;
    let nodes = model.mesh.nodes.len();
    // refuses kernels that this machine cannot run, before any of them does
    let mut solid = model.solid(&case)?;
    let (bandwidth, peak) = (machine::triad(), machine::peak(kernels, threads));

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
    let mut stages = [0.0; 4];
    let step = median(|| {
        let before = *simulation.timers();
        (0..REPEATS).for_each(|n| {
            simulation.step(n % 10 == 0);
        });
        let after = simulation.timers();
        stages = [
            after.internal_force - before.internal_force,
            after.contact - before.contact,
            after.boundary - before.boundary,
            after.nodes - before.nodes,
        ]
        .map(|stage| stage.as_secs_f64());
    });
    // What a step must move at least once: connectivity and reference of the elements; of the
    // nodes displacement, velocity and force read and written, inverse mass read.
    let bytes =
        (solid.bytes() as f64 + nodes as f64 * (6.0 * size_of::<Padded>() as f64 + 8.0)) / elements;
    // And compute: its elements, and of each node v += dt/m f, u += dt v.
    let flops = (solid.flops() as f64 + 12.0 * nodes as f64) / elements;
    let per = |seconds: f64| seconds / REPEATS as f64 / elements * 1e9;
    // ns: bytes over GB/s, flops over GFLOP/s
    let roofline = (bytes / bandwidth).max(flops / peak);
    let [internal, contact, boundary, moved] = stages;
    let total = internal + contact + boundary + moved;
    Ok(ReferenceBench {
        threads,
        kernels: kernels.name(),
        elements: elements as u64,
        bandwidth_gb_s: bandwidth,
        peak_gflop_s: peak,
        kernel_ns_per_element: per(kernel),
        step_ns_per_element: per(step),
        internal_force_fraction: internal / total,
        contact_fraction: contact / total,
        boundary_fraction: boundary / total,
        nodes_fraction: moved / total,
        bytes_per_element: bytes,
        flops_per_element: flops,
        roofline_ns_per_element: roofline,
        roofline_fraction: roofline / per(step),
        time_loop_bytes_per_element: simulation.bytes() as f64 / elements,
    })
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
