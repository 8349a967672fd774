//! The stress below the patch of a run.

use std::path::PathBuf;

use crate::Error;
use crate::check::Depth;
use crate::commands::check::{BasisOptions, basis};
use crate::subsurface::{StressProfile, stress_profiles};
use serde::Deserialize;

/// Of which run.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StressProfileOptions {
    /// Folder of a run.
    pub run: PathBuf,
}

/// Stress over the depth on the axis of the patch, of the disk and of the bar, at the last record of the bodies.
///
/// # Errors
/// Files that cannot be read; a run that has not written the stress tensor, or whose bodies do not touch then.
pub fn stress_profile(options: &StressProfileOptions) -> Result<[StressProfile; 2], Error> {
    let (paths, mut against) = basis(&options.run, &BasisOptions::default(), Depth::Read)?;
    Ok(stress_profiles(&paths, &mut against)?)
}
