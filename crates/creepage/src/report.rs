//! Self-contained HTML pages of a run and of a sweep, with figures inline: no network is needed.

mod foreign;
mod numbers;
mod overview;
mod runs;
mod scene;
mod sweep;
mod verdict;

use crate::check::PostError;
use crate::check::basis::Basis;
use crate::check::digits::{all_digits, digits};
use crate::check::limits::Limit;
use crate::check::patch_series::{PATCH_TABLE, PatchLine, PatchMeasure};
use crate::check::result::{CheckResult, LawUsed, ScaleUsed};
use crate::figures::Named;
use crate::scene::SceneError;
use crate::sweep::plan::quoted;
use output::files::made::PAGE_MARK;
use output::layout::file;
use output::summary::Summary;
use std::fmt::Write;
use std::path::Path;

pub use runs::{ListedRun, runs_page};
pub use sweep::sweep_page;

const STYLE: &str = "
body{font-family:\"DejaVu Sans\",sans-serif;max-width:min(110rem,96vw);margin:2rem auto;padding:0 1rem;
color:#111;line-height:1.45}p,li{max-width:70rem;overflow-wrap:anywhere}
h1{font-size:1.5rem}h2{font-size:1.2rem;margin-top:2.2rem;border-bottom:1px solid #bbb}
table{border-collapse:collapse;margin:.8rem 0;font-size:.85rem}
td,th{padding:.25rem .7rem;border-bottom:1px solid #ddd;text-align:left;vertical-align:top}
td.n,th.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
.wide{overflow-x:auto;background:linear-gradient(to right,#fff 2rem,#fff0) 0/4rem 100%,
linear-gradient(to left,#fff 2rem,#fff0) 100%/4rem 100%,linear-gradient(to right,#0006,#0000) 0/1rem 100%,
linear-gradient(to left,#0006,#0000) 100%/1rem 100%;background-repeat:no-repeat;
background-attachment:local,local,scroll,scroll}.wide td:last-child:not(.n){min-width:14rem}nav a{margin-right:1rem}.csv{font-size:.8rem}
.pass{color:#00573d;font-weight:bold}.fail{color:#a33c00;font-weight:bold}
.springs{color:#6b5600;font-weight:bold}
.note{color:#444}figure{margin:1.2rem 0}svg{width:100%;height:auto;border:1px solid #ddd}
#values{position:fixed;z-index:1;pointer-events:none;background:#fffe;border:1px solid #999;padding:.3rem .6rem;
font-size:.8rem;max-width:90vw}#values i{display:inline-block;width:1em;height:.6em;margin-right:.5em}
#rule{stroke:#999;stroke-width:3;pointer-events:none}
pre{background:#f4f4f4;padding:.8rem;overflow:auto;font-size:.8rem}
@media(max-width:600px){figure{overflow-x:auto}figure svg{min-width:44rem}td,th{padding:.2rem .3rem}
figure:not(.scene)::before{content:\"\u{2194} the figure goes on to the right\";position:sticky;left:0;font-size:.8rem}
.lines table,.lines tbody{display:block}.lines tr{display:grid;grid-template-columns:1fr 5rem 4rem 2.7rem}
.verdicts tr{grid-template-columns:1fr 3rem 8rem}.lines td:last-child{grid-column:1/-1}
.lines th:last-child{display:none}.lines td:not(:last-child){border-bottom:none}}
@media print{body{max-width:none}figure{break-inside:avoid}}";

/// Offers each table as CSV: a link that the browser makes of the table, without a request.
const TABLES: &str = "
for (const table of document.querySelectorAll('table')) {
  const text = cell => '\\\"' + cell.innerText.trim().replaceAll('\\\"', '\\\"\\\"') + '\\\"';
  const rows = [...table.rows].map(row => [...row.cells].map(text).join(','));
  const link = document.createElement('a');
  link.textContent = 'CSV'; link.className = 'csv'; link.download = 'table.csv';
  link.href = 'data:text/csv;charset=utf-8,' + encodeURIComponent(rows.join('\\n'));
  table.after(link);
}";

/// Shows values under the pointer in figures, from the attributes that they have for it.
const VALUES: &str = include_str!("report/values.js");

/// The HTML page of a run in `folder`, from what its check found and its figures.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn run_page(
    basis: &Basis,
    folder: &Path,
    checked: &CheckResult,
    figures: &[Named],
) -> Result<String, PostError> {
    let mut out = head(&basis.name);
    let _ = write!(out, "<h1>{}</h1>\n<p>{}</p>\n", escape(&basis.name), title(basis, checked));
    overview::contents(&mut out);
    overview::section(&mut out, basis, folder, checked);
    out.push_str("<h2 id=\"patch\">The patch</h2>\n");
    patch(&mut out, basis, checked);
    drawn(&mut out, figures, &PATCH_FIGURES)?;
    verdicts(&mut out, checked);
    drawn(&mut out, figures, &CONDITION_FIGURES)?;
    out.push_str("<h2 id=\"details\">Details</h2>\n");
    case(&mut out, basis, checked);
    numbers::section(&mut out, basis);
    energy(&mut out, basis);
    let shown = |stem: &&str| PATCH_FIGURES.contains(stem) || CONDITION_FIGURES.contains(stem);
    let rest: Vec<&str> = figures.iter().map(|named| named.stem).filter(|s| !shown(s)).collect();
    drawn(&mut out, figures, &rest)?;
    reproduce(&mut out, basis, folder);
    overview::data(&mut out, checked);
    end(&mut out);
    Ok(out)
}

/// The page with the scene of the run in `folder` alone.
///
/// # Errors
/// A scene that cannot be read.
pub fn scene_page(folder: &Path) -> Result<String, SceneError> {
    let name = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy().into_owned();
    let mut out = head(&name);
    let _ = writeln!(out, "<h1>{}</h1>", escape(&name));
    out.push_str(&scene::element(folder)?);
    out.push_str("</body>\n</html>\n");
    Ok(out)
}

/// Figures of the section about the patch, and of that about the contact conditions.
const PATCH_FIGURES: [&str; 5] =
    ["figure-3-tractions", "contact-maps", "figure-2-stick-slip", "stress-section", "stress-depth"];
const CONDITION_FIGURES: [&str; 2] = ["figure-4-bound", "figure-7-law"];

/// Appends those of the figures that have these names, in the order of the names.
fn drawn(out: &mut String, figures: &[Named], stems: &[&str]) -> Result<(), PostError> {
    for stem in stems {
        for named in figures.iter().filter(|named| named.stem == *stem) {
            let svg = named.figure.svg_element()?;
            let about = escape(named.about);
            let _ = writeln!(out, "<figure id=\"{stem}\" aria-label=\"{about}\">{svg}</figure>");
        }
    }
    Ok(())
}

/// Ends a page, with its scripts.
fn end(out: &mut String) {
    let _ =
        writeln!(out, "<script>{TABLES}</script>\n<script>\n{VALUES}</script>\n</body>\n</html>");
}

fn head(name: &str) -> String {
    // an empty icon keeps browsers from asking a server for one
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n{PAGE_MARK}\n\
         <title>{}</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n<style>{}{STYLE}</style>\n</head>\n<body>\n",
        escape(name),
        crate::chart::font_face()
    )
}

/// Text as HTML.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// What Hertz's theory gives for a patch measure (SI), where it is known apart from the records.
fn half_space(basis: &Basis, measure: PatchMeasure) -> Option<f64> {
    use PatchMeasure as P;
    let known = [P::HalfLength, P::HalfWidth, P::PeakPressure].contains(&measure);
    basis.hertz(measure.name()).filter(|_| known)
}

/// A mean to the digit that half its 95 % interval leaves it, at most four; to four where it has none.
fn worth(mean: f64, half: Option<f64>) -> String {
    let known = |half: f64| libm::floor(libm::log10(mean.abs() / half)) as i32 + 2;
    let significant = half.filter(|half| *half > 0.0 && mean != 0.0).map_or(4, known);
    digits(mean, significant.clamp(1, 4))
}

fn title(basis: &Basis, checked: &CheckResult) -> String {
    let text = basis.case.as_ref().and_then(|case| case.get("title")).and_then(|t| t.as_str());
    let [from, to] = checked.window.map(|time| digits(1e3 * time, 5));
    format!(
        "{} All means are those from {from} to {to} ms, in {} records.",
        text.map(|text| format!("{}.", escape(text.trim_end_matches('.')))).unwrap_or_default(),
        checked.steps
    )
}

fn verdicts(out: &mut String, checked: &CheckResult) {
    let _ = write!(
        out,
        "<h2 id=\"conditions\">Contact conditions</h2>\n\
         <p>The limits are those of {} methods. The slip velocity paired with a traction is {}. \
         Definitions and scales: docs/checks.md of Creepage.</p>\n\
         <div class=\"wide lines\"><table>\n<tr><th>measure</th><th class=\"n\">value</th><th class=\"n\">limit</th>\
         <th></th><th>what it says</th></tr>\n",
        checked.limits_for,
        checked.pairing.reported.slip()
    );
    for (measure, metric) in &checked.metrics {
        let limit = match metric.limit {
            Some(Limit::Most(most)) => digits(most, 2),
            Some(Limit::Between(low, high)) => {
                format!("{} to {}", all_digits(low), all_digits(high))
            }
            None => String::new(),
        };
        let word = metric.verdict().word().to_lowercase();
        let units = if metric.units == "1" { "" } else { &metric.units };
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td class=\"n\">{} {units}</td><td class=\"n\">{limit}</td>\
             <td class=\"{word}\">{word}</td><td>{}</td></tr>",
            measure.name(),
            metric.value.map_or("\u{2013}".into(), |value| digits(value, 3)),
            escape(&verdict::verdict(*measure, metric))
        );
    }
    out.push_str("</table></div>\n");
    for note in &checked.notes {
        let _ = writeln!(out, "<p class=\"note\">Note: {}.</p>", escape(note));
    }
}

fn case(out: &mut String, basis: &Basis, checked: &CheckResult) {
    out.push_str("<h3>The case</h3>\n<table>\n");
    let mut row = |label: &str, text: String| {
        let _ = writeln!(out, "<tr><td>{label}</td><td>{}</td></tr>", escape(&text));
    };
    let LawUsed { law, mu_static, mu_dynamic, decay, .. } = &checked.law;
    let [mu_static, mu_dynamic, decay] =
        [mu_static, mu_dynamic, decay].map(|value| value.map_or("?".into(), |v| digits(v, 3)));
    match law.as_deref() {
        Some("coulomb") => row("friction", format!("Coulomb, \u{3bc} = {mu_static}")),
        Some(_) => row(
            "friction",
            format!(
                "exponential, falls with the slip speed: \u{3bc}_S = {mu_static}, \u{3bc}_D = {mu_dynamic}, k = {decay} s/m"
            ),
        ),
        None => row("friction", "the coefficient that the data give".into()),
    }
    if let Some(enforcement) = &basis.enforcement {
        row("contact", enforcement.clone());
    }
    for (name, ScaleUsed { value, units, about, from }) in &checked.scales {
        let units = if units == "1" { String::new() } else { format!(" {units}") };
        let value = digits(*value, 5);
        row(&name.replace('_', " "), format!("{value}{units}: {about} (from: {from})"));
    }
    if let Some(Summary { elements, nodes, steps, .. }) = &basis.summary {
        row("model", format!("{elements} elements, {nodes} nodes, {steps} steps"));
    }
    out.push_str("</table>\n");
}

fn patch(out: &mut String, basis: &Basis, checked: &CheckResult) {
    out.push_str(
        "<div class=\"wide\"><table>\n<tr><th>mean over the window</th><th class=\"n\">value</th>\
         <th></th><th class=\"n\">95 % interval</th><th class=\"n\">deviation</th>\
         <th class=\"n\">half-space</th></tr>\n",
    );
    for PatchLine { label, measure, factor, unit } in PATCH_TABLE {
        let Some(found) = checked.patch.get(&measure) else { continue };
        let note = found.note.as_deref();
        let Some(mean) = found.mean else {
            if let Some(note) = note {
                let _ = writeln!(
                    out,
                    "<tr><td>{label}</td><td class=\"n\">\u{2013}</td><td colspan=\"4\">{}</td></tr>",
                    escape(note)
                );
            }
            continue;
        };
        let reference = half_space(basis, measure).map(|value| digits(factor * value, 4));
        let _ = writeln!(
            out,
            "<tr><td>{label}</td><td class=\"n\">{}</td><td>{unit}</td><td class=\"n\">{}</td>\
             <td class=\"n\">{}</td><td class=\"n\">{}</td>{}</tr>",
            worth(factor * mean, found.ci95.map(|half| factor * half)),
            found
                .ci95
                .map(|half| format!("\u{b1} {}", digits(factor * half, 2)))
                .unwrap_or_default(),
            found.deviation.map(|d| digits(factor * d, 2)).unwrap_or_default(),
            reference.unwrap_or_default(),
            note.map(|note| format!("<td>{}</td>", escape(note))).unwrap_or_default()
        );
    }
    out.push_str(
        "</table></div>\n<p class=\"note\">95 % interval: that of the mean, from batches of records. It is missing where \
         the value drifts during the window. Deviation: the standard deviation over the records.</p>\n",
    );
}

fn energy(out: &mut String, basis: &Basis) {
    let Some(Summary { energy, .. }) = &basis.summary else { return };
    out.push_str("<h3>Energy at the end</h3>\n<table>\n");
    for (label, value) in [
        ("kinetic", energy.kinetic),
        ("strain", energy.internal),
        ("hourglass stiffness", energy.hourglass),
        ("contact springs", energy.contact_stored),
        ("heat of friction", energy.friction_dissipated),
        ("heat of damping", energy.damping_dissipated),
        ("work of drive and load", energy.external_work),
    ] {
        let _ =
            writeln!(out, "<tr><td>{label}</td><td class=\"n\">{} J</td></tr>", digits(value, 4));
    }
    let _ = writeln!(
        out,
        "</table>\n<p>The energy balance closes to {} of the largest energy exchanged.</p>",
        digits(energy.balance_error, 2)
    );
    if energy.internal > 0.0 {
        let _ = writeln!(
            out,
            "<p>Hourglass energy is {} % of the strain energy (commonly kept below 1 %).</p>",
            digits(100.0 * energy.hourglass / energy.internal, 2)
        );
    }
}

/// The commands that repeat the run in `folder`, into a folder beside it.
fn repeating(folder: &Path) -> String {
    let beside = match folder.file_name() {
        Some(name) => folder.with_file_name(format!("{}-again", name.to_string_lossy())),
        None => folder.join("again"),
    };
    let [case, again] =
        [folder.join(file::CASE), beside].map(|path| quoted(&path.to_string_lossy()));
    format!(
        "creepage run {case} --out {again}\ncreepage check {again}\ncreepage plot {again}\ncreepage report {again}"
    )
}

fn reproduce(out: &mut String, basis: &Basis, folder: &Path) {
    out.push_str("<h3 id=\"reproduce\">How to reproduce</h3>\n");
    let friction = basis.case.as_ref().and_then(|case| case.get("friction"));
    if foreign::is_foreign(basis, folder) {
        out.push_str(
            "<p>The records are of another program, which alone can make them again.</p>\n",
        );
    } else if friction.and_then(|f| f.get("law")).is_some_and(|law| law.as_str() == Some("python"))
    {
        out.push_str(
            "<p>In Python, with the friction law of the run: <code>creepage.run(case, law=law)</code>, where case is \
             the one below.</p>\n",
        );
    } else {
        let _ = writeln!(
            out,
            "<p>In the folder from which <code>creepage report</code> was started, or with the case below saved there \
             as a file:</p>\n<pre>{}</pre>\n\
             <p>Running the resolved case again gives the same bits on the same kind of processor.</p>",
            escape(&repeating(folder))
        );
    }
    let _ = writeln!(out, "<p>Made by Creepage {}.</p>", env!("CARGO_PKG_VERSION"));
    if let Some(text) = basis.case.as_ref().and_then(|case| toml::to_string_pretty(case).ok()) {
        let _ = writeln!(
            out,
            "<details><summary>case.toml, as resolved</summary><pre>{}</pre></details>",
            escape(&text)
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_has_the_digits_that_its_interval_leaves_it() {
        assert_eq!(worth(0.261_23, Some(0.02)), "0.261");
        assert_eq!(worth(1212.7, Some(300.0)), "1213");
        assert_eq!(worth(0.261_23, Some(0.3)), "0.3");
        assert_eq!(worth(0.261_23, None), "0.2612");
        assert_eq!(worth(0.261_23, Some(1e-9)), "0.2612");
    }

    #[test]
    fn the_commands_that_repeat_a_run_name_its_folder_as_it_was_named() {
        let first = |folder: &str| repeating(Path::new(folder)).lines().next().map(str::to_owned);
        for (folder, case, again) in [
            ("runs/quick", "runs/quick/case.toml", "runs/quick-again"),
            ("runs/quick/", "runs/quick/case.toml", "runs/quick-again"),
            ("a run", "'a run/case.toml'", "'a run-again'"),
            (".", "./case.toml", "./again"),
            ("..", "../case.toml", "../again"),
        ] {
            assert_eq!(first(folder), Some(format!("creepage run {case} --out {again}")));
        }
    }

    #[test]
    fn text_cannot_become_markup() {
        assert_eq!(escape("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
    }
}
