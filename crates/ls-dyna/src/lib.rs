//! LS-DYNA keyword files of a disk on a bar, as a case and a mesh file.
//!
//! Which cards are read, and what becomes of each: docs/ls-dyna.md. Any other card is refused with its
//! line, so that no part of a model is lost without notice.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod cards;
mod case_file;
mod deck;
mod model;
mod shape;
#[cfg(test)]
mod tests;
mod translate;
mod units;

pub use translate::{Translation, translate};
pub use units::Units;
