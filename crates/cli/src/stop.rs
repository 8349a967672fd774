//! Ctrl-C, SIGTERM and SIGHUP, in one place.
//!
//! A command that holds nothing half-done ends at the first. One that ends in order, as `run` does, is asked
//! to, and ended too where it has not heard within some seconds: what takes long before a run
//! rolls (meshes, preloads, the creation of its files) leaves nothing that a kill could damage.

#[cfg(unix)]
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use creepage::{Error, FailureResult, INTERRUPTED};
#[cfg(unix)]
use output::files::input;

use crate::report;
use crate::terminal;

/// How long a command has to hear that it is asked to end.
const PATIENCE: Duration = Duration::from_secs(5);

/// What the signals have asked for, and how the command takes it.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    asked: Arc<AtomicBool>,
    /// What a command that ends in order says when it is asked to; unset where it may end at once.
    in_order: Arc<OnceLock<&'static str>>,
    /// Whether it looks at `asked` often enough, and ends by itself however long that takes.
    hears: Arc<AtomicBool>,
    /// Whether standard output must hold a document.
    json: bool,
}

/// What a command that writes its results says when it is asked to end.
pub const WRITING: &str =
    "\nstopping: results so far are being written (Ctrl-C again ends at once)";

impl Stop {
    /// Listens to the signals from now on.
    pub fn listening(json: bool) -> Result<Self, Error> {
        let stop = Self { json, ..Self::default() };
        let heard = stop.clone();
        listen(move || heard.ask()).map_err(|error| {
            Error::System(format!("the handler of Ctrl-C cannot be set: {error}"))
        })?;
        Ok(stop)
    }

    /// From now on the command ends in order once this flag is set, and says `ending` when it is.
    pub fn in_order(&self, ending: &'static str) -> Arc<AtomicBool> {
        self.in_order.get_or_init(|| ending);
        Arc::clone(&self.asked)
    }

    /// From now on the command sees the flag within seconds.
    pub fn hears(&self) {
        self.hears.store(true, Ordering::SeqCst);
    }

    /// Asks the command to end; the second time, it is ended.
    pub fn ask(&self) {
        let Some(ending) = self.in_order.get() else { self.end() };
        if self.asked.swap(true, Ordering::SeqCst) {
            self.end();
        }
        terminal::message(ending);
        let this = self.clone();
        let waits = std::thread::Builder::new().spawn(move || {
            std::thread::sleep(PATIENCE);
            if !this.hears.load(Ordering::SeqCst) {
                terminal::message("stopped: there were no results to write yet");
                this.end();
            }
        });
        // where there is no thread to wait there is no order either
        if waits.is_err() {
            self.end();
        }
    }

    fn end(&self) -> ! {
        if self.json {
            report::print_json(&FailureResult::new("interrupted", INTERRUPTED, ""));
        }
        std::process::exit(INTERRUPTED.into());
    }
}

/// A process that assists another ends when that does, whatever signal asks both.
pub fn leave_to_the_first() -> Result<(), Error> {
    listen(|| ())
        .map_err(|error| Error::System(format!("the handler of Ctrl-C cannot be set: {error}")))
}

/// Calls `ask` at every signal that asks the program to end.
///
/// A signal that was ignored when the program started stays ignored: this is how `nohup`, `trap '' HUP` and a script's
/// `command &` protect what they start.
#[cfg(unix)]
fn listen(ask: impl Fn() + Send + 'static) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let ignored = ignored();
    let signals = [SIGHUP, SIGINT, SIGTERM].into_iter();
    let heeded = signals.filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut heard = signal_hook::iterator::Signals::new(heeded)?;
    let listener = std::thread::Builder::new().spawn(move || heard.forever().for_each(|_| ask()));
    listener.map(drop)
}

/// The signals that this process ignores, number n as bit n - 1; none where the system does not tell.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = input::text(Path::new("/proc/self/status"), input::LOG).unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(not(unix))]
fn listen(ask: impl FnMut() + Send + 'static) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(ask)
}
