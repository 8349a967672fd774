//! Which files the program reads, and which it may write over.
//!
//! Every path that a user names passes through here. An [`input`] is a regular file of bounded size: opening
//! a pipe would wait for its writer, and reading a device might never end. An [`made`] never replaces an
//! input, nor a file that this program did not write. A message quotes at most one line of a file, without
//! control characters ([`line_of`], [`printable`]).

pub mod input;
pub mod made;
mod printable;

pub use input::{InputError, Kind};
pub use made::{Made, OutputRefused};
pub use printable::{Line, line_of, printable};
