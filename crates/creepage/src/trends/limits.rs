//! Three questions to a sweep: does the force settle, do the fluctuations of slip, and where are the conditions of
//! contact violated? A sentence for each, and a figure of what they follow from.

use super::figures::panel;
use super::groups::{Group, Sweep};
use super::lines::{GROUPS, axis_over, label, spans_decades};
use super::measures::{MEASURES, SweepMeasure};
use super::verdict::{group_trend, towards_zero};
use crate::chart::{Axis, Draw, Figure, Panel, Scale, Series};
use crate::check::digits::digits;

/// Name of the figure.
pub(crate) const LIMITS: &str = "limits";

const FORCE: &str = "T/N";
const FLUCTUATION: &str = "fluctuation of slip";
const VIOLATING: &str = "violating_fraction";
const VIOLATING_IN_SLIP: &str = "violating_fraction_slip_state";

fn measure(name: &str) -> Option<&'static SweepMeasure> {
    MEASURES.iter().find(|measure| measure.name == name)
}

/// The questions with their answers; a question that no run of the sweep answers is left out.
pub(crate) fn answers(sweep: &Sweep<'_>) -> Vec<(&'static str, String)> {
    let grows = |axis: &str| {
        let way = if towards_zero(axis) { "goes to zero" } else { "grows" };
        format!("As {axis} {way}")
    };
    let trends =
        |name| answer(sweep, grows, |axis, group| trend_along(sweep, axis, group, measure(name)?));
    let over = |axis: &str| format!("Over {axis}");
    let questions = [
        ("Does the force T/N settle?", trends(FORCE)),
        ("Do the fluctuations of slip settle?", trends(FLUCTUATION)),
        (
            "Where are the conditions of contact violated?",
            answer(sweep, over, |_, group| violations(sweep, group)),
        ),
    ];
    questions.into_iter().filter_map(|(question, answer)| Some((question, answer?))).collect()
}

/// The axes along which a trend can be seen.
fn axes<'a>(sweep: &Sweep<'a>) -> Vec<&'a str> {
    let mut axes = sweep.numeric_axes();
    axes.retain(|axis| sweep.values(axis).len() > 2);
    axes
}

/// What `of` says of the groups of each axis, in a sentence that `begins` with the axis.
fn answer(
    sweep: &Sweep<'_>,
    begins: impl Fn(&str) -> String,
    of: impl Fn(&str, &Group<'_>) -> Option<String>,
) -> Option<String> {
    let mut sentences = Vec::new();
    for axis in axes(sweep) {
        let said = |group: &Group<'_>| {
            let with = if group.label.is_empty() { "" } else { " with " };
            Some(format!("{with}{} {}", group.label, of(axis, group)?))
        };
        let said: Vec<String> = sweep.groups(axis).iter().filter_map(said).collect();
        if !said.is_empty() {
            sentences.push(format!("{},{}.", begins(axis), said.join(";")));
        }
    }
    (!sentences.is_empty()).then(|| sentences.join(" "))
}

/// What a measure does along an axis, and its value with exact contact.
fn trend_along(
    sweep: &Sweep<'_>,
    axis: &str,
    group: &Group<'_>,
    measure: &SweepMeasure,
) -> Option<String> {
    let (_, trend) = group_trend(axis, group, measure)?;
    let points = group.points(measure);
    let last = if towards_zero(axis) { points.first() } else { points.last() }?;
    let exact = sweep.exact_beside(group).and_then(|run| measure.of(run));
    let exact = exact
        .map_or(String::new(), |exact| format!(" (exact contact: {})", digits(exact.value, 4)));
    Some(format!("it {}{exact}", trend.phrase(last.1.value, measure.unit)))
}

/// The shares of the contact that violate the conditions over a group, and with exact contact.
fn violations(sweep: &Sweep<'_>, group: &Group<'_>) -> Option<String> {
    let [all, in_slip] = [measure(VIOLATING)?, measure(VIOLATING_IN_SLIP)?];
    let over = |measure| {
        let values = group.points(measure).into_iter().map(|(_, point)| 100.0 * point.value);
        values.fold(None, |ends: Option<[f64; 2]>, value| {
            let [low, high] = ends.unwrap_or([value; 2]);
            Some([low.min(value), high.max(value)])
        })
    };
    let exact = sweep.exact_beside(group).and_then(|run| all.of(run));
    let exact = exact.map_or(String::new(), |exact| {
        format!(" (exact contact: {} %)", digits(100.0 * exact.value, 2))
    });
    Some(format!(
        "on {} of contact area and time, on {} where nodes slip by the algorithm{exact}",
        percent(over(all)?),
        percent(over(in_slip)?)
    ))
}

