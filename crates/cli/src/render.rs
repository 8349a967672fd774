//! `creepage render`: pictures and films are drawn by PyVista, through the Python package.

use creepage::{Error, RenderOptions, python};

use crate::args::Args;

/// Has the Python package draw the run and returns its exit code.
///
/// # Errors
/// Where no Python has the package, with the command that installs it.
pub fn command(args: &Args, options: &RenderOptions) -> Result<u8, Error> {
    let mut command = python::with_package().ok_or_else(|| Error::Option {
        problem: "pictures and films are drawn by PyVista, through the Python package creepage, which no Python on the \
                  path has"
            .to_owned(),
        help: Some(
            "pip install 'creepage[render]' installs both; `creepage view` needs neither and shows the run in a \
             browser"
                .to_owned(),
        ),
    })?;
    command.args(["-m", "creepage", "render"]).args(args.shared()).args(options.words());
    let status = command.status();
    let status = status.map_err(|error| Error::System(format!("Python cannot be run: {error}")))?;
    // Ctrl-C in a terminal ends both programs, the other perhaps without a code
    Ok(status.code().map_or(creepage::INTERRUPTED, |code| code as u8))
}
