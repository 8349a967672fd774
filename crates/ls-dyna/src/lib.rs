//! LS-DYNA keyword files of a disk on a bar, as a case and a mesh file.
//!
//! Cards that are read, and what becomes of each: docs/ls-dyna.md. Everything else is refused by its
//! line, so that nothing of a model is lost unseen.

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
