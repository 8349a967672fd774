//! A function of the library held by Python: it works beside the interpreter, which stays free for other threads.

use creepage::{Error, Listener, Progress, Watched};
use miette::{MietteHandlerOpts, Report};
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;
use serde::de::DeserializeOwned;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, Once, PoisonError};
use std::time::Duration;

/// How often Ctrl-C is looked for.
const LOOK: Duration = Duration::from_millis(50);
/// Stack of the thread that does the work: that of a program's first (bytes).
const STACK: usize = 8 << 20;

/// What a function came to.
pub struct Answer {
    /// Exit code of the command line.
    pub code: u8,
    /// Its results, as JSON text.
    document: String,
}

impl Answer {
    /// Results with the exit code of the command line.
    pub fn new(code: u8, results: &impl Serialize) -> Self {
        Self { code, document: json(results) }
    }
}

/// As JSON text; only a key that is no text could prevent that, and no result has one.
pub fn json(results: &(impl Serialize + ?Sized)) -> String {
    serde_json::to_string(results).unwrap_or_default()
}

/// What the thread that does the work says.
enum Event {
    Folder(PathBuf),
    /// What of, and as JSON text.
    Told(&'static str, String),
    Ended(Result<Answer, Error>),
}

/// Hands what it hears to the thread that holds the interpreter; nobody listens any more only after the end.
struct EventSender {
    stop: Arc<AtomicBool>,
    events: Sender<Event>,
}

impl Listener for EventSender {
    fn stop(&mut self) -> Arc<AtomicBool> {
        Arc::clone(&self.stop)
    }

    fn remark(&mut self, line: &str) {
        let _ = self.events.send(Event::Told("said", json(line)));
    }

    fn folder(&mut self, folder: &Path) {
        let _ = self.events.send(Event::Folder(folder.to_owned()));
    }

    fn run(&mut self, progress: &Progress) {
        let _ = self.events.send(Event::Told("run", json(progress)));
    }

    fn sweep(&mut self, _name: &str, now: &Watched) {
        let _ = self.events.send(Event::Told("sweep", json(now)));
    }
}

/// Does `work` with its options, and returns what it came to as a dict (see [`crate::commands`]).
pub fn held<'py, O: DeserializeOwned + Send + 'static>(
    options: &str,
    listen: &Bound<'py, PyAny>,
    work: impl FnOnce(O, &mut dyn Listener) -> Result<Answer, Error> + Send + 'static,
) -> PyResult<Bound<'py, PyDict>> {
    plain_reports();
    let py = listen.py();
    let options = match toml::from_str(options) {
        Ok(read) => read,
        Err(error) => return answer(py, Err(refused(options, &error)), None, false),
    };
    let stop = Arc::new(AtomicBool::new(false));
    let (sender, events) = channel();
    let mut listener = EventSender { stop: Arc::clone(&stop), events: sender.clone() };
    let worker = std::thread::Builder::new().stack_size(STACK).spawn(move || {
        drop(sender.send(Event::Ended(work(options, &mut listener))));
    })?;
    let events = Mutex::new(events);
    let (mut raised, mut folder) = (None, None);
    let ended = loop {
        let outcome = match py.detach(|| next(&events)) {
            Ok(Event::Ended(ended)) => break ended,
            Ok(Event::Folder(path)) => {
                folder = Some(path);
                Ok(())
            }
            Ok(Event::Told(kind, what)) => listen.call1((kind, what)).map(drop),
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => {
                drop(worker.join());
                let text = "a command ended in a defect of the program; its message is above";
                return Err(PyRuntimeError::new_err(text));
            }
        };
        if let Err(error) = outcome.and_then(|()| py.check_signals()) {
            stop.store(true, Ordering::SeqCst);
            raised.get_or_insert(error);
        }
    };
    // it has nothing left to do but to end
    py.detach(|| drop(worker.join()));
    let interrupted = match raised {
        Some(error) if !error.is_instance_of::<PyKeyboardInterrupt>(py) => return Err(error),
        raised => raised.is_some(),
    };
    answer(py, ended, folder, interrupted)
}

/// Options that cannot be read, by the line of the option.
fn refused(options: &str, error: &toml::de::Error) -> Error {
    let at = error.span().map_or(0, |span| span.start.min(options.len()));
    let line = options[..at].matches('\n').count();
    let option = options.lines().nth(line).unwrap_or_default();
    Error::Option { problem: format!("{option}: {}", error.message()), help: None }
}

fn next(events: &Mutex<Receiver<Event>>) -> Result<Event, RecvTimeoutError> {
    events.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK)
}

/// What a function came to, as a dict.
fn answer<'py>(
    py: Python<'py>,
    ended: Result<Answer, Error>,
    folder: Option<PathBuf>,
    interrupted: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let answer = PyDict::new(py);
    answer.set_item("folder", folder)?;
    answer.set_item("interrupted", interrupted)?;
    match ended {
        Ok(Answer { code, document }) => {
            answer.set_item("code", code)?;
            answer.set_item("document", document)?;
        }
        Err(error) => {
            answer.set_item("code", error.exit_code())?;
            let report = Report::new(error);
            answer.set_item("error", report.to_string())?;
            answer.set_item("text", format!("{report:?}"))?;
            answer.set_item("help", report.help().map(|help| help.to_string()))?;
        }
    }
    Ok(answer)
}

/// Reports as the command line prints them, without colours and links.
fn plain_reports() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // a hook that is there already only draws them otherwise
        let _ = miette::set_hook(Box::new(|_| {
            let look = MietteHandlerOpts::new().wrap_lines(false).context_lines(1);
            Box::new(look.color(false).unicode(true).terminal_links(false).build())
        }));
    });
}
