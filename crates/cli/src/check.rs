//! `creepage check`.

use std::path::{Path, PathBuf};

use files::output::among;
use miette::miette;
use output::OutputError;
use post::{Basis, CheckOptions, Depth, Limits, Pairing, PostError, Report, RunPaths, Span};

use crate::args::Args;
use crate::failure::{BAD_INPUT, Failure};
use crate::outputs::{claim_grid, of_the_run};
use crate::report;

/// Exit code: a measure beyond its limit.
const BEYOND: u8 = 1;

/// Options of `check`.
#[derive(Debug, clap::Args)]
pub struct CheckArgs {
    /// Folder of a run, or a file of the layout of contact.vtkhdf
    #[arg(value_name = "RUN")]
    pub run: PathBuf,
    #[command(flatten)]
    window: WindowArgs,
    /// Set the limit of a measure, for example law_error=0.02; may be repeated
    #[arg(long = "limit", value_name = "NAME=VALUE", value_parser = named)]
    limits: Vec<(String, f64)>,
    /// Write the violations of every node over time here, for ParaView
    #[arg(long, value_name = "FILE.vtkhdf", value_parser = map_file)]
    map: Option<PathBuf>,
    /// Pairing in time of traction and slip to report: with the slip of the step `before` or
    /// `after` it, or the `stricter` of both [default: what the file states, else stricter]
    #[arg(long, value_name = "stricter|before|after", value_parser = pairing)]
    pairing: Option<Report>,
    /// Prove every bit of all files of the run by the checksums in its summary, also of those that
    /// are not read for the check
    #[arg(long)]
    deep: bool,
    #[command(flatten)]
    pub basis: BasisArgs,
}

/// Which records are taken.
#[derive(Debug, clap::Args)]
pub struct WindowArgs {
    /// Take the records from T0 to T1 seconds; either may be left out [default: the run's evaluation
    /// window; to compare, the first [[output.window]] of the first run]
    #[arg(long, value_name = "T0:T1", value_parser = window, allow_hyphen_values = true)]
    window: Option<[f64; 2]>,
    /// Take the last N contact transits (2a/V) of the evaluation window's end
    #[arg(long, value_name = "N", value_parser = transits, conflicts_with = "window")]
    transits: Option<f64>,
}

impl WindowArgs {
    /// What was asked for.
    pub fn span(&self) -> Option<Span> {
        self.window.map(Span::Between).or(self.transits.map(Span::Transits))
    }
}

/// What a run is measured against, where its own files do not say.
#[derive(Debug, clap::Args)]
pub struct BasisArgs {
    /// Take friction law and scales from this case file [default: case.toml beside the contact
    /// history]
    #[arg(long, value_name = "CASE.toml")]
    case: Option<PathBuf>,
    /// Set a scale, for example peak_pressure=1.2e9; may be repeated
    #[arg(long = "scale", value_name = "NAME=VALUE", value_parser = named)]
    scales: Vec<(String, f64)>,
}

/// Runs the command.
pub fn command(args: &Args, options: &CheckArgs) -> Result<u8, Failure> {
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
    let wanted = CheckOptions {
        window: options.window.span(),
        limits,
        report: options.pairing.unwrap_or_default(),
        map: options.map.as_deref(),
    };
    let found = post::check(&paths, &mut basis, &wanted)?;
    if args.json {
        args.print_json(&found.document);
    } else if !args.quiet {
        report::print_check(&found.document);
    }
    Ok(if found.pass { 0 } else { BEYOND })
}

/// The files of a run, proven as far as asked, and what it is measured against.
pub fn basis(run: &Path, options: &BasisArgs, depth: Depth) -> Result<(RunPaths, Basis), Failure> {
    let mut paths = RunPaths::of(run)?;
    if let Some(warning) = post::prove(&paths, depth)? {
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
        && let Ok(case) = case::Case::load(&paths.case, &[])
    {
        if options.case.is_none() {
            post::prove_case(&paths, &case.hash(), env!("CARGO_PKG_VERSION"))?;
        }
        let named = basis.case.as_ref().is_some_and(|case| case.contains_key("evaluate"));
        basis.window = basis.window.or(named.then(|| case.evaluation_window()));
        basis.shape = case::hertz::patch_shape(&case);
        let hertz = case::hertz::hertz(&case);
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
    let own = ::run::folder::RUN_FILES.map(|file| paths.folder.join(file));
    own.into_iter().chain([paths.contact.clone(), paths.case.clone()]).collect()
}

fn window(text: &str) -> Result<[f64; 2], String> {
    let wanted = "two times in seconds with a colon between, such as 1.0e-3:1.5e-3, are needed";
    let (from, to) = text.split_once(':').ok_or(wanted)?;
    let end = |text: &str, open: f64| match text.trim() {
        "" => Ok(open),
        text => text.parse::<f64>().ok().filter(|t| t.is_finite()).ok_or(wanted),
    };
    let window = [end(from, f64::NEG_INFINITY)?, end(to, f64::INFINITY)?];
    if window[0] <= window[1] { Ok(window) } else { Err("the window ends before it begins".into()) }
}

fn transits(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|n| n.is_finite() && *n > 0.0);
    number.ok_or_else(|| "a number greater than 0 is needed".to_owned())
}

fn named(text: &str) -> Result<(String, f64), String> {
    let wanted = "a name and a number, such as law_error=0.02, are needed";
    let (name, value) = text.split_once('=').ok_or(wanted)?;
    let value = value.trim().parse().map_err(|_| wanted)?;
    Ok((name.trim().to_owned(), value))
}

fn pairing(text: &str) -> Result<Report, String> {
    match text {
        "stricter" => Ok(Report::Stricter),
        "before" => Ok(Report::Only(Pairing::Before)),
        "after" => Ok(Report::Only(Pairing::After)),
        _ => Err("one of stricter, before, after is needed".into()),
    }
}

fn map_file(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("vtkhdf") => Ok(path),
        _ => Err("the file's name must end in .vtkhdf".into()),
    }
}

impl From<PostError> for Failure {
    fn from(error: PostError) -> Self {
        let report = match &error {
            PostError::Output(OutputError::Damaged { .. }) => {
                miette!(help = "copy it again from where it is whole, or run it again", "{error}")
            }
            _ => miette!("{error}"),
        };
        Self { report, code: BAD_INPUT }
    }
}
