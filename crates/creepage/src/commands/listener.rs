//! What a command tells while it works.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::scenario::Progress;
use crate::sweep::Watched;

/// Hears a command while it works, and may end it. Nothing has to be heard: `&mut ()` is a listener. A run tells it from a
/// thread of its own.
pub trait Listener: Send {
    /// The flag that, once it is set, ends the command in order: what was computed until then is written.
    fn stop(&mut self) -> Arc<AtomicBool> {
        Arc::default()
    }

    /// A warning about the case (`warning: ...`), or a remark.
    fn remark(&mut self, _line: &str) {}

    /// The folder of the run that begins.
    fn folder(&mut self, _folder: &Path) {}

    /// How far a run is.
    fn run(&mut self, _progress: &Progress) {}

    /// How far a sweep is.
    fn sweep(&mut self, _name: &str, _now: &Watched) {}

    /// How far the slider is.
    fn slider(&mut self, _step: u64, _steps: u64) {}
}

impl Listener for () {}
