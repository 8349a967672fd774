//! Why a run cannot be shown.

use super::quantity::Drawable;
use crate::chart::FigureError;
use crate::check::PostError;
use output::OutputError;
use output::layout::file;
use std::path::PathBuf;
use thiserror::Error;

/// Why a run cannot be shown, and what to do about it.
#[derive(Debug, Error)]
pub enum SceneError {
    /// A file of the run cannot be read, is damaged or lacks data.
    #[error(transparent)]
    Post(#[from] PostError),
    /// The still picture cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// The file with the records is not there.
    #[error("{} holds no {}", folder.display(), what.file())]
    NoFile {
        /// The folder.
        folder: PathBuf,
        /// What was to be drawn.
        what: Drawable,
    },
    /// No record has been written yet.
    #[error("{} holds no record yet", .0.display())]
    NoRecord(PathBuf),
}

impl From<OutputError> for SceneError {
    fn from(error: OutputError) -> Self {
        Self::Post(error.into())
    }
}

impl SceneError {
    /// What the user can do about it, where the message does not say.
    pub fn remedy(&self) -> Option<String> {
        match self {
            Self::Post(PostError::Output(OutputError::Damaged { .. })) => {
                Some("copy it again from where it is whole, or run it again".into())
            }
            Self::Post(_) | Self::Figure(_) => None,
            Self::NoFile { .. } => Some(format!(
                "give the folder of a run; a run writes {} every output.fields_interval and {} every \
                 output.contact_interval",
                file::FIELDS,
                file::CONTACT
            )),
            Self::NoRecord(_) => Some("wait until the run rolls".into()),
        }
    }
}