/// A range of percentages in words.
fn percent([low, high]: [f64; 2]) -> String {
    let [low, high] = [low, high].map(|value| digits(value, 2));
    if low == high { format!("{low} %") } else { format!("{low} to {high} %") }
}

/// The measures of the questions over each axis of numbers, with the limits and the values of exact contact; `None`
/// where no axis has three values.
pub(super) fn limits(sweep: &Sweep<'_>) -> Option<Figure> {
    let axes = axes(sweep);
    let mut panels = Vec::new();
    for measure in [FORCE, FLUCTUATION, VIOLATING].into_iter().filter_map(measure) {
        for axis in &axes {
            let mut groups = sweep.groups(axis);
            groups.retain(|group| group.points(measure).len() > 1);
            let x = axis_over(&label(axis, sweep.form(axis)), &sweep.values(axis));
            let Some(panel) = panel(measure, &x, &groups, panels.is_empty()) else { continue };
            let named = panels.is_empty();
            panels.push(beside(panel, sweep, axis, &groups, measure, named));
        }
    }
    if panels.is_empty() {
        return None;
    }
    let columns = axes.len().clamp(1, 3);
    let caption = "Tangential over normal force, fluctuation of slip and share of the contact that violates the \
                   conditions. Large dots: the limit that the points give, with its interval, where the axis ends. \
                   Dashed: exact contact, without springs."
        .into();
    let size = [360 * columns as u32, 270 * panels.len().div_ceil(columns) as u32 + 60];
    Some(Figure { size, columns, panels, caption })
}

/// A panel with the limits of its groups at the end of the axis, and lines for exact contact.
fn beside(
    mut panel: Panel,
    sweep: &Sweep<'_>,
    axis: &str,
    groups: &[Group<'_>],
    measure: &SweepMeasure,
    named: bool,
) -> Panel {
    let xs = sweep.values(axis);
    let [Some(&first), Some(&last)] = [xs.first(), xs.last()] else { return panel };
    let log = spans_decades(xs.iter().copied());
    // half a decade beyond the last value; a linear axis that is refined to zero ends there
    let end = match (towards_zero(axis), log) {
        (true, true) => first / 3.0,
        (true, false) => 0.0,
        (false, true) => 3.0 * last,
        (false, false) => last + 0.2 * (last - first),
    };
    let mut values: Vec<f64> = Vec::new();
    for (k, group) in groups.iter().enumerate() {
        let colour = GROUPS[k % GROUPS.len()];
        let unnamed = |points, draw| Series { label: String::new(), points, draw };
        if let Some([limit, half]) =
            group_trend(axis, group, measure).and_then(|(_, trend)| trend.limit())
        {
            let bar = vec![[end, limit - half], [end, limit + half]];
            values.extend(bar.iter().map(|point| point[1]));
            panel.series.push(unnamed(bar, Draw::Line(colour)));
            panel.series.push(unnamed(vec![[end, limit]], Draw::Dots(colour, 5.0)));
        }
        if let Some(exact) = sweep.exact_beside(group).and_then(|run| measure.of(run)) {
            let label =
                if named { format!("exact contact, {}", group.label) } else { String::new() };
            let label = label.trim_end_matches(", ").to_owned();
            values.push(exact.value);
            let points = vec![[first.min(end), exact.value], [last.max(end), exact.value]];
            panel.series.push(Series { label, points, draw: Draw::Dashed(colour) });
        }
    }
    widen(&mut panel.y, &values);
    panel
}

/// Widens a linear axis so that it shows `values`; a logarithmic one without a range takes them from the series.
fn widen(axis: &mut Axis, values: &[f64]) {
    if let (Some([low, high]), Scale::Linear) = (&mut axis.range, axis.scale) {
        let margin = 0.04 * (*high - *low);
        for value in values.iter().filter(|value| value.is_finite()) {
            *low = low.min(value - margin);
            *high = high.max(value + margin);
        }
    }
}
