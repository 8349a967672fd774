//! `creepage verify`: starts `creepage-verify`, the program of the verification problems, beside this one.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::Command;
use std::sync::atomic::Ordering;
use std::time::Duration;

use creepage::{Error, FailureResult, INTERRUPTED};

use crate::args::Args;
use crate::report;

/// Which problems to run, and how.
#[derive(Debug, clap::Args)]
pub struct VerifyArgs {
    /// Problems to run [default: all]
    #[arg(value_name = "NAME")]
    names: Vec<String>,
    /// Name all problems and run none
    #[arg(long, conflicts_with_all = ["names", "quick", "plot"])]
    list: bool,
    /// Coarse meshes, for continuous integration
    #[arg(long)]
    quick: bool,
    /// Draw error over mesh size (convergence.svg, .png) and rupture times (rupture.svg, .png) in this folder
    #[arg(long, value_name = "FOLDER")]
    plot: Option<PathBuf>,
}

impl VerifyArgs {
    /// The words for the other program.
    fn words(&self, args: &Args) -> Vec<OsString> {
        let flags = [
            ("--list", self.list),
            ("--quick", self.quick),
            ("--json", args.json),
            ("--quiet", args.quiet),
        ];
        let mut words: Vec<OsString> =
            flags.into_iter().filter(|(_, given)| *given).map(|(flag, _)| flag.into()).collect();
        if let Some(folder) = &self.plot {
            words.extend(["--plot".into(), folder.into()]);
        }
        words.push("--".into());
        words.extend(self.names.iter().map(OsString::from));
        words
    }
}

/// How often the other program is looked at.
const POLL: Duration = Duration::from_millis(20);

/// Runs the verification problems and returns the exit code of the program that does.
///
/// # Errors
/// Where that program is not beside this one, with the command that gets it.
pub fn command(args: &Args, options: &VerifyArgs) -> Result<u8, Error> {
    let program = beside_this_one().ok_or_else(|| Error::Option {
        problem: "the verification problems are a program of their own, creepage-verify, which is not beside this one"
            .to_owned(),
        help: Some(
            "`cargo run --release -p verification` in the sources builds and runs it".to_owned(),
        ),
    })?;
    let stop = args.stop.in_order("\nstopping");
    args.stop.hears();
    let failed = |error| Error::System(format!("{} cannot be run: {error}", program.display()));
    let mut child = Command::new(&program).args(options.words(args)).spawn().map_err(failed)?;
    loop {
        let ended = child.try_wait().map_err(failed)?;
        // Ctrl-C in a terminal ends both programs, the other without a code
        if let Some(code) = ended.and_then(|status| status.code()) {
            return Ok(code as u8);
        }
        if ended.is_some() || stop.load(Ordering::SeqCst) {
            break;
        }
        std::thread::sleep(POLL);
    }
    // it holds nothing half done; where it has ended by itself there is nothing to kill
    let _ = child.kill();
    child.wait().map_err(failed)?;
    if args.json {
        report::print_json(&FailureResult::new("interrupted", INTERRUPTED, ""));
    }
    Ok(INTERRUPTED)
}

/// `creepage-verify` in the folder of this program.
fn beside_this_one() -> Option<PathBuf> {
    let this = std::env::current_exe().ok()?;
    let name = format!("creepage-verify{}", std::env::consts::EXE_SUFFIX);
    Some(this.with_file_name(name)).filter(|program| program.is_file())
}
