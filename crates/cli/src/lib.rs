//! The command line: its options, what it prints, and how Ctrl-C ends it. What it does is in the crate `creepage`.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod args;
mod commands;
mod manual;
#[cfg_attr(not(feature = "mpi"), path = "without_mpi.rs")]
mod mpi;
mod processes;
mod progress;
mod render;
mod report;
mod run;
mod stop;
mod terminal;
mod verify;

use std::ffi::OsString;
#[cfg(unix)]
use std::sync::{Arc, atomic::AtomicBool};

use clap::Parser;
use creepage::{BAD_INPUT, Error, FailureResult};
use miette::Report;
use tracing_subscriber::filter::LevelFilter;

use args::Args;
use commands::Line;
use processes::Process;

/// Runs the command that `words` write, the first of which is the program's name, for the terminal; returns
/// the exit code.
pub fn main(words: impl IntoIterator<Item = OsString>) -> u8 {
    let words: Vec<_> = words.into_iter().collect();
    let process = Process::of_several();
    let speaks = process.is_none_or(Process::speaks);
    let mut line = match Line::try_parse_from(&words) {
        Ok(line) => line,
        Err(_) if !speaks => return BAD_INPUT,
        Err(error) => return usage(&error, &words),
    };
    let args = &line.args;
    set_up_messages(args);
    let json = args.json;
    if let Some(process) = process
        && !speaks
    {
        return stop::leave_to_the_first()
            .map_or_else(show_error, |()| process.assist(&line.command));
    }
    let done = full_disks_are_errors().and_then(|()| stop::Stop::listening(json));
    let done = done.and_then(|stop| {
        let universe = process.map(|process| process.join(&line.command)).transpose()?;
        if let Some(universe) = &universe {
            processes::lead(universe, &mut line.command);
        }
        line.args.stop = stop;
        let done = commands::dispatch(&line);
        // the others hear that the run has ended before MPI does
        drop(line);
        done
    });
    printed(done.unwrap_or_else(|error| {
        if json {
            report::print_json(&FailureResult::of(&error, error.exit_code()));
        }
        show_error(error)
    }))
}

/// Shows an error and returns its exit code.
fn show_error(error: Error) -> u8 {
    let code = error.exit_code();
    terminal::message(&format!("{:?}", Report::new(error)));
    code
}

/// The exit code of a command that ended with `code`, by whether standard output took what it printed.
fn printed(code: u8) -> u8 {
    let Some(cause) = terminal::failure() else { return code };
    let failed = show_error(Error::Option {
        problem: format!("standard output cannot be written: {cause}"),
        help: Some(
            "make room where it goes, and print again; files that the command wrote are complete"
                .into(),
        ),
    });
    if code == 0 { failed } else { code }
}

/// A file that reaches the limit of a file's size (`ulimit -f`) is one that cannot be written, as on a full
/// disk: the system would else end the program without a word.
#[cfg(unix)]
fn full_disks_are_errors() -> Result<(), Error> {
    use signal_hook::{consts::SIGXFSZ, flag::register};
    // the flag is nobody's: the call that was refused tells
    let unheard = Arc::new(AtomicBool::new(false));
    let failed = |error| Error::System(format!("the handler of SIGXFSZ cannot be set: {error}"));
    register(SIGXFSZ, unheard).map(drop).map_err(failed)
}

#[cfg(not(unix))]
fn full_disks_are_errors() -> Result<(), Error> {
    Ok(())
}

/// The document of wrong usage, from the text for the terminal: the first paragraph says what was wrong, the others
/// what to do.
fn wrong_usage(text: &str) -> FailureResult {
    let (error, help) = text.split_once("\n\n").unwrap_or((text, ""));
    let words: Vec<_> = error.trim_start_matches("error: ").split_whitespace().collect();
    FailureResult::new(&words.join(" "), BAD_INPUT, help.trim())
}

/// Help and version that were asked for, or wrong usage.
fn usage(error: &clap::Error, words: &[OsString]) -> u8 {
    let wanted = words.iter().any(|word| word == "--json");
    if error.use_stderr() && wanted {
        report::print_json(&wrong_usage(&error.render().to_string()));
    }
    let printed_error = error.print();
    if error.use_stderr() {
        return BAD_INPUT;
    }
    terminal::note(printed_error);
    printed(0)
}

fn set_up_messages(args: &Args) {
    // The hook is set once, before any report is made; a second setting could only be a mistake
    // of this program, and the default handler would still show the message.
    let _ = miette::set_hook(Box::new(|_| {
        Box::new(miette::MietteHandlerOpts::new().wrap_lines(false).context_lines(1).build())
    }));
    let level = match (args.quiet, args.verbose) {
        (true, _) => LevelFilter::ERROR,
        (false, 0) => LevelFilter::WARN,
        (false, 1) => LevelFilter::INFO,
        (false, _) => LevelFilter::DEBUG,
    };
    tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(|| terminal::Messages)
        .with_target(false)
        .without_time()
        .init();
}
