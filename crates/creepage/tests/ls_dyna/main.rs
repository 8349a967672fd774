//! LS-DYNA keyword files.
#![allow(clippy::unwrap_used)]

mod files;
mod ls_prepost;
mod unnoticed;
