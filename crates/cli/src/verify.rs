//! `creepage verify` at the command line.

use creepage::{Error, Listener, Problem, Row, VerifyOptions};

use crate::args::Args;
use crate::report::verify::{rows, text};
use crate::terminal;

/// The options of the command.
pub type VerifyArgs = VerifyOptions;

/// Runs verification problems, shows each as it is done, and returns the exit code.
pub fn command(args: &Args, options: &VerifyArgs) -> Result<u8, Error> {
    let found = creepage::verify(options, &mut VerifyWatch(args))?;
    args.show(&found.document, || text(&found));
    Ok(found.exit_code())
}

/// Shows the verification problems as they are done, and leaves Ctrl-C to end them at once.
struct VerifyWatch<'a>(&'a Args);

impl Listener for VerifyWatch<'_> {
    fn remark(&mut self, line: &str) {
        self.0.say(line);
    }

    fn verified(&mut self, problem: &Problem, found: &[Row], seconds: f64) {
        if !self.0.json && !self.0.quiet {
            terminal::print(rows(problem, found, seconds).as_bytes());
        }
    }
}
