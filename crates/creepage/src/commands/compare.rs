//! How far runs differ.

use std::path::{Path, PathBuf};

use crate::chart::{Format, Paper};
use crate::check::{Depth, PostError};
use crate::compare::{Compared, ComparisonResult};
use serde::Deserialize;

use crate::Error;
use crate::commands::check::{BasisOptions, SpanOptions, basis};
use crate::commands::values::FIGURE;

/// What to compare.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CompareOptions {
    /// Folders of two runs or more; each is compared with the one before it
    #[cfg_attr(feature = "clap", arg(value_name = "RUN", num_args = 2.., required = true))]
    pub runs: Vec<PathBuf>,
    /// Over which span of time.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub span: SpanOptions,
    /// Draw the slip along the centre line: mean in time and one standard deviation
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.svg|FILE.pdf|FILE.png",
        value_parser = |file: &str| FIGURE.read(file)))]
    pub plot: Option<PathBuf>,
    /// What the runs are measured against.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub basis: BasisOptions,
}

/// Compares runs: slip and shear over place and time, means, statistics, growth of a disturbance.
///
/// # Errors
/// Results that cannot be read, or are not over the same times; a figure that cannot be written.
pub fn compare(options: &CompareOptions) -> Result<ComparisonResult, Error> {
    FIGURE.check("--plot", options.plot.as_ref())?;
    let window = options.span.span()?;
    let mut runs = Vec::new();
    for run in &options.runs {
        let (paths, basis) = basis(run, &options.basis, Depth::Read)?;
        runs.push(Compared { paths, basis });
    }
    let found = crate::compare::compare(&mut runs, window)?;
    let mut result = found.result;
    if let Some(plot) = &options.plot {
        let (folder, stem, format) = parts(plot).ok_or_else(|| Error::plain("--plot: no file"))?;
        let path =
            found.figure.write_as(folder, stem, format, &Paper::SCREEN).map_err(PostError::from)?;
        result.figure = Some(path.display().to_string());
    }
    Ok(result)
}

/// Folder, name without its ending, and kind of a figure's file.
fn parts(path: &Path) -> Option<(&Path, &str, Format)> {
    let format = path.extension()?.to_str()?.parse().ok()?;
    Some((path.parent()?, path.file_stem()?.to_str()?, format))
}
