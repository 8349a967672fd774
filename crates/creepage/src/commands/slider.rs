//! The 1-D slider.

mod csv_file;
mod law_numbers;
mod settings;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use crate::figures::slider::{self as figures, figure_6, figure_7, figure_8, time_step_map};
use ::slider::tables::{self, Tables};
use ::slider::{Method, Outcome, Parameters, Thresholds};
use output::files::made::SLIDER;
use output::summary::Status;
use serde::{Deserialize, Serialize};

use crate::commands::error::INTERRUPTED;
use crate::commands::outputs::claim;
use crate::commands::values::exclude;
use crate::{Error, Listener};
use csv_file::{CsvFile, Unwritable};
pub use friction::Kind as LawName;
pub use law_numbers::LawNumbers;
use settings::Sources;
pub use settings::{MethodName, SettingError, Settings};

/// What to compute with the slider.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct SliderOptions {
    /// Its parameters.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub settings: Settings,
    /// Read parameters from a TOML file with the options' names as keys (t_end = 5); options on
    /// the command line come before it
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.toml"))]
    pub config: Option<PathBuf>,
    /// Write time, position, velocity, slip velocity, friction coefficient and forces of every step
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE"))]
    pub csv: Option<PathBuf>,
    /// Draw the paper's Figures 6, 7 and 8 (implicit against explicit, or against --method) and a
    /// map of the time step, as SVG and PNG
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR"))]
    pub plot: Option<PathBuf>,
    /// Print the time steps above which the explicit method chatters (dt_1) and collapses too
    /// early (dt_2), by formula and by bisection on runs
    #[cfg_attr(feature = "clap", arg(long,
        conflicts_with_all = ["csv", "plot", "tables", "method"]))]
    pub thresholds: bool,
    /// Compute Tables 2, 3 and 4 of the paper and set them beside the printed values
    #[cfg_attr(feature = "clap", arg(long,
        conflicts_with_all = ["Settings", "LawNumbers", "config", "csv", "plot"]))]
    pub tables: bool,
}

impl SliderOptions {
    /// Refuses what cannot be asked for at once.
    fn exclusive(&self) -> Result<(), Error> {
        let files = [("--csv", self.csv.is_some()), ("--plot", self.plot.is_some())];
        let method = ("--method", self.settings.method.is_some());
        let config = ("--config", self.config.is_some());
        let settings = ("a parameter", self.settings != Settings::default());
        exclude(("--thresholds", self.thresholds), &files)?;
        exclude(("--thresholds", self.thresholds), &[("--tables", self.tables), method])?;
        exclude(("--tables", self.tables), &files)?;
        exclude(("--tables", self.tables), &[config, settings])
    }
}

/// What the slider gave: the document of `creepage slider --json`.
#[derive(Clone, Debug, Serialize)]
#[serde(untagged)]
pub enum SliderFound {
    /// Tables 2, 3 and 4 of the paper.
    Tables(Tables),
    /// The time steps above which the explicit method fails (s).
    Thresholds(Thresholds),
    /// A run.
    Run(Box<SliderRun>),
}

/// A run of the slider.
#[derive(Clone, Debug, Serialize)]
#[serde(into = "SliderResult")]
pub struct SliderRun {
    /// Its parameters.
    pub parameters: Parameters,
    /// Its time stepping.
    pub method: Method,
    /// What it came to.
    pub outcome: Outcome,
    /// The figures that were drawn.
    pub figures: Vec<PathBuf>,
}

/// The numbers of a run of the slider; NaN, which is null in JSON, where there is none.
#[derive(Clone, Debug, Serialize)]
pub struct SliderResult {
    /// Name of the time stepping.
    pub method: &'static str,
    /// Time step (s).
    pub dt: f64,
    /// Mass (kg).
    pub mass: f64,
    /// Damping (N s/m).
    pub damping: f64,
    /// What it came to.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Whether it was interrupted.
    pub status: Status,
    /// The figures that were drawn.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub figures: Vec<String>,
}

impl From<SliderRun> for SliderResult {
    fn from(run: SliderRun) -> Self {
        let SliderRun { parameters, method, outcome, figures } = run;
        Self {
            method: method.name(),
            dt: parameters.dt,
            mass: parameters.mass,
            damping: parameters.damping,
            outcome,
            status: if outcome.stopped { Status::Interrupted } else { Status::Completed },
            figures: figures.iter().map(|path| path.display().to_string()).collect(),
        }
    }
}

