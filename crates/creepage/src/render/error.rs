//! Why a run cannot be drawn.

use super::quantity::{Drawable, Quantity};
use crate::chart::PictureError;
use crate::check::PostError;
use output::OutputError;
use output::layout::file;
use std::path::PathBuf;
use thiserror::Error;

/// Why a run cannot be drawn, and what to do about it.
#[derive(Debug, Error)]
pub enum RenderError {
    /// A file of the run cannot be read, is damaged or lacks data.
    #[error(transparent)]
    Post(#[from] PostError),
    /// The drawing library failed.
    #[error(transparent)]
    Picture(#[from] PictureError),
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
    /// The run did not write what the colours would show.
    #[error("{} holds no field {field}, of which {} is made", path.display(), quantity.name())]
    NoField {
        /// The file.
        path: PathBuf,
        /// Its dataset that is missing.
        field: &'static str,
        /// What was to be shown.
        quantity: Quantity,
    },
}

impl From<OutputError> for RenderError {
    fn from(error: OutputError) -> Self {
        Self::Post(error.into())
    }
}

impl RenderError {
    /// What the user can do about it, where the message does not say.
    pub fn remedy(&self) -> Option<String> {
        match self {
            Self::Post(PostError::Output(OutputError::Damaged { .. })) => {
                Some("copy it again from where it is whole, or run it again".into())
            }
            Self::Post(_) | Self::Picture(_) => None,
            Self::NoFile { what: Drawable::Fields, .. } => Some(format!(
                "give the folder of a run; a run writes {} every output.fields_interval, but one of half-spaces \
                 (model = \"half-space\") has no bodies to draw: --what contact draws its surfaces",
                file::FIELDS
            )),
            Self::NoFile { what: Drawable::Contact, .. } => {
                Some("give the folder of a run; its contact surfaces are written every output.contact_interval".into())
            }
            Self::NoRecord(_) => Some("wait until the run rolls".into()),
            Self::NoField { quantity: Quantity::VonMises, .. } => {
                Some("run the case with output.stress = true, or choose --field velocity".into())
            }
            Self::NoField { .. } => Some("choose another --field".into()),
        }
    }
}
