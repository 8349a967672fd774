//! Which files the program reads, and which it may write over.
//!
//! Every path that a person gives passes through here. An [`input`] is a regular file of a bounded
//! size: a pipe would be waited for, a device read for ever. An [`output`] never replaces an input,
//! nor a file that this program did not write. A message shows one line of a file at most, [`printable`].

pub mod input;
pub mod output;
mod printable;

pub use input::{InputError, Kind};
pub use output::{Made, OutputRefused};
pub use printable::{Line, line_of, printable};
