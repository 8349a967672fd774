//! The page of a sweep: its verdicts, its table and its figures.

use super::{escape, head};
use crate::chart::Figure;
use crate::check::PostError;
use crate::check::digits::digits;
use crate::sweep::plan::{self, quoted};
use crate::sweep::result::{Entry, SweepPlan, SweepResult};
use crate::trends::{
    LIMITS, MEASURES, RULE, Sweep, SweepVerdict, answers, steps, sweep_figures, sweep_verdicts,
    value_text,
};
use std::fmt::Write;
use std::path::Path;

/// The HTML page of a sweep: `name` is its title, `path` its `sweep.json`.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn sweep_page(name: &str, path: &Path, sweep: &SweepResult) -> Result<String, PostError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let known = Sweep::of(folder, sweep);
    let verdicts = sweep_verdicts(folder, sweep);
    let mut out = head(name);
    let completed = known.completed().count();
    let _ = writeln!(
        out,
        "<h1>{}</h1>\n<p>{} {} over {}; {completed} completed.</p>",
        escape(name),
        known.runs.len(),
        if known.ensemble { "points of an ensemble" } else { "runs" },
        escape(&known.axes.join(", "))
    );
    if let Some(title) = &sweep.plan.title {
        let _ = writeln!(out, "<p>{}</p>", escape(title));
    }
    if let Some(text) = time_step(&known, &sweep.plan) {
        let _ = writeln!(out, "<p>{text}</p>");
    }
    if known.ensemble {
        out.push_str(
            "<p>Each value is the mean over the members of its point, which differ by a disturbance of the \
             preload alone, with half the width of the 95 % confidence interval of that mean.</p>\n",
        );
    }
    for (question, answer) in answers(&known) {
        let _ = writeln!(out, "<p><b>{question}</b> {}</p>", escape(&answer));
    }
    let (limits, figures): (Vec<_>, Vec<_>) =
        sweep_figures(folder, sweep).into_iter().partition(|(stem, _)| stem == LIMITS);
    draw(&mut out, &limits)?;
    trends(&mut out, &verdicts);
    table(&mut out, &known);
    out.push_str("<h2>Figures</h2>\n");
    draw(&mut out, &figures)?;
    if let Some(name) =
        sweep.runs.iter().find_map(|run| run.name.as_deref()).filter(|_| !known.ensemble)
    {
        let case = quoted(&plan::case_file(folder, name).display().to_string());
        let again = quoted(&folder.join("again").join(name).display().to_string());
        let _ = writeln!(
            out,
            "<h2>How to reproduce</h2>\n<p>The cases of the runs are in the folder of the sweep, each with all its values. \
             For one of them, in the folder from which this page was made:</p>\n<pre>creepage run {} --out {}</pre>",
            escape(&case),
            escape(&again)
        );
    }
    let _ = writeln!(
        out,
        "<p>Made by Creepage {} from {}.</p>",
        env!("CARGO_PKG_VERSION"),
        escape(&path.file_name().unwrap_or_default().to_string_lossy())
    );
    super::end(&mut out);
    Ok(out)
}

fn draw(out: &mut String, figures: &[(String, Figure)]) -> Result<(), PostError> {
    for (stem, figure) in figures {
        let svg = figure.svg_element()?;
        let _ = writeln!(out, "<figure id=\"{stem}\">{svg}</figure>");
    }
    Ok(())
}

/// The time step of the runs, in a sentence, with the rule that it follows; `None` where no run has one.
fn time_step(sweep: &Sweep<'_>, plan: &SweepPlan) -> Option<String> {
    let Some(differing) = steps(sweep.completed()) else {
        let step = sweep.completed().find_map(|run| run.step())?;
        return Some(format!("Time step of all runs: {}.", nanoseconds([step, step])));
    };
    let why = if plan.step_is_bound() {
        " (rule \u{201c}bound\u{201d}: time.factor times the stability limit of each run)"
    } else {
        ""
    };
    Some(format!("The time step differs from run to run: {}{why}.", nanoseconds(differing)))
}

/// Time steps (s) in nanoseconds.
fn nanoseconds([least, most]: [f64; 2]) -> String {
    let of = |step: f64| digits(1e9 * step, 4);
    if least == most {
        format!("{} ns", of(least))
    } else {
        format!("{} to {} ns", of(least), of(most))
    }
}

