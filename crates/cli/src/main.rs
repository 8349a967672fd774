//! `creepage`: the command line.

mod args;
mod commands;
mod progress;
mod report;

use std::io::Write;
use std::process::ExitCode;

use clap::Parser;

use args::Args;

fn main() -> ExitCode {
    let args = Args::parse();
    set_up_messages(&args);
    match commands::dispatch(&args) {
        Ok(code) => ExitCode::from(code),
        Err(failure) => {
            if args.json {
                // Standard output holds one JSON document whatever happens.
                let document = serde_json::json!({
                    "status": "failed",
                    "exit_code": failure.code,
                    "error": failure.report.to_string(),
                });
                report::print_json(&document);
            }
            // A closed standard error is no reason to panic.
            let _ = writeln!(std::io::stderr(), "{:?}", failure.report);
            ExitCode::from(failure.code)
        }
    }
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
