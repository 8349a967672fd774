use crate::room_left;
use std::path::{Path, PathBuf};

/// Why a file of a run could not be written or read, and what to do about it.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// A new file could not be written.
    #[error(
        "cannot create {}: {reason}{}; check that its folder exists and is writable and that the \
         disk has room", path.display(), room_left(path)
    )]
    Create {
        /// The file.
        path: PathBuf,
        /// What the system or the HDF5 library said.
        reason: String,
    },
    /// An existing file could not be extended.
    #[error(
        "cannot append to {}: {reason}{}; what it held before is still readable; check that the \
         disk has room and that the file was not moved or removed", path.display(), room_left(path)
    )]
    Append {
        /// The file.
        path: PathBuf,
        /// What the system or the HDF5 library said.
        reason: String,
    },
    /// Another process has written to the file or replaced it.
    #[error(
        "{} was changed by another process: it holds {found} rows where this one left {left}, so this one has \
         stopped; look for a second process in its folder, and begin the run anew", path.display()
    )]
    Another {
        /// The file.
        path: PathBuf,
        /// Rows that it holds.
        found: usize,
        /// Rows that this process left in it.
        left: usize,
    },
    /// A file could not be read.
    #[error(
        "cannot read {}: {reason}; check that it is a file written by creepage and whole",
        path.display()
    )]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system or the HDF5 library said.
        reason: String,
    },
    /// A checkpoint of a form that this version does not read.
    #[error("{} was written by another version of creepage, in a form that this one does not read", path.display())]
    Form {
        /// The file.
        path: PathBuf,
    },
    /// A file is not as it was written.
    #[error("{} is damaged: {reason}", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What shows it.
        reason: String,
    },
    /// Names or shapes of data that the file cannot take.
    #[error("cannot write to {}: {problem}", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// What was expected, what was found, and the remedy.
        problem: String,
    },
    /// A snapshot of the bodies for a run that does not record them.
    #[error("the run has no fields.vtkhdf, so no snapshot of its bodies can be written")]
    NoFields,
    /// The system has no thread left.
    #[error(
        "a thread that reads or writes results cannot be started: {cause}; raise the limits of processes and \
         memory (ulimit -u, ulimit -v)"
    )]
    Thread {
        /// What the system said.
        cause: std::io::Error,
    },
    /// A state that cannot be serialised, or is read as another type than it was written.
    #[error("the state of the run cannot be kept in a checkpoint: {cause}")]
    State {
        /// What postcard said.
        cause: postcard::Error,
    },
    /// The background writer has stopped: its error was already returned, or it panicked.
    #[error(
        "the background writer has stopped; what was written before is readable; the first error \
         that it reported says why"
    )]
    Stopped,
}

impl OutputError {
    /// The file, if its content is the reason.
    pub fn damaged(&self) -> Option<&Path> {
        match self {
            Self::Read { path, .. } | Self::Form { path } | Self::Damaged { path, .. } => {
                Some(path)
            }
            _ => None,
        }
    }
}

/// A text file beside the results cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {cause}{}", path.display(), room_left(path))]
pub struct NotWritten {
    /// The file.
    pub path: PathBuf,
    /// What the system said.
    pub cause: std::io::Error,
}

impl NotWritten {
    /// What the user can do, as half a sentence.
    pub fn remedy(&self) -> &'static str {
        "the run has stopped; check that its folder is still there and that the disk has room"
    }
}
