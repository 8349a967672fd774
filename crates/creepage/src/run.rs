//! The run of a case: its folder, the time loop, records, checkpoints, summary.

mod bench;
mod checkpoint;
mod cost;
pub mod derived;
mod disk;
mod error;
mod execute;
pub mod folder;
mod held;
mod log;
mod means;
mod mesh_file;
mod mesh_mode;
mod mesh_report;
mod options;
mod postmortem;
mod probes;
mod processes;
pub mod progress_lines;
mod record;
pub mod resume;
mod summary;
#[cfg(test)]
mod tests;
mod text_file;

pub use bench::{
    BenchResult, BlockBench, BlockElement, ReferenceBench, bench, bench_block, reference,
};
pub use disk::DiskEstimate;
pub use error::RunError;
pub use execute::run;
pub use log::REFUSED;
pub use mesh_report::{BodyReport, Estimate, MeshReport, QualityReport, StableStep, mesh_report};
pub use options::RunOptions;
pub use processes::{Leader, SharedWork, assist};
pub use solid::Level;
