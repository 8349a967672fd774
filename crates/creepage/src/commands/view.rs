//! The interactive scene of a run.

use std::fs;
use std::path::PathBuf;

use output::files::made::PAGE;
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::commands::outputs::{claim, shown};
use crate::report::scene_page;
use crate::run::folder::RUN_FILES;
use crate::scene::SceneError;

/// What to view.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct ViewOptions {
    /// Folder of a run
    #[cfg_attr(feature = "clap", arg(value_name = "RUN"))]
    pub run: PathBuf,
    /// The page [default: scene.html in that folder]
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.html"))]
    pub out: Option<PathBuf>,
}

/// The page of a run's scene: the document of `creepage view --json`.
#[derive(Clone, Debug, Serialize)]
pub struct Viewed {
    /// The page.
    #[serde(serialize_with = "shown")]
    pub page: PathBuf,
}

/// Writes a self-contained page with the interactive scene of a run.
///
/// # Errors
/// Records that cannot be read; a page that cannot be written, or would be written over another file.
pub fn view(options: &ViewOptions) -> Result<Viewed, Error> {
    let page = options.out.clone().unwrap_or_else(|| options.run.join("scene.html"));
    let text = scene_page(&options.run)?;
    claim("--out", &page, &PAGE, &RUN_FILES.map(|file| options.run.join(file)))?;
    fs::write(&page, text).map_err(|error| {
        Error::plain(format!("--out {}: cannot write the page: {error}", page.display()))
    })?;
    Ok(Viewed { page })
}

impl From<SceneError> for Error {
    fn from(error: SceneError) -> Self {
        Self::Option { problem: error.to_string(), help: error.remedy() }
    }
}
