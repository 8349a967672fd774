//! `creepage render`: pictures and films are drawn by PyVista, through the Python package.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use creepage::Error;

use crate::args::Args;

/// What to draw; the Python package judges the values.
#[derive(Debug, clap::Args)]
pub struct RenderArgs {
    /// Folder of a run
    #[arg(value_name = "RUN")]
    run: PathBuf,
    /// Draw the record nearest to this time (s) [default: the last]; a film shows all records
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    time: Option<OsString>,
    /// What the colours show: von_mises, velocity or deformation of the bodies, pressure, shear or slip_velocity of
    /// the contact surfaces [default: the first that the run has]
    #[arg(long, value_name = "FIELD")]
    field: Option<OsString>,
    /// The bodies (fields) or the contact surfaces (contact) [default: that which --field is of, or fields]
    #[arg(long, value_name = "fields|contact")]
    what: Option<OsString>,
    /// View of the bodies [default: both, side by side]
    #[arg(long, value_name = "whole|contact|both")]
    view: Option<OsString>,
    /// The picture, or the film [default: render.png in that folder, of contact surfaces render-contact.png]
    #[arg(long, value_name = "FILE.png|FILE.gif|FILE.mp4")]
    out: Option<OsString>,
    /// How many times larger deformation is drawn [default: a round number that shows it]
    #[arg(long, value_name = "TIMES")]
    magnify: Option<OsString>,
    /// Height of what a view of the contact shows (m) [default: some patches]
    #[arg(long, value_name = "M")]
    span: Option<OsString>,
    /// Width (pixels) [default: 1600, of a GIF 1000]
    #[arg(long, value_name = "PIXELS")]
    width: Option<OsString>,
    /// At most so many pictures in a film, evenly spread over the records [default: all]
    #[arg(long, value_name = "N")]
    frames: Option<OsString>,
}

impl RenderArgs {
    /// The words for Python.
    fn words(&self, args: &Args) -> Vec<OsString> {
        let mut words = vec!["-m".into(), "creepage".into(), "render".into()];
        let flags = [("--json", args.json), ("--quiet", args.quiet)];
        words.extend(flags.iter().filter(|(_, given)| *given).map(|(flag, _)| flag.into()));
        let options = [
            ("--time=", &self.time),
            ("--field=", &self.field),
            ("--what=", &self.what),
            ("--view=", &self.view),
            ("--out=", &self.out),
            ("--magnify=", &self.magnify),
            ("--span=", &self.span),
            ("--width=", &self.width),
            ("--frames=", &self.frames),
        ];
        for (name, value) in options {
            words.extend(value.as_ref().map(|value| {
                let mut word = OsString::from(name);
                word.push(value);
                word
            }));
        }
        words.extend(["--".into(), self.run.clone().into()]);
        words
    }
}

/// Has the Python package draw the run and returns its exit code.
///
/// # Errors
/// Where no Python has the package, with the command that installs it.
pub fn command(args: &Args, options: &RenderArgs) -> Result<u8, Error> {
    let has_package = |python: &&str| {
        let mut ask = Command::new(python);
        ask.args(["-c", "import creepage"]).stdin(Stdio::null());
        ask.stdout(Stdio::null()).stderr(Stdio::null());
        ask.status().is_ok_and(|status| status.success())
    };
    let python = ["python3", "python"].into_iter().find(has_package).ok_or_else(|| Error::Option {
        problem: "pictures and films are drawn by PyVista, through the Python package creepage, which no Python on the \
                  path has"
            .to_owned(),
        help: Some(
            "pip install 'creepage[render]' installs both; `creepage view` needs neither and shows the run in a \
             browser"
                .to_owned(),
        ),
    })?;
    let status = Command::new(python).args(options.words(args)).status();
    let status =
        status.map_err(|error| Error::System(format!("{python} cannot be run: {error}")))?;
    // Ctrl-C in a terminal ends both programs, the other perhaps without a code
    Ok(status.code().map_or(creepage::INTERRUPTED, |code| code as u8))
}
