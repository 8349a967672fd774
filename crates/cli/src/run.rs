//! `creepage run`.

use creepage::{Error, INTERRUPTED, RunOptions};

use crate::args::Args;
use crate::progress::RunWatch;
use crate::report;
use crate::stop::Stop;
use crate::terminal;

/// Options of `run`.
#[derive(Debug, clap::Args)]
pub struct RunArgs {
    #[command(flatten)]
    pub options: RunOptions,
    /// Live as long as standard input is open, and print progress: how a sweep holds its runs
    #[arg(long, hide = true)]
    leash: bool,
}

/// Runs a case.
pub fn command(args: &Args, RunArgs { options, leash }: &RunArgs) -> Result<u8, Error> {
    if *leash {
        hold_leash(args.stop.clone())?;
    }
    let done = creepage::run(options, &mut RunWatch::new(args, *leash))?;
    args.show(&done.document, || {
        report::run::text(&done.document, &done.folder, done.fluctuating_slip().as_deref())
    });
    if let Some(diagnosis) = done.diagnosis() {
        terminal::message(&format!("stopped: {diagnosis}"));
    }
    if done.interrupted() {
        args.say("interrupted: --resume goes on");
    }
    Ok(done.exit_code())
}

/// Ends the run with the process at the other end of standard input: in order where that asks for
/// it, at once where it is gone.
fn hold_leash(stop: Stop) -> Result<(), Error> {
    let held = std::thread::Builder::new().spawn(move || {
        for line in std::io::stdin().lines().map_while(Result::ok) {
            if line == creepage::sweep::schedule::STOP {
                stop.ask();
            }
        }
        std::process::exit(INTERRUPTED.into());
    });
    held.map(drop).map_err(|error| {
        Error::System(format!("the thread that watches the sweep cannot be started: {error}"))
    })
}
