//! `creepage run`.

use creepage::{Error, RunOptions};

use crate::args::Args;
use crate::progress::RunWatch;
use crate::report;
use crate::terminal;

/// Runs a case.
pub fn command(args: &Args, options: &RunOptions) -> Result<u8, Error> {
    let done = creepage::run(options, &mut RunWatch::new(args))?;
    args.show(&done.summary, || {
        report::run::text(&done.summary, &done.folder, done.fluctuating_slip().as_deref())
    });
    if let Some(diagnosis) = done.diagnosis() {
        terminal::message(&format!("stopped: {diagnosis}"));
    }
    if done.interrupted() {
        args.say("interrupted: --resume goes on");
    }
    Ok(done.exit_code())
}
