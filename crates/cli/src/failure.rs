//! Commands that fail: what is said, and the exit codes.

use ::run::RunError;
use miette::{Diagnostic, Report};
use serde_json::{Value, json};

/// Exit code: bad input.
pub const BAD_INPUT: u8 = 2;
/// Exit code: stopped by the run's own guards.
pub const STOPPED_BY_GUARD: u8 = 3;
/// Exit code: interrupted by Ctrl-C or SIGTERM.
pub const INTERRUPTED: u8 = 130;

/// A command that failed.
#[derive(Debug)]
pub struct Failure {
    /// What to say.
    pub report: Report,
    /// The exit code.
    pub code: u8,
}

impl Failure {
    /// The JSON document of the failure: what was wrong, what to do, and what else was wrong.
    pub fn document(&self) -> Value {
        let mut document = failure(&self.report.to_string(), self.code);
        let help = |diagnostic: &dyn Diagnostic| diagnostic.help().map(|help| help.to_string());
        document["help"] = json!(help(&*self.report).unwrap_or_default());
        let others = self.report.related().into_iter().flatten();
        let others: Vec<_> = others
            .map(|other| json!({ "error": other.to_string(), "help": help(other) }))
            .collect();
        document["others"] = json!(others);
        document
    }
}

/// The JSON document of a command that failed: with `--json`, standard output holds one document
/// whatever happens.
pub fn failure(message: &str, code: u8) -> Value {
    json!({ "status": "failed", "exit_code": code, "error": message })
}

impl From<case::CaseError> for Failure {
    fn from(error: case::CaseError) -> Self {
        Self { report: error.into(), code: BAD_INPUT }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        let code = error.exit_code();
        Self { report: error.into(), code }
    }
}
