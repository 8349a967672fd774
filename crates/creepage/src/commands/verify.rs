//! The verification problems, which a program of their own runs: `creepage-verify`.

use std::ffi::OsString;
use std::path::PathBuf;

use serde::Deserialize;

/// Which problems to run, and how.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
pub struct VerifyOptions {
    /// Problems to run [default: all]
    #[cfg_attr(feature = "clap", arg(value_name = "NAME"))]
    pub names: Vec<String>,
    /// Name all problems and run none
    #[cfg_attr(feature = "clap", arg(long, conflicts_with_all = ["names", "quick", "plot"]))]
    pub list: bool,
    /// Coarse meshes, for continuous integration
    #[cfg_attr(feature = "clap", arg(long))]
    pub quick: bool,
    /// Draw error over mesh size (convergence.svg, .png) and rupture times (rupture.svg, .png) in this folder
    #[cfg_attr(feature = "clap", arg(long, value_name = "FOLDER"))]
    pub plot: Option<PathBuf>,
}

impl VerifyOptions {
    /// As words for the program.
    pub fn words(&self) -> Vec<OsString> {
        let flags = [("--list", self.list), ("--quick", self.quick)];
        let flags = flags.into_iter().filter(|(_, given)| *given).map(|(flag, _)| flag.into());
        let plot = self.plot.iter().flat_map(|folder| ["--plot".into(), folder.into()]);
        let names = self.names.iter().map(OsString::from);
        flags.chain(plot).chain(["--".into()]).chain(names).collect()
    }
}
