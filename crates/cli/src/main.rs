//! `creepage`: the command line.

mod args;
mod check;
mod commands;
mod convergence_plot;
mod import_contact;
mod import_k;
mod plot;
mod progress;
mod report;
mod report_page;
mod rupture_plot;
mod slider;
mod sweep;
mod sweep_folder;
mod verify;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

use args::Args;

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        Err(error) => return usage(&error),
    };
    set_up_messages(&args);
    match commands::dispatch(&args) {
        Ok(code) => ExitCode::from(code),
        Err(failure) => {
            if args.json {
                report::print_json(&failure.document());
            }
            // A closed standard error is no reason to panic.
            let _ = writeln!(std::io::stderr(), "{:?}", failure.report);
            ExitCode::from(failure.code)
        }
    }
}

/// Help and version that were asked for, or wrong usage.
fn usage(error: &clap::Error) -> ExitCode {
    let wanted = std::env::args_os().any(|word| word == "--json");
    if error.use_stderr() && wanted {
        let text = error.render().to_string();
        let message = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
        report::print_json(&commands::failure(message, commands::BAD_INPUT));
    }
    let _ = error.print();
    ExitCode::from(if error.use_stderr() { commands::BAD_INPUT } else { 0 })
}

fn set_up_messages(args: &Args) {
    // The hook is set once, before any report is made; a second setting could only be a mistake
    // of this program, and the default handler would still show the message.
    let _ = miette::set_hook(Box::new(|_| {
        Box::new(miette::MietteHandlerOpts::new().wrap_lines(false).context_lines(1).build())
    }));
    let level = match (args.quiet, args.verbose) {
        (true, _) => "error",
        (false, 0) => "warn",
        (false, 1) => "info",
        (false, _) => "debug",
    };
    let filter = tracing_subscriber::EnvFilter::try_from_env("CREEPAGE_LOG")
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new(level));
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_target(false)
        .without_time()
        .init();
}
