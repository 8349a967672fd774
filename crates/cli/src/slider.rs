//! `creepage slider`.

mod csv_file;
mod page;
mod settings;

use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use files::output::SLIDER;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use miette::miette;
use serde_json::{Value, json};
use slider::figures::{figure_6, figure_7, figure_8, time_step_map};
use slider::{BlowUp, Method, Outcome, Parameters, Threshold, figures, tables};

use crate::args::{Args, stop_flag};
use crate::failure::{BAD_INPUT, Failure, INTERRUPTED, STOPPED_BY_GUARD};
use crate::outputs::claim;
use csv_file::{CsvFile, Unwritable};
use settings::{SettingError, Settings, Sources};

/// Options of `slider`.
#[derive(Debug, clap::Args)]
pub struct SliderArgs {
    #[command(flatten)]
    settings: Settings,
    /// Read parameters from a TOML file with the options' names as keys (t_end = 5); options on
    /// the command line come before it
    #[arg(long, value_name = "FILE.toml")]
    config: Option<PathBuf>,
    /// Write time, position, velocity, slip velocity, friction coefficient and forces of every step
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Draw the paper's Figures 6, 7 and 8 (implicit against explicit, or against --method) and a
    /// map of the time step, as SVG and PNG
    #[arg(long, value_name = "DIR")]
    plot: Option<PathBuf>,
    /// Print the time steps above which the explicit method chatters (dt_1) and collapses too
    /// early (dt_2), by formula and by bisection on runs
    #[arg(long, conflicts_with_all = ["csv", "plot", "tables", "method"])]
    thresholds: bool,
    /// Compute Tables 2, 3 and 4 of the paper and set them beside the printed values
    #[arg(long, conflicts_with_all = ["Settings", "config", "csv", "plot"])]
    tables: bool,
}

/// Runs the command.
pub fn command(args: &Args, options: &SliderArgs) -> Result<u8, Failure> {
    if options.tables {
        let tables = tables::tables()?;
        show(args, &json!(tables), || page::tables(&tables));
        return Ok(0);
    }
    let sources = Sources::new(&options.settings, options.config.as_deref())?;
    let parameters = sources.parameters()?;
    if options.thresholds {
        let found = slider::thresholds(&parameters).map_err(|e| sources.out_of_range(&e))?;
        let document = json!({
            "dt_1": threshold(found.chatter), "dt_2": found.collapse.map(threshold),
        });
        show(args, &document, || page::thresholds(&found));
        return Ok(0);
    }
    if options.plot.is_some() {
        figures::drawable(&parameters).map_err(|e| sources.out_of_range(&e))?;
    }
    let method = sources.method().unwrap_or(Method::Implicit);
    if let Some(csv) = &options.csv {
        let inputs: Vec<PathBuf> = options.config.iter().cloned().chain(sources.table()).collect();
        claim("--csv", csv, &SLIDER, &inputs)?;
    }
    let out = simulate(args, &parameters, method, options.csv.as_deref())?;
    let mut document = document(&parameters, method, &out);
    let mut drawn = Vec::new();
    if let (Some(folder), false) = (&options.plot, out.stopped) {
        let other = sources.method().filter(|m| *m != Method::Implicit);
        drawn = plot(args, &parameters, other.unwrap_or(Method::Explicit), folder)?;
        document["figures"] = json!(drawn);
    }
    show(args, &document, || {
        let figures = drawn.iter().map(|path| format!("{}\n", path.display()));
        page::outcome(&parameters, method, &out) + &figures.collect::<String>()
    });
    Ok(if out.stopped { INTERRUPTED } else { 0 })
}

/// Steps between looks at Ctrl-C and at the bar.
const LOOK: u64 = 1 << 16;

