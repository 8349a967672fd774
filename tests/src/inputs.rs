//! Every kind of input that comes from outside, as a function over bytes that reads it as the program
//! does and stops where a computation would begin.
//!
//! Whatever the bytes, such a function returns: it does not panic, and takes at most [`LIMIT`] and
//! [`LIMIT_MIB`] of memory. The fuzzers of the folder `fuzz/` look for bytes that
//! break this; what they ever found, and their corpus, is replayed by the tests of this crate.

mod hdf5;
mod keywords;
mod mesh;
mod text;

use std::time::Duration;

/// Time that an input may take.
pub const LIMIT: Duration = Duration::from_secs(5);

/// Memory that an input may take (MiB).
pub const LIMIT_MIB: usize = 512;

/// A kind of input.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name: of its fuzzer and of the folders of its corpus and its found cases.
    pub name: &'static str,
    /// Reads bytes as such an input.
    pub read: fn(&[u8]),
}

/// All kinds.
pub const TARGETS: [Target; 10] = [
    Target { name: "case", read: text::case },
    Target { name: "sweep", read: text::sweep },
    Target { name: "formula", read: text::formula },
    Target { name: "table", read: text::table },
    Target { name: "import", read: text::import },
    Target { name: "mesh", read: mesh::mesh },
    Target { name: "keywords", read: keywords::keywords },
    Target { name: "grid", read: hdf5::grid },
    Target { name: "history", read: hdf5::history },
    Target { name: "checkpoint", read: hdf5::checkpoint },
];

/// Reads bytes as the kind of that name; nothing where there is none.
pub fn read(name: &str, data: &[u8]) {
    if let Some(target) = TARGETS.iter().find(|target| target.name == name) {
        (target.read)(data);
    }
}
