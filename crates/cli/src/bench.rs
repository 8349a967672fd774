//! `creepage bench`.

use std::path::Path;

use ::run::{BlockElement, Level};

use crate::args::Args;
use crate::case_file::placed;
use crate::failure::Failure;
use crate::report;
use crate::threads::{all_cores, threads};

/// Options of `bench`.
#[derive(Debug, clap::Args)]
pub struct BenchArgs {
    /// Number of threads [default: one per core]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub threads: Option<usize>,
    /// Instruction set of the element kernels [default: the best of this machine]
    #[arg(long, value_name = "avx512|avx2|fused|portable", value_parser = kernels)]
    pub kernels: Option<Level>,
    /// Set a key of the reference case, for example mesh.zone.size=2e-3; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
    /// Instead of the reference case, a free block of N x N x N elements
    #[arg(long, value_name = "N", value_parser = edge, conflicts_with = "sets")]
    pub block: Option<usize>,
    /// Elements of the block
    #[arg(long, value_name = "one-point|full", value_parser = element, requires = "block",
        default_value = "one-point")]
    pub element: BlockElement,
}

fn edge(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n @ 1..=400) => Ok(n),
        _ => Err("a whole number from 1 to 400 is needed".into()),
    }
}

fn element(text: &str) -> Result<BlockElement, String> {
    [BlockElement::OnePoint, BlockElement::Full]
        .into_iter()
        .find(|element| element.name() == text)
        .ok_or_else(|| "one of one-point, full is needed".into())
}

fn kernels(text: &str) -> Result<Level, String> {
    match Level::named(text) {
        Some(level) if level.available() => Ok(level),
        Some(_) => Err("this machine does not have these instructions".into()),
        None => Err("one of avx512, avx2, fused, portable is needed".into()),
    }
}

/// Measures this machine.
pub fn command(args: &Args, options: &BenchArgs) -> Result<u8, Failure> {
    let threads = options.threads.unwrap_or_else(all_cores);
    let found = match options.block {
        Some(n) => ::run::bench_block(n, options.element, threads, options.kernels)?,
        None => ::run::bench(threads, options.kernels, &options.sets)
            .map_err(|error| placed(error, args, Path::new("reference.toml"), &options.sets))?,
    };
    if args.json {
        args.print_json(&found);
    } else if !args.quiet {
        report::print_bench(&found);
    }
    Ok(0)
}
