//! The check of a run against the contact conditions.

use std::path::{Path, PathBuf};

use crate::check::{Basis, Checked, Depth, Limits, PostError, Report, RunPaths, Span};
use output::files::made::among;
use serde::Deserialize;

use crate::Error;
use crate::commands::outputs::{claim_grid, of_the_run};
#[cfg(feature = "clap")]
use crate::commands::values::words::{named, window};
use crate::commands::values::{MAP, TRANSITS, WINDOW, maybe_parsed};

/// What to check.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct CheckOptions {
    /// Folder of a run, or a file of the layout of contact.vtkhdf
    #[cfg_attr(feature = "clap", arg(value_name = "RUN"))]
    pub run: PathBuf,
    /// Over which span of time.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub span: SpanOptions,
    /// Set the limit of a measure, for example law_error=0.02; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "limit", value_name = "NAME=VALUE", value_parser = named))]
    pub limits: Vec<(String, f64)>,
    /// Write the violations of every node over time here, for ParaView
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.vtkhdf",
        value_parser = |file: &str| MAP.read(file)))]
    pub map: Option<PathBuf>,
    /// Pairing in time of traction and slip to report: with the slip of the step `before` or
    /// `after` it, or the `stricter` of both [default: what the file states, else stricter]
    #[serde(deserialize_with = "maybe_parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "stricter|before|after"))]
    pub pairing: Option<Report>,
    /// Prove every bit of all files of the run by the checksums in its summary, also of those that
    /// are not read for the check
    #[cfg_attr(feature = "clap", arg(long))]
    pub deep: bool,
    /// What the run is measured against.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub basis: BasisOptions,
}

/// Which records are taken.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SpanOptions {
    /// Take the records from T0 to T1 seconds; either may be left out [default: the run's evaluation
    /// window; to compare, the first [[output.window]] of the first run]
    #[cfg_attr(feature = "clap", arg(long, value_name = "T0:T1", value_parser = window,
        allow_hyphen_values = true))]
    pub window: Option<[f64; 2]>,
    /// Take the last N contact transits (2a/V) of the evaluation window's end
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", conflicts_with = "window",
        value_parser = |n: &str| TRANSITS.read(n)))]
    pub transits: Option<f64>,
}

impl SpanOptions {
    /// What was asked for.
    pub(crate) fn span(&self) -> Result<Option<Span>, Error> {
        WINDOW.check("--window", self.window.as_ref())?;
        TRANSITS.check("--transits", self.transits.as_ref())?;
        Ok(self.window.map(Span::Between).or(self.transits.map(Span::Transits)))
    }
}

/// What a run is measured against, where its own files do not say.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct BasisOptions {
    /// Take friction law and scales from this case file [default: case.toml beside the contact
    /// history]
    #[cfg_attr(feature = "clap", arg(long, value_name = "CASE.toml"))]
    pub case: Option<PathBuf>,
    /// Set a scale, for example peak_pressure=1.2e9; may be repeated
    #[cfg_attr(feature = "clap", arg(long = "scale", value_name = "NAME=VALUE", value_parser = named))]
    pub scales: Vec<(String, f64)>,
}

/// Checks where and by how much a run violates the contact conditions. The document is that of
/// `creepage check --json`.
///
/// # Errors
/// Files that cannot be read or are damaged; a scale that is not known; a map that cannot be written.
pub fn check(options: &CheckOptions) -> Result<Checked, Error> {
    MAP.check("--map", options.map.as_ref())?;
    let window = options.span.span()?;
    let depth = if options.deep { Depth::Every } else { Depth::Read };
    let (paths, mut basis) = basis(&options.run, &options.basis, depth)?;
    let mut limits = Limits::for_enforcement(basis.enforcement.as_deref());
    for (name, value) in &options.limits {
        limits.set(name, *value)?;
    }
    if let Some(map) = &options.map {
        let inputs = inputs(&paths);
        if among(&inputs, std::slice::from_ref(map)).is_some() {
            return Err(of_the_run("--map", map));
        }
        claim_grid("--map", map, &inputs)?;
    }
    let report = options.pairing.unwrap_or_default();
    let wanted = crate::check::Criteria { window, limits, report, map: options.map.as_deref() };
    Ok(crate::check::check(&paths, &mut basis, &wanted)?)
}

/// The files of a run, proven as far as asked, and what it is measured against.
pub fn basis(run: &Path, options: &BasisOptions, depth: Depth) -> Result<(RunPaths, Basis), Error> {
    let mut paths = RunPaths::of(run)?;
    if let Some(warning) = crate::check::verify_files(&paths, depth)? {
        tracing::warn!("{warning}");
    }
    if let Some(case) = &options.case {
        if !case.is_file() {
            let problem = format!("--case {}: there is no such file", case.display());
            return Err(PostError::Asked(problem).into());
        }
        paths.case = case.clone();
    }
    let mut basis = Basis::read(&paths)?;
    for (name, value) in &options.scales {
        basis.set(name, *value)?;
    }
    // A run in progress has no summary yet; Hertz's contact and the evaluation window follow from its
    // case. Other codes' cases need not be cases of this program, nor name a window.
    if (basis.summary.is_none() || basis.scale("approach").is_none())
        && let Ok(case) = crate::case::Case::load(&paths.case, &[])
    {
        if options.case.is_none() {
            crate::check::verify_case(&paths, &case.hash(), env!("CARGO_PKG_VERSION"))?;
        }
        let named = basis.case.as_ref().is_some_and(|case| case.contains_key("evaluate"));
        basis.window = basis.window.or(named.then(|| case.evaluation_window()));
        basis.shape = crate::case::hertz::patch_shape(&case);
        let hertz = crate::case::hertz::hertz(&case);
        for (name, value) in [
            ("peak_pressure", hertz.p0),
            ("approach", hertz.approach),
            ("half_length", hertz.a),
            ("half_width", hertz.b),
        ] {
            basis.offer(name, value, "Hertz's contact of the case");
        }
    }
    Ok((paths, basis))
}

/// What a command reads of a run.
pub fn inputs(paths: &RunPaths) -> Vec<PathBuf> {
    let own = crate::run::folder::RUN_FILES.map(|file| paths.folder.join(file));
    own.into_iter().chain([paths.contact.clone(), paths.case.clone()]).collect()
}
