//! The options that all commands share.

use std::ffi::OsString;
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::ArgAction;
use serde_json::Value;

use crate::embedded::{Embedded, Told};
use crate::report;
use crate::stop::Stop;

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
    /// The program that holds this command.
    #[arg(skip)]
    pub embedded: Option<Embedded>,
    /// The program, and its first arguments, that does the runs of a sweep; empty for this one.
    #[arg(skip)]
    pub program: Vec<OsString>,
    /// Ctrl-C and SIGTERM.
    #[arg(skip)]
    pub stop: Stop,
}

impl Args {
    /// Hands over the document of `--json`.
    pub fn print_json(&self, document: &Value) {
        match &self.embedded {
            Some(embedded) => (embedded.tell)(Told::Document(document.clone())),
            None => report::print_json(document),
        }
    }

    /// Says a remark beside the results.
    pub fn say(&self, line: &str) {
        match &self.embedded {
            Some(embedded) => (embedded.tell)(Told::Said(line.to_owned())),
            // A closed standard error is no reason to panic.
            None if !self.quiet => drop(writeln!(std::io::stderr(), "{line}")),
            None => {}
        }
    }

    /// Tells the program that holds this command, if one does.
    pub fn tell(&self, told: impl FnOnce() -> Told) {
        if let Some(embedded) = &self.embedded {
            (embedded.tell)(told());
        }
    }
}

/// The flag that ends a command in order: at the first Ctrl-C or SIGTERM, or by the program that holds
/// it.
pub fn stop_flag(args: &Args) -> Arc<AtomicBool> {
    match &args.embedded {
        Some(embedded) => Arc::clone(&embedded.stop),
        None => args.stop.in_order(),
    }
}
