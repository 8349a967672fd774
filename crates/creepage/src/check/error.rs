use output::OutputError;
use std::path::PathBuf;

/// Why a run cannot be judged, and what to do about it.
#[derive(Debug, thiserror::Error)]
pub enum PostError {
    /// A file of the run cannot be read or written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// There is nothing at the path of a run.
    #[error("{}: there is no such file or folder", path.display())]
    NoSuchRun {
        /// The path that was given.
        path: PathBuf,
    },
    /// There is no contact history.
    #[error(
        "{} holds no contact.vtkhdf: give the folder of a run, or a file of that layout",
        path.display()
    )]
    NoContactFile {
        /// The path that was given.
        path: PathBuf,
    },
    /// A case or a sweep file in the place of a run.
    #[error(
        "{} is a case or a sweep, and no run: run it first, then give the folder of the run",
        path.display()
    )]
    NotYetRun {
        /// The path that was given.
        path: PathBuf,
    },
    /// The file can be read but lacks data that the contact conditions need.
    #[error("{}: {what}", path.display())]
    Lacks {
        /// The file.
        path: PathBuf,
        /// What is missing or wrong, as half a sentence.
        what: String,
    },
    /// A value is not finite.
    #[error(
        "{}: {field} is not a number at node {node} at t = {time:e} s; the run went wrong before, \
         or the file was filled without data: leave that time out with --window",
        path.display()
    )]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// The field.
        field: &'static str,
        /// Index of the node in the file.
        node: usize,
        /// Time (s).
        time: f64,
    },
    /// A text file (case, summary of a sweep) that cannot be read as what it should be.
    #[error("{}: {reason}", path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A scale that the measures need is not known.
    #[error("{name} is not known: {remedy}")]
    Unknown {
        /// What is missing.
        name: &'static str,
        /// How to state it.
        remedy: &'static str,
    },
    /// A name, number or range from the user that cannot be used; the message says why.
    #[error("{0}")]
    Asked(String),
    /// Data that end early: the file is damaged.
    #[error(
        "{} cannot be read to its end: its headers or data are damaged", path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// A figure cannot be written.
    #[error(transparent)]
    Figure(#[from] crate::chart::FigureError),
}
