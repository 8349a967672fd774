//! The three-dimensional picture of a run, and a film.

use std::path::PathBuf;

use crate::chart::{Film, FilmError, FilmFormat};
use crate::render::{Drawable, Quantity, Rendering, View, Wanted};
use crate::run::folder::RUN_FILES;
use serde::Deserialize;
use serde_json::{Value, json};

use crate::Error;
#[cfg(feature = "clap")]
use crate::commands::values::words::{drawable, quantity, view};
use crate::commands::values::{FRAMES, MAGNIFY, SPAN, TIME, WIDTH, exclude, parsed};

/// What to draw.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct RenderOptions {
    /// Folder of a run
    #[cfg_attr(feature = "clap", arg(value_name = "RUN"))]
    pub run: PathBuf,
    /// Draw the record nearest to this time (s) [default: the last]; a film shows all records
    #[cfg_attr(feature = "clap", arg(long, value_name = "S", allow_negative_numbers = true,
        value_parser = |text: &str| TIME.read(text)))]
    pub time: Option<f64>,
    /// What the colours show: von_mises, velocity or deformation of the bodies, pressure, shear or slip_velocity of
    /// the contact surfaces [default: the first that the run has]
    #[serde(deserialize_with = "parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "FIELD", value_parser = quantity))]
    pub field: Option<Quantity>,
    /// The bodies (fields) or the contact surfaces (contact) [default: that which --field is of, or fields]
    #[serde(deserialize_with = "parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "fields|contact", value_parser = drawable))]
    pub what: Option<Drawable>,
    /// View of the bodies [default: both, side by side]
    #[serde(deserialize_with = "parsed")]
    #[cfg_attr(feature = "clap", arg(long, value_name = "whole|contact|both", value_parser = view))]
    pub view: Option<View>,
    /// The picture, or the film [default: render.png in that folder, of contact surfaces render-contact.png]
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.png|FILE.gif|FILE.mp4"))]
    pub out: Option<PathBuf>,
    /// How many times larger deformation is drawn [default: a round number that shows it]
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIMES", value_parser = |text: &str| MAGNIFY.read(text)))]
    pub magnify: Option<f64>,
    /// Side of what a view of the contact shows (m) [default: some patches]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M", value_parser = |text: &str| SPAN.read(text)))]
    pub span: Option<f64>,
    /// Width (pixels) [default: 1600, of a GIF 1000]
    #[cfg_attr(feature = "clap", arg(long, value_name = "PIXELS", value_parser = |text: &str| WIDTH.read(text)))]
    pub width: Option<u32>,
    /// At most so many pictures in a film, evenly spread over the records [default: all]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N", value_parser = |text: &str| FRAMES.read(text)))]
    pub frames: Option<usize>,
}

/// How long a picture of a film is shown (hundredths of a second).
const DELAY: u16 = 10;

/// Draws the bodies or the contact surfaces of a run at one time, or as a film, and returns the document of
/// `creepage render --json`: file, field, label and top of the colours, magnifications, times (s).
///
/// # Errors
/// Options that do not go together; records that cannot be read or lack the field; a file that cannot be written, or
/// is not to be written over.
pub fn render(options: &RenderOptions) -> Result<Value, Error> {
    let out = options.out.clone().unwrap_or_else(|| {
        options.run.join(if of_contact(options) { "render-contact.png" } else { "render.png" })
    });
    let format = FilmFormat::of(&out)?;
    check(options, format)?;
    let wanted = Wanted {
        what: options.what,
        quantity: options.field,
        view: options.view.unwrap_or_default(),
        magnify: options.magnify,
        span: options.span,
    };
    let inputs = RUN_FILES.map(|file| options.run.join(file));
    let width = options.width.unwrap_or(if format == FilmFormat::Gif { 1000 } else { 1600 });
    let mut rendering = Rendering::open(&options.run, &wanted)?;
    let records = records(options, &rendering, format);
    let mut film = Film::create(&out, width, DELAY, &inputs)?;
    rendering.scale_to(&records)?;
    for &record in &records {
        film.add(&rendering.picture(record)?)?;
    }
    film.end()?;
    let (label, top) = rendering.colours();
    let times: Vec<f64> = records.iter().map(|&record| rendering.times()[record]).collect();
    Ok(json!({
        "file": out.display().to_string(),
        "field": rendering.quantity().name(),
        "label": label,
        "top": top,
        "magnifications": rendering.magnifications(),
        "times": times,
        "records": rendering.times().len(),
    }))
}

