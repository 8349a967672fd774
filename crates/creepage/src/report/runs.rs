//! The page that lists the runs of a folder.

use super::{end, escape, head};
use crate::check::digits::digits;
use output::summary::{Status, Summary};
use std::fmt::Write;

/// A run of a folder.
#[derive(Clone, Debug)]
pub struct ListedRun {
    /// The name of its folder.
    pub name: String,
    /// Its `summary.json`.
    pub summary: Summary,
    /// Whether its folder has a page of its own, `report.html`.
    pub page: bool,
}

/// A number of the list: label, and value in the unit of the label.
type Number = (&'static str, fn(&Summary) -> Option<f64>);

const NUMBERS: [Number; 4] = [
    ("T/N", |s| s.contact.traction_coefficient),
    ("creepage (10\u{207b}\u{b3})", |s| Some(1e3 * s.contact.creepage?)),
    ("peak pressure (MPa)", |s| Some(1e-6 * s.contact.peak_pressure?)),
    ("wall time (s)", |s| s.status.map(|_| s.wall_s)),
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
    for (label, _) in NUMBERS {
        let _ = write!(out, "<th class=\"n\">{label}</th>");
    }
    out.push_str("</tr>\n");
    for run in runs {
        let name = escape(&run.name);
        let shown =
            if run.page { format!("<a href=\"{name}/report.html\">{name}</a>") } else { name };
        let status = run.summary.status.map_or("unknown", Status::word);
        let _ = write!(out, "<tr><td>{shown}</td><td>{status}</td>");
        for (_, of) in NUMBERS {
            let value = of(&run.summary).map(|value| digits(value, 4));
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
