//! Files with planted content: checks, figures and verdicts find what was planted.
#![allow(clippy::unwrap_used, missing_docs)]

mod contact_maps;
mod half_space;
mod law_followed;
mod planted;
mod runs;
mod sweeps;