fn simulate(
    args: &Args,
    p: &Parameters,
    method: Method,
    csv: Option<&Path>,
) -> Result<Outcome, Failure> {
    let mut csv = csv.map(CsvFile::new).transpose()?;
    let stop = stop_flag(args);
    let bar = bar(args, (p.end / p.dt).round() as u64);
    let mut step = 0u64;
    let result = slider::run(p, method, |time, state| {
        if let Some(csv) = &mut csv {
            csv.row(p, time, state);
        }
        step += 1;
        if step.is_multiple_of(LOOK) {
            bar.set_position(step);
            if stop.load(Ordering::Relaxed) || csv.as_ref().is_some_and(CsvFile::failed) {
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    // what was computed is written even if the run blew up
    csv.map_or(Ok(()), CsvFile::finish)?;
    Ok(result?)
}

fn bar(args: &Args, steps: u64) -> ProgressBar {
    let bar = ProgressBar::new(steps);
    bar.set_draw_target(if !args.quiet && std::io::stderr().is_terminal() {
        ProgressDrawTarget::stderr_with_hz(8)
    } else {
        ProgressDrawTarget::hidden()
    });
    let style = ProgressStyle::with_template("slider  {percent:>3}% {bar:12} {eta} left");
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// Draws all figures into a folder; returns their paths.
fn plot(
    args: &Args,
    p: &Parameters,
    other: Method,
    folder: &Path,
) -> Result<Vec<PathBuf>, Failure> {
    let methods = [Method::Implicit, other];
    let mut paths = Vec::new();
    let mut write = |figure: figure::Figure, stem: &str| -> Result<(), Failure> {
        paths.extend(figure.write(folder, stem).map_err(|error| {
            bad_input(miette!(
                help = "give --plot a folder that you may write to",
                "--plot {}: {error}",
                folder.display()
            ))
        })?);
        Ok(())
    };
    write(figure_6(p, methods)?, "figure-6")?;
    write(figure_7(p, methods)?, "figure-7")?;
    write(figure_8(p, other, zoom(p))?, "figure-8")?;
    args.say("running the map of the time step, a few seconds");
    write(time_step_map(p), "time-step-map")?;
    Ok(paths)
}

/// The paper's t in [0.78, 0.80] s, or the same share of a shorter or longer run.
fn zoom(p: &Parameters) -> [f64; 2] {
    [0.156 * p.end, 0.160 * p.end]
}

fn document(p: &Parameters, method: Method, out: &Outcome) -> Value {
    // numbers that do not exist are null
    let number = |value: f64| value.is_finite().then_some(value);
    let ringing = out.ringing.map(
        |r| json!({ "capture": r.capture, "peak": r.peak, "rms": r.rms, "later_rms": r.later_rms }),
    );
    json!({
        "method": method.name(), "dt": p.dt, "mass": p.mass, "damping": p.damping,
        "x_min": out.x_min, "x_max": number(out.x_max), "v_max": out.v_max,
        "status": if out.stopped { "interrupted" } else { "completed" },
        "steps": out.steps, "adhesion_slip": number(out.adhesion_slip), "ringing": ringing,
        "picard_iterations": out.picard, "most_picard_iterations": out.most_picard,
        "fallback_steps": out.fallbacks,
    })
}

fn threshold(t: Threshold) -> Value {
    json!({ "formula": t.formula, "bisection": t.bisection })
}

fn show(args: &Args, document: &Value, page: impl FnOnce() -> String) {
    if args.json {
        args.print_json(document);
    } else if !args.quiet {
        let _ = write!(std::io::stdout(), "{}", page());
    }
}

fn bad_input(report: miette::Report) -> Failure {
    Failure { report, code: BAD_INPUT }
}

impl From<Box<SettingError>> for Failure {
    fn from(error: Box<SettingError>) -> Self {
        bad_input((*error).into())
    }
}

impl From<BlowUp> for Failure {
    fn from(error: BlowUp) -> Self {
        let report = miette!(
            help = "`creepage slider --thresholds` prints the limits of the explicit method",
            "{error}"
        );
        Self { report, code: STOPPED_BY_GUARD }
    }
}

impl From<Unwritable> for Failure {
    fn from(error: Unwritable) -> Self {
        bad_input(miette!(
            help = "give a path in a folder that you may write to",
            "--csv {}: cannot write the file: {}",
            error.path.display(),
            error.cause
        ))
    }
}
