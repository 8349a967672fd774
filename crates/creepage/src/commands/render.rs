//! Pictures and films of a run, which the Python package draws, by PyVista.

use std::ffi::OsString;
use std::path::PathBuf;

use serde::Deserialize;

/// What to draw. Values are the words that were given: the Python package judges them.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct RenderOptions {
    /// Folder of a run
    #[cfg_attr(feature = "clap", arg(value_name = "RUN"))]
    pub run: PathBuf,
    /// Draw the record nearest to this time (s) [default: the last]; a film shows all records
    #[cfg_attr(feature = "clap", arg(long, value_name = "S", allow_negative_numbers = true))]
    pub time: Option<String>,
    /// What the colours show: von_mises, velocity or deformation of the bodies, pressure, shear or slip_velocity of
    /// the contact surfaces [default: the first that the run has]
    #[cfg_attr(feature = "clap", arg(long, value_name = "FIELD"))]
    pub field: Option<String>,
    /// The bodies (fields) or the contact surfaces (contact) [default: that which --field is of, or fields]
    #[cfg_attr(feature = "clap", arg(long, value_name = "fields|contact"))]
    pub what: Option<String>,
    /// View of the bodies [default: both, side by side]
    #[cfg_attr(feature = "clap", arg(long, value_name = "whole|contact|both"))]
    pub view: Option<String>,
    /// The picture, or the film [default: render.png in that folder, of contact surfaces render-contact.png]
    #[cfg_attr(feature = "clap", arg(long, value_name = "FILE.png|FILE.gif|FILE.mp4"))]
    pub out: Option<PathBuf>,
    /// How many times larger deformation is drawn [default: a round number that shows it]
    #[cfg_attr(feature = "clap", arg(long, value_name = "TIMES"))]
    pub magnify: Option<String>,
    /// Height of what a view of the contact shows (m) [default: some patches]
    #[cfg_attr(feature = "clap", arg(long, value_name = "M"))]
    pub span: Option<String>,
    /// Width (pixels) [default: 1600, of a GIF 1000]
    #[cfg_attr(feature = "clap", arg(long, value_name = "PIXELS"))]
    pub width: Option<String>,
    /// At most so many pictures in a film, evenly spread over the records [default: all]
    #[cfg_attr(feature = "clap", arg(long, value_name = "N"))]
    pub frames: Option<String>,
}

impl RenderOptions {
    /// As words for the Python package.
    pub fn words(&self) -> Vec<OsString> {
        let Self { run, time, field, what, view, out, magnify, span, width, frames } = self;
        let mut words = Vec::new();
        for (name, value) in [
            ("--time=", time),
            ("--field=", field),
            ("--what=", what),
            ("--view=", view),
            ("--magnify=", magnify),
            ("--span=", span),
            ("--width=", width),
            ("--frames=", frames),
        ] {
            words.extend(value.iter().map(|value| OsString::from(format!("{name}{value}"))));
        }
        words.extend(out.iter().map(|out| {
            let mut word = OsString::from("--out=");
            word.push(out);
            word
        }));
        words.extend(["--".into(), run.into()]);
        words
    }
}