/// The verdicts, for each axis and each combination of values of the others.
fn trends(out: &mut String, verdicts: &[SweepVerdict]) {
    out.push_str("<h2>What settles, and what does not</h2>\n");
    if verdicts.is_empty() {
        out.push_str(
            "<p>No axis of numbers has two runs that completed: nothing can be said.</p>\n",
        );
        return;
    }
    let _ = writeln!(
        out,
        "<p>From the fit v = v\u{221e} + c r<sup>\u{2212}q</sup> to the last points of each measure, r growing as the \
         axis is refined; T/N and shear over k<sub>t</sub> by springs in series, 1/v = 1/v\u{221e} + c/k<sub>t</sub>. \
         slip_roughness is the standard deviation over time of |s|/s<sub>c</sub>; roughness_ratio that of \
         p<sub>f</sub>/p<sub>n</sub> over that of the coefficient which the law gives for the same slip. {RULE} More: docs/checks.md of Creepage, Verdicts on a sweep.</p>"
    );
    let (few, verdicts): (Vec<&SweepVerdict>, Vec<&SweepVerdict>) =
        verdicts.iter().partition(|v| {
            let alike = verdicts.iter().filter(|other| other.axis == v.axis);
            alike.map(|other| other.points).max() < Some(3)
        });
    let section = |a: &&SweepVerdict, b: &&SweepVerdict| a.axis == b.axis && a.others == b.others;
    for verdicts in verdicts.chunk_by(section) {
        let (axis, others) = (escape(&verdicts[0].axis), escape(&verdicts[0].others));
        let others = if others.is_empty() { others } else { format!(", {others}") };
        let _ = writeln!(out, "<h3>{axis}{others}</h3>");
        if let Some(steps) = verdicts[0].time_steps {
            let _ = writeln!(
                out,
                "<p>The time step changes along this axis, from {}: the trends may be of either.</p>",
                nanoseconds(steps)
            );
        }
        let most = verdicts.iter().map(|verdict| verdict.points).max().unwrap_or(0);
        if most < 3 {
            let _ = writeln!(out, "<p>{}</p>", too_few(most));
            continue;
        }
        out.push_str(
            "<div class=\"wide lines verdicts\"><table>\n<tr><th>measure</th><th class=\"n\">points</th><th>verdict</th>\
             <th>trend</th></tr>\n",
        );
        for verdict in verdicts {
            let _ = writeln!(
                out,
                "<tr><td>{}</td><td class=\"n\">{}</td><td>{}</td><td>{}</td></tr>",
                escape(verdict.measure),
                verdict.points,
                verdict.verdict,
                escape(&verdict.why)
            );
        }
        out.push_str("</table></div>\n");
    }
    for verdicts in few.chunk_by(|a, b| a.axis == b.axis) {
        let most = verdicts.iter().map(|verdict| verdict.points).max().unwrap_or(0);
        let axis = escape(&verdicts[0].axis);
        let _ = writeln!(out, "<h3>{axis}</h3>\n<p>{}</p>", too_few(most));
    }
}

fn too_few(points: usize) -> String {
    format!("Cannot be told: {points} points; three are the least.")
}

/// The table of all runs, with the reason of those that failed.
fn table(out: &mut String, sweep: &Sweep<'_>) {
    out.push_str(if sweep.ensemble { "<h2>Points</h2>" } else { "<h2>Runs</h2>" });
    out.push_str("\n<div class=\"wide\"><table>\n<tr>");
    for axis in &sweep.axes {
        let _ = write!(out, "<th class=\"n\">{}</th>", escape(axis));
    }
    out.push_str("<th>status</th>");
    let has = |measure: &&crate::trends::SweepMeasure| {
        measure.in_table && sweep.runs.iter().any(|run| measure.of(*run).is_some())
    };
    let columns: Vec<_> = MEASURES.iter().filter(has).collect();
    for measure in &columns {
        let _ = write!(out, "<th class=\"n\">{}</th>", escape(&measure.heading()));
    }
    out.push_str("<th>checks</th></tr>\n");
    for run in &sweep.runs {
        out.push_str("<tr>");
        for axis in &sweep.axes {
            let value = value_text(run.parameters().get(*axis));
            let _ = write!(out, "<td class=\"n\">{}</td>", escape(&value));
        }
        let reason = match run {
            Entry::Run(run) => run.reason.as_ref().map(|reason| format!(": {reason}")),
            Entry::Point(_) => None,
        };
        let status = format!("{}{}", run.status(), reason.unwrap_or_default());
        let _ = write!(out, "<td>{}</td>", escape(&status));
        for measure in &columns {
            let point = measure.of(*run);
            let half = point.and_then(|point| point.half);
            let half = half.map_or(String::new(), |half| format!(" \u{b1} {}", digits(half, 2)));
            let text = point.map_or("\u{2013}".into(), |point| digits(point.value, 4) + &half);
            let _ = write!(out, "<td class=\"n\">{text}</td>");
        }
        let (word, class) = match run.check().map(|check| check.pass) {
            Some(true) => ("pass", "pass"),
            Some(false) => ("fail", "fail"),
            None => ("", ""),
        };
        let _ = writeln!(out, "<td class=\"{class}\">{word}</td></tr>");
    }
    out.push_str("</table></div>\n");
}
