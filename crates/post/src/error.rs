use output::OutputError;
use std::path::PathBuf;

/// Why a run cannot be judged, and what to do about it.
#[derive(Debug, thiserror::Error)]
pub enum PostError {
    /// A file of the run cannot be read or written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// There is no contact history.
    #[error(
        "{} holds no contact.vtkhdf: give the folder of a run, or a file of that layout",
        path.display()
    )]
    NoContactFile {
        /// What was given.
        path: PathBuf,
    },
    /// The file is whole but lacks something that the conditions are written in.
    #[error("{}: {what}", path.display())]
    Lacks {
        /// The file.
        path: PathBuf,
        /// What is missing or wrong, and the remedy.
        what: String,
    },
    /// A value is not a number.
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
        /// Row of the node in the file.
        node: usize,
        /// Time (s).
        time: f64,
    },
    /// A file beside the contact history is no such file.
    #[error("{}: {reason}", path.display())]
    Text {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A scale that the measures need is nowhere to be found.
    #[error("{name} is not known: {remedy}")]
    Unknown {
        /// What is missing.
        name: &'static str,
        /// Where to give it.
        remedy: &'static str,
    },
    /// A name, number or range from the user.
    #[error("{0}")]
    Asked(String),
    /// Reading stopped in the middle.
    #[error(
        "{} cannot be read to its end: its headers or data are damaged", path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// A figure cannot be written.
    #[error(transparent)]
    Figure(#[from] figure::FigureError),
}
