//! The figures of a run or a sweep.

use std::path::PathBuf;

use crate::chart::{Format, Paper};
use crate::check::{Depth, PostError};
use crate::figures::{Choice, Reference};
use crate::sweep::SweepResult;
use crate::trends::ComparedSweep;
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::commands::check::{BasisOptions, SpanOptions, basis};
use crate::commands::sweep_folder;
use crate::commands::values::{FONT_SIZE, PAPER_WIDTH, all_parsed, maybe_parsed};

/// What to draw.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct PlotOptions {
    /// Folder of a run or of a sweep, or a file of the layout of contact.vtkhdf
    #[cfg_attr(feature = "clap", arg(value_name = "RUN_OR_SWEEP"))]
    pub run: PathBuf,
    /// Folder of the figures [default: figures in that folder]
    #[cfg_attr(feature = "clap", arg(long, value_name = "DIR"))]
    pub out: Option<PathBuf>,
    /// Folder of a sweep by another method, whose creep-force curve is drawn beside; may be repeated
    #[cfg_attr(feature = "clap", arg(long, value_name = "SWEEP"))]
    pub with: Vec<PathBuf>,
    /// Kinds of files: svg, pdf, png, with a comma between
    // none are svg and png
    #[serde(deserialize_with = "all_parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "KINDS", value_delimiter = ',',
        default_values = ["svg", "png"]))]
    pub format: Vec<Format>,
    /// Width of a figure on paper (mm), of PNG with 300 pixels per inch [default: as on a screen]
    #[cfg_attr(feature = "clap", arg(long, value_name = "MM",
        value_parser = |width: &str| PAPER_WIDTH.read(width)))]
    pub width: Option<f64>,
    /// Size of the letters (points of 1/72 inch) [default: 6.65]
    #[cfg_attr(feature = "clap", arg(long, value_name = "PT",
        value_parser = |size: &str| FONT_SIZE.read(size)))]
    pub font_size: Option<f64>,
    /// No caption below the panels
    #[cfg_attr(feature = "clap", arg(long))]
    pub no_caption: bool,
    /// Draw lines and maps at the records nearest to these times in seconds, with a comma between, four at most
    /// [default: the last three, 5.7e-6 s apart]
    #[cfg_attr(
        feature = "clap",
        arg(long, value_name = "TIME", value_delimiter = ',', allow_hyphen_values = true)
    )]
    pub at: Vec<f64>,
    /// Draw the spectra of these probes, with a comma between [default: the first six]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_delimiter = ','))]
    pub probes: Vec<usize>,
    /// Draw the tractions beside steady rolling of half-spaces at the run's mean creepage, which is computed (seconds) and kept
    /// as reference-half-space.json in its folder: elliptic contact of one material with Coulomb friction
    #[serde(deserialize_with = "maybe_parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "half-space"))]
    pub reference: Option<Reference>,
    /// Over which span of time; lines and maps are those at its end.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub span: SpanOptions,
    /// What the run is measured against.
    #[cfg_attr(feature = "clap", command(flatten))]
    pub basis: BasisOptions,
}

/// Figures that were drawn: the document of `creepage plot --json`.
#[derive(Clone, Debug, Serialize)]
pub struct Drawn {
    /// Name of the run or sweep.
    pub name: String,
    /// The figures, in order.
    pub figures: Vec<DrawnFigure>,
}

/// A figure that was drawn.
#[derive(Clone, Debug, Serialize)]
pub struct DrawnFigure {
    /// Its name: that of its files, without their endings.
    pub name: String,
    /// What it shows.
    pub about: String,
    /// Its files, one of each format.
    pub files: Vec<String>,
}

/// Draws the figures of a run (those of the papers, histories, slip over space and time, spectra) or of a sweep.
///
/// # Errors
/// Results that cannot be read; a folder that cannot be written to; `with` beside a run, or beside a
/// sweep without a creep-force curve; an instant or a probe that the run does not have.
pub fn plot(options: &PlotOptions) -> Result<Drawn, Error> {
    let window = options.span.span()?;
    PAPER_WIDTH.check("--width", options.width.as_ref())?;
    FONT_SIZE.check("--font-size", options.font_size.as_ref())?;
    let paper =
        Paper { width: options.width, font_size: options.font_size, caption: !options.no_caption };
    let (name, folder, figures) = if let Some(sweep) = sweep_folder::read(&options.run)? {
        if !(options.at.is_empty() && options.probes.is_empty()) || options.reference.is_some() {
            return Err(Error::option(
                format!("--at, --probes, --reference: {} is a sweep", options.run.display()),
                "give the folder of one of its runs: only the figures of a run have them",
            ));
        }
        let mut figures = crate::trends::sweep_figures(&options.run, &sweep);
        if !options.with.is_empty() {
            let (name, figure) = compared(options, &sweep)?;
            figures.retain(|(known, _)| *known != name);
            figures.push((name, figure));
        }
        let figures = figures.into_iter().map(|(stem, figure)| (stem, String::new(), figure));
        (sweep_folder::name(&options.run), options.run.clone(), figures.collect::<Vec<_>>())
    } else if !options.with.is_empty() {
        return Err(Error::option(
            format!("--with: {} is no sweep", options.run.display()),
            "only the creep-force curves of sweeps are drawn beside one another",
        ));
    } else {
        let (paths, mut against) = basis(&options.run, &options.basis, Depth::Read)?;
        let choice = Choice {
            instants: options.at.clone(),
            probes: options.probes.clone(),
            reference: options.reference,
        };
        let figures = crate::figures::figures(&paths, &mut against, window, &choice)?;
        let figures =
            figures.into_iter().map(|n| (n.stem.to_owned(), n.about.to_owned(), n.figure));
        (against.name, paths.folder, figures.collect())
    };
    let folder = options.out.clone().unwrap_or_else(|| folder.join("figures"));
    let formats = match &options.format[..] {
        [] => &[Format::Svg, Format::Png],
        some => some,
    };
    let mut drawn = Drawn { name, figures: Vec::new() };
    for (name, about, figure) in figures {
        let mut files = Vec::new();
        for format in formats {
            let path = figure.write_as(&folder, &name, *format, &paper).map_err(PostError::from)?;
            files.push(path.display().to_string());
        }
        drawn.figures.push(DrawnFigure { name, about, files });
    }
    Ok(drawn)
}

/// The creep-force curves of the sweep beside those of `with`, with the figure's name.
fn compared(
    options: &PlotOptions,
    result: &SweepResult,
) -> Result<(String, crate::chart::Figure), Error> {
    let mut others = Vec::new();
    for folder in &options.with {
        if !folder.exists() {
            let problem = format!("--with {}: there is no such file or folder", folder.display());
            return Err(Error::plain(problem));
        }
        let Some(other) = sweep_folder::read(folder)? else {
            return Err(Error::option(
                format!("--with: {} is no sweep", folder.display()),
                "give the folder of a sweep, which holds sweep.json",
            ));
        };
        others.push((folder, other));
    }
    let all: Vec<ComparedSweep<'_>> = std::iter::once((&options.run, result))
        .chain(others.iter().map(|(folder, other)| (*folder, other)))
        .map(|(folder, result)| ComparedSweep { name: sweep_folder::name(folder), folder, result })
        .collect();
    crate::trends::creep_force_figure(&all).ok_or_else(|| {
        Error::option(
            "--with: no sweep has two values of drive.creepage",
            "only creep-force curves are drawn beside one another: sweep drive.creepage",
        )
    })
}
