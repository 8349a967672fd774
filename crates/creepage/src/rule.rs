//! What the value of an option must be.

use thiserror::Error;

/// What a value must be.
pub struct Rule<T> {
    pub(crate) holds: fn(&T) -> bool,
    pub(crate) wanted: &'static str,
}

/// An option with a value that is not as it must be.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{option}: {wanted}")]
pub struct NotAsWanted {
    option: &'static str,
    wanted: &'static str,
}

/// Threads, or runs at a time.
pub const THREADS: Rule<usize> =
    Rule { holds: |n| (1..=1024).contains(n), wanted: "a whole number from 1 to 1024 is needed" };

/// Processes that share a run.
pub const RANKS: Rule<usize> =
    Rule { holds: |n| (2..=65536).contains(n), wanted: "a whole number from 2 to 65536 is needed" };

/// As many threads as there are cores.
pub fn all_cores() -> usize {
    std::thread::available_parallelism().map_or(1, |n| n.get())
}

impl<T> Rule<T> {
    /// The value of an option, where it is as it must be.
    pub fn check(&self, option: &'static str, value: Option<&T>) -> Result<(), NotAsWanted> {
        match value {
            Some(value) if !(self.holds)(value) => Err(NotAsWanted { option, wanted: self.wanted }),
            _ => Ok(()),
        }
    }
}

#[cfg(feature = "clap")]
impl<T: std::str::FromStr> Rule<T> {
    /// Reads a value.
    pub fn read(&self, text: &str) -> Result<T, &'static str> {
        text.parse().ok().filter(self.holds).ok_or(self.wanted)
    }
}