/// Refuses values out of their range, and options that do not go together.
fn check(options: &RenderOptions, format: FilmFormat) -> Result<(), Error> {
    TIME.check("--time", options.time.as_ref())?;
    MAGNIFY.check("--magnify", options.magnify.as_ref())?;
    SPAN.check("--span", options.span.as_ref())?;
    WIDTH.check("--width", options.width.as_ref())?;
    FRAMES.check("--frames", options.frames.as_ref())?;
    let film = format.is_film();
    exclude(("--time", options.time.is_some()), &[("a film, which shows all records", film)])?;
    exclude(("--frames", options.frames.is_some()), &[("a picture (.png)", !film)])?;
    if let (Some(what), Some(field)) = (options.what, options.field)
        && field.of() != what
    {
        let names: Vec<_> = what.quantities().map(Quantity::name).collect();
        return Err(Error::option(
            format!("--field {}: --what {} does not have it", field.name(), what.name()),
            format!("it has {}", names.join(", ")),
        ));
    }
    let surfaces = of_contact(options);
    exclude(("--view", options.view.is_some()), &[("contact surfaces, which have one", surfaces)])
}

/// Whether the contact surfaces are drawn, not the bodies.
fn of_contact(options: &RenderOptions) -> bool {
    options.what.or(options.field.map(Quantity::of)) == Some(Drawable::Contact)
}

/// The records that are drawn.
fn records(options: &RenderOptions, rendering: &Rendering, format: FilmFormat) -> Vec<usize> {
    let count = rendering.times().len();
    match (format.is_film(), options.time) {
        (false, Some(time)) => vec![rendering.nearest(time)],
        (false, None) => vec![count - 1],
        (true, _) => spread(count, options.frames.unwrap_or(count)),
    }
}

/// At most `most` of `count` indices, evenly spread, with the last and, of several, the first.
fn spread(count: usize, most: usize) -> Vec<usize> {
    let taken = most.clamp(1, count.max(1));
    let last = count.saturating_sub(1);
    (0..taken).map(|i| if taken == 1 { last } else { i * last / (taken - 1) }).collect()
}

impl From<FilmError> for Error {
    fn from(error: FilmError) -> Self {
        let (problem, help) = (format!("--out {error}"), error.remedy());
        match help {
            Some(help) => Self::option(problem, help),
            None => Self::plain(error.to_string()),
        }
    }
}

impl From<crate::render::RenderError> for Error {
    fn from(error: crate::render::RenderError) -> Self {
        Self::Option { problem: error.to_string(), help: error.remedy() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(options: RenderOptions, said: &str) {
        let error = render(&options).unwrap_err();
        assert!(error.to_string().contains(said) && error.exit_code() == 2, "{error}");
    }

    #[test]
    fn options_that_do_not_go_together_are_refused() {
        let film = RenderOptions { out: Some("film.gif".into()), ..RenderOptions::default() };
        refused(
            RenderOptions { time: Some(1e-3), ..film.clone() },
            "--time cannot be used with a film",
        );
        refused(RenderOptions { frames: Some(0), ..film.clone() }, "--frames: a whole number");
        refused(RenderOptions { width: Some(1), ..film.clone() }, "--width: a whole number");
        refused(RenderOptions { magnify: Some(f64::NAN), ..film.clone() }, "--magnify: a number");
        refused(
            RenderOptions { out: Some("film.avi".into()), ..film },
            "must end in .png, .gif or .mp4",
        );
        let picture = RenderOptions::default();
        refused(
            RenderOptions { frames: Some(9), ..picture.clone() },
            "--frames cannot be used with a picture",
        );
        let pressure = RenderOptions { field: Some(Quantity::Pressure), ..picture };
        refused(
            RenderOptions { what: Some(Drawable::Fields), ..pressure.clone() },
            "--field pressure: --what fields does not have it",
        );
        refused(
            RenderOptions { view: Some(View::Whole), ..pressure },
            "--view cannot be used with contact",
        );
    }

    #[test]
    fn records_are_spread_from_the_first_to_the_last() {
        assert_eq!(spread(5, 5), [0, 1, 2, 3, 4]);
        assert_eq!(spread(41, 3), [0, 20, 40]);
        assert_eq!(spread(4, 1), [3]);
        assert_eq!(spread(1, 9), [0]);
    }
}