impl SliderFound {
    /// Exit code of the command line: 0, 130 when interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Run(run) if run.outcome.stopped => INTERRUPTED,
            _ => 0,
        }
    }
}

/// Computes with the slider: a run, the thresholds of the explicit method, or the paper's tables.
///
/// The listener hears how far the run is; its flag ends the run.
///
/// # Errors
/// A parameter out of its range, where it was set; numbers that grow without bound; a file that cannot be written.
pub fn slider(options: &SliderOptions, listener: &mut dyn Listener) -> Result<SliderFound, Error> {
    options.exclusive()?;
    if options.tables {
        return Ok(SliderFound::Tables(tables::tables()?));
    }
    let sources = Sources::new(&options.settings, options.config.as_deref())?;
    let parameters = sources.parameters()?;
    if options.thresholds {
        let found = ::slider::thresholds(&parameters).map_err(|e| sources.out_of_range(&e))?;
        return Ok(SliderFound::Thresholds(found));
    }
    if options.plot.is_some() {
        figures::drawable(&parameters).map_err(|e| sources.out_of_range(&e))?;
    }
    let method = sources.method().unwrap_or(Method::Implicit);
    if let Some(csv) = &options.csv {
        let inputs: Vec<PathBuf> = options.config.iter().cloned().chain(sources.table()).collect();
        claim("--csv", csv, &SLIDER, &inputs)?;
    }
    let outcome = simulate(&parameters, method, options.csv.as_deref(), listener)?;
    let mut figures = Vec::new();
    if let (Some(folder), false) = (&options.plot, outcome.stopped) {
        let other = sources.method().filter(|m| *m != Method::Implicit);
        figures = plot(&parameters, other.unwrap_or(Method::Explicit), folder, listener)?;
    }
    Ok(SliderFound::Run(Box::new(SliderRun { parameters, method, outcome, figures })))
}

/// Steps between looks at the stop flag, and at who listens.
const LOOK: u64 = 1 << 16;

fn simulate(
    p: &Parameters,
    method: Method,
    csv: Option<&Path>,
    listener: &mut dyn Listener,
) -> Result<Outcome, Error> {
    let mut csv = csv.map(CsvFile::new).transpose()?;
    let stop = listener.stop();
    let steps = (p.end / p.dt).round() as u64;
    let mut step = 0u64;
    let result = ::slider::run(p, method, |time, state| {
        if let Some(csv) = &mut csv {
            csv.row(p, time, state);
        }
        step += 1;
        if step.is_multiple_of(LOOK) {
            listener.slider(step, steps);
            if stop.load(Ordering::Relaxed) || csv.as_ref().is_some_and(CsvFile::failed) {
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    });
    listener.slider(step, steps);
    // what was computed is written even if the run blew up
    csv.map_or(Ok(()), CsvFile::finish)?;
    Ok(result?)
}

/// Draws all figures into a folder; returns their paths.
fn plot(
    p: &Parameters,
    other: Method,
    folder: &Path,
    listener: &mut dyn Listener,
) -> Result<Vec<PathBuf>, Error> {
    let methods = [Method::Implicit, other];
    let mut paths = Vec::new();
    let mut write = |figure: crate::chart::Figure, stem: &str| -> Result<(), Error> {
        paths.extend(figure.write(folder, stem).map_err(|error| {
            let problem = format!("--plot {}: {error}", folder.display());
            Error::option(problem, "give --plot a folder that you may write to")
        })?);
        Ok(())
    };
    write(figure_6(p, methods)?, "figure-6")?;
    write(figure_7(p, methods)?, "figure-7")?;
    write(figure_8(p, other, zoom(p))?, "figure-8")?;
    listener.remark("running the map of the time step, a few seconds");
    write(time_step_map(p), "time-step-map")?;
    Ok(paths)
}

/// The paper's t in [0.78, 0.80] s, or the same share of a shorter or longer run.
fn zoom(p: &Parameters) -> [f64; 2] {
    [0.156 * p.end, 0.160 * p.end]
}

impl From<Unwritable> for Error {
    fn from(error: Unwritable) -> Self {
        let problem =
            format!("--csv {}: cannot write the file: {}", error.path.display(), error.cause);
        Self::option(problem, "give a path in a folder that you may write to")
    }
}
