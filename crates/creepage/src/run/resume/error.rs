//! Why a run cannot be resumed.

use std::path::PathBuf;

use miette::Diagnostic;
use thiserror::Error;

/// Why a run cannot be resumed.
#[derive(Debug, Error, Diagnostic)]
pub enum ResumeError {
    /// The folder holds no run.
    #[error("there is no run to resume in {}", folder.display())]
    #[diagnostic(help("leave out --resume to begin it, or name its folder with --out DIR"))]
    NoRun {
        /// The folder.
        folder: PathBuf,
    },
    /// The run in the folder is of another case.
    #[error("{} holds the run of another case: {difference}", folder.display())]
    #[diagnostic(help(
        "resume it with its own case (--set too), choose another folder with --out DIR, or replace \
         it with --force"
    ))]
    AnotherCase {
        /// The folder.
        folder: PathBuf,
        /// What differs.
        difference: String,
    },
    /// There are checkpoints, but none that can be used.
    #[error("no checkpoint in {} can be used: {reasons}", folder.display())]
    #[diagnostic(help(
        "begin the run anew with --force; that replaces its results, look at them first"
    ))]
    Unusable {
        /// The folder.
        folder: PathBuf,
        /// What is wrong with each.
        reasons: String,
    },
    /// A file is not as the run left it, and there is no checkpoint to go on from.
    #[error("the run in {} cannot be resumed: {reason}", folder.display())]
    #[diagnostic(help("copy its files again, or begin the run anew with --force"))]
    Damaged {
        /// The folder.
        folder: PathBuf,
        /// The file and what is wrong with it.
        reason: String,
    },
}
