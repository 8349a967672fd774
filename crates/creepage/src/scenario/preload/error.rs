//! Why no preload was found.

use dynamics::RelaxationError;
use statics::StaticsError;

/// Why no preload was found.
#[derive(Debug, thiserror::Error)]
pub enum PreloadError {
    /// By Newton's method.
    #[error("static preload: {0}")]
    Static(#[from] StaticsError),
    /// By dynamic relaxation.
    #[error(transparent)]
    Relaxation(#[from] RelaxationError),
}

impl PreloadError {
    /// Whether the preload ended because it was asked to stop.
    pub fn is_interruption(&self) -> bool {
        matches!(
            self,
            Self::Static(StaticsError::Interrupted)
                | Self::Relaxation(RelaxationError::Interrupted)
        )
    }
}
