//! When the observer of a run hears how far it is.

use std::time::{Duration, Instant};

use crate::scenario::progress::Progress;

/// Steps between two calls, at most.
const STEPS: u64 = 64;

/// Wall time after which a long step makes a call due.
const LONG: Duration = Duration::from_secs(1);

/// The observer of a time loop.
pub(super) struct Observer<'a> {
    observe: &'a mut (dyn FnMut(&Progress) + Send),
    last: Instant,
}

impl<'a> Observer<'a> {
    pub(super) fn new(observe: &'a mut (dyn FnMut(&Progress) + Send)) -> Self {
        Self { observe, last: Instant::now() }
    }

    /// Tells the observer after step `n` how far the run is, if that is due.
    pub(super) fn after_step(&mut self, n: u64, progress: impl FnOnce() -> Progress) {
        if n.is_multiple_of(STEPS) || self.last.elapsed() > LONG {
            self.last = Instant::now();
            (self.observe)(&progress());
        }
    }
}
