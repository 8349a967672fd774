//! `creepage verify`: starts `creepage-verify`, the program of the verification problems, beside this one.

use std::path::PathBuf;
use std::process::Command;
use std::sync::atomic::Ordering;
use std::time::Duration;

use creepage::{Error, FailureResult, INTERRUPTED, VerifyOptions};

use crate::args::Args;
use crate::report;

/// How often the other program is looked at.
const POLL: Duration = Duration::from_millis(20);

/// Runs the verification problems and returns the exit code of the program that does.
///
/// # Errors
/// Where that program is not beside this one, with the command that gets it.
pub fn command(args: &Args, options: &VerifyOptions) -> Result<u8, Error> {
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
    let mut child =
        Command::new(&program).args(args.shared()).args(options.words()).spawn().map_err(failed)?;
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
