//! Verification problems beside their references, as tables to read.

use std::fmt::Write;

use verification::{Problem, Row};

/// The names of problems, and what each verifies.
pub fn names(problems: &[Problem]) -> String {
    let width = problems.iter().map(|problem| problem.name.len()).max().unwrap_or(0);
    let line = |problem: &Problem| format!("{:<width$}  {}\n", problem.name, problem.about);
    problems.iter().map(line).collect()
}

/// What closes the tables.
pub fn count(rows: &[Row]) -> String {
    let passed = rows.iter().filter(|row| row.pass).count();
    format!("{passed} of {} quantities within their limits\n", rows.len())
}

/// The rows of a problem, one line each, and below what they rest on.
pub fn rows(problem: &Problem, rows: &[Row], seconds: f64) -> String {
    let mut page = format!("{} ({seconds:.1} s)\n", problem.name);
    let width = rows.iter().map(|row| row.quantity.chars().count()).max().unwrap_or(0).max(8);
    let _ = writeln!(
        page,
        "  {:<width$}  {:>12} {:>12} {:>9} {:>9}  ",
        "quantity", "reference", "computed", "error", "limit"
    );
    for row in rows {
        let _ = writeln!(
            page,
            "  {:<width$}  {:>12} {:>12} {:>9.1e} {:>9.1e}  {}",
            row.quantity,
            number(row.reference),
            number(row.computed),
            row.error,
            row.limit,
            if row.pass { "pass" } else { "FAIL" }
        );
        for sample in &row.meshes {
            let _ = writeln!(
                page,
                "  {:<width$}  {:>12} {:>12}",
                format!("    h = {}", length(sample.size)),
                "",
                number(sample.value)
            );
        }
    }
    let mut said = Vec::new();
    for row in rows {
        let line = format!("reference: {}; limit: {}", row.source, row.limit_from);
        if !said.contains(&line) {
            let _ = writeln!(page, "  {line}");
            said.push(line);
        }
    }
    page.push('\n');
    page
}

/// A mesh size (m).
fn length(size: f64) -> String {
    if size < 1.0 { format!("{:.4} mm", 1e3 * size) } else { format!("{size} m") }
}

fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        format!("{value:.6}")
    } else {
        format!("{value:.5e}")
    }
}
