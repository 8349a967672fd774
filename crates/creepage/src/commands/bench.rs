//! How fast this machine computes.

use crate::Error;
#[cfg(feature = "clap")]
use crate::commands::values::words::kernels;
use crate::commands::values::{EDGE, KERNELS, ONE_PER_CORE, maybe_parsed, parsed};
use crate::rule::{THREADS, all_cores};
use crate::run::{BenchResult, BlockElement, Level};
use serde::Deserialize;

/// What to measure.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct BenchOptions {
    /// Number of threads, at most one per core [default: one per core]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = |n: &str| THREADS.read(n)))]
    pub threads: Option<usize>,
    /// Instruction set of the element kernels [default: the best of this machine]
    #[serde(deserialize_with = "maybe_parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "avx512|avx2|neon|fused|portable",
        value_parser = kernels))]
    pub kernels: Option<Level>,
    /// Set a key of the reference case, for example mesh.zone.size=2e-3; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "set", value_name = "KEY=VALUE"))]
    pub sets: Vec<String>,
    /// Instead of the reference case, a free block of N x N x N elements
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", conflicts_with = "sets",
        value_parser = |n: &str| EDGE.read(n)))]
    pub block: Option<usize>,
    /// Elements of the block
    #[serde(deserialize_with = "parsed")]
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "one-point|full", requires = "block", default_value = "one-point")
    )]
    pub element: BlockElement,
}

/// Measures the element kernel and the whole step on this machine, beside what its memory and arithmetic allow.
///
/// # Errors
/// A key of the reference case that cannot be used; kernels that this machine cannot run.
pub fn bench(options: &BenchOptions) -> Result<BenchResult, Error> {
    THREADS.check("--threads", options.threads.as_ref())?;
    ONE_PER_CORE.check("--threads", options.threads.as_ref())?;
    EDGE.check("--block", options.block.as_ref())?;
    KERNELS.check("--kernels", options.kernels.as_ref())?;
    let threads = options.threads.unwrap_or_else(all_cores);
    if let Some(n) = options.block {
        let found = crate::run::bench_block(n, options.element, threads, options.kernels)?;
        return Ok(BenchResult::Block(found));
    }
    let case = crate::run::reference(&options.sets)?;
    let found = crate::run::bench(threads, options.kernels, &case);
    found.map(BenchResult::Reference).map_err(|error| case.placed(error))
}
