//! Verification problems beside their references, as tables to read.

use std::fmt::Write;

use creepage::{Problem, Row, Verified};

use super::layout::text as word;

/// What closes the tables, or the names of all problems.
pub fn text(found: &Verified) -> String {
    if let Some(problems) = found.document["problems"].as_array() {
        let names = problems.iter().map(|p| word(p, "/name").len());
        let width = names.max().unwrap_or(0);
        let line = |p| format!("{:<width$}  {}\n", word(p, "/name"), word(p, "/about"));
        return problems.iter().map(line).collect();
    }
    let passed = found.rows.iter().filter(|row| row.pass).count();
    format!("{passed} of {} quantities within their limits\n", found.rows.len())
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
