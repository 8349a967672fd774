//! What a command prints when its work is done.

mod bench;
mod check;
mod compare;
mod layout;
mod mesh;
mod run;
mod sweep;

use std::io::Write;
use std::path::Path;

use serde_json::Value;

/// Prints one JSON document on standard output.
pub fn print_json(document: &Value) {
    // Pretty-printing a value cannot fail; a reader that closed the pipe wants no more.
    let text = serde_json::to_string_pretty(document).unwrap_or_default();
    let _ = writeln!(std::io::stdout(), "{text}");
}

/// Prints a run's summary and how to look at its results.
pub fn print_run(summary: &Value, folder: &Path) {
    print(&run::text(summary, folder));
}

/// Prints what `creepage mesh` found.
pub fn print_mesh(report: &Value) {
    print(&mesh::text(report));
}

/// Prints what `creepage check` found.
pub fn print_check(document: &Value) {
    print(&check::text(document));
}

/// Prints how far runs differ.
pub fn print_compare(document: &Value) {
    print(&compare::text(document));
}

/// Prints the runs of a sweep.
pub fn print_sweep(results: &Value, folder: &Path, page: &Path) {
    print(&sweep::text(results, folder, page));
}

/// Prints what `creepage bench` measured.
pub fn print_bench(report: &Value) {
    print(&bench::text(report));
}

fn print(text: &str) {
    let _ = write!(std::io::stdout(), "{text}");
}
