//! The page that lists the runs of a folder.

use super::{end, escape, head, number};
use crate::check::digits::digits;
use serde_json::Value;
use std::fmt::Write;

/// A run of a folder.
#[derive(Clone, Debug)]
pub struct ListedRun {
    /// The name of its folder.
    pub name: String,
    /// Its `summary.json`.
    pub summary: Value,
    /// Whether its folder has a page of its own, `report.html`.
    pub page: bool,
}

/// Means that the list shows: label, place in the summary, factor to the unit.
const MEANS: [(&str, &str, f64); 4] = [
    ("T/N", "/contact/traction_coefficient", 1.0),
    ("creepage (10\u{207b}\u{b3})", "/contact/creepage", 1e3),
    ("peak pressure (MPa)", "/contact/peak_pressure", 1e-6),
    ("wall time (s)", "/wall_s", 1.0),
];

/// The HTML page that lists `runs` of the folder called `name`, with links to those that have pages.
pub fn runs_page(name: &str, runs: &[ListedRun]) -> String {
    let mut out = head(name);
    let _ = write!(
        out,
        "<h1>Runs in {}</h1>\n<div class=\"wide\"><table>\n<tr><th>run</th>",
        escape(name)
    );
    out.push_str("<th>status</th>");
    for (label, ..) in MEANS {
        let _ = write!(out, "<th class=\"n\">{label}</th>");
    }
    out.push_str("</tr>\n");
    for run in runs {
        let name = escape(&run.name);
        let shown =
            if run.page { format!("<a href=\"{name}/report.html\">{name}</a>") } else { name };
        let status = escape(run.summary["status"].as_str().unwrap_or("unknown"));
        let _ = write!(out, "<tr><td>{shown}</td><td>{status}</td>");
        for (_, place, factor) in MEANS {
            let value = number(&run.summary, place).map(|value| digits(factor * value, 4));
            let _ = write!(out, "<td class=\"n\">{}</td>", value.unwrap_or_default());
        }
        out.push_str("</tr>\n");
    }
    let _ = writeln!(
        out,
        "</table></div>\n<p>A run with a link has a page: <code>creepage report RUN</code> makes one. Made by \
         Creepage {}.</p>",
        env!("CARGO_PKG_VERSION")
    );
    end(&mut out);
    out
}
