//! Commands held by Python.

use crate::law::PythonLaw;
use cli::{Embedded, Failure, Told};
use friction::OwnLaw;
use miette::MietteHandlerOpts;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use scenario::{Progress, Stage};
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, Once, PoisonError};
use std::time::Duration;

/// How often Ctrl-C is looked for.
const LOOK: Duration = Duration::from_millis(50);
/// Stack of the thread that does the work: that of a program's first (bytes).
const STACK: usize = 8 << 20;

/// What the thread that does the work says.
enum Event {
    Told(Told),
    Ended(Result<u8, Failure>),
}

/// Runs a command of the command line beside the interpreter, which stays free for other threads.
///
/// `words` are its words after the program's name; `case` the text of the case where it is not in a file; `law`
/// the friction law; `program` what does the runs of a sweep; `listen(kind, what)` hears how far it is
/// ("run", "sweep": a dict) and remarks ("said": a str).
///
/// Returns a dict: `code` (the exit code), `document` (what `--json` prints, as text), `folder` (of a run),
/// `interrupted` (by Ctrl-C), and, where it failed, `error`, `text` (the error as it is shown) and `help`.
#[pyfunction]
#[pyo3(signature = (words, *, case=None, law=None, program=Vec::new(), listen=None))]
pub fn command<'py>(
    py: Python<'py>,
    words: Vec<OsString>,
    case: Option<String>,
    law: Option<Py<PyAny>>,
    program: Vec<OsString>,
    listen: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    plain_reports();
    let law = law.map(|law| PythonLaw::new(py, law)).transpose()?.map(Arc::new);
    let stop = Arc::new(AtomicBool::new(false));
    let (sender, events) = channel();
    let told = sender.clone();
    let embedded = Embedded {
        case,
        law: law.clone().map(|law| law as Arc<dyn OwnLaw>),
        stop: Arc::clone(&stop),
        program,
        // nobody listens any more only after the end
        tell: Arc::new(move |what| drop(told.send(Event::Told(what)))),
    };
    let words = std::iter::once("creepage".into()).chain(words).collect::<Vec<OsString>>();
    let worker = std::thread::Builder::new().stack_size(STACK).spawn(move || {
        let ended = cli::command(words, embedded);
        drop(sender.send(Event::Ended(ended)));
    })?;
    let events = Mutex::new(events);
    let (mut raised, mut document, mut folder) = (None, None, None);
    let ended = loop {
        let outcome = match py.detach(|| next(&events)) {
            Ok(Event::Ended(ended)) => break ended,
            Ok(Event::Told(Told::Document(value))) => {
                document = Some(value.to_string());
                Ok(())
            }
            Ok(Event::Told(Told::Folder(path))) => {
                folder = Some(path);
                Ok(())
            }
            Ok(Event::Told(told)) => listen.as_ref().map_or(Ok(()), |listen| hear(listen, &told)),
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
    if let Some(error) = law.and_then(|law| law.take_failure()) {
        return Err(error);
    }
    let interrupted = match raised {
        Some(error) if !error.is_instance_of::<PyKeyboardInterrupt>(py) => return Err(error),
        raised => raised.is_some(),
    };
    answer(py, ended, document, folder, interrupted)
}

fn next(events: &Mutex<Receiver<Event>>) -> Result<Event, RecvTimeoutError> {
    events.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK)
}

/// What a command came to, as a dict.
fn answer<'py>(
    py: Python<'py>,
    ended: Result<u8, Failure>,
    document: Option<String>,
    folder: Option<PathBuf>,
    interrupted: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let answer = PyDict::new(py);
    answer.set_item("document", document)?;
    answer.set_item("folder", folder)?;
    answer.set_item("interrupted", interrupted)?;
    match ended {
        Ok(code) => answer.set_item("code", code)?,
        Err(failure) => {
            let help = failure.report.help().map(|help| help.to_string());
            answer.set_item("code", failure.code)?;
            answer.set_item("error", failure.report.to_string())?;
            answer.set_item("text", format!("{:?}", failure.report))?;
            answer.set_item("help", help)?;
        }
    }
    Ok(answer)
}

/// Tells how far a command is.
fn hear(listen: &Bound<'_, PyAny>, told: &Told) -> PyResult<()> {
    let what = PyDict::new(listen.py());
    let kind = match told {
        Told::Run(progress) => {
            describe(progress, &what)?;
            "run"
        }
        Told::Sweep(now) => {
            what.set_item("runs", now.runs)?;
            what.set_item("completed", now.completed)?;
            what.set_item("failed", now.failed)?;
            what.set_item("running", now.running)?;
            what.set_item("fraction", now.fraction)?;
            "sweep"
        }
        Told::Said(line) => return listen.call1(("said", line)).map(drop),
        Told::Folder(_) | Told::Document(_) => return Ok(()),
    };
    listen.call1((kind, what)).map(drop)
}

fn describe(progress: &Progress, what: &Bound<'_, PyDict>) -> PyResult<()> {
    let stage = match progress.stage {
        Stage::Mesh => "mesh",
        Stage::Preload => "preload",
        Stage::Roll => "roll",
    };
    what.set_item("stage", stage)?;
    what.set_item("step", progress.step)?;
    what.set_item("steps", progress.steps)?;
    what.set_item("time", progress.time)?;
    what.set_item("end_time", progress.end_time)?;
    what.set_item("normal_force", progress.normal_force)?;
    what.set_item("tangential_force", progress.tangential_force)?;
    what.set_item("element_steps_per_s", progress.element_steps_per_s)
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

/// Runs the command line for the terminal; `words` begin with the program's name, `program` does the runs of a
/// sweep. Returns the exit code.
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<OsString>, program: Vec<OsString>) -> u8 {
    py.detach(|| cli::main(words, program))
}

/// JSON text as TOML text.
#[pyfunction]
pub fn toml(json: &str) -> PyResult<String> {
    let value: serde_json::Value = serde_json::from_str(json).map_err(|error| wrong(&error))?;
    ::toml::to_string(&value).map_err(|error| wrong(&error))
}

/// TOML text as JSON text.
#[pyfunction]
pub fn from_toml(toml: &str) -> PyResult<String> {
    let value: serde_json::Value = ::toml::from_str(toml).map_err(|error| wrong(&error))?;
    Ok(value.to_string())
}

fn wrong(error: &dyn std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}
