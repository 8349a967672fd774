//! Why a command did not come to its end.

use crate::case::CaseError;
use crate::check::{ImportError, PostError};
use crate::ls_dyna::DeckError;
use crate::rule::NotAsWanted;
use crate::run::RunError;
use crate::sweep::SweepError;
use miette::Diagnostic;
use output::OutputError;
use serde::Serialize;
use slider::BlowUp;
use thiserror::Error;

use crate::commands::slider::SettingError;

/// Exit code: a check, a run of a sweep or a verification problem failed.
pub const FAILED: u8 = 1;
/// Exit code: bad input.
pub const BAD_INPUT: u8 = 2;
/// Exit code: stopped by the run's own guards.
pub const STOPPED_BY_GUARD: u8 = 3;
/// Exit code: interrupted.
pub const INTERRUPTED: u8 = 130;

/// The document of a command that failed: with `--json`, standard output holds one document whatever happens.
#[derive(Clone, Debug, Serialize)]
pub struct FailureResult {
    status: &'static str,
    exit_code: u8,
    error: String,
    help: String,
    others: Vec<FurtherError>,
}

/// What else was wrong.
#[derive(Clone, Debug, Serialize)]
pub struct FurtherError {
    error: String,
    help: Option<String>,
}

impl FailureResult {
    /// A failure with its message, its exit code, and what to do.
    pub fn new(error: &str, exit_code: u8, help: &str) -> Self {
        let (error, help) = (error.to_owned(), help.to_owned());
        Self { status: "failed", exit_code, error, help, others: Vec::new() }
    }

    /// That of an error, with what else was wrong.
    pub fn of(error: &dyn Diagnostic, exit_code: u8) -> Self {
        let help = |diagnostic: &dyn Diagnostic| diagnostic.help().map(|help| help.to_string());
        let others = error.related().into_iter().flatten();
        let others =
            others.map(|other| FurtherError { error: other.to_string(), help: help(other) });
        let others = others.collect();
        let help = help(error).unwrap_or_default();
        Self { others, ..Self::new(&error.to_string(), exit_code, &help) }
    }
}

/// Why a command did not come to its end, and what to do.
#[derive(Debug, Error, Diagnostic)]
pub enum Error {
    /// The case.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Case(#[from] CaseError),
    /// The run, or what it is computed from.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Run(#[from] RunError),
    /// The sweep, or a case of it.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Sweep(#[from] SweepError),
    /// The results of a run cannot be judged.
    #[error("{cause}")]
    Post {
        /// What is wrong with them.
        cause: PostError,
        /// What to do, where the cause does not say.
        #[help]
        help: Option<&'static str>,
    },
    /// An LS-DYNA keyword file.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Deck(Box<DeckError>),
    /// A parameter of the slider.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Setting(Box<SettingError>),
    /// The slider's numbers grew without bound.
    #[error("{0}")]
    #[diagnostic(help("`creepage slider --thresholds` prints the limits of the explicit method"))]
    BlowUp(BlowUp),
    /// An option, or a file that it names, that cannot be used.
    #[error("{problem}")]
    Option {
        /// What is wrong with it.
        problem: String,
        /// What to do.
        #[help]
        help: Option<String>,
    },
    /// What a program must be given by its system.
    #[error("{0}")]
    System(String),
}

impl Error {
    /// Exit code of the command line: 2 for bad input, 3 where a run's own guards stopped it, 130 when
    /// interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Run(error) => error.exit_code(),
            Self::Sweep(error) => error.exit_code(),
            Self::BlowUp(_) | Self::System(_) => STOPPED_BY_GUARD,
            Self::Case(_)
            | Self::Post { .. }
            | Self::Deck(_)
            | Self::Setting(_)
            | Self::Option { .. } => BAD_INPUT,
        }
    }

    /// An option that cannot be used, and the remedy.
    pub(crate) fn option(problem: impl Into<String>, help: impl Into<String>) -> Self {
        Self::Option { problem: problem.into(), help: Some(help.into()) }
    }

    /// An option that cannot be used; the problem says what it must be.
    pub(crate) fn plain(problem: impl Into<String>) -> Self {
        Self::Option { problem: problem.into(), help: None }
    }
}

impl From<NotAsWanted> for Error {
    fn from(error: NotAsWanted) -> Self {
        Self::plain(error.to_string())
    }
}

impl From<PostError> for Error {
    fn from(cause: PostError) -> Self {
        let damaged = matches!(cause, PostError::Output(OutputError::Damaged { .. }));
        let help = damaged.then_some("copy it again from where it is whole, or run it again");
        Self::Post { cause, help }
    }
}

impl From<ImportError> for Error {
    fn from(error: ImportError) -> Self {
        match error {
            ImportError::Input { .. } => Self::option(
                error.to_string(),
                "`creepage import-contact --help` and docs/checks.md name the columns",
            ),
            ImportError::Output(_) => Self::plain(error.to_string()),
        }
    }
}

impl From<DeckError> for Error {
    fn from(error: DeckError) -> Self {
        Self::Deck(Box::new(error))
    }
}

impl From<Box<SettingError>> for Error {
    fn from(error: Box<SettingError>) -> Self {
        Self::Setting(error)
    }
}

impl From<BlowUp> for Error {
    fn from(error: BlowUp) -> Self {
        Self::BlowUp(error)
    }
}
