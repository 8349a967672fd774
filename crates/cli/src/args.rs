//! The options that all commands share.

use clap::ArgAction;
use serde::Serialize;

use crate::report;
use crate::stop::Stop;
use crate::terminal;

// No doc comment here: clap would show it as the help of the whole program.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Print exactly one JSON document on standard output, everything else on standard error
    #[arg(long, global = true)]
    pub json: bool,
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Say more (-vv still more)
    #[arg(short, long, global = true, action = ArgAction::Count)]
    pub verbose: u8,
    /// Read the command line, and the case or sweep that it runs, and stop there: how the commands of
    /// the documents are checked
    #[arg(long, global = true, hide = true)]
    pub check_args: bool,
    /// Ctrl-C and SIGTERM.
    #[arg(skip)]
    pub stop: Stop,
}

impl Args {
    /// Shows the results of a command: their document with `--json`, else a page to read.
    pub fn show(&self, document: &impl Serialize, page: impl FnOnce() -> String) {
        if self.json {
            report::print_json(document);
        } else if !self.quiet {
            terminal::print(page().as_bytes());
        }
    }

    /// The words of `--json` and `--quiet`, for a program that does a command.
    pub fn shared(&self) -> impl Iterator<Item = &'static str> {
        let flags = [("--json", self.json), ("--quiet", self.quiet)];
        flags.into_iter().filter(|(_, given)| *given).map(|(flag, _)| flag)
    }

    /// Says a remark beside the results.
    pub fn say(&self, line: &str) {
        if !self.quiet {
            terminal::message(line);
        }
    }
}
