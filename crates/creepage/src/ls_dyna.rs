//! LS-DYNA keyword files of a disk on a bar: read as a case and a mesh file ([`translate`]), and written of a case
//! ([`export()`]); and what results of any keyword file refer to ([`interface()`]).
//!
//! Which cards are read and written, and the keys of each: docs/ls-dyna.md. Any other card is refused with its
//! line, and what cards cannot say of a case is listed, so that no part of a model is lost without notice.

mod axes;
mod bodies;
mod cards;
mod case_file;
mod contact_card;
mod contact_surface;
mod control;
mod curve;
mod deck;
mod drive;
mod error;
mod export;
mod fields;
mod ignored;
mod interface;
mod loads;
mod model;
mod motion;
mod parameters;
mod plausible;
mod sets;
mod shape;
mod sources;
#[cfg(test)]
mod tests;
mod translate;
mod units;

pub use deck::Account;
pub use error::{DeckError, DeckLine, Fault};
pub use export::{Exported, RollingMotion, export, unsayable};
pub use interface::{Interface, interface};
pub use sources::Source;
pub use translate::{Translation, translate};
pub use units::Units;
